#include "cad/solid/film_knots.h"

#include <algorithm>
#include <cmath>

namespace meniscus::solid {

namespace {

constexpr double kTurnsToo = 0.5;  // of the turn the other way

std::vector<double> turned_knots(const std::vector<double>& knots,
                                 bool backwards) {
  return backwards ? reversed(SplineCurve{knots, {}}).knots : knots;
}

}  // namespace

double length_of(const FilmMesh& mesh, const std::vector<int>& chain) {
  double length = 0.0;
  for (std::size_t k = 1; k < chain.size(); ++k) {
    length += (mesh.points[chain[k]] - mesh.points[chain[k - 1]]).norm();
  }
  return length;
}

RimSide FilmOnRims::side(const FilmPatch& patch, int side) const {
  const std::vector<int>& chain = patch.chains[side];
  const std::vector<double>& at = cut.rim_position;
  RimSide result{&rim(patch.rims[side]), at[chain.front()], at[chain.back()]};
  const double length = result.rim->curve().length();
  const double step = at[chain[1]] - at[chain[0]];
  result.growing = step - length * std::round(step / length) > 0.0;
  return result;
}

FilmKnots::FilmKnots(const FilmOnRims& film, const FaceLimits& limits)
    : film_(film),
      limits_(limits),
      directions_(static_cast<int>(film.cut.patches.size())) {
  set_classes();
  set_knots();
  spread_knots();
}

void FilmKnots::set_classes() {
  const CutFilm& cut = film_.cut;
  // Two sides on one line have one knot vector, mirrored if they run against
  // each other: union of the parameter directions of all patches.
  std::vector<std::array<int, 2>> user(cut.lines.size(), {-1, -1});
  for (std::size_t p = 0; p < cut.patches.size(); ++p) {
    for (int side = 0; side < 4; ++side) {
      const int line = cut.patches[p].lines[side];
      if (line >= 0 && user[line][0] < 0) {
        user[line] = {static_cast<int>(p), side};
      } else if (line >= 0) {
        const auto [q, other] = user[line];
        directions_.join(
            static_cast<int>(p), side, q, other,
            cut.patches[p].reversed[side] != cut.patches[q].reversed[other]);
      }
    }
  }
}

/// Knots that meet all demands of a class serve all its sides.
void FilmKnots::set_knots() {
  // What each side of a class asks for: spans by length, breaks of rims.
  std::map<int, std::vector<SideDemand>> demands;
  for (std::size_t p = 0; p < film_.cut.patches.size(); ++p) {
    const FilmPatch& patch = film_.cut.patches[p];
    for (int side = 0; side < 4; ++side) {
      const auto [root, flipped] = directions_.of(static_cast<int>(p), side);
      demands[root].push_back(
          patch.rims[side] >= 0
              ? demand(film_.side(patch, side), flipped)
              : SideDemand{.length =
                               length_of(film_.cut.mesh, patch.chains[side])});
    }
  }
  for (const auto& [root, sides] : demands) {
    knots_[root] = common_knots(sides, limits_.span);
  }
}

/// The classes' knots turned to the direction of each patch and of each line.
void FilmKnots::spread_knots() {
  const CutFilm& cut = film_.cut;
  line_knots_.resize(cut.lines.size());
  patch_knots_.resize(cut.patches.size());
  for (std::size_t p = 0; p < cut.patches.size(); ++p) {
    const FilmPatch& patch = cut.patches[p];
    for (int side = 0; side < 4; ++side) {
      const auto [root, flipped] = directions_.of(static_cast<int>(p), side);
      patch_knots_[p][side % 2] = turned_knots(knots_.at(root), flipped);
      if (patch.lines[side] >= 0) {
        line_knots_[patch.lines[side]] =
            turned_knots(knots_[root], flipped != patch.reversed[side]);
      }
    }
  }
}

void FilmKnots::restore(const Classes& knots) {
  knots_ = knots;
  spread_knots();
}

void FilmKnots::mark(int patch, int side, std::size_t span) {
  const auto [root, flipped] = directions_.of(patch, side);
  LongSpans& spans = long_[root];
  spans[flipped ? spans.size() - 1 - span : span] = 1;
}

/// Where a surface leaves its film, the spans along which the film's normal
/// turns.
void FilmKnots::mark_misses(int patch, const FittedPatch& fitted,
                            double times) {
  const std::array<std::vector<double>, 2>& knots = patch_knots_[patch];
  struct Cell {
    double off = 0.0;
    std::vector<const PatchMiss*> samples;
  };
  std::map<std::array<std::size_t, 2>, Cell> cells;
  for (const PatchMiss& miss : fitted.misses) {
    Cell& cell =
        cells[{span_at(knots[0], miss.at[0]), span_at(knots[1], miss.at[1])}];
    cell.off = std::max(cell.off, miss.off);
    cell.samples.push_back(&miss);
  }
  for (const auto& [spans, cell] : cells) {
    if (cell.off <= times * limits_.off) {
      continue;
    }
    // Samples of one row of the cell tell the turn along it.
    std::array<double, 2> turn{};
    for (const PatchMiss* p : cell.samples) {
      for (const PatchMiss* q : cell.samples) {
        for (const int along : {0, 1}) {
          if (p->at[1 - along] == q->at[1 - along]) {
            turn[along] = std::max(turn[along], (p->normal - q->normal).norm());
          }
        }
      }
    }
    for (const int along : {0, 1}) {
      if (turn[along] >= kTurnsToo * turn[1 - along]) {
        mark(patch, along, spans[along]);
      }
    }
  }
}

/// Where the spline along a rim leaves the rim's curve.
void FilmKnots::mark_gaps(int patch, int side, const Brep& brep) {
  constexpr int kPerSpan = 8;
  const RimSide rim = film_.side(film_.cut.patches[patch], side);
  const std::vector<double>& knots = patch_knots_[patch][side % 2];
  const SplineCurve fitted = fit_rim(rim, knots, brep);
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    for (int i = 0; i < kPerSpan && knots[k + 1] > knots[k]; ++i) {
      const double t =
          knots[k] + (knots[k + 1] - knots[k]) * (i + 0.5) / kPerSpan;
      if ((point_of(fitted, t) - rim.point(t)).norm() > limits_.gap) {
        mark(patch, side, span_at(knots, t));
        break;
      }
    }
  }
}

bool FilmKnots::halve(const std::vector<FittedPatch>& patches, const Brep& brep,
                      double times) {
  for (const auto& [root, knots] : knots_) {
    long_[root].assign(span_count(knots), 0);
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    // What three rounds have not unfolded finer knots fold the more.
    if (times == 1.0 || folded_share(patches[p]) == 0.0) {
      mark_misses(static_cast<int>(p), patches[p], times);
    }
    for (int side = 0; side < 4; ++side) {
      if (film_.cut.patches[p].rims[side] >= 0) {
        mark_gaps(static_cast<int>(p), side, brep);
      }
    }
  }
  bool any = false;
  for (auto& [root, knots] : knots_) {
    const LongSpans& spans = long_[root];
    if (std::count(spans.begin(), spans.end(), 1) > 0) {
      knots = halved(knots, spans);
      any = true;
    }
  }
  spread_knots();
  return any;
}

}  // namespace meniscus::solid
