#include "evolve/walls/sheet.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/math/union_find.h"

namespace meniscus::walls {

namespace {

std::string place(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

// An area below this, relative to the longest edge squared, has no normal.
constexpr double kFlatFacet = 1e-14;

void check_facet(const SurfaceMesh& film, int f) {
  const auto points = static_cast<int>(film.points.size());
  const Triangle& t = film.facets[f];
  for (const int v : t) {
    if (v < 0 || v >= points) {
      throw InvalidInput(
          fmt::format("wall: facet {} of the film has corner {}, but there are "
                      "{} points",
                      f, v, points));
    }
    if (!film.points[v].allFinite()) {
      throw InvalidInput(
          fmt::format("wall: point {} of the film is not finite", v));
    }
  }
  const int label = film.facet_label[f];
  if (label < 0 || label >= static_cast<int>(film.labels.size())) {
    throw InvalidInput(
        fmt::format("wall: facet {} has label {}, but there are "
                    "{} labels",
                    f, label, film.labels.size()));
  }
  double longest2 = 0.0;
  for (int k = 0; k < 3; ++k) {
    longest2 = std::max(
        longest2,
        (film.points[t[k]] - film.points[t[(k + 1) % 3]]).squaredNorm());
  }
  if (!(area_vector2(film, f).norm() > kFlatFacet * longest2)) {
    throw InvalidInput(fmt::format(
        "wall: facet {} of \"{}\" near {} has no area and so no normal; "
        "remesh the film",
        f, film.labels[label], place(film.points[t[0]])));
  }
}

// Drops points that no facet uses.
void compact(const SurfaceMesh& film, Sheet& sheet) {
  std::vector<int> id(film.points.size(), -1);
  for (const Triangle& t : film.facets) {
    for (const int v : t) {
      id[v] = 0;
    }
  }
  for (std::size_t v = 0; v < id.size(); ++v) {
    if (id[v] == 0) {
      id[v] = static_cast<int>(sheet.origin.size());
      sheet.origin.push_back(static_cast<int>(v));
      sheet.film.points.push_back(film.points[v]);
    }
  }
  sheet.film.labels = film.labels;
  sheet.film.facet_label = film.facet_label;
  for (const Triangle& t : film.facets) {
    sheet.film.facets.push_back({id[t[0]], id[t[1]], id[t[2]]});
  }
}

[[noreturn]] void refuse_edge(const Sheet& sheet, const Edge& edge,
                              const std::vector<int>& facets,
                              const char* what) {
  const SurfaceMesh& film = sheet.film;
  std::string names;
  std::string ids;
  for (const int f : facets) {
    const std::string& name = film.labels[film.facet_label[f]];
    if (names.find('"' + name + '"') == std::string::npos) {
      names += (names.empty() ? "\"" : ", \"") + name + '"';
    }
    ids += (ids.empty() ? "" : ", ") + std::to_string(f);
  }
  throw MeshError(fmt::format(
      "wall: {} at {}, facets {} of {}", what,
      place(0.5 * (film.points[edge[0]] + film.points[edge[1]])), ids, names));
}

void join_edges(Sheet& sheet) {
  struct Use {
    Edge edge;
    int facet;
    bool forward;
  };
  // Half edges, sorted by their edge: uses of one edge come together.
  std::vector<Use> uses;
  const auto count = static_cast<int>(sheet.film.facets.size());
  for (int f = 0; f < count; ++f) {
    const Triangle& t = sheet.film.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      uses.push_back({edge_key(a, b), f, a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.facet < b.facet;
  });
  for (std::size_t i = 0; i < uses.size();) {
    std::vector<int> facets;
    std::size_t j = i;
    for (; j < uses.size() && uses[j].edge == uses[i].edge; ++j) {
      facets.push_back(uses[j].facet);
    }
    // Two sides everywhere: at most two facets an edge, and these must run
    // opposite ways.
    if (facets.size() > 2) {
      refuse_edge(sheet, uses[i].edge, facets,
                  "films meet in a junction, which has no two sides; thicken "
                  "the films one by one or make them bodies:");
    }
    if (facets.size() == 2 && uses[i].forward == uses[i + 1].forward) {
      refuse_edge(sheet, uses[i].edge, facets,
                  "neighbouring facets have normals on opposite sides; turn "
                  "one film's facets:");
    }
    sheet.edges.push_back(uses[i].edge);
    sheet.edge_facets.push_back(
        {facets[0], facets.size() == 2 ? facets[1] : -1});
    i = j;
  }
}

// Rows of a compressed table from (row, entry) lists in order.
template <typename Rows>
void tabulate(std::size_t rows, const Rows& lists, std::vector<int>& start,
              std::vector<int>& list) {
  start.assign(rows + 1, 0);
  for (const auto& entries : lists) {
    for (const int v : entries) {
      ++start[v + 1];
    }
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  list.resize(start.back());
  std::vector<int> next(start.begin(), start.end() - 1);
  int id = 0;
  for (const auto& entries : lists) {
    for (const int v : entries) {
      list[next[v]++] = id;
    }
    ++id;
  }
}

int corner_of(const Sheet& sheet, int facet, int vertex) {
  const Triangle& t = sheet.film.facets[facet];
  return 3 * facet + (t[0] == vertex ? 0 : (t[1] == vertex ? 1 : 2));
}

// The corners around a vertex must hang together by the edges there.
void check_fans(const Sheet& sheet) {
  UnionFind fans(3 * sheet.film.facets.size());
  for (std::size_t e = 0; e < sheet.edges.size(); ++e) {
    const auto& [f, g] = sheet.edge_facets[e];
    for (int k = 0; g >= 0 && k < 2; ++k) {
      const int v = sheet.edges[e][k];
      fans.join(corner_of(sheet, f, v), corner_of(sheet, g, v));
    }
  }
  for (int v = 0; v < static_cast<int>(sheet.film.points.size()); ++v) {
    const int first = sheet.facet_list[sheet.facet_start[v]];
    for (int k = sheet.facet_start[v]; k < sheet.facet_start[v + 1]; ++k) {
      if (!fans.same(corner_of(sheet, sheet.facet_list[k], v),
                     corner_of(sheet, first, v))) {
        throw MeshError(fmt::format(
            "wall: parts of the film touch in one point only, {} (point {}); "
            "separate them or join them along edges",
            place(sheet.film.points[v]), sheet.origin[v]));
      }
    }
  }
}

}  // namespace

Sheet make_sheet(const SurfaceMesh& film) {
  if (film.facets.empty()) {
    throw InvalidInput("wall: the film has no facets");
  }
  if (film.facet_label.size() != film.facets.size()) {
    throw InvalidInput(fmt::format("wall: {} facets, but {} facet labels",
                                   film.facets.size(),
                                   film.facet_label.size()));
  }
  Sheet sheet;
  const auto facets = static_cast<int>(film.facets.size());
  for (int f = 0; f < facets; ++f) {
    check_facet(film, f);
  }
  compact(film, sheet);
  for (int f = 0; f < facets; ++f) {
    sheet.facet_normal.push_back(area_vector2(sheet.film, f).normalized());
  }
  join_edges(sheet);
  const std::size_t points = sheet.film.points.size();
  tabulate(points, sheet.film.facets, sheet.facet_start, sheet.facet_list);
  tabulate(points, sheet.edges, sheet.edge_start, sheet.edge_list);
  check_fans(sheet);
  sheet.crease.assign(sheet.edges.size(), 0);
  sheet.on_crease.assign(points, 0);
  for (std::size_t e = 0; e < sheet.edges.size(); ++e) {
    const auto& [f, g] = sheet.edge_facets[e];
    if (g >= 0 &&
        sheet.facet_normal[f].dot(sheet.facet_normal[g]) < kCreaseCosine) {
      sheet.crease[e] = 1;
      sheet.on_crease[sheet.edges[e][0]] = 1;
      sheet.on_crease[sheet.edges[e][1]] = 1;
    }
  }
  return sheet;
}

}  // namespace meniscus::walls
