#include "core/geometry/surface_mesh.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"

namespace meniscus {

int SurfaceMesh::label_of(const std::string& name) const {
  const auto found = std::find(labels.begin(), labels.end(), name);
  return found == labels.end() ? -1 : static_cast<int>(found - labels.begin());
}

Vec3 area_vector2(const SurfaceMesh& mesh, int facet) {
  const Triangle& t = mesh.facets[facet];
  const Vec3& a = mesh.points[t[0]];
  return (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
}

Vec3 polygon_area_vector(const Points& rim) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < rim.size(); ++i) {
    sum += (rim[i] - rim[0]).cross(rim[i + 1] - rim[0]);
  }
  return 0.5 * sum;
}

Vec3 mean_of(const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) {
    sum += p;
  }
  return sum / static_cast<double>(points.size());
}

double surface_area(const SurfaceMesh& mesh, int label) {
  double sum = 0.0;
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    if (label < 0 || mesh.facet_label[f] == label) {
      sum += area_vector2(mesh, f).norm();
    }
  }
  return 0.5 * sum;
}

int body_of_side(const SurfaceMesh& mesh, int side) {
  const FacetBodies bodies =
      mesh.facet_bodies.empty() ? FacetBodies{} : mesh.facet_bodies[side / 2];
  return side % 2 == 0 ? bodies.behind : bodies.front;
}

int body_count(const SurfaceMesh& mesh) {
  int count = mesh.facet_bodies.empty() && !mesh.facets.empty() ? 1 : 0;
  for (const FacetBodies& bodies : mesh.facet_bodies) {
    count = std::max({count, bodies.behind + 1, bodies.front + 1});
  }
  return count;
}

double enclosed_volume(const SurfaceMesh& mesh) {
  if (mesh.points.empty()) {
    return 0.0;
  }
  const Vec3 origin = mesh.points.front();  // keeps the terms small
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (!mesh.facet_bodies.empty() && mesh.facet_bodies[f].front >= 0) {
      continue;  // gives to one body what it takes from the other
    }
    const Triangle& t = mesh.facets[f];
    const Vec3 a = mesh.points[t[0]] - origin;
    const Vec3 b = mesh.points[t[1]] - origin;
    const Vec3 c = mesh.points[t[2]] - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

namespace {

// Per half edge (3 f + k) the first half edge between the same two points:
// half edges are put in one bucket per smaller point by counting, so that the
// time is linear but for the sorting of large buckets.
std::vector<int> first_half_edges(const std::vector<Triangle>& facets) {
  constexpr int kSmall = 24;  // above it sorting beats comparing all
  int points = 0;
  for (const Triangle& t : facets) {
    points = std::max({points, t[0] + 1, t[1] + 1, t[2] + 1});
  }
  struct Half {
    int other;
    int half;
  };
  // Counting sort: sizes of the buckets, their starts, then the half edges.
  std::vector<int> start(points + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t f = 0; f < facets.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const int a = facets[f][k];
        const int b = facets[f][k == 2 ? 0 : k + 1];
        visit(std::min(a, b),
              Half{std::max(a, b), static_cast<int>(3 * f) + k});
      }
    }
  };
  each([&](int point, const Half&) { ++start[point + 1]; });
  for (int p = 0; p < points; ++p) {
    start[p + 1] += start[p];
  }
  std::vector<Half> halves(3 * facets.size());
  std::vector<int> fill(start.begin(), start.end() - 1);
  each([&](int point, const Half& half) { halves[fill[point]++] = half; });
  // Within a bucket equal larger points are one edge; filled in rising order,
  // the first of them is the lowest half edge.
  std::vector<int> first(3 * facets.size());
  for (int p = 0; p < points; ++p) {
    Half* begin = halves.data() + start[p];
    Half* end = halves.data() + start[p + 1];
    if (end - begin > kSmall) {
      std::sort(begin, end, [](const Half& x, const Half& y) {
        return x.other < y.other || (x.other == y.other && x.half < y.half);
      });
      for (Half* h = begin; h != end; ++h) {
        const bool again = h != begin && (h - 1)->other == h->other;
        first[h->half] = again ? first[(h - 1)->half] : h->half;
      }
      continue;
    }
    for (Half* h = begin; h != end; ++h) {
      Half* same = begin;
      while (same->other != h->other) {
        ++same;
      }
      first[h->half] = same->half;
    }
  }
  return first;
}

}  // namespace

void list_edges(const std::vector<Triangle>& facets, std::vector<Edge>& edges,
                std::vector<Triangle>& facet_edges) {
  edges.clear();
  edges.reserve(facets.size() + facets.size() / 2 + 3);
  facet_edges.assign(facets.size(), Triangle{});
  const std::vector<int> first = first_half_edges(facets);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int same = first[3 * f + k];
      if (same != static_cast<int>(3 * f) + k) {
        facet_edges[f][k] = facet_edges[same / 3][same % 3];
        continue;
      }
      const int a = facets[f][k];
      const int b = facets[f][k == 2 ? 0 : k + 1];
      facet_edges[f][k] = static_cast<int>(edges.size());
      edges.push_back(edge_key(a, b));
    }
  }
}

double mean_edge_length(const SurfaceMesh& mesh) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  double sum = 0.0;
  for (const Edge& e : edges) {
    sum += (mesh.points[e[1]] - mesh.points[e[0]]).norm();
  }
  return edges.empty() ? 0.0 : sum / static_cast<double>(edges.size());
}

double bounding_diagonal(const Points& points) {
  if (points.empty()) {
    return 0.0;
  }
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace meniscus
