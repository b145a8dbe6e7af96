#include "mesh_tet/tet_boundary.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "core/math/union_find.h"
#include "mesh_tet/tet_quality.h"

namespace meniscus::mesh_tet {

namespace {

/// One side of a triangle, kept at its smallest corner.
struct Side {
  std::uint64_t others;  // the other corners, the larger in the low bits
  int owner;             // element; for a facet -1 - facet
  bool even;             // (smallest, middle, largest) runs as the triangle

  int middle() const { return static_cast<int>(others >> 32); }
  int largest() const { return static_cast<int>(others & 0xffffffffU); }
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
      sides_[next[s.corners[0]]++] = {
          (static_cast<std::uint64_t>(s.corners[1]) << 32) |
              static_cast<std::uint32_t>(s.corners[2]),
          owner, s.even};
    });
    for (std::size_t n = 0; n + 1 < start_.size(); ++n) {
      std::sort(sides_.begin() + start_[n], sides_.begin() + start_[n + 1],
                [](const Side& a, const Side& b) {
                  return a.others < b.others ||
                         (a.others == b.others && a.owner < b.owner);
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
        while (last != end && last->others == first->others) {
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

/// Regions grow from the facets through all faces that are none.
class RegionFiller {
 public:
  explicit RegionFiller(int elements) : parts_(elements), body_(elements, -1) {}

  void join(int e, int f) { parts_.join(e, f); }

  /// To be called when all are joined; what is wrong, if anything.
  std::string claim(int e, int body, int facet) {
    int& owner = body_[parts_.root(e)];
    if (owner >= 0 && owner != body) {
      return fmt::format(
          "element {} behind or before facet {} belongs to body {} and to "
          "body {}",
          e, facet, owner, body);
    }
    owner = body;
    return {};
  }

  std::vector<int> regions() {
    std::vector<int> result = parts_.roots();
    for (int& e : result) {
      e = body_[e];
    }
    return result;
  }

 private:
  UnionFind parts_;
  std::vector<int> body_;
};

std::string inner_problem(int smallest, const Side* sides, int count) {
  if (count == 1) {
    return fmt::format(
        "element {} has the boundary face ({}, {}, {}), which is no facet of "
        "the surface",
        sides[0].owner, smallest, sides[0].middle(), sides[0].largest());
  }
  if (count > 2 || sides[0].even == sides[1].even) {
    return fmt::format("elements {} and {} overlap at face ({}, {}, {})",
                       sides[0].owner, sides[1].owner, smallest,
                       sides[0].middle(), sides[0].largest());
  }
  return {};
}

/// Puts the elements on a facet's sides into the mesh.
std::string take_facet(const SurfaceMesh& surface, int facet, const Side* sides,
                       int count, TetMesh& mesh) {
  int& behind = mesh.face_element[facet];
  int front = -1;
  for (int i = 1; i < count; ++i) {
    int& place = sides[i].even == sides[0].even ? behind : front;
    if (place >= 0 || sides[i].owner < 0) {
      return fmt::format("facet {} is there twice or has overlapping elements",
                         facet);
    }
    place = sides[i].owner;
  }
  const int before = body_of_side(surface, 2 * facet + 1);
  if (behind < 0) {
    return fmt::format("facet {} has no element behind it", facet);
  }
  if ((front >= 0) != (before >= 0)) {
    return fmt::format("facet {} has {} element in front of it", facet,
                       front >= 0 ? "an" : "no");
  }
  if (!mesh.face_front.empty()) {
    mesh.face_front[facet] = front;
  }
  return {};
}

std::string fill_regions(const SurfaceMesh& surface, RegionFiller& filler,
                         TetMesh& mesh) {
  for (int f = 0; f < mesh.face_count(); ++f) {
    std::string problem =
        filler.claim(mesh.face_element[f], surface.facet_bodies[f].behind, f);
    if (problem.empty() && mesh.face_front[f] >= 0) {
      problem =
          filler.claim(mesh.face_front[f], surface.facet_bodies[f].front, f);
    }
    if (!problem.empty()) {
      return problem;
    }
  }
  mesh.element_region = filler.regions();
  const auto lost =
      std::find(mesh.element_region.begin(), mesh.element_region.end(), -1);
  return lost == mesh.element_region.end()
             ? std::string()
             : fmt::format("element {} belongs to no body",
                           lost - mesh.element_region.begin());
}

}  // namespace

std::string attach_surface(const SurfaceMesh& surface, TetMesh& mesh) {
  const std::size_t count = surface.facets.size();
  const bool bodies = !surface.facet_bodies.empty();
  mesh.labels = surface.labels;
  mesh.face_label = surface.facet_label;
  mesh.faces.resize(3 * count);
  for (std::size_t f = 0; f < count; ++f) {
    std::copy(surface.facets[f].begin(), surface.facets[f].end(),
              mesh.faces.begin() + 3 * static_cast<std::ptrdiff_t>(f));
  }
  mesh.face_element.assign(count, -1);
  mesh.face_front.assign(bodies ? count : 0, -1);
  std::string problem;
  const SideTable table(surface, mesh);
  RegionFiller filler(bodies ? mesh.element_count() : 0);
  table.for_each_triangle([&](int smallest, const Side* sides, int number) {
    if (!problem.empty()) {
      return;
    }
    const int facet = -1 - sides[0].owner;
    if (facet >= 0) {
      problem = take_facet(surface, facet, sides, number, mesh);
      return;
    }
    problem = inner_problem(smallest, sides, number);
    if (bodies && problem.empty()) {
      filler.join(sides[0].owner, sides[1].owner);
    }
  });
  if (bodies && problem.empty()) {
    problem = fill_regions(surface, filler, mesh);
  }
  if (!bodies) {
    mesh.element_region.assign(mesh.element_count(), 0);
  }
  return problem;
}

}  // namespace meniscus::mesh_tet
