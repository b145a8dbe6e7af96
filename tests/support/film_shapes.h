/// Small film complexes made by hand.
#pragma once

#include <numbers>

#include "evolve/films/film_complex.h"
#include "tests/support/shapes.h"

namespace meniscus::shapes {

/// Film "tube" of tension 1 between circles of radius R at z = -L/2 and L/2,
/// n points around and m rows along, radius profile(z); normals outward.
template <typename Profile>
films::FilmComplex tube(double radius, double length, int n, int m,
                        const Profile& profile) {
  films::FilmComplex complex;
  complex.mesh.labels = {"tube"};
  complex.surfaces = {{"tube", true, 1.0}};
  for (const double z : {-0.5 * length, 0.5 * length}) {
    complex.curves.push_back(
        {z < 0 ? "bottom" : "top",
         curves::Circle{Vec3(0, 0, z), Vec3::UnitZ(), radius}});
  }
  for (int j = 0; j <= m; ++j) {
    const double z = length * (static_cast<double>(j) / m - 0.5);
    const bool rim = j == 0 || j == m;
    for (int i = 0; i < n; ++i) {
      const double t = static_cast<double>(i) / n;
      const double angle = 2.0 * std::numbers::pi * t;
      const double r = rim ? radius : profile(z);
      complex.mesh.points.emplace_back(r * std::cos(angle), r * std::sin(angle),
                                       z);
      complex.vertices.push_back(
          {rim ? films::VertexKind::OnCurve : films::VertexKind::Free,
           rim ? (j == 0 ? 0 : 1) : -1, rim ? t : 0.0});
    }
  }
  const auto add = [&](int a, int b, int c, int label) {
    complex.mesh.facets.push_back({a, b, c});
    complex.mesh.facet_label.push_back(label);
  };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i;
      const int b = j * n + (i + 1) % n;
      if ((i + j) % 2 == 0) {
        add(a, b, b + n, 0);
        add(a, b + n, a + n, 0);
      } else {
        add(a, b, a + n, 0);
        add(b, b + n, a + n, 0);
      }
    }
  }
  return complex;
}

/// Closes a tube with flat caps (fans) and makes it the body "part".
inline void close_tube(films::FilmComplex& complex, int n) {
  const auto points = static_cast<int>(complex.mesh.points.size());
  complex.mesh.labels = {"tube", "floor", "lid"};
  complex.surfaces.push_back({"floor", false, 0.0});
  complex.surfaces.push_back({"lid", false, 0.0});
  for (const int cap : {0, 1}) {
    const int first = cap == 0 ? 0 : points - n;
    const auto center = static_cast<int>(complex.mesh.points.size());
    complex.mesh.points.emplace_back(0, 0, complex.mesh.points[first].z());
    complex.vertices.push_back({films::VertexKind::InCap, -1, 0.0});
    for (int i = 0; i < n; ++i) {
      const int a = first + i;
      const int b = first + (i + 1) % n;
      complex.mesh.facets.push_back(cap == 0 ? Triangle{center, b, a}
                                             : Triangle{center, a, b});
      complex.mesh.facet_label.push_back(1 + cap);
    }
  }
  films::ComplexBody body;
  body.name = "part";
  body.sides = {{0, 1}, {1, 1}, {2, 1}};
  complex.bodies.push_back(body);
}

/// The surface as one floating film that encloses the body "drop".
inline films::FilmComplex drop(const SurfaceMesh& mesh, double volume) {
  films::FilmComplex complex;
  complex.mesh = mesh;
  complex.mesh.labels = {"film"};
  complex.mesh.facet_label.assign(mesh.facets.size(), 0);
  complex.surfaces = {{"film", true, 1.0}};
  complex.vertices.resize(mesh.points.size());
  films::ComplexBody body;
  body.name = "drop";
  body.sides = {{0, 1}};
  body.volume = volume;
  complex.bodies.push_back(body);
  return complex;
}

}  // namespace meniscus::shapes
