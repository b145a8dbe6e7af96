#include "tests/support/complex_builder.h"

#include <cmath>

namespace meniscus::test_films {

namespace {

constexpr double kSamePlace = 1e-9;  // far below any cell of a plate

}  // namespace

int ComplexBuilder::liquid(const std::string& name, double tension) {
  complex_.mesh.labels.push_back(name);
  complex_.surfaces.push_back({.name = name, .tension = tension});
  return static_cast<int>(complex_.surfaces.size()) - 1;
}

int ComplexBuilder::solid(const std::string& name) {
  complex_.mesh.labels.push_back(name);
  complex_.surfaces.push_back({.name = name, .liquid = false});
  return static_cast<int>(complex_.surfaces.size()) - 1;
}

int ComplexBuilder::curve(const std::string& name, curves::CurveShape shape) {
  complex_.curves.push_back({name, std::move(shape)});
  return static_cast<int>(complex_.curves.size()) - 1;
}

int ComplexBuilder::vertex(const Vec3& place, films::VertexKind kind) {
  complex_.mesh.points.push_back(place);
  complex_.vertices.push_back({.kind = kind});
  return static_cast<int>(complex_.vertices.size()) - 1;
}

int ComplexBuilder::on_curve(int curve, double t) {
  const double wrapped = t - std::floor(t);
  const int v = vertex(curves::point_at(complex_.curves[curve].shape, wrapped),
                       films::VertexKind::OnCurve);
  complex_.vertices[v].curve = curve;
  complex_.vertices[v].t = wrapped;
  return v;
}

void ComplexBuilder::facet(int surface, int a, int b, int c) {
  complex_.mesh.facets.push_back({a, b, c});
  complex_.mesh.facet_label.push_back(surface);
}

void ComplexBuilder::quad(int surface, int a, int b, int c, int d) {
  facet(surface, a, b, c);
  facet(surface, a, c, d);
}

void ComplexBuilder::quad_about_centre(int surface, int a, int b, int c,
                                       int d) {
  fan(surface, {a, b, c, d}, films::VertexKind::Free);
}

void ComplexBuilder::fan(int surface, const std::vector<int>& ring,
                         films::VertexKind kind) {
  Vec3 sum = Vec3::Zero();
  for (const int v : ring) {
    sum += place(v);
  }
  const int middle = vertex(sum / static_cast<double>(ring.size()), kind);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    facet(surface, ring[i], ring[(i + 1) % ring.size()], middle);
  }
}

std::vector<int> ComplexBuilder::rim(int curve, int n, double offset) {
  std::vector<int> ring;
  for (int i = 0; i < n; ++i) {
    ring.push_back(on_curve(curve, static_cast<double>(i) / n + offset));
  }
  for (int i = 0; i < n; ++i) {
    complex_.edges.push_back({.a = ring[i],
                              .b = ring[(i + 1) % n],
                              .kind = films::VertexKind::OnCurve,
                              .curve = curve});
  }
  return ring;
}

void ComplexBuilder::fixed_edge(int a, int b) {
  complex_.edges.push_back({.a = a, .b = b, .kind = films::VertexKind::Fixed});
}

void ComplexBuilder::band(int surface, const std::vector<int>& lower,
                          const std::vector<int>& upper) {
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const std::size_t next = (i + 1) % lower.size();
    quad(surface, lower[i], lower[next], upper[next], upper[i]);
  }
}

int ComplexBuilder::corner(const Vec3& at) {
  for (const int v : corners_) {
    if ((place(v) - at).norm() < kSamePlace) {
      return v;
    }
  }
  corners_.push_back(vertex(at));
  return corners_.back();
}

void ComplexBuilder::plate(int surface, const Vec3& origin, const Vec3& u,
                           const Vec3& v, int n) {
  const auto at = [&](int i, int j) {
    return corner(origin + (u * i + v * j) / n);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = at(i, j);
      const int b = at(i + 1, j);
      const int c = at(i + 1, j + 1);
      const int d = at(i, j + 1);
      quad_about_centre(surface, a, b, c, d);
    }
  }
}

}  // namespace meniscus::test_films
