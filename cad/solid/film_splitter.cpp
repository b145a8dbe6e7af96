#include "cad/solid/film_splitter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "core/geometry/edge_key.h"
#include "core/math/dense.h"

namespace meniscus::solid {

namespace {

// A crossing nearer to an edge's end than this share is at that end, so that
// no slivers arise.
constexpr double kNearEnd = 0.03;
constexpr double kOnLevel = 1e-9;
constexpr int kMostRefinements = 3;
constexpr std::size_t kEnoughFacets = 8000;  // for smooth cuts

/// The polygon's fan from its first corner.
template <class Corner, class Make>
void fan(const std::vector<Corner>& corners, const Make& make) {
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    make(corners[0], corners[k], corners[k + 1]);
  }
}

}  // namespace

int add_vertex(SplitFilm& split, int a, int b, double t) {
  CutFilm& film = split.film;
  const int v = static_cast<int>(film.mesh.points.size());
  const Edge edge = edge_key(a, b);
  Vec3 point = smooth_edge_point(film.mesh, a, b, t);
  int rim = -1;
  double position = 0.0;
  if (split.rim_edges.erase(edge) > 0) {
    rim = film.rim_of[a];
    const RimCurve& curve = *(*split.rims)[rim].curve;
    double way = film.rim_position[b] - film.rim_position[a];
    way -= curve.length() * std::round(way / curve.length());
    position = curve.wrapped(film.rim_position[a] + t * way);
    point = curve.point(position);
    split.rim_edges.insert(edge_key(a, v));
    split.rim_edges.insert(edge_key(v, b));
  }
  film.mesh.points.push_back(point);
  film.mesh.normals.push_back(mixed_normal(film.mesh, a, b, t));
  film.rim_of.push_back(rim);
  film.rim_position.push_back(position);
  return v;
}

namespace {

SplitFilm start(FilmMesh mesh, const std::vector<FilmRim>& rims) {
  SplitFilm split;
  split.rims = &rims;
  split.film.rim_of.assign(mesh.points.size(), -1);
  split.film.rim_position.assign(mesh.points.size(), 0.0);
  for (std::size_t r = 0; r < rims.size(); ++r) {
    const std::vector<int>& loop = rims[r].loop;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int next = loop[(k + 1) % loop.size()];
      split.film.rim_of[loop[k]] = static_cast<int>(r);
      split.film.rim_position[loop[k]] = rims[r].positions[k];
      split.rim_edges.insert(edge_key(loop[k], next));
    }
  }
  split.cell.assign(mesh.facets.size(), 0);
  split.sector.assign(mesh.facets.size(), 0);
  split.film.mesh = std::move(mesh);
  return split;
}

/// Every facet in four.
void refine(SplitFilm& split) {
  FilmMesh& mesh = split.film.mesh;
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  const int first = static_cast<int>(mesh.points.size());
  for (const Edge& edge : edges) {
    add_vertex(split, edge[0], edge[1], 0.5);
  }
  std::vector<Triangle> facets;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Triangle t = mesh.facets[f];
    Triangle m = facet_edges[f];
    for (int& v : m) {
      v += first;
    }
    facets.insert(facets.end(),
                  {Triangle{t[0], m[0], m[2]}, Triangle{m[0], t[1], m[1]},
                   Triangle{m[2], m[1], t[2]}, m});
  }
  mesh.facets = std::move(facets);
  set_normals(mesh);
  split.cell.assign(mesh.facets.size(), 0);
  split.sector.assign(mesh.facets.size(), 0);
}

}  // namespace

SplitFilm refined_film(FilmMesh mesh, const std::vector<FilmRim>& rims) {
  SplitFilm split = start(std::move(mesh), rims);
  for (int round = 0; round < kMostRefinements &&
                      split.film.mesh.facets.size() < kEnoughFacets;
       ++round) {
    refine(split);
  }
  return split;
}

namespace {

/// Corner weights where three linear functions, given at the corners (a row
/// each), are alike; kept inside.
Vec3 meeting_place(const Mat3& values) {
  Mat3 system;
  system.row(0) = (values.col(0) - values.col(1)).transpose();
  system.row(1) = (values.col(1) - values.col(2)).transpose();
  system.row(2).setOnes();
  Vec3 at = solve_lu(system, Vec3(0.0, 0.0, 1.0));
  at = at.cwiseMax(0.1);
  return at / at.sum();
}

struct GreatestCutter {
  SplitFilm& split;
  const Eigen::MatrixXd& measures;
  std::vector<int> label;
  std::map<Edge, int> crossings;
  std::vector<Triangle> facets;
  std::vector<int> cells;
  std::vector<int> nodes;

  int crossing(int a, int b) {
    const Edge edge = edge_key(a, b);
    const auto found = crossings.find(edge);
    if (found != crossings.end()) {
      return found->second;
    }
    const int i = label[edge[0]];
    const int j = label[edge[1]];
    const double at_a = measures(edge[0], i) - measures(edge[0], j);
    const double at_b = measures(edge[1], i) - measures(edge[1], j);
    const double t = at_a - at_b > 0.0 ? at_a / (at_a - at_b) : 0.5;
    const int v = add_vertex(split, edge[0], edge[1],
                             std::clamp(t, kNearEnd, 1.0 - kNearEnd));
    crossings[edge] = v;
    return v;
  }
  void put(const Triangle& t, int cell) {
    facets.push_back(t);
    cells.push_back(cell);
  }
  void cut(int f);
};

void GreatestCutter::cut(int f) {
  const Triangle t = split.film.mesh.facets[f];
  std::array<int, 3> l{label[t[0]], label[t[1]], label[t[2]]};
  // One measure is greatest at all corners: linear, hence within the facet.
  if (l[0] == l[1] && l[1] == l[2]) {
    put(t, l[0]);
    return;
  }
  // Three cells meet: the node is where the three linear measures are equal;
  // with the crossings on the sides it makes two facets per corner.
  if (l[0] != l[1] && l[1] != l[2] && l[2] != l[0]) {
    Mat3 values;
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) {
        values(k, c) = measures(t[k], l[c]);
      }
    }
    const Vec3 at = meeting_place(values);
    CutFilm& film = split.film;
    const Vec3 point = smooth_point(film.mesh, f, at);
    Vec3 normal = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      normal += at[k] * film.mesh.normals[t[k]];
    }
    const std::array<int, 3> mid{crossing(t[0], t[1]), crossing(t[1], t[2]),
                                 crossing(t[2], t[0])};
    const int node = static_cast<int>(film.mesh.points.size());
    film.mesh.points.push_back(point);
    film.mesh.normals.push_back(normal.normalized());
    film.rim_of.push_back(-1);
    film.rim_position.push_back(0.0);
    nodes.push_back(node);
    for (int k = 0; k < 3; ++k) {
      put({t[k], mid[k], node}, l[k]);
      put({t[k], node, mid[(k + 2) % 3]}, l[k]);
    }
    return;
  }
  // Two cells: the line of equal measures cuts off the lone corner.
  int lone = 0;
  while (l[(lone + 1) % 3] != l[(lone + 2) % 3]) {
    ++lone;
  }
  const int a = t[lone];
  const int b = t[(lone + 1) % 3];
  const int c = t[(lone + 2) % 3];
  const int ab = crossing(a, b);
  const int ca = crossing(c, a);
  put({a, ab, ca}, label[a]);
  put({ab, b, c}, label[b]);
  put({ab, c, ca}, label[b]);
}

}  // namespace

std::vector<int> split_by_greatest(SplitFilm& split,
                                   const Eigen::MatrixXd& measures) {
  GreatestCutter cutter{split, measures, {}, {}, {}, {}, {}};
  for (Eigen::Index v = 0; v < measures.rows(); ++v) {
    Eigen::Index best = 0;
    measures.row(v).maxCoeff(&best);
    cutter.label.push_back(static_cast<int>(best));
  }
  const int count = static_cast<int>(split.film.mesh.facets.size());
  for (int f = 0; f < count; ++f) {
    cutter.cut(f);
  }
  split.film.mesh.facets = std::move(cutter.facets);
  split.cell = std::move(cutter.cells);
  return cutter.nodes;
}

namespace {

struct LevelCutter {
  SplitFilm& split;
  int cell;
  double level;
  std::vector<char> at_level = {};  // per vertex
  std::map<Edge, int> crossings = {};

  /// Corner values less the level and the whole number that brings the line
  /// into the facet.
  std::array<double, 3> differences(int f) const {
    const std::array<double, 3>& value = split.value[f];
    const double middle = (value[0] + value[1] + value[2]) / 3.0;
    const double shift = level + std::round(middle - level);
    std::array<double, 3> d{};
    for (int k = 0; k < 3; ++k) {
      d[k] = value[k] - shift;
      const int v = split.film.mesh.facets[f][k];
      if (std::abs(d[k]) < kOnLevel ||
          (v < static_cast<int>(at_level.size()) && at_level[v] != 0 &&
           std::abs(d[k]) < 0.25)) {
        d[k] = 0.0;
      }
    }
    return d;
  }
  void mark_near(const std::vector<char>& kept) {
    std::vector<char> marks(split.film.mesh.points.size(), 0);
    for (std::size_t f = 0; f < split.cell.size(); ++f) {
      if (split.cell[f] != cell) {
        continue;
      }
      const Triangle& t = split.film.mesh.facets[f];
      const std::array<double, 3> d = differences(static_cast<int>(f));
      for (int k = 0; k < 3; ++k) {
        const int n = (k + 1) % 3;
        if (d[k] * d[n] < 0.0) {
          const double share = d[k] / (d[k] - d[n]);
          const int v = share < kNearEnd         ? t[k]
                        : share > 1.0 - kNearEnd ? t[n]
                                                 : -1;
          if (v >= 0 && (v >= static_cast<int>(kept.size()) || kept[v] == 0)) {
            marks[v] = 1;
          }
        }
      }
    }
    at_level = std::move(marks);
  }
  int crossing(int a, int b, double da, double db) {
    const Edge edge = edge_key(a, b);
    const auto found = crossings.find(edge);
    if (found != crossings.end()) {
      return found->second;
    }
    if (a != edge[0]) {
      std::swap(da, db);
    }
    return crossings[edge] =
               add_vertex(split, edge[0], edge[1], da / (da - db));
  }
  void cut(int f);
};

void LevelCutter::cut(int f) {
  struct Corner {
    int vertex;
    double value;
    double difference;
  };
  const Triangle t = split.film.mesh.facets[f];
  // Values are linear on the facet: signs at the corners tell where the
  // level line enters and leaves.
  const std::array<double, 3> d = differences(f);
  std::array<std::vector<Corner>, 2> sides;  // below, above
  bool crossed = false;
  // Corners on the line get its exact value, so that neighbours agree.
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0.0) {
      double& value = split.value[f][k];
      value = level + std::round(value - level);
    }
  }
  // Clip the facet at the line into a polygon below and one above; they share
  // the crossings, found once per edge.
  for (int k = 0; k < 3; ++k) {
    const int n = (k + 1) % 3;
    const Corner here{t[k], split.value[f][k], d[k]};
    for (int side = 0; side < 2; ++side) {
      if (side == 0 ? d[k] <= 0.0 : d[k] >= 0.0) {
        sides[side].push_back(here);
      }
    }
    if (d[k] * d[n] < 0.0) {
      crossed = true;
      const int v = crossing(t[k], t[n], d[k], d[n]);
      const double share = d[k] / (d[k] - d[n]);
      const Corner cut{
          v,
          split.value[f][k] + share * (split.value[f][n] - split.value[f][k]),
          0.0};
      sides[0].push_back(cut);
      sides[1].push_back(cut);
    }
  }
  if (!crossed) {
    return;
  }
  // Both polygons are convex, so that fans triangulate them.
  bool first = true;
  for (const std::vector<Corner>& side : sides) {
    fan(side, [&](const Corner& a, const Corner& b, const Corner& c) {
      const Triangle facet{a.vertex, b.vertex, c.vertex};
      const std::array<double, 3> value{a.value, b.value, c.value};
      if (first) {
        split.film.mesh.facets[f] = facet;
        split.value[f] = value;
        first = false;
      } else {
        split.film.mesh.facets.push_back(facet);
        split.value.push_back(value);
        split.cell.push_back(split.cell[f]);
        split.sector.push_back(split.sector[f]);
      }
    });
  }
}

}  // namespace

void split_by_level(SplitFilm& split, int cell, double level,
                    const std::vector<char>& kept) {
  LevelCutter cutter{split, cell, level};
  cutter.mark_near(kept);
  const int count = static_cast<int>(split.cell.size());
  for (int f = 0; f < count; ++f) {
    if (split.cell[f] == cell) {
      cutter.cut(f);
    }
  }
}

}  // namespace meniscus::solid
