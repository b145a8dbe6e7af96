#include "tests/support/film_sums.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

namespace meniscus::sums {

namespace {

double at(const Expression& expression, const Vec3& p) {
  return expression.evaluate(std::array{p.x(), p.y(), p.z()});
}

double at(const PlaceField& field, const Vec3& p) {
  return at(with_numbers(field), p);
}

Vec3 at(const films::VectorField& field, const Vec3& p) {
  return {at(field[0], p), at(field[1], p), at(field[2], p)};
}

// Node k of n of Gauss-Legendre on [-1, 1] and its weight, by Newton's method
// on the recurrence.
std::array<double, 2> gauss(int k, int n) {
  double x = std::cos(3.14159265358979323846 * (k + 0.75) / (n + 0.5));
  double slope = 1.0;
  for (int step = 0; step < 10; ++step) {
    double p = 1.0;
    double before = 0.0;
    for (int j = 1; j <= n; ++j) {
      const double next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
      before = p;
      p = next;
    }
    slope = n * (x * p - before) / (x * x - 1.0);
    x -= p / slope;
  }
  return {x, 2.0 / ((1.0 - x * x) * slope * slope)};
}

double along(const films::FilmComplex& complex, const films::VectorField& field,
             const films::ComplexEdge& edge) {
  const Vec3& a = complex.mesh.points[edge.a];
  const Vec3& b = complex.mesh.points[edge.b];
  double sum = 0.0;
  for (int k = 0; k < complex.line_points; ++k) {
    const auto [x, w] = gauss(k, complex.line_points);
    sum += 0.5 * w * at(field, a + 0.5 * (1.0 + x) * (b - a)).dot(b - a);
  }
  return sum;
}

Vec3 normal(const films::LevelSet& level, const Vec3& p) {
  return level.formula
      .evaluate(std::array{Dual::variable(p.x(), 0, 3),
                           Dual::variable(p.y(), 1, 3),
                           Dual::variable(p.z(), 2, 3)})
      .gradient.normalized();
}

double gap(const films::FilmComplex& complex, const films::ComplexEdge& edge) {
  const Vec3& a = complex.mesh.points[edge.a];
  const Vec3& b = complex.mesh.points[edge.b];
  double sum = 0.0;
  if (edge.kind != films::VertexKind::Free || edge.constraints < 0) {
    return sum;
  }
  for (const int index : complex.constraint_sets[edge.constraints]) {
    const films::LevelSet& level = complex.level_sets[index];
    if (level.convex) {
      sum += complex.gap_constant * (b - a).norm() *
             (std::abs((b - a).dot(normal(level, a))) +
              std::abs((b - a).dot(normal(level, b)))) /
             12.0;
    }
  }
  return sum;
}

// Twelve points, exact to degree 6 (Dunavant 1985, Evolver's own rule): mean
// over a triangle.
template <class Function>
double mean(const Vec3& a, const Vec3& b, const Vec3& c, Function function) {
  double sum = 0.0;
  const auto add = [&](double w, double p, double q) {
    sum += w * function(p * a + q * b + (1.0 - p - q) * c);
  };
  for (const auto& [w, q] :
       {std::array{0.11678627572637936603, 0.24928674517091042129},
        std::array{0.05084490637020681692, 0.06308901449150222834}}) {
    add(w, q, q);
    add(w, q, 1.0 - 2.0 * q);
    add(w, 1.0 - 2.0 * q, q);
  }
  constexpr double kWeight = 0.08285107561837357519;
  constexpr std::array<double, 3> kAt = {
      0.05314504984481694735, 0.31035245103378440542, 0.63650249912139864723};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i != j) {
        add(kWeight, kAt[i], kAt[j]);
      }
    }
  }
  return sum;
}

struct Corners {
  Vec3 a, b, c;
  Vec3 vector() const { return 0.5 * (b - a).cross(c - a); }
};

Corners corners(const films::FilmComplex& complex, std::size_t facet) {
  const Triangle& t = complex.mesh.facets[facet];
  return {complex.mesh.points[t[0]], complex.mesh.points[t[1]],
          complex.mesh.points[t[2]]};
}

// Sign of the facet in the body: 1, -1, or 0.
int sign_in(const films::FilmComplex& complex, int body, std::size_t facet) {
  int sign = 0;
  for (const films::BodySide& side : complex.bodies[body].sides) {
    if (side.surface == complex.mesh.facet_label[facet]) {
      sign += side.sign;
    }
  }
  return sign;
}

double weight(const films::FilmComplex& complex, int body) {
  const double specific = -complex.gravity.z() * complex.bodies[body].density;
  double sum = 0.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const auto [a, b, c] = corners(complex, f);
    const double squares = a.z() * a.z() + b.z() * b.z() + c.z() * c.z() +
                           a.z() * b.z() + b.z() * c.z() + c.z() * a.z();
    sum += sign_in(complex, body, f) * squares / 12.0 *
           corners(complex, f).vector().z();
  }
  return specific * sum;
}

}  // namespace

double area(const films::FilmComplex& complex) {
  double sum = 0.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    sum += corners(complex, f).vector().norm();
  }
  return sum;
}

double quantity(const films::FilmComplex& complex, int index) {
  const films::FilmQuantity& q = complex.quantities[index];
  double sum = 0.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (!q.surfaces.empty() &&
        std::find(q.surfaces.begin(), q.surfaces.end(),
                  complex.mesh.facet_label[f]) == q.surfaces.end()) {
      continue;
    }
    const Corners t = corners(complex, f);
    if (q.kind == films::FilmQuantity::Kind::VectorIntegral) {
      sum += mean(t.a, t.b, t.c, [&](const Vec3& p) {
        return at(q.field, p).dot(t.vector());
      });
    } else if (q.kind == films::FilmQuantity::Kind::ScalarIntegral) {
      sum += t.vector().norm() * mean(t.a, t.b, t.c, [&](const Vec3& p) {
               return at(q.scalar, p);
             });
    } else {
      sum += t.vector().norm();
    }
  }
  return sum;
}

double size(const films::DropShape& shape, const Vec3& area) {
  double sum = shape.empty() ? area.norm() : 0.0;
  for (const films::Spheroid& part : shape) {
    const Vec3 axis = part.axis.normalized();
    sum += std::hypot(part.along * axis.dot(area),
                      part.across * area.cross(axis).norm());
  }
  return sum;
}

double energy(const films::FilmComplex& complex) {
  double sum = 0.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const films::ComplexSurface& surface =
        complex.surfaces[complex.mesh.facet_label[f]];
    const Corners t = corners(complex, f);
    sum += size(surface.drop_shape, t.vector()) *
           (surface.tension_field ? mean(t.a, t.b, t.c,
                                         [&](const Vec3& p) {
                                           return at(*surface.tension_field, p);
                                         })
                                  : surface.tension);
  }
  for (std::size_t b = 0; b < complex.bodies.size(); ++b) {
    sum += weight(complex, static_cast<int>(b));
  }
  for (const films::ComplexEdge& edge : complex.edges) {
    sum += gap(complex, edge);
    if (edge.integrals < 0) {
      continue;
    }
    for (const int index : complex.integral_sets[edge.integrals]) {
      const films::LineIntegral& integral = complex.integrals[index];
      if (integral.role == films::LineIntegral::Role::Energy) {
        sum += along(complex, integral.field, edge);
      }
    }
  }
  for (std::size_t q = 0; q < complex.quantities.size(); ++q) {
    if (complex.quantities[q].role == films::FilmQuantity::Role::Energy) {
      sum += complex.quantities[q].modulus *
             quantity(complex, static_cast<int>(q));
    }
  }
  return sum;
}

double volume(const films::FilmComplex& complex, int body) {
  double sum = complex.bodies[body].volume_offset;
  std::map<Edge, int> runs;  // with sign in the body, both ways of each edge
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const int sign = sign_in(complex, body, f);
    const Corners t = corners(complex, f);
    const Vec3 middle = (t.a + t.b + t.c) / 3.0;
    sum += sign * (complex.volume_rule == films::VolumeRule::Cone
                       ? middle.dot(t.vector()) / 3.0
                       : middle.z() * t.vector().z());
    const Triangle& v = complex.mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      runs[{v[k], v[(k + 1) % 3]}] += sign;
      runs[{v[(k + 1) % 3], v[k]}] -= sign;
    }
  }
  for (const films::ComplexEdge& edge : complex.edges) {
    if (edge.integrals < 0) {
      continue;
    }
    for (const int index : complex.integral_sets[edge.integrals]) {
      const films::LineIntegral& integral = complex.integrals[index];
      if (integral.role == films::LineIntegral::Role::Content) {
        sum += runs[{edge.a, edge.b}] * along(complex, integral.field, edge);
      }
    }
  }
  return sum;
}

int edges(const films::FilmComplex& complex) {
  std::vector<Edge> list;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, list, facet_edges);
  return static_cast<int>(list.size());
}

}  // namespace meniscus::sums
