#include "evolve/energy/film_products.h"

#include <algorithm>
#include <utility>

#include "core/parallel_for.h"
#include "evolve/energy/facet_terms.h"
#include "evolve/energy/over_term.h"

namespace meniscus::energy {

namespace {

using Corners = std::array<Vec3, 3>;

/// Slope at 0 from four places, to fourth order: times the step, weight. The
/// step, of a mean edge, is small against any field's length.
constexpr std::array<std::array<double, 2>, 4> kSlope = {{{1.0, 2.0 / 3.0},
                                                          {-1.0, -2.0 / 3.0},
                                                          {2.0, -1.0 / 12.0},
                                                          {-2.0, 1.0 / 12.0}}};
constexpr double kTermStep = 1e-3;

/// What a motion of its corners does to a facet.
struct FacetMotion {
  std::array<Vec3, 3> opposite;  // of e_i
  Vec3 normal2 = Vec3::Zero();   // of N
  Vec3 normal = Vec3::Zero();    // of n; zero where that does not turn

  FacetMotion(const FacetFrame& frame, const Corners& d)
      : opposite{d[2] - d[1], d[0] - d[2], d[1] - d[0]} {
    for (int i = 0; i < 3; ++i) {
      normal2 += frame.opposite[i].cross(d[i]);
    }
    if (frame.turns) {
      normal =
          (normal2 - frame.normal.dot(normal2) * frame.normal) / frame.area2;
    }
  }
};

}  // namespace

FilmProducts::FilmProducts(const FilmEnergy& energy,
                           const films::FilmTargets& targets, VectorX pressure)
    : energy_(energy),
      tension_(VectorX::Zero(static_cast<Eigen::Index>(energy.plain_.size()))),
      numbers_(targets.numbers),
      energies_(1.0),
      pressure_(std::move(pressure)) {
  for (std::size_t s = 0; s < energy.plain_.size(); ++s) {
    if (energy.has_tension(static_cast<int>(s))) {
      tension_[static_cast<Eigen::Index>(s)] = targets.tension[s];
    }
  }
}

FilmProducts::FilmProducts(const FilmEnergy& energy, VectorX pressure)
    : energy_(energy),
      tension_(VectorX::Zero(static_cast<Eigen::Index>(energy.plain_.size()))),
      energies_(0.0),
      pressure_(std::move(pressure)) {}

template <class OfFacet>
VectorX FilmProducts::over_films(const Points& points, const Points& motion,
                                 const OfFacet& of_facet) const {
  const FilmEnergy& e = energy_;
  VectorX sum = VectorX::Zero(static_cast<Eigen::Index>(e.liquid_.size()));
  for (std::size_t f = 0; f < e.facets_.size(); ++f) {
    if (e.counted_[e.label_[f]] != 0) {
      const Corners c = corners_of(points, e.facets_[f]);
      const Corners d = corners_of(motion, e.facets_[f]);
      const FacetFrame frame(c[0], c[1], c[2], e.flat(static_cast<int>(f)));
      sum[e.label_[f]] += of_facet(frame, FacetMotion(frame, d), d);
    }
  }
  return sum;
}

/// The facets' motion as one vector, and what of bent faces' areas goes with
/// it.
template <class OfJet>
void FilmProducts::over_bent(const Points& points, const Points& motion,
                             JetOrder order, const OfJet& of_jet) const {
  for (const FilmEnergy::BentArea& area : energy_.bent_) {
    for (const FilmTerm::Element& e : area.elements) {
      const Triangle& at = energy_.facets_[e.facet];
      Eigen::Matrix<double, 9, 1> d;
      d << motion[at[0]], motion[at[1]], motion[at[2]];
      if (!d.isZero(0.0)) {
        of_jet(area.surface, at, energy_.jet_of(area, e, points, order), d);
      }
    }
  }
}

VectorX FilmProducts::area_rates(const Points& points,
                                 const Points& motion) const {
  VectorX sum = over_films(points, motion,
                           [](const FacetFrame& frame, const FacetMotion& moved,
                              const Corners& /*d*/) {
                             return 0.5 * frame.normal.dot(moved.normal2);
                           });
  over_bent(points, motion, JetOrder::Gradient,
            [&](int surface, const Triangle& /*at*/, const FacetJet& jet,
                const auto& d) { sum[surface] += jet.gradient.dot(d); });
  return sum;
}

void FilmProducts::add_bent(const Points& points, const Points& motion,
                            double factor, Points& sum) const {
  over_bent(
      points, motion, JetOrder::Hessian,
      [&](int surface, const Triangle& at, const FacetJet& jet, const auto& d) {
        const Eigen::Matrix<double, 9, 1> product =
            factor * tension_[surface] * (jet.hessian * d);
        for (int i = 0; i < 3; ++i) {
          sum[at[i]] += product.template segment<3>(3 * i);
        }
      });
}

void FilmProducts::add_facets(const Points& points, const Points& motion,
                              Points& sum) const {
  const FilmEnergy& e = energy_;
  const Vec3 origin = e.cone_origin(points);
  const std::vector<double> jump = e.pressure_jumps(pressure_);
  for (std::size_t f = 0; f < e.facets_.size(); ++f) {
    const Triangle& at = e.facets_[f];
    const int label = e.label_[f];
    const double t = e.plain_[label] != 0 ? tension_[label] : 0.0;
    const double p = jump[label];
    if (t == 0.0 && p == 0.0) {
      continue;
    }
    const Corners d = corners_of(motion, at);
    const FacetFrame frame(points[at[0]] - origin, points[at[1]] - origin,
                           points[at[2]] - origin, e.flat(static_cast<int>(f)));
    const FacetMotion moved(frame, d);
    const double half = 0.5 * t;  // of a facet without area the normal is 0
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      // d (n x e_i) / 2 of the area, d (x_j x x_k) / 6 of the cone.
      const Vec3 of_area = moved.normal.cross(frame.opposite[i]) +
                           frame.normal.cross(moved.opposite[i]);
      const Vec3 of_cone =
          d[j].cross(frame.corner[k]) + frame.corner[j].cross(d[k]);
      sum[at[i]] += half * of_area - p / 6.0 * of_cone;
    }
  }
}

/// What term `functional` counts in L.
double FilmProducts::weight_of(int functional) const {
  return functional == -1  ? energies_
         : functional >= 0 ? -pressure_[functional]
                           : 0.0;
}

void FilmProducts::add_terms(const Points& points, const Points& motion,
                             double scale, Points& sum) const {
  for (const auto& term : energy_.terms_) {
    const double factor = scale * weight_of(term->functional());
    if (factor == 0.0) {
      continue;
    }
    const auto motion_of = [&](const FilmTerm::Element& e) {
      const Triangle& at = energy_.facets_[e.facet];
      FilmTerm::Vector9 d;
      d << motion[at[0]], motion[at[1]], motion[at[2]];
      return d;
    };
    energy_.over_term(
        *term, points, JetOrder::Hessian, numbers_of(*term, numbers_),
        [&](const FilmTerm::Element& e) { return !motion_of(e).isZero(0.0); },
        [&](const FilmTerm::Element& e, const FacetJet& jet) {
          const Triangle& at = energy_.facets_[e.facet];
          const FilmTerm::Vector9 d = motion_of(e);
          const FilmTerm::Vector9 product = factor * (jet.hessian * d);
          for (int i = 0; i < 3; ++i) {
            sum[at[i]] += product.segment<3>(3 * i);
          }
        });
  }
}

Points FilmProducts::hessian_times(const Points& points,
                                   const Points& motion) const {
  Points sum(points.size(), Vec3::Zero());
  add_facets(points, motion, sum);
  add_bent(points, motion, 1.0, sum);
  add_terms(points, motion, 1.0, sum);
  return sum;
}

VectorX FilmProducts::area_curvatures(const Points& points,
                                      const Points& motion) const {
  VectorX sum = over_films(
      points, motion,
      [](const FacetFrame& frame, const FacetMotion& moved, const Corners& d) {
        const Vec3 bend = (d[1] - d[0]).cross(d[2] - d[0]);
        return 0.5 * moved.normal.dot(moved.normal2) + frame.normal.dot(bend);
      });
  over_bent(points, motion, JetOrder::Hessian,
            [&](int surface, const Triangle& /*at*/, const FacetJet& jet,
                const auto& d) { sum[surface] += d.dot(jet.hessian * d); });
  return sum;
}

/// With N(x + s d) = N + s N1 + s^2 N2, m = N1 - (n.N1) n and a the area,
///   a'' = (m.N1 / |N| + 2 n.N2) / 2,
///   da''/dN1 = m / |N|,
///   da''/dN = (P N2 - ((n.N1) m + m.m n / 2) / |N|) / |N|, P across n;
/// of the cone, v'' = sum x_i . (d_j x d_k) / 3.
Points FilmProducts::third_times(const Points& points,
                                 const Points& motion) const {
  const FilmEnergy& e = energy_;
  Points sum(points.size(), Vec3::Zero());
  const std::vector<double> jump = e.pressure_jumps(pressure_);
  for (std::size_t f = 0; f < e.facets_.size(); ++f) {
    const Triangle& at = e.facets_[f];
    const Corners c = corners_of(points, at);
    const Corners d = corners_of(motion, at);
    const FacetFrame frame(c[0], c[1], c[2], e.flat(static_cast<int>(f)));
    const FacetMotion moved(frame, d);
    const bool counts = frame.turns && e.plain_[e.label_[f]] != 0;
    const double t = counts ? tension_[e.label_[f]] : 0.0;
    const double p = jump[e.label_[f]];
    const Vec3& n = frame.normal;
    Vec3 by_first = Vec3::Zero();
    Vec3 by_normal = Vec3::Zero();
    // Derivatives of T a'' by N1 and N; `bend` is N2, the bilinear part.
    if (t != 0.0) {
      const Vec3 bend = (d[1] - d[0]).cross(d[2] - d[0]);
      const Vec3 m = moved.normal;  // over |N| already
      by_first = t * m;
      by_normal = t * ((bend - n.dot(bend) * n) / frame.area2 -
                       n.dot(moved.normal2) / frame.area2 * m -
                       0.5 * m.squaredNorm() * n);
    }
    // Chain rule to the corners: N changes by e_i x dx_i, N1 by the motion's
    // own e_i x dx_i; the cone's part is explicit.
    for (int i = 0; i < 3; ++i) {
      const Vec3 of_cone = d[(i + 1) % 3].cross(d[(i + 2) % 3]);
      sum[at[i]] += by_normal.cross(frame.opposite[i]) +
                    by_first.cross(moved.opposite[i]) - p / 3.0 * of_cone;
    }
  }
  // Third derivatives of fields: a difference of their exact second ones along
  // the motion, of fourth order in a small step.
  if (has_terms()) {
    const double step = term_step(points, motion);
    for (const auto& [times, weight] : kSlope) {
      Points moved = points;
      flat(moved) += times * step * flat(motion);
      add_bent(moved, motion, weight / step, sum);
      add_terms(moved, motion, weight / step, sum);
    }
  }
  return sum;
}

double FilmProducts::term_step(const Points& points,
                               const Points& motion) const {
  double most = 0.0;
  for (const Vec3& d : motion) {
    most = std::max(most, d.norm());
  }
  return kTermStep * energy_.mean_edge(points) / std::max(most, 1e-300);
}

/// Calls each(term, field) for the energies whose fields have numbers.
template <class Each>
void FilmProducts::over_numbers(const Each& each) const {
  for (const auto& term : energy_.terms_) {
    const auto q = static_cast<std::size_t>(term->field());
    if (term->has_numbers() && term->functional() == -1 &&
        q < numbers_.size()) {
      each(*term, q);
    }
  }
}

std::vector<VectorX> FilmProducts::no_numbers() const {
  std::vector<VectorX> sum;
  for (const VectorX& of_quantity : numbers_) {
    sum.push_back(VectorX::Zero(of_quantity.size()));
  }
  return sum;
}

/// add(element, sum) for the elements of a term: chunk by chunk in threads, the
/// chunks' sums added in their order.
template <class Add>
void FilmProducts::over_chunks(const FilmTerm& term, const Add& add,
                               VectorX& sum) {
  constexpr std::size_t kChunk = 512;
  const std::vector<FilmTerm::Element>& all = term.elements();
  std::vector<VectorX> parts((all.size() + kChunk - 1) / kChunk);
  parallel_for(std::ssize(parts), [&](std::ptrdiff_t k) {
    parts[k] = VectorX::Zero(sum.size());
    const std::size_t first = static_cast<std::size_t>(k) * kChunk;
    for (std::size_t i = first; i < std::min(first + kChunk, all.size()); ++i) {
      add(all[i], parts[k]);
    }
  });
  for (const VectorX& part : parts) {
    sum += part;
  }
}

void FilmProducts::add_number_slopes(const Points& points, const Points& motion,
                                     double factor,
                                     std::vector<VectorX>& sum) const {
  over_numbers([&](const FilmTerm& term, std::size_t q) {
    const auto add = [&](const FilmTerm::Element& e, VectorX& part) {
      const Triangle& at = energy_.facets_[e.facet];
      term.add_by_numbers(e, corners_of(points, at), corners_of(motion, at),
                          factor, numbers_of(term, numbers_), part);
    };
    over_chunks(term, add, sum[q]);
  });
}

std::vector<VectorX> FilmProducts::number_slopes(const Points& points,
                                                 const Points& motion,
                                                 double energies) const {
  std::vector<VectorX> sum = no_numbers();
  add_number_slopes(points, motion, energies_, sum);
  if (energies == 0.0) {
    return sum;
  }
  over_numbers([&](const FilmTerm& term, std::size_t q) {
    const auto add = [&](const FilmTerm::Element& e, VectorX& part) {
      term.add_value_by_numbers(e, corners_of(points, energy_.facets_[e.facet]),
                                energies, numbers_of(term, numbers_), part);
    };
    over_chunks(term, add, sum[q]);
  });
  return sum;
}

std::vector<VectorX> FilmProducts::number_curvatures(
    const Points& points, const Points& motion) const {
  std::vector<VectorX> sum = no_numbers();
  const double step = term_step(points, motion);
  for (const auto& [times, weight] : kSlope) {
    Points moved = points;
    flat(moved) += times * step * flat(motion);
    add_number_slopes(moved, motion, energies_ * weight / step, sum);
  }
  return sum;
}

Points FilmProducts::number_motion(const Points& points,
                                   const std::vector<VectorX>& rates) const {
  Points sum(points.size(), Vec3::Zero());
  over_numbers([&](const FilmTerm& term, std::size_t q) {
    if (q >= rates.size() || rates[q].size() != numbers_[q].size()) {
      return;
    }
    const std::vector<FilmTerm::Element>& all = term.elements();
    std::vector<FilmTerm::Vector9> of_element(all.size());
    parallel_for(std::ssize(all), [&](std::ptrdiff_t k) {
      of_element[k] = term.gradient_rate(
          all[k], corners_of(points, energy_.facets_[all[k].facet]),
          numbers_of(term, numbers_), numbers_of(term, rates));
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Triangle& at = energy_.facets_[all[i].facet];
      for (int k = 0; k < 3; ++k) {
        sum[at[k]] += of_element[i].segment<3>(3 * k);
      }
    }
  });
  return sum;
}

bool FilmProducts::has_terms() const {
  return !energy_.bent_.empty() ||
         std::any_of(energy_.terms_.begin(), energy_.terms_.end(),
                     [&](const auto& term) {
                       return weight_of(term->functional()) != 0.0;
                     });
}

Points FilmProducts::metric_gradient(const Points& points,
                                     const VectorX& weight) const {
  const FilmEnergy& e = energy_;
  Points sum(points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < e.facets_.size(); ++f) {
    if (e.liquid_[e.label_[f]] == 0) {
      continue;
    }
    double of_facet = 0.0;
    for (int i = e.corner_start_[f]; i < e.corner_start_[f + 1]; ++i) {
      of_facet += weight[e.corners_[i].unknown] / 3.0;
    }
    const Corners c = corners_of(points, e.facets_[f]);
    const FacetFrame frame(c[0], c[1], c[2]);
    for (int i = 0; i < 3; ++i) {
      sum[e.facets_[f][i]] += of_facet * frame.area_gradient(i);
    }
  }
  return sum;
}

}  // namespace meniscus::energy
