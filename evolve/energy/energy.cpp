#include "evolve/energy/energy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/operation_count.h"
#include "evolve/energy/bent_facets.h"
#include "evolve/energy/facet_terms.h"
#include "evolve/energy/over_term.h"

namespace meniscus::energy {

namespace {

// Operations a facet (docs/theory.md, Counting work).
constexpr double kAreaWork = 23.0;
constexpr double kAreaSlopeWork = 56.0;
constexpr double kConeWork = 24.0;
constexpr double kConeSlopeWork = 55.0;
constexpr double kLumpWork = 25.0;
constexpr double kCosineWork = 48.0;

}  // namespace

FilmEnergy::~FilmEnergy() = default;
FilmEnergy::FilmEnergy(FilmEnergy&&) noexcept = default;
FilmEnergy& FilmEnergy::operator=(FilmEnergy&&) noexcept = default;

FilmEnergy::FilmEnergy(const films::FilmComplex& complex, FilmMotion motion)
    : space_(complex, motion),
      facets_(complex.mesh.facets),
      label_(complex.mesh.facet_label),
      terms_(film_terms(complex)),
      body_count_(static_cast<int>(complex.bodies.size())),
      quantity_count_(static_cast<int>(complex.quantities.size())) {
  if (std::any_of(
          complex.bodies.begin(), complex.bodies.end(),
          [](const films::ComplexBody& b) { return b.density != 0.0; })) {
    gravity_ = complex.gravity;
  }
  functional_count_ =
      body_count_ + static_cast<int>(held_quantities(complex).size());
  volume_offset_ = VectorX::Zero(functional_count_);
  for (int b = 0; b < body_count_; ++b) {
    const bool closed = closed_by_facets(complex, b);
    cone_.push_back(closed || complex.volume_rule == films::VolumeRule::Cone);
    open_cones_ = open_cones_ || (cone_.back() != 0 && !closed);
    volume_offset_[b] = complex.bodies[b].volume_offset;
  }
  for (const films::ComplexSurface& surface : complex.surfaces) {
    liquid_.push_back(surface.liquid ? 1 : 0);
    const bool bent = surface.wetted && surface.wetted->bent;
    const bool flat = surface.wetted && !bent;
    counted_.push_back(surface.liquid || flat ? 1 : 0);
    flat_.push_back(flat ? std::optional(surface.wetted->normal)
                         : std::nullopt);
    plain_.push_back(counted_.back() != 0 && !surface.tension_field &&
                             surface.drop_shape.empty()
                         ? 1
                         : 0);
    tense_.push_back(plain_.back() != 0 || bent ? 1 : 0);
    if (bent) {
      add_bent_area(complex, static_cast<int>(side_.size()));
    }
    resisted_ = resisted_ || surface.tension_field;
    std::vector<int> sides(body_count_, 0);
    const int s = static_cast<int>(side_.size());
    for (int b = 0; b < body_count_; ++b) {
      for (const films::BodySide& side : complex.bodies[b].sides) {
        sides[b] += side.surface == s ? side.sign : 0;
      }
    }
    side_.push_back(std::move(sides));
  }
  for (const films::FilmQuantity& quantity : complex.quantities) {
    const bool energy = quantity.role == films::FilmQuantity::Role::Energy;
    modulus_.push_back(energy ? quantity.modulus : 1.0);
    resisted_ = resisted_ || quantity.role != films::FilmQuantity::Role::Info;
  }
  corner_start_.reserve(facets_.size() + 1);
  corner_start_.push_back(0);
  for (const Triangle& t : facets_) {
    for (int k = 0; k < 3; ++k) {
      const int first = space_.first(t[k]);
      for (int r = 0; r < space_.rank(t[k]); ++r) {
        corners_.push_back({k, first + r});
      }
    }
    corner_start_.push_back(static_cast<int>(corners_.size()));
  }
  find_floating(complex);
  build_pattern();
}

void FilmEnergy::add_bent_area(const films::FilmComplex& complex, int surface) {
  const films::WettedWall& wall = *complex.surfaces[surface].wetted;
  BentArea& area = bent_.emplace_back();
  area.surface = surface;
  area.term = bent_area_term(*wall.bent, wall.side);
  for (std::size_t f = 0; f < label_.size(); ++f) {
    if (label_[f] == surface) {
      area.elements.push_back({static_cast<int>(f), 1.0, 0});
    }
  }
}

FacetJet FilmEnergy::jet_of(const BentArea& area,
                            const FilmTerm::Element& element,
                            const Points& points, JetOrder order) const {
  return area.term->jet(element, corners_of(points, facets_[element.facet]),
                        order, {});
}

double FilmEnergy::value(const Points& points,
                         const films::FilmTargets& targets) const {
  double sum = 0.0;
  count_operations(kAreaWork * static_cast<double>(facets_.size()));
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (plain_[label_[f]] != 0) {
      const Triangle& t = facets_[f];
      const Vec3& a = points[t[0]];
      const Vec3 area2 = (points[t[1]] - a).cross(points[t[2]] - a);
      const Vec3* normal = flat(static_cast<int>(f));
      sum += targets.tension[label_[f]] *
             (normal != nullptr ? normal->dot(area2) : area2.norm());
    }
  }
  sum *= 0.5;
  for (const BentArea& area : bent_) {
    for (const FilmTerm::Element& e : area.elements) {
      sum += targets.tension[area.surface] *
             jet_of(area, e, points, JetOrder::Value).value;
    }
  }
  for (const auto& term : terms_) {
    if (term->functional() == -1) {
      over_term(*term, points, JetOrder::Value,
                numbers_of(*term, targets.numbers),
                [&](const FilmTerm::Element& /*e*/, const FacetJet& jet) {
                  sum += jet.value;
                });
    }
  }
  return sum;
}

double FilmEnergy::area(const Points& points) const {
  double sum = 0.0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] != 0) {
      const Triangle& t = facets_[f];
      const Vec3& a = points[t[0]];
      sum += (points[t[1]] - a).cross(points[t[2]] - a).norm();
    }
  }
  return 0.5 * sum;
}

/// A point of the film keeps the cones of closed bodies small. The line
/// integrals that close others count on cones to the origin.
Vec3 FilmEnergy::cone_origin(const Points& points) const {
  return points.empty() || open_cones_ ? Vec3::Zero() : points.front();
}

VectorX FilmEnergy::volumes(const Points& points) const {
  VectorX sum = volume_offset_;
  const Vec3 origin = cone_origin(points);
  if (body_count_ > 0) {
    count_operations((kConeWork + 2.0 * body_count_) *
                     static_cast<double>(facets_.size()));
  }
  for (std::size_t f = 0; f < facets_.size() && body_count_ > 0; ++f) {
    const Triangle& t = facets_[f];
    const Vec3 a = points[t[0]] - origin;
    const double cone =
        a.dot((points[t[1]] - origin).cross(points[t[2]] - origin)) / 6.0;
    for (int b = 0; b < body_count_; ++b) {
      if (cone_[b] != 0) {
        sum[b] += side_[label_[f]][b] * cone;
      }
    }
  }
  for (const auto& term : terms_) {
    if (term->functional() >= 0) {
      over_term(*term, points, JetOrder::Value, {},
                [&](const FilmTerm::Element& /*e*/, const FacetJet& jet) {
                  sum[term->functional()] += jet.value;
                });
    }
  }
  return sum;
}

VectorX FilmEnergy::quantities(const Points& points,
                               const films::FilmTargets& targets) const {
  VectorX sum = VectorX::Zero(quantity_count_);
  for (const auto& term : terms_) {
    const int q = term->quantity();
    if (q >= 0) {
      over_term(*term, points, JetOrder::Value,
                numbers_of(*term, targets.numbers),
                [&](const FilmTerm::Element& /*e*/, const FacetJet& jet) {
                  sum[q] += jet.value;
                });
    }
  }
  for (int q = 0; q < quantity_count_; ++q) {
    sum[q] = modulus_[q] != 0.0 ? sum[q] / modulus_[q] : 0.0;
  }
  return sum;
}

Points FilmEnergy::gradient(const Points& points,
                            const films::FilmTargets& targets) const {
  VectorX weight(static_cast<Eigen::Index>(plain_.size()));
  for (std::size_t s = 0; s < plain_.size(); ++s) {
    weight[static_cast<Eigen::Index>(s)] =
        has_tension(static_cast<int>(s)) ? targets.tension[s] : 0.0;
  }
  Points sum = area_gradient(points, weight);
  add_term_gradients(points, -1, targets.numbers, sum);
  return sum;
}

VectorX FilmEnergy::areas(const Points& points) const {
  VectorX sum = VectorX::Zero(static_cast<Eigen::Index>(liquid_.size()));
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (counted_[label_[f]] != 0) {
      const std::array<Vec3, 3> c = corners_of(points, facets_[f]);
      const Vec3 area2 = (c[1] - c[0]).cross(c[2] - c[0]);
      const Vec3* normal = flat(static_cast<int>(f));
      sum[label_[f]] +=
          0.5 * (normal != nullptr ? normal->dot(area2) : area2.norm());
    }
  }
  for (const BentArea& area : bent_) {
    for (const FilmTerm::Element& e : area.elements) {
      sum[area.surface] += jet_of(area, e, points, JetOrder::Value).value;
    }
  }
  return sum;
}

Points FilmEnergy::area_gradient(const Points& points,
                                 const VectorX& weight) const {
  Points sum(points.size(), Vec3::Zero());
  count_operations(kAreaSlopeWork * static_cast<double>(facets_.size()));
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const int label = label_[f];
    if (counted_[label] == 0 || weight[label] == 0.0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3 ab = points[t[1]] - points[t[0]];
    const Vec3 ac = points[t[2]] - points[t[0]];
    Vec3 n = ab.cross(ac);
    const double size = n.norm();
    if (const Vec3* normal = flat(static_cast<int>(f)); normal != nullptr) {
      n = 0.5 * weight[label] * *normal;
    } else if (size > 0.0) {
      n *= 0.5 * weight[label] / size;
    }
    // dA/dx_i = n x e_i / 2, e_i opposite: e_b = -ac, e_c = ab.
    const Vec3 at_b = ac.cross(n);
    const Vec3 at_c = n.cross(ab);
    sum[t[1]] += at_b;
    sum[t[2]] += at_c;
    sum[t[0]] -= at_b + at_c;
  }
  for (const BentArea& area : bent_) {
    const double w = weight[area.surface];
    for (const FilmTerm::Element& e : area.elements) {
      if (w == 0.0) {
        break;
      }
      const FacetJet jet = jet_of(area, e, points, JetOrder::Gradient);
      for (int k = 0; k < 3; ++k) {
        sum[facets_[e.facet][k]] += w * jet.gradient.segment<3>(3 * k);
      }
    }
  }
  return sum;
}

void FilmEnergy::add_term_gradients(const Points& points, int functional,
                                    const std::vector<VectorX>& numbers,
                                    Points& sum) const {
  for (const auto& term : terms_) {
    if (term->functional() != functional) {
      continue;
    }
    over_term(*term, points, JetOrder::Gradient, numbers_of(*term, numbers),
              [&](const FilmTerm::Element& e, const FacetJet& jet) {
                for (int k = 0; k < 3; ++k) {
                  sum[facets_[e.facet][k]] += jet.gradient.segment<3>(3 * k);
                }
              });
  }
}

Points FilmEnergy::functional_gradient(const Points& points,
                                       int functional) const {
  Points sum(points.size(), Vec3::Zero());
  const Vec3 origin = cone_origin(points);
  if (functional < body_count_ && cone_[functional] != 0) {
    count_operations(kConeSlopeWork * static_cast<double>(facets_.size()));
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      const int sign = side_[label_[f]][functional];
      if (sign == 0) {
        continue;
      }
      const Triangle& t = facets_[f];
      const Vec3 a = points[t[0]] - origin;
      const Vec3 b = points[t[1]] - origin;
      const Vec3 c = points[t[2]] - origin;
      const double w = sign / 6.0;
      sum[t[0]] += w * b.cross(c);
      sum[t[1]] += w * c.cross(a);
      sum[t[2]] += w * a.cross(b);
    }
  }
  add_term_gradients(points, functional, {}, sum);
  return sum;
}

VectorX FilmEnergy::along(const Points& slope, const Points& directions) const {
  VectorX result(unknowns());
  count_operations(5.0 * unknowns());
  for (int i = 0; i < unknowns(); ++i) {
    result[i] = slope[vertices()[i]].dot(directions[i]);
  }
  return result;
}

VectorX FilmEnergy::lumped_area(const Points& points) const {
  std::vector<double> at(points.size(), 0.0);
  count_operations(kLumpWork * static_cast<double>(facets_.size()));
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3& a = points[t[0]];
    const double area2 = (points[t[1]] - a).cross(points[t[2]] - a).norm();
    for (const int v : t) {
      at[v] += area2 / 6.0;
    }
  }
  VectorX sum(unknowns());
  for (int i = 0; i < unknowns(); ++i) {
    sum[i] = at[vertices()[i]];
  }
  return sum;
}

double FilmEnergy::smallest_cosine(const Points& points, const Points& base,
                                   int* facet) const {
  double least = 1.0;
  count_operations(kCosineWork * static_cast<double>(facets_.size()));
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] == 0 || corner_start_[f] == corner_start_[f + 1]) {
      continue;
    }
    const Triangle& t = facets_[f];
    const auto normal2 = [&t](const Points& x) -> Vec3 {
      return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
    };
    const Vec3 now = normal2(points);
    const Vec3 was = normal2(base);
    const double size = std::sqrt(now.squaredNorm() * was.squaredNorm());
    const double cosine = size > 0.0 ? now.dot(was) / size : -1.0;
    if (!(cosine >= least)) {  // not finite counts as folded
      least = std::isfinite(cosine) ? cosine : -1.0;
      if (facet != nullptr) {
        *facet = static_cast<int>(f);
      }
    }
  }
  return least;
}

double FilmEnergy::mean_edge(const Points& points) const {
  double sum = 0.0;
  long count = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[label_[f]] != 0) {
      for (int k = 0; k < 3; ++k) {
        sum += (points[facets_[f][(k + 1) % 3]] - points[facets_[f][k]]).norm();
      }
      count += 3;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace meniscus::energy
