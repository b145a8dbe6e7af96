#include "evolve/start/hull.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace meniscus::start {

namespace {

// Owns qhull's state and the file that its messages go to.
class Qhull {
 public:
  Qhull() : messages_(std::tmpfile()) { qh_zero(&state_, messages_); }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    state_.NOerrexit = True;
    qh_freeqhull(&state_, !qh_ALL);
    int kept = 0;  // blocks and bytes that qhull still holds
    int bytes = 0;
    qh_memfreeshort(&state_, &kept, &bytes);
    if (messages_ != nullptr) {
      std::fclose(messages_);
    }
  }

  std::vector<Triangle> run(std::vector<double>& coordinates) {
    // Qt: triangulated; Pp: no warnings; the string must be writable.
    std::string command = "qhull Qt Pp";
    const int count = static_cast<int>(coordinates.size() / 3);
    const int failed = qh_new_qhull(&state_, 3, count, coordinates.data(),
                                    False, command.data(), nullptr, messages_);
    if (failed != 0) {
      throw MeshError(fmt::format("no convex hull of {} points: {}", count,
                                  first_message()));
    }
    std::vector<Triangle> facets;
    qhT* qh = &state_;
    facetT* facet = nullptr;
    FORALLfacets {
      Triangle corners{};
      int at = 0;
      vertexT* vertex = nullptr;
      vertexT** vertexp = nullptr;
      FOREACHvertex_(facet->vertices) {
        corners[at++] = qh_pointid(qh, vertex->point);
      }
      facets.push_back(corners);
    }
    return facets;
  }

 private:
  std::string first_message() {
    std::string text;
    if (messages_ != nullptr) {
      std::rewind(messages_);
      std::array<char, 200> line{};
      if (std::fgets(line.data(), line.size(), messages_) != nullptr) {
        text = line.data();
        text.erase(text.find_last_not_of("\r\n ") + 1);
      }
    }
    return text;
  }

  qhT state_;
  std::FILE* messages_;
};

// Turns every facet like its neighbours, starting from the largest, whose
// normal is the safest: single thin facets have none to trust.
void orient_outward(const Points& points, std::vector<Triangle>& facets) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(facets, edges, facet_edges);
  // The two facets at each edge, and the largest facet as the seed.
  std::vector<std::array<int, 2>> sides(edges.size(), {-1, -1});
  const auto normal = [&](const Triangle& t) {
    return Vec3(
        (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]));
  };
  int largest = 0;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    for (const int e : facet_edges[f]) {
      (sides[e][0] < 0 ? sides[e][0] : sides[e][1]) = f;
    }
    if (normal(facets[f]).norm() > normal(facets[largest]).norm()) {
      largest = f;
    }
  }
  // The points' mean is inside a convex hull: the seed's normal has to point
  // away from it.
  Vec3 inside = Vec3::Zero();
  for (const Vec3& p : points) {
    inside += p / static_cast<double>(points.size());
  }
  Triangle& first = facets[largest];
  if (normal(first).dot(points[first[0]] - inside) < 0.0) {
    std::swap(first[1], first[2]);
  }
  // Depth first over the edges: a neighbour is turned that runs the same way
  // along the common edge.
  const auto runs = [](const Triangle& t, const Edge& e) {
    return (t[0] == e[0] && t[1] == e[1]) || (t[1] == e[0] && t[2] == e[1]) ||
           (t[2] == e[0] && t[0] == e[1]);
  };
  std::vector<int> stack = {largest};
  std::vector<char> seen(facets.size(), 0);
  seen[largest] = 1;
  while (!stack.empty()) {
    const int f = stack.back();
    stack.pop_back();
    for (const int e : facet_edges[f]) {
      const int g = sides[e][0] == f ? sides[e][1] : sides[e][0];
      if (g < 0 || seen[g] != 0) {
        continue;
      }
      if (runs(facets[g], edges[e]) == runs(facets[f], edges[e])) {
        std::swap(facets[g][1], facets[g][2]);
      }
      seen[g] = 1;
      stack.push_back(g);
    }
  }
}

}  // namespace

std::vector<Triangle> convex_hull(const Points& points) {
  std::vector<double> coordinates;
  for (const Vec3& p : points) {
    coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
  }
  std::vector<Triangle> facets = Qhull().run(coordinates);
  for (Triangle& t : facets) {
    std::sort(t.begin(), t.end());
  }
  std::sort(facets.begin(), facets.end());
  orient_outward(points, facets);
  for (Triangle& t : facets) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  return facets;
}

}  // namespace meniscus::start
