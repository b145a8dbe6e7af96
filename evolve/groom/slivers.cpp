#include "evolve/groom/slivers.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "evolve/films/triangle_shape.h"
#include "evolve/groom/flip_average.h"

namespace meniscus::groom {

namespace {

constexpr double kSliver = 15.0 / 180.0 * std::numbers::pi;
constexpr int kAveragings = 2;

/// Corners of the films' slivers and of the facets around them, by vertex;
/// empty where there is none.
std::vector<char> beside_slivers(const films::FilmComplex& complex) {
  const SurfaceMesh& mesh = complex.mesh;
  std::vector<char> corner(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto [a, b, c] = mesh.facets[f];
    if (complex.surfaces[mesh.facet_label[f]].liquid &&
        films::smallest_angle(mesh.points[a], mesh.points[b], mesh.points[c]) <
            kSliver) {
      corner[a] = corner[b] = corner[c] = 1;
    }
  }
  std::vector<char> beside = corner;
  for (const auto& [a, b, c] : mesh.facets) {
    if (corner[a] != 0 || corner[b] != 0 || corner[c] != 0) {
      beside[a] = beside[b] = beside[c] = 1;
    }
  }
  return std::find(corner.begin(), corner.end(), 1) != corner.end()
             ? beside
             : std::vector<char>();
}

}  // namespace

bool spread_slivers(films::FilmComplex& complex) {
  const std::vector<char> beside = beside_slivers(complex);
  if (beside.empty()) {
    return false;
  }
  for (int round = 0; round < kAveragings; ++round) {
    average_vertices(complex, beside);
  }
  return true;
}

}  // namespace meniscus::groom
