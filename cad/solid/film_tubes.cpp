#include "cad/solid/film_tubes.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/harmonic.h"

namespace meniscus::solid {

std::vector<int> facets_of(const SplitFilm& split, int cell) {
  std::vector<int> facets;
  for (std::size_t f = 0; f < split.cell.size(); ++f) {
    if (split.cell[f] == cell) {
      facets.push_back(static_cast<int>(f));
    }
  }
  return facets;
}

std::vector<Triangle> corners_of(const FilmMesh& mesh,
                                 const std::vector<int>& facets) {
  std::vector<Triangle> result;
  result.reserve(facets.size());
  for (const int f : facets) {
    result.push_back(mesh.facets[f]);
  }
  return result;
}

int count_in(const std::vector<int>& some, const std::vector<int>& all) {
  return static_cast<int>(std::count_if(some.begin(), some.end(), [&](int v) {
    return std::find(all.begin(), all.end(), v) != all.end();
  }));
}

namespace {

constexpr int kMostTries = 60;
constexpr std::size_t kMostRims = 48;  // tries of more take minutes
constexpr double kGrow = 1.06;
constexpr double kLongLine = 0.15;  // of the shorter end: long enough
constexpr double kShrink = 0.85;    // of a tube's measure, from try to try

/// Loops of the refined film, in the rims' order.
std::vector<std::vector<int>> loops_of_rims(const SplitFilm& split) {
  std::vector<std::vector<int>> loops(split.rims->size());
  for (std::vector<int>& loop :
       boundary_loops(split.film.mesh.facets, split.film.mesh.points)) {
    const int rim = split.film.rim_of[loop[0]];
    loops[rim] = std::move(loop);
  }
  return loops;
}

/// A column per rim: 1 on it, 0 on the others, harmonic between.
Eigen::MatrixXd harmonic_measures(const SplitFilm& split) {
  const FilmMesh& mesh = split.film.mesh;
  HarmonicProblem problem{
      mesh.points, mesh.facets, facets_of(split, 0), {}, {}};
  problem.fixed.assign(mesh.points.size(), 0);
  problem.values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.points.size()),
                            static_cast<Eigen::Index>(split.rims->size()));
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (split.film.rim_of[v] >= 0) {
      problem.fixed[v] = 1;
      problem.values(static_cast<Eigen::Index>(v), split.film.rim_of[v]) = 1.0;
    }
  }
  return harmonic(problem);
}

/// The loops of a cell; nothing where it is no tube.
std::optional<Tube> tube_of(const SplitFilm& split, int cell,
                            std::size_t& loops) {
  const std::vector<std::vector<int>> found =
      boundary_loops(corners_of(split.film.mesh, facets_of(split, cell)),
                     split.film.mesh.points);
  loops = found.size();
  if (found.size() != 2) {
    return {};
  }
  const bool first = split.film.rim_of[found[0][0]] == cell;
  return Tube{found[first ? 0 : 1], found[first ? 1 : 0]};
}

double loop_length(const std::vector<int>& loop, const Points& points) {
  double length = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    length += (points[loop[(k + 1) % loop.size()]] - points[loop[k]]).norm();
  }
  return length;
}

/// The line between two tubes that is the shortest share of the shorter of
/// their ends: beside a long rim a small one's lines are short shares of its.
struct ShortLine {
  double share = 1.0;
  std::array<int, 2> tubes{-1, -1};
};

ShortLine shortest_line(const Tubes& tubes) {
  const FilmMesh& mesh = tubes.split.film.mesh;
  std::map<Edge, int> cell_at;  // directed edge
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      cell_at[{mesh.facets[f][k], mesh.facets[f][(k + 1) % 3]}] =
          tubes.split.cell[f];
    }
  }
  std::vector<double> ends;
  for (const Tube& tube : tubes.tubes) {
    ends.push_back(loop_length(tube.top, mesh.points));
  }
  ShortLine shortest;
  for (std::size_t tube = 0; tube < tubes.tubes.size(); ++tube) {
    std::vector<int> top = tubes.tubes[tube].top;
    const auto node = std::find_if(top.begin(), top.end(), [&](int v) {
      return count_in({v}, tubes.nodes) > 0;
    });
    std::rotate(top.begin(), node, top.end());
    std::vector<std::pair<double, int>> lines;  // length, other tube
    for (std::size_t k = 0; k < top.size(); ++k) {
      const int next = top[(k + 1) % top.size()];
      if (count_in({top[k]}, tubes.nodes) > 0) {
        lines.emplace_back(0.0, cell_at.at({next, top[k]}));
      }
      lines.back().first += (mesh.points[next] - mesh.points[top[k]]).norm();
    }
    for (const auto& [length, other] : lines) {
      const double share = length / std::min(ends[tube], ends[other]);
      if (share < shortest.share) {
        shortest = {share, {static_cast<int>(tube), other}};
      }
    }
  }
  return shortest;
}

/// Tubes by the greatest measure. Where one lies between others, so that these
/// do not meet, theirs are made greater until they do, or, where all have
/// nodes, its own less: theirs fall off with distance, so that other lines
/// stay. Two that hardly meet have theirs made greater.
Tubes cut_into_tubes(const SplitFilm& whole) {
  // Harmonic measure w_k: 1 on rim k, 0 on the others.
  const Eigen::MatrixXd measures = harmonic_measures(whole);
  const int count = static_cast<int>(measures.cols());
  VectorX factors = VectorX::Ones(count);
  std::optional<Tubes> best;
  double best_share = 0.0;
  for (int round = 0; round < kMostTries; ++round) {
    // Each point belongs to the rim whose f_k w_k is greatest.
    Tubes result{whole, {}, {}};
    result.nodes =
        split_by_greatest(result.split, measures * factors.asDiagonal());
    result.split.sector.assign(result.split.cell.size(), 0);
    // Each cell must be an annulus with two nodes or more at its top; one with
    // more loops keeps others apart.
    std::vector<int> between;
    std::vector<int> apart;
    bool done = true;
    for (int k = 0; k < count; ++k) {
      std::size_t loops = 0;
      const std::optional<Tube> tube = tube_of(result.split, k, loops);
      if (loops > 2) {
        between.push_back(k);
      } else if (tube && count_in(result.nodes, tube->top) < 2) {
        apart.push_back(k);
      } else if (tube) {
        result.tubes.push_back(*tube);
        continue;
      }
      done = false;
    }
    for (const int k : apart) {
      factors[k] /= kShrink;
    }
    for (const int k : between) {
      factors[k] *= apart.empty() ? kShrink : 1.0;
    }
    if (!done) {
      continue;
    }
    // Lengthen the shortest line between two tubes; the best cut is kept.
    const ShortLine line = shortest_line(result);
    for (const int tube : line.tubes) {
      factors[tube] *= kGrow;
    }
    if (line.share > best_share) {
      best_share = line.share;
      best = std::move(result);
    }
    if (best_share >= kLongLine) {
      break;
    }
  }
  if (!best) {
    throw MeshError(fmt::format(
        "a film with {} rims has no cut into tubes that meet in threes",
        count));
  }
  return std::move(*best);
}

}  // namespace

Tubes film_tubes(FilmMesh mesh, const std::vector<FilmRim>& rims) {
  if (rims.size() > kMostRims) {
    throw MeshError(fmt::format(
        "it has {} rims, and is cut into patches between {} at most",
        rims.size(), kMostRims));
  }
  Tubes tubes{refined_film(std::move(mesh), rims), {}, {}};
  if (rims.size() == 2) {
    const std::vector<std::vector<int>> loops = loops_of_rims(tubes.split);
    tubes.tubes.push_back({loops[0], loops[1]});
  } else {
    tubes = cut_into_tubes(tubes.split);
  }
  return tubes;
}

}  // namespace meniscus::solid
