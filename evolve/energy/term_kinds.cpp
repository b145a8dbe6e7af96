#include "evolve/energy/term_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/math/gauss_rule.h"
#include "evolve/energy/facet_size.h"
#include "evolve/energy/film_space.h"
#include "evolve/energy/flux_jet.h"
#include "evolve/films/drop_shape.h"

namespace meniscus::energy {

namespace {

/// 1 to 8 points.
std::vector<GaussPoint> edge_rule(int points) {
  return gauss_rule(std::clamp(points, 1, 8));
}

/// Integral of F . n over facets.
class FluxTerm : public FilmTerm {
 public:
  FluxTerm(FieldFunction field, std::span<const QuadraturePoint> rule)
      : field_(std::move(field)), rule_(rule) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order, Numbers /*numbers*/) const override {
    FacetJet sum;
    add_flux(rule_, element.sign, c, order, field_, sum);
    return sum;
  }

 private:
  FieldFunction field_;
  std::span<const QuadraturePoint> rule_;
};

/// The least points that are exact for polynomials of a degree.
std::span<const QuadraturePoint> points_for(int degree) {
  if (degree <= 1) {
    return middle_rule();
  }
  if (degree == 2) {
    return three_points();
  }
  return facet_rule();
}

/// What a facet counts for and its derivative by the corners.
struct GrowingFacet {
  NormalJet n;
  FacetSize size;
  FilmTerm::Vector9 grow = FilmTerm::Vector9::Zero();

  GrowingFacet(const FilmTerm::Corners& c, Numbers spheroids,
               JetOrder order = JetOrder::Gradient)
      : n(c),
        size(facet_size(n.normal, spheroids, order == JetOrder::Hessian)) {
    grow = by_corners(size.slope);
  }

  /// Of what grows with N by so much.
  FilmTerm::Vector9 by_corners(const Vec3& slope) const {
    FilmTerm::Vector9 all;
    for (int i = 0; i < 3; ++i) {
      all.segment<3>(3 * i) = n.slope[i].transpose() * slope;
    }
    return all;
  }

  /// Of N as corners move.
  Vec3 turn(const FilmTerm::Corners& motion) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      sum += n.slope[i] * motion[i];
    }
    return sum;
  }
};

FilmTerm::Vector9 stacked(const FilmTerm::Corners& c) {
  FilmTerm::Vector9 all;
  all << c[0], c[1], c[2];
  return all;
}

/// Each corner's share of a vector.
FilmTerm::Vector9 shared(const QuadraturePoint& q, const Vec3& v) {
  FilmTerm::Vector9 all;
  for (int i = 0; i < 3; ++i) {
    all.segment<3>(3 * i) = q.weight_of[i] * v;
  }
  return all;
}

/// Integral of a scalar over facets.
class ScalarTerm : public FilmTerm {
 public:
  ScalarTerm(PlaceField scalar, int spheroids)
      : scalar_(std::move(scalar)), spheroids_(spheroids) {}

  bool has_numbers() const override {
    return scalar_.has_numbers() || spheroids_ > 0;
  }
  bool is_costly() const override { return !scalar_.is_constant(); }

  FacetJet jet(const Element& element, const Corners& c, JetOrder order,
               Numbers numbers) const override {
    const GrowingFacet n(c, spheroids(numbers), order);
    FacetJet sum;
    if (!(n.size.value > 0.0)) {
      return sum;
    }
    double mean = 0.0;
    for (const QuadraturePoint& q : facet_rule()) {
      const auto& l = q.weight_of;
      PlaceJet f;
      if (order == JetOrder::Value) {  // duals cost several times as much
        f.value = value_at(scalar_, numbers, q.at(c));
      } else {
        f = jet_at(scalar_, numbers, q.at(c));
      }
      const double w = 0.5 * element.sign * q.weight;
      mean += w * f.value;
      if (order == JetOrder::Value) {
        continue;
      }
      const Vector9 pull = shared(q, f.gradient);
      sum.gradient += w * n.size.value * pull;
      if (order == JetOrder::Hessian) {
        sum.hessian +=
            w * (pull * n.grow.transpose() + n.grow * pull.transpose());
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            sum.hessian.block<3, 3>(3 * i, 3 * j) +=
                w * n.size.value * l[i] * l[j] * f.hessian;
          }
        }
      }
    }
    sum.value = mean * n.size.value;
    sum.gradient += mean * n.grow;
    if (order == JetOrder::Hessian) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          sum.hessian.block<3, 3>(3 * i, 3 * j) +=
              mean * (n.n.slope[i].transpose() * n.size.curve * n.n.slope[j] +
                      NormalJet::bend(n.size.slope, i, j));
        }
      }
    }
    return sum;
  }

  void add_by_numbers(const Element& element, const Corners& c,
                      const Corners& motion, double factor, Numbers numbers,
                      VectorX& sum) const override {
    const GrowingFacet n(c, spheroids(numbers));
    const double growth = n.grow.dot(stacked(motion));
    double mean = 0.0;
    double pull = 0.0;  // how fast the mean changes
    for (const QuadraturePoint& q : facet_rule()) {
      const double w = 0.5 * factor * element.sign * q.weight;
      if (scalar_.has_numbers()) {
        meniscus::add_by_numbers(scalar_, numbers, q.at(c), w * growth,
                                 w * n.size.value * q.at(motion), sum);
      }
      if (spheroids_ > 0) {
        const PlaceJet f = jet_at(scalar_, numbers, q.at(c));
        mean += w * f.value;
        pull += w * f.gradient.dot(q.at(motion));
      }
    }
    add_by_spheroids(n.n.normal, spheroids(numbers), pull,
                     mean * n.turn(motion), sum, first_spheroid(numbers));
  }

  void add_value_by_numbers(const Element& element, const Corners& c,
                            double factor, Numbers numbers,
                            VectorX& sum) const override {
    const GrowingFacet n(c, spheroids(numbers));
    double mean = 0.0;
    for (const QuadraturePoint& q : facet_rule()) {
      const double w = 0.5 * factor * element.sign * q.weight;
      if (scalar_.has_numbers()) {
        meniscus::add_by_numbers(scalar_, numbers, q.at(c), w * n.size.value,
                                 Vec3::Zero(), sum);
      }
      mean += spheroids_ > 0 ? w * value_at(scalar_, numbers, q.at(c)) : 0.0;
    }
    add_by_spheroids(n.n.normal, spheroids(numbers), mean, Vec3::Zero(), sum,
                     first_spheroid(numbers));
  }

  Vector9 gradient_rate(const Element& element, const Corners& c,
                        Numbers numbers, Numbers rates) const override {
    const GrowingFacet n(c, spheroids(numbers));
    const FacetSize moving =
        facet_size_rate(n.n.normal, spheroids(numbers), spheroids(rates));
    const Vector9 grow_rate = n.by_corners(moving.slope);
    Vector9 sum = Vector9::Zero();
    for (const QuadraturePoint& q : facet_rule()) {
      const PlaceJet rate = rate_at(scalar_, numbers, rates, q.at(c));
      const double w = 0.5 * element.sign * q.weight;
      sum +=
          w * (n.size.value * shared(q, rate.gradient) + rate.value * n.grow);
      if (spheroids_ > 0) {
        const PlaceJet f = jet_at(scalar_, numbers, q.at(c));
        sum += w * (moving.value * shared(q, f.gradient) + f.value * grow_rate);
      }
    }
    return sum;
  }

 private:
  std::size_t first_spheroid(Numbers numbers) const {
    return numbers.size() -
           static_cast<std::size_t>(spheroids_ * films::kSpheroidNumbers);
  }
  Numbers spheroids(Numbers numbers) const {
    return spheroids_ == 0 ? Numbers()
                           : numbers.subspan(first_spheroid(numbers));
  }

  PlaceField scalar_;
  int spheroids_;
};

/// Integral of a scalar over a body, by the flux of a radial field.
class BodyTerm : public FilmTerm {
 public:
  BodyTerm(PlaceField scalar, const films::RayOrigin& origin)
      : scalar_(std::move(scalar)), origin_(origin) {}

  bool has_numbers() const override { return scalar_.has_numbers(); }
  bool is_costly() const override { return !scalar_.is_constant(); }

  FacetJet jet(const Element& element, const Corners& c, JetOrder order,
               Numbers numbers) const override {
    FacetJet sum;
    add_flux(
        facet_rule(), element.sign, c, order,
        [&](const Vec3& at, JetOrder wanted) {
          if (wanted == JetOrder::Value) {  // duals cost several times as much
            FieldJet value;
            value.bend.fill(Mat3::Zero());
            value.value = radial_value(scalar_, numbers, origin_, at);
            return value;
          }
          return radial_field(scalar_, numbers, origin_, at);
        },
        sum);
    return sum;
  }

  void add_by_numbers(const Element& element, const Corners& c,
                      const Corners& motion, double factor, Numbers numbers,
                      VectorX& sum) const override {
    const NormalJet n(c);
    Vec3 turn = Vec3::Zero();  // of N
    for (int i = 0; i < 3; ++i) {
      turn += n.slope[i] * motion[i];
    }
    for (const QuadraturePoint& q : facet_rule()) {
      const double w = 0.5 * factor * element.sign * q.weight;
      add_radial_by_numbers(scalar_, numbers, origin_, q.at(c), w * turn,
                            w * n.normal * q.at(motion).transpose(), sum);
    }
  }

  void add_value_by_numbers(const Element& element, const Corners& c,
                            double factor, Numbers numbers,
                            VectorX& sum) const override {
    const NormalJet n(c);
    for (const QuadraturePoint& q : facet_rule()) {
      const double w = 0.5 * factor * element.sign * q.weight;
      add_radial_by_numbers(scalar_, numbers, origin_, q.at(c), w * n.normal,
                            Eigen::Matrix3d::Zero(), sum);
    }
  }

  Vector9 gradient_rate(const Element& element, const Corners& c,
                        Numbers numbers, Numbers rates) const override {
    FacetJet sum;
    add_flux(
        facet_rule(), element.sign, c, JetOrder::Gradient,
        [&](const Vec3& at, JetOrder /*order*/) {
          return radial_rate(scalar_, numbers, rates, origin_, at);
        },
        sum);
    return sum.gradient;
  }

 private:
  PlaceField scalar_;
  films::RayOrigin origin_;
};

/// Integral of F . dl along an edge of the facet.
class LineTerm : public FilmTerm {
 public:
  LineTerm(FieldFunction field, int points)
      : field_(std::move(field)), rule_(edge_rule(points)) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order, Numbers /*numbers*/) const override {
    const int a = element.first;
    const int b = (a + 1) % 3;
    const Vec3 way = c[b] - c[a];
    FacetJet sum;
    for (const auto& [s, weight] : rule_) {
      const FieldJet f = field_(c[a] + s * way, order);
      const double w = element.sign * weight;
      sum.value += w * f.value.dot(way);
      if (order == JetOrder::Value) {
        continue;
      }
      const std::array<int, 2> corner = {a, b};
      const std::array<double, 2> l = {1.0 - s, s};
      const std::array<double, 2> d = {-1.0, 1.0};
      const Vec3 pull = f.slope.transpose() * way;
      Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
      for (int m = 0; m < 3; ++m) {
        bend += way[m] * f.bend[m];
      }
      for (int i = 0; i < 2; ++i) {
        sum.gradient.segment<3>(3 * corner[i]) +=
            w * (l[i] * pull + d[i] * f.value);
        for (int j = 0; j < 2 && order == JetOrder::Hessian; ++j) {
          sum.hessian.block<3, 3>(3 * corner[i], 3 * corner[j]) +=
              w * (l[i] * l[j] * bend + l[i] * d[j] * f.slope.transpose() +
                   l[j] * d[i] * f.slope);
        }
      }
    }
    return sum;
  }

 private:
  FieldFunction field_;
  std::vector<GaussPoint> rule_;
};

/// Area between edges and the convex wall that they are chords of:
/// k |S| (|S . n_a| + |S . n_b|) / 12 (Surface Evolver manual 2.70, "convex
/// constraints"). The Hessian is that of differences of the exact gradient.
class GapTerm : public FilmTerm {
 public:
  GapTerm(Expression formula, double constant)
      : formula_(std::move(formula)), constant_(constant) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order, Numbers /*numbers*/) const override {
    FacetJet sum = first_order(element, c);
    if (order == JetOrder::Hessian) {
      const double step = 1e-5 * (c[1] - c[0]).norm();
      for (int i = 0; i < 9; ++i) {
        std::array<Vec3, 3> up = c;
        std::array<Vec3, 3> down = c;
        up[i / 3][i % 3] += step;
        down[i / 3][i % 3] -= step;
        sum.hessian.col(i) = (first_order(element, up).gradient -
                              first_order(element, down).gradient) /
                             (2.0 * step);
      }
      sum.hessian = 0.5 * (sum.hessian + sum.hessian.transpose()).eval();
    }
    return sum;
  }

 private:
  FacetJet first_order(const Element& element,
                       const std::array<Vec3, 3>& c) const {
    const int a = element.first;
    const int b = (a + 1) % 3;
    const Vec3 s = c[b] - c[a];
    const double length = s.norm();
    const double w = element.sign * constant_ / 12.0;
    FacetJet sum;
    if (!(length > 0.0)) {
      return sum;
    }
    double rise = 0.0;
    Vec3 by_s = Vec3::Zero();
    for (const int end : {a, b}) {
      const PlaceJet f = jet_at(formula_, c[end]);
      const double size = f.gradient.norm();
      if (!(size > 0.0)) {
        continue;
      }
      const Vec3 n = f.gradient / size;
      const double dot = s.dot(n);
      const double sign = dot < 0.0 ? -1.0 : 1.0;
      rise += std::abs(dot);
      by_s += sign * n;
      // dn = (I - n n^T) H dx / |grad|.
      const Vec3 across = s - dot * n;
      sum.gradient.segment<3>(3 * end) +=
          w * length * sign / size * (f.hessian * across);
    }
    sum.value = w * length * rise;
    const Vec3 pull = w * (rise / length * s + length * by_s);
    sum.gradient.segment<3>(3 * b) += pull;
    sum.gradient.segment<3>(3 * a) -= pull;
    return sum;
  }

  Expression formula_;
  double constant_;
};

}  // namespace

std::unique_ptr<FilmTerm> flux_term(FieldFunction field, int degree) {
  return std::make_unique<FluxTerm>(std::move(field), points_for(degree));
}

std::unique_ptr<FilmTerm> scalar_term(PlaceField scalar, int spheroids) {
  return std::make_unique<ScalarTerm>(std::move(scalar), spheroids);
}

std::unique_ptr<FilmTerm> body_term(PlaceField scalar,
                                    const films::RayOrigin& origin) {
  return std::make_unique<BodyTerm>(std::move(scalar), origin);
}

std::unique_ptr<FilmTerm> line_term(FieldFunction field, int points) {
  return std::make_unique<LineTerm>(std::move(field), points);
}

std::unique_ptr<FilmTerm> gap_term(Expression formula, double constant) {
  return std::make_unique<GapTerm>(std::move(formula), constant);
}

}  // namespace meniscus::energy
