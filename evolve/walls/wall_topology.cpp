#include "evolve/walls/wall_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/geometry/edge_key.h"
#include "core/math/union_find.h"
#include "evolve/walls/wall_middles.h"
#include "evolve/walls/wall_sectors.h"

namespace meniscus::walls {

namespace {

// Rim strips get rows of about square cells, at most so many.
constexpr int kMostWallRows = 16;

/// A facet of a strip, or of a cap at the end of a junction line.
struct RimFacet {
  std::array<StripCorner, 3> at;
  bool cap = false;
  int label = 0;
  int region = 0;
};

class Builder {
 public:
  explicit Builder(const WallFilms& films)
      : films_(films),
        middles_(films.middles, result_),
        sectors_(find_sectors(films.mesh)) {}

  WallTopology build() {
    add_sides();
    add_rims();
    add_caps();
    result_.coarse = surface();
    for (int level = 0; level < films_.levels; ++level) {
      refine();
    }
    result_.fine = films_.levels > 0 ? surface() : result_.coarse;
    result_.cap.assign(2 * result_.facets.size(), 0);
    for (const RimFacet& facet : rim_facets_) {
      result_.cap.push_back(facet.cap ? 1 : 0);
    }
    find_junctions();
    return std::move(result_);
  }

 private:
  const Points& x() const { return films_.mesh.points; }
  const Triangle& film_facet(int f) const { return films_.mesh.facets[f]; }
  int region_of(int label) const { return films_.region[films_.wall[label]]; }

  int add_point(WallPoint point) {
    return middles_.add_point(std::move(point));
  }

  void add_sides() {
    std::vector<int> point_of(sectors_.of_corner.size(), -1);
    const auto count = static_cast<int>(films_.mesh.facets.size());
    for (int f = 0; f < count; ++f) {
      WallFacet facet{.film = film_facet(f),
                      .label = films_.mesh.facet_label[f]};
      for (const int side : {0, 1}) {
        for (int k = 0; k < 3; ++k) {
          int& point = point_of[sectors_.of_corner[(2 * f + side) * 3 + k]];
          if (point < 0) {
            point = add_point({.vertex = film_facet(f)[k], .of = {}});
          }
          (side == 0 ? facet.front : facet.back)[k] = point;
        }
      }
      result_.facets.push_back(facet);
    }
    labels_ = films_.mesh.labels;
    for (const std::string& label : films_.mesh.labels) {
      labels_.push_back(label + "/back");
    }
  }

  // --- rims ---------------------------------------------------------------
  using Column = std::pair<int, int>;  // front and back point

  // As strips of films that are turned otherwise have it too.
  static Column either_way(const Column& column) {
    return std::minmax(column.first, column.second);
  }

  struct RimEdge {
    Column from, to;  // as the film's facet runs
    int facet = 0;
    int group = 0;  // of edges whose strips hang together
    Edge film = {};
  };

  void collect_rim_edges() {
    std::map<Column, int> group_of;
    UnionFind strips(0);
    for (const Incidence& rim_edge : sectors_.rims) {
      const auto [f, k] = rim_edge;
      const WallFacet& facet = result_.facets[f];
      const int next = (k + 1) % 3;
      RimEdge rim{.from = {facet.front[k], facet.back[k]},
                  .to = {facet.front[next], facet.back[next]},
                  .facet = f,
                  .film = {facet.film[k], facet.film[next]}};
      std::array<int, 2> groups = {};
      int i = 0;
      for (const Column& column : {rim.from, rim.to}) {
        const auto [at, is_new] = group_of.try_emplace(
            either_way(column), static_cast<int>(strips.size()));
        if (is_new) {
          strips.add();
        }
        groups[i++] = at->second;
      }
      strips.join(groups[0], groups[1]);
      rim.group = groups[0];
      rim_edges_.push_back(rim);
    }
    for (RimEdge& rim : rim_edges_) {
      rim.group = strips.root(rim.group);
    }
  }

  std::map<int, int> rows_of_groups() const {
    std::map<int, std::pair<double, double>> sizes;  // thickness, length
    for (const RimEdge& rim : rim_edges_) {
      auto& [thickness, length] = sizes[rim.group];
      thickness += films_.asked[films_.wall[result_.facets[rim.facet].label]];
      length += (x()[rim.film[1]] - x()[rim.film[0]]).norm();
    }
    std::map<int, int> rows;
    for (const auto& [group, size] : sizes) {
      rows[group] =
          static_cast<int>(std::clamp(std::round(size.first / size.second), 1.0,
                                      static_cast<double>(kMostWallRows)));
    }
    return rows;
  }

  /// The name along an edge of the film, of those at one end: a curve that is a
  /// name alone, one that holds the film, any other; none: empty.
  std::string curve_along(const Edge& edge, const std::string& film,
                          const std::vector<int>& at_end) const {
    const auto rank = [&](const RimName& name) {
      const bool own = std::find(name.films.begin(), name.films.end(), film) !=
                       name.films.end();
      return !name.holds ? 0 : own ? 1 : 2;
    };
    const RimName* best = nullptr;
    for (const int n : at_end) {
      const RimName& name = films_.names[n];
      if (std::binary_search(name.vertices.begin(), name.vertices.end(),
                             edge[1]) &&
          (best == nullptr || rank(name) < rank(*best))) {
        best = &name;
      }
    }
    return best == nullptr ? "" : best->curve;
  }

  void name_rims() {
    std::map<int, std::vector<int>> at;  // names by film vertex
    for (std::size_t n = 0; n < films_.names.size(); ++n) {
      for (const int v : films_.names[n].vertices) {
        at[v].push_back(static_cast<int>(n));
      }
    }
    std::map<int, int> unnamed;  // per group its number
    for (RimEdge& rim : rim_edges_) {
      const std::string& film =
          films_.mesh.labels[result_.facets[rim.facet].label];
      const int plane = films_.planes.common(rim.film[0], rim.film[1]);
      if (plane >= 0) {
        rim_label_.push_back(
            label_named(film + "/" + films_.planes.planes[plane].rim));
        continue;
      }
      std::string curve = curve_along(rim.film, film, at[rim.film[0]]);
      if (curve.empty()) {
        const auto number = static_cast<int>(unnamed.size()) + 1;
        curve = std::to_string(
            unnamed.try_emplace(rim.group, number).first->second);
      }
      rim_label_.push_back(
          label_named(std::string(film).append("/rim:").append(curve)));
    }
  }

  int label_named(const std::string& name) {
    const auto at = std::find(labels_.begin(), labels_.end(), name);
    if (at == labels_.end()) {
      labels_.push_back(name);
      return static_cast<int>(labels_.size()) - 1;
    }
    return static_cast<int>(at - labels_.begin());
  }

  void add_rims() {
    collect_rim_edges();
    const std::map<int, int> rows_of = rows_of_groups();
    name_rims();
    for (std::size_t e = 0; e < rim_edges_.size(); ++e) {
      const RimEdge& rim = rim_edges_[e];
      const int rows = rows_of.at(rim.group);
      rows_[either_way(rim.from)] = rows;
      rows_[either_way(rim.to)] = rows;
      const int region = region_of(result_.facets[rim.facet].label);
      for (int j = 0; j < rows; ++j) {
        const double high = 1.0 - static_cast<double>(j) / rows;
        const double low = 1.0 - static_cast<double>(j + 1) / rows;
        const auto at = [&](const Column& c, double across) {
          return StripCorner{c.first, c.second, across};
        };
        add_strip({at(rim.to, high), at(rim.from, high), at(rim.from, low)},
                  rim_label_[e], region);
        add_strip({at(rim.to, high), at(rim.from, low), at(rim.to, low)},
                  rim_label_[e], region);
      }
    }
  }

  void add_strip(const std::array<StripCorner, 3>& at, int label, int region) {
    rim_facets_.push_back(
        {.at = at, .cap = false, .label = label, .region = region});
  }

  // --- caps where junction lines end on a rim ------------------------------
  struct Opening {
    Column column;
    bool forward = true;  // the cap runs from the front to the back
    int label = 0;
    int region = 0;
  };

  void add_caps() {
    std::map<Column, int> uses;
    for (const RimEdge& rim : rim_edges_) {
      ++uses[either_way(rim.from)];
      ++uses[either_way(rim.to)];
    }
    std::map<int, Opening> starting;  // by the point at which it starts
    for (std::size_t e = 0; e < rim_edges_.size(); ++e) {
      const RimEdge& rim = rim_edges_[e];
      const int region = region_of(result_.facets[rim.facet].label);
      if (uses[either_way(rim.from)] == 1) {
        starting[rim.from.second] = {rim.from, false, rim_label_[e], region};
      }
      if (uses[either_way(rim.to)] == 1) {
        starting[rim.to.first] = {rim.to, true, rim_label_[e], region};
      }
    }
    while (!starting.empty()) {
      std::vector<Opening> loop;
      auto at = starting.begin();
      while (at != starting.end()) {
        const Opening opening = at->second;
        loop.push_back(opening);
        starting.erase(at);
        at = starting.find(opening.forward ? opening.column.second
                                           : opening.column.first);
      }
      add_cap(loop);
    }
  }

  void add_cap(const std::vector<Opening>& loop) {
    WallPoint middle;
    const double part = 1.0 / static_cast<double>(loop.size());
    for (const Opening& opening : loop) {
      middle.of.emplace_back(
          opening.forward ? opening.column.first : opening.column.second, part);
    }
    const int center = add_point(std::move(middle));
    for (const Opening& opening : loop) {
      const int rows = rows_.at(either_way(opening.column));
      const auto corner = [&](int j) {
        const double down = static_cast<double>(j) / rows;
        return StripCorner{opening.column.first, opening.column.second,
                           opening.forward ? 1.0 - down : down};
      };
      for (int j = 0; j < rows; ++j) {
        rim_facets_.push_back(
            {.at = {StripCorner{center, center, 1.0}, corner(j), corner(j + 1)},
             .cap = true,
             .label = loop[0].label,
             .region = opening.region});
      }
    }
  }

  // --- refinement -----------------------------------------------------------
  void refine() {
    std::vector<WallFacet> facets;
    facets.reserve(4 * result_.facets.size());
    for (const WallFacet& facet : result_.facets) {
      refine_side(facet, facets);
    }
    result_.facets = std::move(facets);
    std::vector<RimFacet> rims;
    rims.reserve(4 * rim_facets_.size());
    for (const RimFacet& facet : rim_facets_) {
      refine_rim(facet, rims);
    }
    rim_facets_ = std::move(rims);
  }

  void refine_side(const WallFacet& facet, std::vector<WallFacet>& children) {
    WallFacet middle{.label = facet.label};
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      middle.front[k] = middles_.side_middle(facet.front[k], facet.front[next]);
      middle.back[k] = middles_.side_middle(facet.back[k], facet.back[next]);
      middle.film[k] = middles_.film_middle(facet.film[k], facet.film[next]);
    }
    const auto child = [&](int k) {
      WallFacet one{.label = facet.label};
      const auto pick = [&](const Triangle& t, const Triangle& m) {
        return Triangle{t[k], m[k], m[(k + 2) % 3]};
      };
      one.film = pick(facet.film, middle.film);
      one.front = pick(facet.front, middle.front);
      one.back = pick(facet.back, middle.back);
      return one;
    };
    for (int k = 0; k < 3; ++k) {
      children.push_back(child(k));
    }
    children.push_back(middle);
  }

  void refine_rim(const RimFacet& facet, std::vector<RimFacet>& children) {
    std::array<StripCorner, 3> m;
    for (int k = 0; k < 3; ++k) {
      const StripCorner& a = facet.at[k];
      const StripCorner& b = facet.at[(k + 1) % 3];
      m[k] =
          facet.cap ? middles_.cap_middle(a, b) : middles_.strip_middle(a, b);
    }
    for (int k = 0; k < 4; ++k) {
      RimFacet child = facet;
      child.at = m;
      if (k < 3) {
        child.at = {facet.at[k], m[k], m[(k + 2) % 3]};
      }
      children.push_back(child);
    }
  }

  // --- result ---------------------------------------------------------------
  SurfaceMesh surface() {
    SurfaceMesh mesh;
    mesh.labels = labels_;
    const auto films = static_cast<int>(films_.mesh.labels.size());
    const bool regions =
        *std::max_element(films_.region.begin(), films_.region.end()) > 0;
    const auto add = [&](const Triangle& t, int label, int region) {
      mesh.facets.push_back(t);
      mesh.facet_label.push_back(label);
      if (regions) {
        mesh.facet_bodies.push_back({region, -1});
      }
    };
    for (const WallFacet& f : result_.facets) {
      add(f.front, f.label, region_of(f.label));
      add({f.back[0], f.back[2], f.back[1]}, f.label + films,
          region_of(f.label));
    }
    for (const RimFacet& f : rim_facets_) {
      add({middles_.strip_point(f.at[0]), middles_.strip_point(f.at[1]),
           middles_.strip_point(f.at[2])},
          f.label, f.region);
    }
    return mesh;
  }

  // On the finest mesh.
  void find_junctions() {
    result_.junction.assign(x().size(), 0);
    for (const auto& [edge, facets] : facets_about_edges(result_.facets)) {
      if (is_junction(result_.facets, facets)) {
        result_.junction[edge[0]] = 1;
        result_.junction[edge[1]] = 1;
      }
    }
  }

  const WallFilms& films_;
  WallTopology result_;
  WallMiddles middles_;
  Sectors sectors_;
  std::vector<std::string> labels_;
  std::vector<RimEdge> rim_edges_;
  std::vector<int> rim_label_;  // per rim edge
  std::map<Column, int> rows_;  // by columns either way
  std::vector<RimFacet> rim_facets_;
};

}  // namespace

FacetsAboutEdges facets_about_edges(const std::vector<WallFacet>& facets) {
  FacetsAboutEdges about;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Triangle& t = facets[f].film;
    for (int k = 0; k < 3; ++k) {
      about[edge_key(t[k], t[(k + 1) % 3])].push_back(static_cast<int>(f));
    }
  }
  return about;
}

bool is_junction(const std::vector<WallFacet>& facets,
                 const std::vector<int>& about) {
  return about.size() > 2 || (about.size() == 2 &&
                              facets[about[0]].label != facets[about[1]].label);
}

WallTopology wall_topology(const WallFilms& films) {
  return Builder(films).build();
}

}  // namespace meniscus::walls
