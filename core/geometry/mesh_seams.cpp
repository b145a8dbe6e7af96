#include "core/geometry/mesh_seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/math/union_find.h"

namespace meniscus {

namespace {

/// Side k of a face: its corners, ascending, and its middle node or -1.
struct Side {
  std::pair<int, int> corners;
  int middle = -1;

  bool operator<(const Side& other) const { return corners < other.corners; }
};

Side side_of(const TetMesh& mesh, int face, int k) {
  const auto ids = mesh.face(face);
  const int a = ids[static_cast<std::size_t>(k)];
  const int b = ids[static_cast<std::size_t>((k + 1) % 3)];
  return {{std::min(a, b), std::max(a, b)},
          mesh.order == 2 ? ids[static_cast<std::size_t>(3 + k)] : -1};
}

/// By Gauss's rule of three points, exact where it is straight.
double length_of(const TetMesh& mesh, const Side& side) {
  const Vec3& a = mesh.nodes[static_cast<std::size_t>(side.corners.first)];
  const Vec3& b = mesh.nodes[static_cast<std::size_t>(side.corners.second)];
  if (side.middle < 0) {
    return (b - a).norm();
  }
  const Vec3& m = mesh.nodes[static_cast<std::size_t>(side.middle)];
  const double at = std::sqrt(0.6);
  constexpr std::array<double, 3> kWeight = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  double length = 0.0;
  for (int q = 0; q < 3; ++q) {
    const double t = (q - 1) * at;  // from -1 to 1
    length += kWeight[static_cast<std::size_t>(q)] *
              ((t - 0.5) * a - 2.0 * t * m + (t + 0.5) * b).norm();
  }
  return length;
}

}  // namespace

int piece_count(const TetMesh& mesh) {
  UnionFind joined(static_cast<std::size_t>(mesh.element_count()));
  int pieces = mesh.element_count();
  const int regions = 1 + *std::max_element(mesh.element_region.begin(),
                                            mesh.element_region.end());
  for (int region = 0; region < regions; ++region) {
    std::vector<int> first(static_cast<std::size_t>(mesh.corner_count), -1);
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.element_region[static_cast<std::size_t>(e)] != region) {
        continue;
      }
      for (int corner = 0; corner < 4; ++corner) {
        int& seen = first[static_cast<std::size_t>(
            mesh.element(e)[static_cast<std::size_t>(corner)])];
        seen = seen < 0 ? e : seen;
        pieces -= joined.join(e, seen) ? 1 : 0;
      }
    }
  }
  return pieces;
}

double seam_length(const TetMesh& mesh) {
  if (mesh.face_front.empty()) {
    return 0.0;
  }
  std::set<Side> between;
  for (int f = 0; f < mesh.face_count(); ++f) {
    for (int k = 0; mesh.face_front[static_cast<std::size_t>(f)] >= 0 && k < 3;
         ++k) {
      between.insert(side_of(mesh, f, k));
    }
  }
  double length = 0.0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    for (int k = 0; mesh.face_front[static_cast<std::size_t>(f)] < 0 && k < 3;
         ++k) {
      // Counted once, though two outer faces meet there.
      if (const auto at = between.find(side_of(mesh, f, k));
          at != between.end()) {
        length += length_of(mesh, *at);
        between.erase(at);
      }
    }
  }
  return length;
}

}  // namespace meniscus
