#include "evolve/film_terms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <span>

#include <Eigen/Dense>

#include "evolve/film_space.h"
#include "evolve/radial_field.h"

namespace meniscus {

namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

struct QuadraturePoint {
  std::array<double, 3> weight_of;  // barycentric
  double weight;                    // of the facet's area
};

/// Degree 5 on a triangle, seven points (Radon 1948).
const std::array<QuadraturePoint, 7>& facet_rule() {
  static const std::array<QuadraturePoint, 7> kRule = [] {
    const double root = std::sqrt(15.0);
    const double a = (6.0 - root) / 21.0;
    const double b = (6.0 + root) / 21.0;
    const double wa = (155.0 - root) / 1200.0;
    const double wb = (155.0 + root) / 1200.0;
    const double third = 1.0 / 3.0;
    return std::array<QuadraturePoint, 7>{{{{third, third, third}, 9.0 / 40.0},
                                           {{1 - 2 * a, a, a}, wa},
                                           {{a, 1 - 2 * a, a}, wa},
                                           {{a, a, 1 - 2 * a}, wa},
                                           {{1 - 2 * b, b, b}, wb},
                                           {{b, 1 - 2 * b, b}, wb},
                                           {{b, b, 1 - 2 * b}, wb}}};
  }();
  return kRule;
}

/// Gauss points on [0, 1], 1 to 8 of them: place, weight.
std::vector<std::array<double, 2>> edge_rule(int points) {
  const int n = std::clamp(points, 1, 8);
  // Golub, Welsch 1969: eigenvalues of the Jacobi matrix of Legendre's
  // polynomials.
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
  for (int k = 1; k < n; ++k) {
    jacobi(k, k - 1) = jacobi(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(jacobi);
  std::vector<std::array<double, 2>> rule;
  for (int k = 0; k < n; ++k) {
    const double first = eigen.eigenvectors()(0, k);
    rule.push_back({0.5 * (1.0 + eigen.eigenvalues()[k]), first * first});
  }
  return rule;
}

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// N = (b - a) x (c - a), its derivative and its constant second derivative:
/// dN/dx_i v = e_i x v.
struct NormalJet {
  Vec3 normal;
  std::array<Eigen::Matrix3d, 3> slope;  // [e_i]x

  explicit NormalJet(const std::array<Vec3, 3>& c) {
    normal = (c[1] - c[0]).cross(c[2] - c[0]);
    for (int i = 0; i < 3; ++i) {
      slope[i] = cross_matrix(c[(i + 2) % 3] - c[(i + 1) % 3]);
    }
  }
  /// Second derivative of f . N by x_i, x_j.
  static Eigen::Matrix3d bend(const Vec3& f, int i, int j) {
    if (i == j) {
      return Eigen::Matrix3d::Zero();
    }
    // d2N(v_i, w_j) = +- w x v, + for j = i + 2; f.(w x v) = v.(f x w).
    const Eigen::Matrix3d m = cross_matrix(f);
    return j == (i + 2) % 3 ? m : Eigen::Matrix3d(-m);
  }
};

using FieldFunction = std::function<FieldJet(const Vec3&, JetOrder)>;

FieldFunction expression_field(const VectorField& field) {
  return [field](const Vec3& at, JetOrder order) {
    FieldJet jet;
    for (int m = 0; m < 3; ++m) {
      if (order == JetOrder::Value) {  // duals cost several times as much
        jet.value[m] = field[m].evaluate(std::span<const double>(at.data(), 3));
        continue;
      }
      const PlaceJet part = jet_at(field[m], at);
      jet.value[m] = part.value;
      jet.slope.row(m) = part.gradient;
      jet.bend[m] = part.hessian;
    }
    return jet;
  };
}

/// Weight: F = -rho (g.x)^2 / (2 |g|^2) g has divergence -rho g.x.
FieldFunction weight_field(double density, const Vec3& g) {
  return [density, g](const Vec3& at, JetOrder /*order*/) {
    FieldJet jet;
    const double along = g.dot(at);
    const double scale = -density / g.squaredNorm();
    jet.value = 0.5 * scale * along * along * g;
    jet.slope = scale * along * g * g.transpose();
    for (int m = 0; m < 3; ++m) {
      jet.bend[m] = scale * g[m] * g * g.transpose();
    }
    return jet;
  };
}

/// F = (0, 0, z): columns down to z = 0.
FieldJet column_field(const Vec3& at, JetOrder /*order*/) {
  FieldJet jet;
  jet.value = Vec3(0, 0, at.z());
  jet.slope(2, 2) = 1.0;
  jet.bend.fill(Eigen::Matrix3d::Zero());
  return jet;
}

/// F = x / 3.
FieldJet cone_field(const Vec3& at, JetOrder /*order*/) {
  FieldJet jet;
  jet.value = at / 3.0;
  jet.slope = Eigen::Matrix3d::Identity() / 3.0;
  jet.bend.fill(Eigen::Matrix3d::Zero());
  return jet;
}

FieldFunction body_field(const FilmQuantity& quantity) {
  return [phi = quantity.scalar, origin = quantity.origin](const Vec3& at,
                                                           JetOrder /*order*/) {
    return radial_field(phi, origin, at);
  };
}

/// Integral of F . n over facets.
class FluxTerm : public FilmTerm {
 public:
  explicit FluxTerm(FieldFunction field) : field_(std::move(field)) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order) const override {
    const NormalJet n(c);
    FacetJet sum;
    for (const QuadraturePoint& q : facet_rule()) {
      const auto& l = q.weight_of;
      const FieldJet f = field_(l[0] * c[0] + l[1] * c[1] + l[2] * c[2], order);
      const double w = 0.5 * element.sign * q.weight;
      sum.value += w * f.value.dot(n.normal);
      if (order == JetOrder::Value) {
        continue;
      }
      const Vec3 pull = f.slope.transpose() * n.normal;
      for (int i = 0; i < 3; ++i) {
        sum.gradient.segment<3>(3 * i) +=
            w * (l[i] * pull + n.slope[i].transpose() * f.value);
      }
      if (order == JetOrder::Hessian) {
        add_hessian(f, n, l, w, sum.hessian);
      }
    }
    return sum;
  }

 private:
  static void add_hessian(const FieldJet& f, const NormalJet& n,
                          const std::array<double, 3>& l, double w,
                          Matrix9& sum) {
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
    for (int m = 0; m < 3; ++m) {
      bend += n.normal[m] * f.bend[m];
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        sum.block<3, 3>(3 * i, 3 * j) +=
            w * (l[i] * l[j] * bend + l[i] * f.slope.transpose() * n.slope[j] +
                 l[j] * n.slope[i].transpose() * f.slope +
                 NormalJet::bend(f.value, i, j));
      }
    }
  }
  FieldFunction field_;
};

/// Integral of a scalar over facets.
class ScalarTerm : public FilmTerm {
 public:
  explicit ScalarTerm(Expression scalar) : scalar_(std::move(scalar)) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order) const override {
    const NormalJet n(c);
    const double size = n.normal.norm();
    FacetJet sum;
    if (!(size > 0.0)) {
      return sum;
    }
    const Vec3 unit = n.normal / size;
    Vector9 grow;  // d|N|
    for (int i = 0; i < 3; ++i) {
      grow.segment<3>(3 * i) = n.slope[i].transpose() * unit;
    }
    double mean = 0.0;
    for (const QuadraturePoint& q : facet_rule()) {
      const auto& l = q.weight_of;
      const Vec3 at = l[0] * c[0] + l[1] * c[1] + l[2] * c[2];
      PlaceJet f;
      if (order == JetOrder::Value) {  // duals cost several times as much
        f.value = scalar_.evaluate(std::span<const double>(at.data(), 3));
      } else {
        f = jet_at(scalar_, at);
      }
      const double w = 0.5 * element.sign * q.weight;
      mean += w * f.value;
      if (order == JetOrder::Value) {
        continue;
      }
      Vector9 pull;
      for (int i = 0; i < 3; ++i) {
        pull.segment<3>(3 * i) = l[i] * f.gradient;
      }
      sum.gradient += w * size * pull;
      if (order == JetOrder::Hessian) {
        sum.hessian += w * (pull * grow.transpose() + grow * pull.transpose());
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            sum.hessian.block<3, 3>(3 * i, 3 * j) +=
                w * size * l[i] * l[j] * f.hessian;
          }
        }
      }
    }
    sum.value = mean * size;
    sum.gradient += mean * grow;
    if (order == JetOrder::Hessian) {
      const Eigen::Matrix3d across =
          (Eigen::Matrix3d::Identity() - unit * unit.transpose()) / size;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          sum.hessian.block<3, 3>(3 * i, 3 * j) +=
              mean * (n.slope[i].transpose() * across * n.slope[j] +
                      NormalJet::bend(unit, i, j));
        }
      }
    }
    return sum;
  }

 private:
  Expression scalar_;
};

/// Integral of F . dl along an edge of the facet.
class LineTerm : public FilmTerm {
 public:
  LineTerm(FieldFunction field, int points)
      : field_(std::move(field)), rule_(edge_rule(points)) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order) const override {
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
  std::vector<std::array<double, 2>> rule_;
};

/// Area between edges and the convex wall that they are chords of:
/// k |S| (|S . n_a| + |S . n_b|) / 12 (Surface Evolver manual 2.70, "convex
/// constraints"). The Hessian is that of differences of the exact gradient.
class GapTerm : public FilmTerm {
 public:
  GapTerm(Expression formula, double constant)
      : formula_(std::move(formula)), constant_(constant) {}

  FacetJet jet(const Element& element, const std::array<Vec3, 3>& c,
               JetOrder order) const override {
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

/// Collects terms; keeps their order fixed.
class FilmTermBuilder {
 public:
  explicit FilmTermBuilder(const FilmComplex& complex) : complex_(complex) {}

  void add(std::unique_ptr<FilmTerm> term,
           std::vector<FilmTerm::Element> elements, int functional,
           int quantity = -1) {
    if (elements.empty()) {
      return;
    }
    term->elements_ = std::move(elements);
    term->functional_ = functional;
    term->quantity_ = quantity;
    terms_.push_back(std::move(term));
  }

  std::vector<FilmTerm::Element> facets_of(const std::vector<int>& surfaces,
                                           double factor) const {
    std::vector<FilmTerm::Element> result;
    const auto& labels = complex_.mesh.facet_label;
    for (std::size_t f = 0; f < labels.size(); ++f) {
      if (surfaces.empty() || std::find(surfaces.begin(), surfaces.end(),
                                        labels[f]) != surfaces.end()) {
        result.push_back({static_cast<int>(f), factor, 0});
      }
    }
    return result;
  }

  std::vector<FilmTerm::Element> facets_of_body(int body, double factor) const {
    std::vector<FilmTerm::Element> result;
    const auto& labels = complex_.mesh.facet_label;
    for (std::size_t f = 0; f < labels.size(); ++f) {
      if (const int sign = side(labels[f], body); sign != 0) {
        result.push_back({static_cast<int>(f), factor * sign, 0});
      }
    }
    return result;
  }

  void add_tension() {
    for (std::size_t s = 0; s < complex_.surfaces.size(); ++s) {
      const ComplexSurface& surface = complex_.surfaces[s];
      if (surface.liquid && surface.tension_field) {
        add(std::make_unique<ScalarTerm>(*surface.tension_field),
            facets_of({static_cast<int>(s)}, 1.0), -1);
      }
    }
  }

  void add_bodies() {
    for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
      const auto body = static_cast<int>(b);
      const double density = complex_.bodies[b].density;
      if (density != 0.0 && !complex_.gravity.isZero(0.0)) {
        add(std::make_unique<FluxTerm>(weight_field(density, complex_.gravity)),
            facets_of_body(body, 1.0), -1);
      }
      if (complex_.volume_rule == VolumeRule::Column &&
          !closed_by_facets(complex_, body)) {
        add(std::make_unique<FluxTerm>(column_field), facets_of_body(body, 1.0),
            body);
      }
    }
  }

  void add_lines() {
    const bool gaps =
        complex_.gap_constant != 0.0 &&
        std::any_of(complex_.level_sets.begin(), complex_.level_sets.end(),
                    [](const LevelSet& wall) { return wall.convex; });
    if (complex_.edges.empty() || (complex_.integrals.empty() && !gaps)) {
      return;
    }
    const std::map<Edge, std::vector<int>> around = facets_at_marked_edges();
    for (std::size_t w = 0; w < complex_.level_sets.size() && gaps; ++w) {
      if (complex_.level_sets[w].convex) {
        add(std::make_unique<GapTerm>(complex_.level_sets[w].formula,
                                      complex_.gap_constant),
            gap_elements(static_cast<int>(w), around), -1);
      }
    }
    for (std::size_t i = 0; i < complex_.integrals.size(); ++i) {
      const LineIntegral& integral = complex_.integrals[i];
      const auto add_line = [&](const auto& elements, int functional) {
        add(std::make_unique<LineTerm>(expression_field(integral.field),
                                       complex_.line_points),
            elements, functional);
      };
      if (integral.role == LineIntegral::Role::Energy) {
        add_line(energy_elements(static_cast<int>(i), around), -1);
        continue;
      }
      for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
        const auto body = static_cast<int>(b);
        add_line(content_elements(static_cast<int>(i), body, around), body);
      }
    }
  }

  void add_quantities() {
    int held = static_cast<int>(complex_.bodies.size());
    for (std::size_t q = 0; q < complex_.quantities.size(); ++q) {
      const FilmQuantity& quantity = complex_.quantities[q];
      const bool energy = quantity.role == FilmQuantity::Role::Energy;
      const int functional =
          energy ? -1
                 : (quantity.role == FilmQuantity::Role::Held ? held++ : -2);
      const double factor = energy ? quantity.modulus : 1.0;
      const auto number = static_cast<int>(q);
      switch (quantity.kind) {
        case FilmQuantity::Kind::VectorIntegral:
          add(std::make_unique<FluxTerm>(expression_field(quantity.field)),
              facets_of(quantity.surfaces, factor), functional, number);
          break;
        case FilmQuantity::Kind::ScalarIntegral:
          add(std::make_unique<ScalarTerm>(quantity.scalar),
              facets_of(quantity.surfaces, factor), functional, number);
          break;
        case FilmQuantity::Kind::Area:
          add(std::make_unique<ScalarTerm>(Expression(1.0)),
              facets_of(quantity.surfaces, factor), functional, number);
          break;
        case FilmQuantity::Kind::BodyVolume:
          add_body_quantity(quantity,
                            complex_.volume_rule == VolumeRule::Column
                                ? FieldFunction(column_field)
                                : FieldFunction(cone_field),
                            factor, functional, number);
          break;
        case FilmQuantity::Kind::BodyScalarIntegral:
          add_body_quantity(quantity, body_field(quantity), factor, functional,
                            number);
          break;
      }
    }
  }

  std::vector<std::unique_ptr<FilmTerm>> take() { return std::move(terms_); }

 private:
  int side(int surface, int body) const {
    int sign = 0;
    for (const BodySide& s : complex_.bodies[body].sides) {
      sign += s.surface == surface ? s.sign : 0;
    }
    return sign;
  }

  void add_body_quantity(const FilmQuantity& quantity, FieldFunction field,
                         double factor, int functional, int number) {
    std::vector<FilmTerm::Element> elements;
    for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
      if (quantity.body < 0 || quantity.body == static_cast<int>(b)) {
        const auto more = facets_of_body(static_cast<int>(b), factor);
        elements.insert(elements.end(), more.begin(), more.end());
      }
    }
    add(std::make_unique<FluxTerm>(std::move(field)), std::move(elements),
        functional, number);
  }

  std::map<Edge, std::vector<int>> facets_at_marked_edges() const {
    std::map<Edge, std::vector<int>> around;
    for (const ComplexEdge& e : complex_.edges) {
      if (e.integrals >= 0 || e.constraints >= 0) {
        around[{std::min(e.a, e.b), std::max(e.a, e.b)}];
      }
    }
    for (std::size_t f = 0; f < complex_.mesh.facets.size(); ++f) {
      const Triangle& t = complex_.mesh.facets[f];
      for (int k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        const auto at = around.find({std::min(a, b), std::max(a, b)});
        if (at != around.end()) {
          at->second.push_back(static_cast<int>(f));
        }
      }
    }
    return around;
  }

  bool has(const ComplexEdge& e, int integral) const {
    if (e.integrals < 0) {
      return false;
    }
    const auto& set = complex_.integral_sets[e.integrals];
    return std::find(set.begin(), set.end(), integral) != set.end();
  }

  /// Corner of `facet` where the edge a-b starts, and +1 when it runs a to b.
  FilmTerm::Element on_facet(const ComplexEdge& e, int facet) const {
    const Triangle& t = complex_.mesh.facets[facet];
    for (int k = 0; k < 3; ++k) {
      const int from = t[k];
      const int to = t[(k + 1) % 3];
      if (from == e.a && to == e.b) {
        return {facet, 1.0, k};
      }
      if (from == e.b && to == e.a) {
        return {facet, -1.0, k};
      }
    }
    return {facet, 0.0, 0};
  }

  std::vector<FilmTerm::Element> energy_elements(
      int integral, const std::map<Edge, std::vector<int>>& around) const {
    std::vector<FilmTerm::Element> result;
    for (const ComplexEdge& e : complex_.edges) {
      if (!has(e, integral)) {
        continue;
      }
      const auto& facets = around.at({std::min(e.a, e.b), std::max(e.a, e.b)});
      if (!facets.empty()) {
        result.push_back(on_facet(e, facets.front()));
      }
    }
    return result;
  }

  std::vector<FilmTerm::Element> gap_elements(
      int wall, const std::map<Edge, std::vector<int>>& around) const {
    std::vector<FilmTerm::Element> result;
    for (const ComplexEdge& e : complex_.edges) {
      if (e.constraints < 0 || e.kind != VertexKind::Free) {
        continue;
      }
      const auto& set = complex_.constraint_sets[e.constraints];
      const auto& facets = around.at({std::min(e.a, e.b), std::max(e.a, e.b)});
      if (std::find(set.begin(), set.end(), wall) != set.end() &&
          !facets.empty()) {
        FilmTerm::Element element = on_facet(e, facets.front());
        element.sign = 1.0;
        result.push_back(element);
      }
    }
    return result;
  }

  std::vector<FilmTerm::Element> content_elements(
      int integral, int body,
      const std::map<Edge, std::vector<int>>& around) const {
    std::vector<FilmTerm::Element> result;
    for (const ComplexEdge& e : complex_.edges) {
      if (!has(e, integral)) {
        continue;
      }
      for (const int f : around.at({std::min(e.a, e.b), std::max(e.a, e.b)})) {
        const int sign = side(complex_.mesh.facet_label[f], body);
        if (sign != 0) {
          // Along the facet's own run, which has sign `sign` in the body.
          FilmTerm::Element element = on_facet(e, f);
          element.sign = sign;
          result.push_back(element);
        }
      }
    }
    return result;
  }

  const FilmComplex& complex_;
  std::vector<std::unique_ptr<FilmTerm>> terms_;
};

std::vector<std::unique_ptr<FilmTerm>> film_terms(const FilmComplex& complex) {
  FilmTermBuilder builder(complex);
  builder.add_tension();
  builder.add_bodies();
  builder.add_lines();
  builder.add_quantities();
  return builder.take();
}

bool closed_by_facets(const FilmComplex& complex, int body) {
  std::vector<int> sign(complex.surfaces.size(), 0);
  for (const BodySide& s : complex.bodies[body].sides) {
    sign[s.surface] += s.sign;
  }
  std::vector<std::pair<Edge, int>> runs;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const Triangle& t = complex.mesh.facets[f];
    const int s = sign[complex.mesh.facet_label[f]];
    for (int k = 0; k < 3 && s != 0; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      runs.push_back({{std::min(a, b), std::max(a, b)}, a < b ? s : -s});
    }
  }
  std::sort(runs.begin(), runs.end());
  for (std::size_t i = 0; i < runs.size();) {
    int sum = 0;
    const Edge edge = runs[i].first;
    for (; i < runs.size() && runs[i].first == edge; ++i) {
      sum += runs[i].second;
    }
    if (sum != 0) {
      return false;
    }
  }
  return true;
}

std::vector<int> held_quantities(const FilmComplex& complex) {
  std::vector<int> result;
  for (std::size_t q = 0; q < complex.quantities.size(); ++q) {
    if (complex.quantities[q].role == FilmQuantity::Role::Held) {
      result.push_back(static_cast<int>(q));
    }
  }
  return result;
}

}  // namespace meniscus
