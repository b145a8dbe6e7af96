#include "cad/solid/cut_film.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "cad/solid/film_cells.h"
#include "cad/solid/film_tubes.h"
#include "core/error.h"
#include "core/geometry/harmonic.h"

namespace meniscus::solid {

namespace {

constexpr int kTubeSeams = 4;          // of a tube between two rims
constexpr double kCornersApart = 4.0;  // of the refined rim's edges

/// Vertices of a loop from `start` on, backwards where asked.
std::vector<int> turned(std::vector<int> loop, int start, bool backwards) {
  if (backwards) {
    std::reverse(loop.begin(), loop.end());
  }
  std::rotate(loop.begin(), std::find(loop.begin(), loop.end(), start),
              loop.end());
  return loop;
}

/// Functions that gain 1 around the tube: the harmonic one whose values on the
/// top are by length (between rims: free at both).
void set_values(SplitFilm& split, int cell, const Tube& tube, bool free_top) {
  const FilmMesh& mesh = split.film.mesh;
  const std::vector<int> facets = facets_of(split, cell);
  TubeCut cut =
      cut_tube(mesh.facets, mesh.points.size(), facets, tube.bottom, tube.top);
  HarmonicProblem problem{mesh.points, mesh.facets, facets,
                          {},          {},          std::move(cut.offsets)};
  problem.fixed.assign(mesh.points.size(), 0);
  problem.values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.points.size()), 1);
  if (free_top) {
    problem.fixed[cut.path.front()] = 1;
  } else {
    const std::vector<int> top = turned(tube.top, cut.path.back(), true);
    std::vector<double> way{0.0};
    for (std::size_t k = 0; k < top.size(); ++k) {
      way.push_back(way.back() + (mesh.points[top[(k + 1) % top.size()]] -
                                  mesh.points[top[k]])
                                     .norm());
    }
    for (std::size_t k = 0; k < top.size(); ++k) {
      problem.fixed[top[k]] = 1;
      problem.values(top[k], 0) = way[k] / way.back();
    }
  }
  const Eigen::MatrixXd values = harmonic(problem);
  split.value.resize(mesh.facets.size(), {0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < facets.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      split.value[facets[i]][k] =
          values(mesh.facets[facets[i]][k], 0) + problem.offsets[i][k];
    }
  }
}

/// Values (modulo 1) of the wanted vertices.
std::vector<double> values_at(const SplitFilm& split, int cell,
                              const std::vector<int>& vertices) {
  std::vector<double> result(vertices.size(), 0.0);
  for (const int f : facets_of(split, cell)) {
    for (int k = 0; k < 3; ++k) {
      const auto found = std::find(vertices.begin(), vertices.end(),
                                   split.film.mesh.facets[f][k]);
      if (found != vertices.end()) {
        const double value = split.value[f][k];
        result[found - vertices.begin()] = value - std::floor(value);
      }
    }
  }
  return result;
}

/// The vertex where the first seam of a tube between smooth rims begins: in the
/// middle of a side, of a rim that has sides.
int first_seam(const SplitFilm& split, const Tube& tube) {
  const auto curve_of = [&](const std::vector<int>& loop) -> const RimCurve& {
    return *(*split.rims)[split.film.rim_of[loop.front()]].curve;
  };
  const bool bottom =
      curve_of(tube.bottom).piece_count() >= curve_of(tube.top).piece_count();
  const std::vector<int>& loop = bottom ? tube.bottom : tube.top;
  const RimCurve& curve = curve_of(loop);
  return rim_vertex(
      split, loop,
      curve.piece_count() > 1 ? 0.5 * curve.start_of(1) : curve.start_of(0));
}

/// The vertices at a rim's corners, the sharper one of two that are near each
/// other.
std::vector<int> corner_vertices(const SplitFilm& split,
                                 const std::vector<int>& loop) {
  const RimCurve& curve = *(*split.rims)[split.film.rim_of[loop.front()]].curve;
  const double apart =
      kCornersApart * curve.length() / static_cast<double>(loop.size());
  std::vector<double> places;
  for (const double corner : curve.corners()) {
    if (std::none_of(places.begin(), places.end(), [&](double place) {
          const double d = corner - place;
          return std::abs(d - curve.length() * std::round(d / curve.length())) <
                 apart;
        })) {
      places.push_back(corner);
    }
  }
  std::sort(places.begin(), places.end());
  std::vector<int> vertices;
  vertices.reserve(places.size());
  for (const double place : places) {
    vertices.push_back(rim_vertex(split, loop, place));
  }
  return vertices;
}

/// Where the seams of a tube between two rims lie: at sharp corners, or a
/// quarter apart from the first rim's beginning.
std::vector<double> seam_levels(const SplitFilm& split, const Tube& tube) {
  std::vector<int> corners = corner_vertices(split, tube.bottom);
  if (corners.empty()) {
    corners = corner_vertices(split, tube.top);
  }
  if (corners.size() >= 2) {
    return values_at(split, 0, corners);
  }
  const int start = first_seam(split, tube);
  const double first = values_at(split, 0, {start})[0];
  std::vector<double> levels;
  for (int k = 0; k < kTubeSeams; ++k) {
    const double level = first + static_cast<double>(k) / kTubeSeams;
    levels.push_back(level - std::floor(level));
  }
  return levels;
}

void set_sectors(SplitFilm& split, int cell,
                 const std::vector<double>& levels) {
  for (const int f : facets_of(split, cell)) {
    const double sum =
        split.value[f][0] + split.value[f][1] + split.value[f][2];
    const double value = sum / 3.0 - std::floor(sum / 3.0);
    const auto above = std::upper_bound(levels.begin(), levels.end(), value);
    const auto count = static_cast<int>(levels.size());
    split.sector[f] =
        (static_cast<int>(above - levels.begin()) + count - 1) % count;
  }
}

enum class SideKind { Rim, Seam, Line };

struct Side {
  SideKind kind = SideKind::Rim;
  int rim = -1;
  int other = -1;          // cell across a line
  std::vector<int> chain;  // in the facets' direction
};

bool alike(const Side& a, const Side& b) {
  return a.kind == b.kind && a.rim == b.rim && a.other == b.other;
}

/// The sides of a sector's outline, from the one on a rim on.
std::vector<Side> sides_of(const SplitFilm& split, int cell,
                           const std::vector<int>& facets) {
  const bool tubes = split.rims->size() > 1;
  // A directed edge belongs to one facet; its reverse is the facet across.
  const std::map<Edge, int> owner = facets_by_edge(split.film.mesh.facets);
  // The outline of a disk is one closed loop.
  const std::vector<std::vector<int>> loops = boundary_loops(
      corners_of(split.film.mesh, facets), split.film.mesh.points);
  if (loops.size() != 1) {
    throw MeshError("a film's patch is not simply connected");
  }
  const std::vector<int>& loop = loops[0];
  // The facet across tells a rim, a seam of this tube or a line to another.
  const auto kind_of = [&](std::size_t k) {
    const int a = loop[k];
    const int b = loop[(k + 1) % loop.size()];
    const auto other = owner.find({b, a});
    Side side;
    if (other == owner.end()) {
      side.rim = split.film.rim_of[a];
    } else {
      side.other = split.cell[other->second];
      side.kind = side.other == cell ? SideKind::Seam : SideKind::Line;
    }
    return side;
  };
  // Runs of alike edges are the sides; the loop may begin within one.
  std::vector<Side> sides;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    Side side = kind_of(k);
    if (sides.empty() || !alike(sides.back(), side)) {
      side.chain = {loop[k]};
      sides.push_back(std::move(side));
    }
    sides.back().chain.push_back(loop[(k + 1) % loop.size()]);
  }
  if (sides.size() > 1 && alike(sides.front(), sides.back())) {
    std::vector<int>& tail = sides.back().chain;
    tail.insert(tail.end(), sides.front().chain.begin() + 1,
                sides.front().chain.end());
    sides.front().chain = std::move(tail);
    sides.pop_back();
  }
  // Order as the patch has it: the side on the own rim is its bottom.
  const auto bottom =
      std::find_if(sides.begin(), sides.end(), [&](const Side& side) {
        return side.kind == SideKind::Rim && (!tubes || side.rim == cell);
      });
  if (bottom != sides.end()) {
    std::rotate(sides.begin(), bottom, sides.end());
  }
  return sides;
}

/// The number of a line between patches, which each of them names once.
int line_of(CutFilm& film, const std::vector<int>& chain, bool& reversed) {
  const std::vector<int> back(chain.rbegin(), chain.rend());
  for (std::size_t k = 0; k < film.lines.size(); ++k) {
    reversed = film.lines[k] == back;
    if (reversed || film.lines[k] == chain) {
      return static_cast<int>(k);
    }
  }
  reversed = false;
  film.lines.push_back(chain);
  return static_cast<int>(film.lines.size()) - 1;
}

FilmPatch patch_of(SplitFilm& split, int cell, int sector) {
  FilmPatch patch;
  for (const int f : facets_of(split, cell)) {
    if (split.sector[f] == sector) {
      patch.facets.push_back(f);
    }
  }
  std::vector<Side> sides = sides_of(split, cell, patch.facets);
  if (sides.size() != 4) {
    throw MeshError(fmt::format(
        "a film's patch has {} sides, not 4: the film is too coarse there",
        sides.size()));
  }
  for (int k = 0; k < 4; ++k) {
    if (k >= 2) {
      std::reverse(sides[k].chain.begin(), sides[k].chain.end());
    }
    patch.chains[k] = std::move(sides[k].chain);
    patch.rims[k] = sides[k].rim;
    if (sides[k].rim < 0) {
      bool reversed = false;
      patch.lines[k] = line_of(split.film, patch.chains[k], reversed);
      patch.reversed[k] = reversed;
    }
  }
  return patch;
}

/// Rims are curved where the film's edges are straight.
void set_bulges(SplitFilm& split) {
  CutFilm& film = split.film;
  for (const Edge& edge : split.rim_edges) {
    const RimCurve& curve = *(*split.rims)[film.rim_of[edge[0]]].curve;
    const double start = film.rim_position[edge[0]];
    double way = film.rim_position[edge[1]] - start;
    way -= curve.length() * std::round(way / curve.length());
    film.mesh.bulges[edge] =
        curve.point(start + 0.5 * way) -
        smooth_edge_point(film.mesh, edge[0], edge[1], 0.5);
  }
}

/// Cuts the tubes by seams; sectors, one count per tube.
std::vector<int> cut_seams(Tubes& tubes, bool between_rims) {
  SplitFilm& split = tubes.split;
  std::vector<int> sectors;
  for (std::size_t k = 0; k < tubes.tubes.size(); ++k) {
    const Tube& tube = tubes.tubes[k];
    const int cell = static_cast<int>(k);
    set_values(split, cell, tube, between_rims);
    std::vector<double> levels;
    std::vector<char> kept(split.film.mesh.points.size(), 0);
    if (between_rims) {
      levels = seam_levels(split, tube);
    } else {
      std::vector<int> nodes;
      std::copy_if(tube.top.begin(), tube.top.end(), std::back_inserter(nodes),
                   [&](int v) { return count_in({v}, tubes.nodes) > 0; });
      levels = values_at(split, cell, nodes);
      for (const int v : tube.top) {
        kept[v] = 1;
      }
    }
    std::sort(levels.begin(), levels.end());
    for (const double level : levels) {
      split_by_level(split, cell, level, kept);
    }
    set_sectors(split, cell, levels);
    sectors.push_back(static_cast<int>(levels.size()));
  }
  return sectors;
}

}  // namespace

CutFilm cut_film(FilmMesh mesh, const std::vector<FilmRim>& rims) {
  SplitFilm split;
  std::vector<int> sectors;
  if (rims.size() < 2) {
    split = film_cells(std::move(mesh), rims);
    if (is_four_sided(rims)) {
      split.film.patches.push_back(whole_patch(split));
    } else {
      sectors.assign(rims.empty() ? kClosedCells : kDiskCells, 1);
    }
  } else {
    Tubes tubes = film_tubes(std::move(mesh), rims);
    sectors = cut_seams(tubes, rims.size() == 2);
    split = std::move(tubes.split);
  }
  for (std::size_t k = 0; k < sectors.size(); ++k) {
    for (int j = 0; j < sectors[k]; ++j) {
      split.film.patches.push_back(patch_of(split, static_cast<int>(k), j));
    }
  }
  if (rims.size() < 2) {
    straighten_nodes(split.film);
  }
  set_bulges(split);
  return std::move(split.film);
}

}  // namespace meniscus::solid
