#include "evolve/energy/term_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "core/math/gauss_rule.h"
#include "evolve/energy/film_space.h"
#include "evolve/energy/flux_jet.h"

namespace meniscus::energy {

namespace {

/// 1 to 8 points.
std::vector<GaussPoint> edge_rule(int points) {
  return gauss_rule(std::clamp(points, 1, 8));
}

/// Integral of F . n over facets.
class FluxTerm : public FilmTerm {
 public:
  explicit FluxTerm(FieldFunction field) : field_(std::move(field)) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order, Numbers /*numbers*/) const override {
    FacetJet sum;
    add_flux(facet_rule(), element.sign, c, order, field_, sum);
    return sum;
  }

 private:
  FieldFunction field_;
};

/// The size of N and its derivative by the corners.
struct NormalSize {
  NormalJet n;
  double size;
  Vec3 unit = Vec3::Zero();  // of a facet without area 0
  FilmTerm::Vector9 grow = FilmTerm::Vector9::Zero();

  explicit NormalSize(const FilmTerm::Corners& c)
      : n(c), size(n.normal.norm()) {
    if (size > 0.0) {
      unit = n.normal / size;
      for (int i = 0; i < 3; ++i) {
        grow.segment<3>(3 * i) = n.slope[i].transpose() * unit;
      }
    }
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
  explicit ScalarTerm(PlaceField scalar) : scalar_(std::move(scalar)) {}

  bool has_numbers() const override { return scalar_.has_numbers(); }
  bool is_costly() const override { return !scalar_.is_constant(); }

  FacetJet jet(const Element& element, const Corners& c, JetOrder order,
               Numbers numbers) const override {
    const NormalSize n(c);
    FacetJet sum;
    if (!(n.size > 0.0)) {
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
      sum.gradient += w * n.size * pull;
      if (order == JetOrder::Hessian) {
        sum.hessian +=
            w * (pull * n.grow.transpose() + n.grow * pull.transpose());
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            sum.hessian.block<3, 3>(3 * i, 3 * j) +=
                w * n.size * l[i] * l[j] * f.hessian;
          }
        }
      }
    }
    sum.value = mean * n.size;
    sum.gradient += mean * n.grow;
    if (order == JetOrder::Hessian) {
      const Eigen::Matrix3d across =
          (Eigen::Matrix3d::Identity() - n.unit * n.unit.transpose()) / n.size;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          sum.hessian.block<3, 3>(3 * i, 3 * j) +=
              mean * (n.n.slope[i].transpose() * across * n.n.slope[j] +
                      NormalJet::bend(n.unit, i, j));
        }
      }
    }
    return sum;
  }

  void add_by_numbers(const Element& element, const Corners& c,
                      const Corners& motion, double factor, Numbers numbers,
                      VectorX& sum) const override {
    const NormalSize n(c);
    const double growth = n.grow.dot(stacked(motion));
    for (const QuadraturePoint& q : facet_rule()) {
      const double w = 0.5 * factor * element.sign * q.weight;
      meniscus::add_by_numbers(scalar_, numbers, q.at(c), w * growth,
                               w * n.size * q.at(motion), sum);
    }
  }

  void add_value_by_numbers(const Element& element, const Corners& c,
                            double factor, Numbers numbers,
                            VectorX& sum) const override {
    const NormalSize n(c);
    for (const QuadraturePoint& q : facet_rule()) {
      meniscus::add_by_numbers(scalar_, numbers, q.at(c),
                               0.5 * factor * element.sign * q.weight * n.size,
                               Vec3::Zero(), sum);
    }
  }

  Vector9 gradient_rate(const Element& element, const Corners& c,
                        Numbers numbers, Numbers rates) const override {
    const NormalSize n(c);
    Vector9 sum = Vector9::Zero();
    for (const QuadraturePoint& q : facet_rule()) {
      const PlaceJet f = rate_at(scalar_, numbers, rates, q.at(c));
      const double w = 0.5 * element.sign * q.weight;
      sum += w * (n.size * shared(q, f.gradient) + f.value * n.grow);
    }
    return sum;
  }

 private:
  PlaceField scalar_;
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

std::unique_ptr<FilmTerm> flux_term(FieldFunction field) {
  return std::make_unique<FluxTerm>(std::move(field));
}

std::unique_ptr<FilmTerm> scalar_term(PlaceField scalar) {
  return std::make_unique<ScalarTerm>(std::move(scalar));
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
