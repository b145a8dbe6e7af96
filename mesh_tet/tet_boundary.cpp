#include "mesh_tet/tet_boundary.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "mesh_tet/tet_quality.h"

namespace meniscus {

namespace {

/// One side of a triangle, kept at its smallest corner.
struct Side {
  int middle, largest;  // the other corners
  int owner;            // element; for a facet -1 - facet
  bool even;            // (smallest, middle, largest) runs as the triangle

  bool same_corners(const Side& other) const {
    return middle == other.middle && largest == other.largest;
  }
};

struct Sorted {
  Triangle corners;
  bool even;
};

Sorted sorted(Triangle t) {
  bool even = true;
  const auto order = [&](int i, int j) {
    if (t[i] > t[j]) {
      std::swap(t[i], t[j]);
      even = !even;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return {t, even};
}

/// All faces of elements and all facets, grouped by smallest corner.
class SideTable {
 public:
  SideTable(const SurfaceMesh& surface, const TetMesh& mesh)
      : start_(mesh.nodes.size() + 1, 0) {
    for_each(surface, mesh,
             [&](const Sorted& s, int) { ++start_[s.corners[0] + 1]; });
    for (std::size_t n = 1; n < start_.size(); ++n) {
      start_[n] += start_[n - 1];
    }
    sides_.resize(start_.back());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for_each(surface, mesh, [&](const Sorted& s, int owner) {
      sides_[next[s.corners[0]]++] = {s.corners[1], s.corners[2], owner,
                                      s.even};
    });
    for (std::size_t n = 0; n + 1 < start_.size(); ++n) {
      std::sort(sides_.begin() + start_[n], sides_.begin() + start_[n + 1],
                [](const Side& a, const Side& b) {
                  return std::tie(a.middle, a.largest, a.owner) <
                         std::tie(b.middle, b.largest, b.owner);
                });
    }
  }

  /// Calls `visit(smallest, first, last)` per distinct triangle.
  template <class Visit>
  void for_each_triangle(Visit visit) const {
    for (std::size_t n = 0; n + 1 < start_.size(); ++n) {
      auto first = sides_.begin() + start_[n];
      const auto end = sides_.begin() + start_[n + 1];
      while (first != end) {
        auto last = first + 1;
        while (last != end && last->same_corners(*first)) {
          ++last;
        }
        visit(static_cast<int>(n), &*first, static_cast<int>(last - first));
        first = last;
      }
    }
  }

 private:
  template <class Take>
  static void for_each(const SurfaceMesh& surface, const TetMesh& mesh,
                       Take take) {
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
      take(sorted(surface.facets[f]), -1 - static_cast<int>(f));
    }
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto ids = mesh.element(e);
      for (const auto& face : kTetFaces) {
        take(sorted({ids[face[0]], ids[face[1]], ids[face[2]]}), e);
      }
    }
  }

  std::vector<int> start_;
  std::vector<Side> sides_;
};

std::string problem_of(int smallest, const Side* sides, int count) {
  const std::string corners =
      fmt::format("({}, {}, {})", smallest, sides[0].middle, sides[0].largest);
  const int facet = -1 - sides[0].owner;
  if (facet < 0) {
    if (count == 1) {
      return fmt::format(
          "element {} has the boundary face {}, which is no facet of the "
          "surface",
          sides[0].owner, corners);
    }
    if (count > 2 || sides[0].even == sides[1].even) {
      return fmt::format("elements {} and {} overlap at face {}",
                         sides[0].owner, sides[1].owner, corners);
    }
    return {};
  }
  if (count == 1) {
    return fmt::format("facet {} {} is missing from the mesh", facet, corners);
  }
  if (count > 2) {
    return fmt::format("facet {} {} has {} elements instead of one", facet,
                       corners, count - 1);
  }
  if (sides[0].even != sides[1].even) {
    return fmt::format("facet {} {} has its element outside", facet, corners);
  }
  return {};
}

}  // namespace

std::string attach_surface(const SurfaceMesh& surface, TetMesh& mesh) {
  const std::size_t count = surface.facets.size();
  mesh.labels = surface.labels;
  mesh.face_label = surface.facet_label;
  mesh.face_element.assign(count, -1);
  mesh.faces.resize(3 * count);
  for (std::size_t f = 0; f < count; ++f) {
    std::copy(surface.facets[f].begin(), surface.facets[f].end(),
              mesh.faces.begin() + 3 * static_cast<std::ptrdiff_t>(f));
  }
  std::string problem;
  const SideTable table(surface, mesh);
  table.for_each_triangle([&](int smallest, const Side* sides, int number) {
    if (problem.empty()) {
      problem = problem_of(smallest, sides, number);
    }
    if (sides[0].owner < 0 && number > 1) {
      mesh.face_element[-1 - sides[0].owner] = sides[1].owner;
    }
  });
  return problem;
}

}  // namespace meniscus
