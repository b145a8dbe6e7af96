#include "evolve/groom/rough_films.h"

#include <array>
#include <numbers>
#include <unordered_map>

#include "core/geometry/edge_key.h"
#include "evolve/films/triangle_shape.h"
#include "evolve/groom/flip_average.h"

namespace meniscus::groom {

namespace {

constexpr double kThin = 10.0 * std::numbers::pi / 180.0;
constexpr double kFoldCosine = 0.5;
constexpr int kPasses = 10;
constexpr int kNear = 3;  // edges

/// The facets along an edge: how many, and the last two ones' normals as if
/// they ran from the lower to the higher point.
struct Beside {
  int facets = 0;
  std::array<Vec3, 2> normal = {Vec3::Zero(), Vec3::Zero()};
};

bool is_film(const films::FilmComplex& complex, std::size_t f) {
  return complex.surfaces[complex.mesh.facet_label[f]].liquid;
}

/// Those within some edges of the marked ones, too.
void widen(const films::FilmComplex& complex, std::vector<char>& marked) {
  for (int ring = 0; ring < kNear; ++ring) {
    const std::vector<char> before = marked;
    for (const Triangle& t : complex.mesh.facets) {
      if (before[t[0]] + before[t[1]] + before[t[2]] > 0) {
        marked[t[0]] = marked[t[1]] = marked[t[2]] = 1;
      }
    }
  }
}

}  // namespace

std::vector<char> rough_vertices(const films::FilmComplex& complex) {
  const SurfaceMesh& mesh = complex.mesh;
  std::vector<char> rough(mesh.points.size(), 0);
  bool any = false;
  std::unordered_map<Edge, Beside, EdgeHash> edges;
  edges.reserve(3 * mesh.facets.size() / 2);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (!is_film(complex, f)) {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    const Vec3& a = mesh.points[t[0]];
    const Vec3& b = mesh.points[t[1]];
    const Vec3& c = mesh.points[t[2]];
    if (films::smallest_angle(a, b, c) < kThin) {
      rough[t[0]] = rough[t[1]] = rough[t[2]] = 1;
      any = true;
    }
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (int k = 0; k < 3; ++k) {
      const int from = t[k];
      const int to = t[(k + 1) % 3];
      Beside& beside = edges[edge_key(from, to)];
      beside.normal[beside.facets++ % 2] = from < to ? normal : Vec3(-normal);
    }
  }
  for (const films::ComplexEdge& line : complex.edges) {
    edges.erase(edge_key(line.a, line.b));
  }
  for (const auto& [edge, beside] : edges) {
    // facets of one film run along their edge in opposite ways
    if (beside.facets == 2 &&
        -beside.normal[0].dot(beside.normal[1]) < kFoldCosine) {
      rough[edge[0]] = rough[edge[1]] = 1;
      any = true;
    }
  }
  return any ? rough : std::vector<char>();
}

bool even_out(films::FilmComplex& complex, EvenOut how) {
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<char> rough = rough_vertices(complex);
    if (rough.empty()) {
      return pass > 0;
    }
    if (how == EvenOut::Flips) {
      equiangulate(complex);
      average_vertices(complex);
    } else {
      widen(complex, rough);
      average_vertices(complex, rough);
    }
  }
  return true;
}

}  // namespace meniscus::groom
