#include "pipeline/case_data/case_sides.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "evolve/films/joined_sides.h"
#include "evolve/films/shared_sides.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/case_data/case_wetted.h"
#include "pipeline/case_data/feature_shapes.h"

namespace meniscus::case_data {

namespace {

using SideName = std::pair<int, int>;  // curve, side

std::string text(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

/// The first of the shared sides that one is the same as.
std::map<SideName, SideName> first_of(
    const std::vector<films::SharedSide>& shared) {
  std::map<SideName, SideName> first;
  for (const films::SharedSide& side : shared) {
    const SideName known(side.first_curve, side.first_side);
    const auto at = first.find(known);
    first.emplace(SideName(side.second_curve, side.second_side),
                  at == first.end() ? known : at->second);
  }
  return first;
}

std::vector<std::string> curves_of_surface(const films::FilmSystem& system,
                                           const std::string& name) {
  for (const films::CapSpec& cap : system.caps) {
    if (cap.name == name) {
      return cap.curves();
    }
  }
  for (const films::FilmSpec& film : system.films) {
    if (film.name == name) {
      return film.curves;
    }
  }
  return {};
}

using SurfacesAtSides = std::map<SideName, std::vector<std::string>>;

/// Surfaces of the body at each side of the curves that bound them.
SurfacesAtSides surfaces_at_sides(const films::FilmSystem& system,
                                  const films::BodySpec& body,
                                  const std::map<SideName, SideName>& first) {
  SurfacesAtSides result;
  for (const std::string& surface : body.enclosed_by) {
    for (const std::string& name : curves_of_surface(system, surface)) {
      for (int c = 0; c < static_cast<int>(system.curves.size()); ++c) {
        const curves::Curve& curve = system.curves[static_cast<std::size_t>(c)];
        if (curve.name != name) {
          continue;
        }
        const auto sides =
            static_cast<int>(films::sides_of(curve.shape).size());
        for (int k = 0; k < sides; ++k) {
          const auto at = first.find({c, k});
          result[at == first.end() ? SideName(c, k) : at->second].push_back(
              surface);
        }
      }
    }
  }
  return result;
}

/// The caps outside the body, by the sides that they end at.
SurfacesAtSides caps_beside(const films::FilmSystem& system,
                            const films::BodySpec& body,
                            const std::map<SideName, SideName>& first) {
  films::BodySpec others;
  for (const films::CapSpec& cap : system.caps) {
    if (std::find(body.enclosed_by.begin(), body.enclosed_by.end(), cap.name) ==
        body.enclosed_by.end()) {
      others.enclosed_by.push_back(cap.name);
    }
  }
  return surfaces_at_sides(system, others, first);
}

/// "the side from A to B of curve 'c' ...": the first of one curve's sides that
/// are open, with `surfaces` there, how many there are, and what to do.
std::string open_sides_text(const films::FilmSystem& system,
                            const std::vector<SideName>& sides,
                            const std::vector<std::string>& surfaces,
                            const SurfacesAtSides& beside) {
  const curves::Curve& curve =
      system.curves[static_cast<std::size_t>(sides.front().first)];
  const films::CurveSide side = films::sides_of(
      curve.shape)[static_cast<std::size_t>(sides.front().second)];
  const std::string more =
      sides.size() == 1
          ? ""
          : fmt::format(" and {} more of its sides", sides.size() - 1);
  const auto face = beside.find(sides.front());
  return fmt::format(
      "the side from {} to {} of curve '{}'{}: {} of its surfaces meet{} there "
      "({}), expected two; {}faces join where both curves have the same two "
      "corners next to each other: add a corner where a face ends amid a side",
      text(side.from), text(side.to), curve.name, more, surfaces.size(),
      surfaces.size() == 1 ? "s" : "", fmt::join(surfaces, ", "),
      face == beside.end()
          ? ""
          : fmt::format("add '{}' to enclosed_by, or: ", face->second.front()));
}

/// Polygons and polylines, by name; of features the edges that are such.
std::set<std::string> curves_with_sides(const Case& input) {
  std::set<std::string> result;
  for (const CurveEntry& entry : input.curves) {
    if (entry.kind == CurveKind::Polygon || entry.kind == CurveKind::Polyline) {
      result.insert(entry.name);
    }
  }
  for (const FeatureEntry& feature : input.features) {
    for (const FeatureCurve& curve : feature_shapes(feature, {}).curves) {
      if (std::holds_alternative<PathOfDuals>(curve.shape)) {
        result.insert(curve.name);
      }
    }
  }
  return result;
}

}  // namespace

bool may_join_by_sides(const Case& input, const std::string& curve) {
  const std::set<std::string> sided = curves_with_sides(input);
  std::set<std::string> rims = {
      curve};  // and those across which there are caps
  for (const CapEntry& cap : input.caps) {
    for (const std::string& name : cap.spec.curves()) {
      if (sided.count(name) != 0) {
        rims.insert(name);
      }
    }
  }
  return sided.count(curve) != 0 && rims.size() > 2;
}

CurvePairs curves_that_share_sides(const Case& input) {
  std::vector<std::string> problems;
  std::vector<curves::Curve> curves;
  try {
    const VectorX design = initial_design(input);
    const CaseValues values(input, design, problems);
    curves = problems.empty() ? curves_of(input, values) : curves;
  } catch (const Error&) {
    return {};  // told when the case is checked
  }
  CurvePairs pairs;
  for (const films::SharedSide& side : films::shared_sides(curves)) {
    const std::string& first = curves[side.first_curve].name;
    const std::string& second = curves[side.second_curve].name;
    pairs.insert({{first, second}, {second, first}});
  }
  return pairs;
}

void check_free_sides(const Case& input, const films::FilmSystem& system,
                      const CaseValues& values) {
  const std::map<SideName, SideName> first =
      first_of(films::shared_sides(system.curves));
  std::map<SideName, std::set<std::string>> films;  // by the first's side
  for (const films::FilmSpec& film : system.films) {
    for (const auto& [side, names] :
         surfaces_at_sides(system, {.enclosed_by = {film.name}}, first)) {
      films[side].insert(names.begin(), names.end());
    }
  }
  std::set<SideName> joined;
  for (const films::JoinedSide& side : films::joined_sides(system)) {
    joined.insert({side.curve, side.side});
  }
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    const curves::Curve& curve = system.curves[c];
    const bool is_used =
        std::any_of(system.films.begin(), system.films.end(),
                    [&](const films::FilmSpec& film) {
                      return std::find(film.curves.begin(), film.curves.end(),
                                       curve.name) != film.curves.end();
                    });
    const std::vector<films::CurveSide> sides = films::sides_of(curve.shape);
    for (std::size_t k = 0; k < sides.size() && is_used; ++k) {
      const bool is_free =
          curve.free ||
          std::count(curve.free_sides.begin(), curve.free_sides.end(), k) > 0;
      const SideName own(static_cast<int>(c), static_cast<int>(k));
      const auto at = first.find(own);
      const std::set<std::string>& there =
          films[at == first.end() ? own : at->second];
      if (is_free && there.size() < 3 && joined.count(own) == 0 &&
          !is_cell(input, curve.name)) {
        const bool joins = std::any_of(system.films.begin(), system.films.end(),
                                       [&](const films::FilmSpec& film) {
                                         return there.contains(film.name) &&
                                                !film.joins.empty();
                                       });
        values.problems().push_back(fmt::format(
            "{}: the side from {} to {} of curve '{}' is free, and {} film{} "
            "there{}{}; {}",
            place(input, input.curves[c].line), text(sides[k].from),
            text(sides[k].to), curve.name, there.size(),
            there.size() == 1 ? " ends" : "s end", there.empty() ? "" : ", ",
            fmt::join(there, ", "),
            joins ? "a side that joins a film is of one film alone: draw them "
                    "apart, or part the film that they join by a curve there"
                  : "lines balance where three films or more meet: let more "
                    "end at that side, name the film that it joins (joins = "
                    "[\"FILM\"]), or hold it"));
        break;
      }
    }
  }
}

void check_join_ends(const Case& input, const films::FilmSystem& system,
                     const std::vector<curves::Curve>& first,
                     std::vector<std::string>& problems) {
  constexpr double kStays = 1e-5;  // of the curve's parameter
  const std::vector<films::JoinEnd> ends = films::join_ends(system);
  std::vector<films::JoinEnd> first_ends;
  if (!ends.empty() && !have_equal_shapes(first, system.curves)) {
    films::FilmSystem there = system;
    for (std::size_t c = 0; c < first.size(); ++c) {
      there.curves[c].shape = first[c].shape;
    }
    first_ends = films::join_ends(there);
  }
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const films::JoinEnd& end = ends[k];
    if (!end.held) {
      continue;
    }
    const FilmEntry& film = input.films[static_cast<std::size_t>(end.film)];
    const std::string start =
        fmt::format("{}: film '{}' joins {} along a line that ends at {}, ",
                    place(input, film.line), film.spec.name,
                    fmt::join(film.spec.joins, ", "), text(end.place));
    if (!end.meets) {
      problems.push_back(fmt::format(
          "{}{:.4g} from the nearest place where that is held; let the line "
          "begin and end on curves of the film that it joins, or on another "
          "film, or be closed",
          start, end.distance));
      return;
    }
    const double moved =
        k < first_ends.size() && first_ends[k].curve == end.curve
            ? std::abs(end.t - first_ends[k].t)
            : 0.0;
    if (std::min(moved, 1.0 - moved) > kStays) {
      problems.push_back(fmt::format(
          "{}elsewhere along curve '{}' than at the initial design; models "
          "keep its place there: move that curve with it, or freeze at this "
          "design (--set)",
          start, system.curves[static_cast<std::size_t>(end.curve)].name));
      return;
    }
  }
}

void check_sides(const Case& input, const films::FilmSystem& system,
                 const CaseValues& values) {
  const std::map<SideName, SideName> first =
      first_of(films::shared_sides(system.curves));
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    if (has_facets(input, input.bodies[b])) {
      continue;  // facets may join elsewhere than on curves: check_start()
    }
    const auto at_sides = surfaces_at_sides(system, system.bodies[b], first);
    std::map<int, std::vector<SideName>> open;  // by curve
    for (const auto& [side, surfaces] : at_sides) {
      const auto curve = static_cast<std::size_t>(side.first);
      if (surfaces.size() != 2 && !is_cell(input, input.curves[curve].name)) {
        open[side.first].push_back(side);
      }
    }
    for (const auto& [curve, sides] : open) {
      values.problems().push_back(fmt::format(
          "{}: body '{}' is not closed at {}",
          place(input, input.bodies[b].enclosure_line), system.bodies[b].name,
          open_sides_text(system, sides, at_sides.at(sides.front()),
                          caps_beside(system, system.bodies[b], first))));
    }
  }
}

}  // namespace meniscus::case_data
