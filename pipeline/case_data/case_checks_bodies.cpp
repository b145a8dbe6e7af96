/// Checks that bodies are closed by their surfaces.
#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_sides.h"
#include "pipeline/case_data/case_wetted.h"

namespace meniscus::case_data {

namespace {

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The body's surfaces by the curve that bounds them.
std::map<std::string, std::set<std::string>> surfaces_at_curves(
    const Case& input, const BodyEntry& body) {
  std::map<std::string, std::set<std::string>> at_curve;
  for (const FilmEntry& film : input.films) {
    if (is_among(body.enclosed_by, film.spec.name)) {
      for (const std::string& curve : film.spec.curves) {
        at_curve[curve].insert(film.spec.name);
      }
    }
  }
  for (const CapEntry& cap : input.caps) {
    if (is_among(body.enclosed_by, cap.spec.name)) {
      films::CapSpec spec = cap.spec;
      spec.start = nullptr;  // a file's surfaces may end anywhere
      for (const std::string& curve : spec.curves()) {
        at_curve[curve].insert(spec.name);
      }
    }
  }
  return at_curve;
}

using SurfacesAtCurves = std::map<std::string, std::set<std::string>>;

/// Each surface outside the body that ends at `curve`, with its curves.
std::vector<std::pair<std::string, std::vector<std::string>>> outside_surfaces(
    const Case& input, const BodyEntry& body, const std::string& curve) {
  std::vector<std::pair<std::string, std::vector<std::string>>> result;
  const auto add = [&](const std::string& name,
                       const std::vector<std::string>& curves) {
    if (is_among(curves, curve) && !is_among(body.enclosed_by, name)) {
      result.emplace_back(name, curves);
    }
  };
  for (const CapEntry& cap : input.caps) {
    add(cap.spec.name, cap.spec.curves());
  }
  for (const FilmEntry& film : input.films) {
    add(film.spec.name, film.spec.curves);
  }
  return result;
}

/// Curves at which one surface of the body ends.
std::vector<std::string> open_curves(const SurfacesAtCurves& at_curve) {
  std::vector<std::string> open;
  for (const auto& [curve, surfaces] : at_curve) {
    if (surfaces.size() == 1) {
      open.push_back(curve);
    }
  }
  return open;
}

/// "let film 'F' end at 'A', not at 'B'" where just two curves are open and F
/// ends at one of them; else empty.
std::string moved_film(const Case& input, const SurfacesAtCurves& at_curve) {
  const std::vector<std::string> open = open_curves(at_curve);
  if (open.size() != 2) {
    return "";
  }
  const std::string& first = *at_curve.at(open[0]).begin();
  const std::string& second = *at_curve.at(open[1]).begin();
  for (const FilmEntry& film : input.films) {
    const std::string& name = film.spec.name;
    if (first != second && (name == first || name == second)) {
      return fmt::format("let film '{}' end at '{}', not at '{}'", name,
                         name == first ? open[1] : open[0],
                         name == first ? open[0] : open[1]);
    }
  }
  return "";
}

/// What would close the body at a curve where one surface ends: one that
/// leaves no other gap, or a film that ends elsewhere.
std::string closing_advice(const Case& input, const BodyEntry& body,
                           const SurfacesAtCurves& at_curve,
                           const std::string& curve) {
  const auto surfaces = outside_surfaces(input, body, curve);
  const auto fits =
      std::find_if(surfaces.begin(), surfaces.end(), [&](const auto& surface) {
        return std::all_of(surface.second.begin(), surface.second.end(),
                           [&](const std::string& name) {
                             const auto at = at_curve.find(name);
                             return at != at_curve.end() &&
                                    at->second.size() == 1;
                           });
      });
  const std::string moved = moved_film(input, at_curve);
  std::string advice;
  if (fits != surfaces.end()) {
    advice = fmt::format("add '{}' to enclosed_by", fits->first);
  } else if (moved.empty() && !surfaces.empty()) {
    advice = fmt::format("add '{}' to enclosed_by", surfaces.front().first);
  } else if (moved.empty()) {
    advice = fmt::format(
        "add a cap across it ([solids.NAME] with curve = \"{}\")", curve);
  }
  return advice + (advice.empty() || moved.empty() ? "" : ", or ") + moved;
}

/// What to do where more than two surfaces meet.
std::string parting_advice(const SurfacesAtCurves& at_curve) {
  const std::vector<std::string> open = open_curves(at_curve);
  return open.empty() ? "take one out of enclosed_by"
                      : "take one out of enclosed_by, or let one of them end "
                        "where one is missing, as at '" +
                            open.front() + "'";
}

/// Two flat caps across one curve lie on each other.
void check_caps(const Case& input, CaseProblems& problems) {
  const auto is_flat = [](const CapEntry& cap) {
    return !cap.is_file && cap.spec.inner.empty() && cap.spec.more.empty() &&
           !cap.spec.curve.empty();
  };
  std::map<std::string, std::string> across;
  for (const CapEntry& cap : input.caps) {
    if (!is_flat(cap) || (cap.wetted && is_cell(input, cap.spec.curve))) {
      continue;
    }
    const auto [first, is_new] = across.emplace(cap.spec.curve, cap.spec.name);
    if (!is_new) {
      problems.add(
          cap.line,
          fmt::format("solids '{}' and '{}' lie on each other, both across "
                      "curve '{}'; one is enough for the bodies on both of its "
                      "sides: name it in their enclosed_by, or give the other "
                      "a curve of its own",
                      first->second, cap.spec.name, cap.spec.curve));
    }
  }
}

/// One film, of one tension, ends at each curve of a wetted face, which holds
/// nothing else.
void check_wetted_curve(const Case& input, const CapEntry& cap,
                        const std::string& curve, CaseProblems& problems) {
  std::vector<std::string> ends;
  std::size_t films = 0;
  for (const FilmEntry& film : input.films) {
    if (!is_among(film.spec.curves, curve)) {
      continue;
    }
    ends.push_back(film.spec.name);
    ++films;
    if (!film.has_one_tension()) {
      problems.add(
          cap.line,
          fmt::format("film '{}' slides on the wall of '{}', and its tension "
                      "depends on {}; give it {}",
                      film.spec.name, cap.spec.name,
                      film.tension.of_place ? "the place" : "how it is turned",
                      film.tension.of_place ? "a number" : "no `drop`"));
    }
  }
  for (const CapEntry& other : input.caps) {
    if (is_among(other.spec.curves(), curve) && &other != &cap &&
        !(other.wetted && is_cell(input, curve))) {
      ends.push_back(other.spec.name);
    }
  }
  if (films != 1 || ends.size() != 1) {
    problems.add(
        cap.line,
        fmt::format("solid '{}' is wetted at curve '{}', where {} end; "
                    "expected one film there and no other solid",
                    cap.spec.name, curve,
                    ends.empty() ? "no films"
                                 : fmt::format("{}", fmt::join(ends, ", "))));
  }
}

void check_wetted(const Case& input, CaseProblems& problems) {
  for (const CapEntry& cap : input.caps) {
    if (cap.wetted) {
      for (const std::string& curve : cap.spec.curves()) {
        check_wetted_curve(input, cap, curve, problems);
      }
    }
  }
}

/// All names that the body's shape hangs on are known; else the reader has
/// told so, and what follows from it is no news.
bool names_are_known(const Case& input, const BodyEntry& body) {
  const std::vector<std::string> surfaces = surface_names(input);
  bool known = std::all_of(
      body.enclosed_by.begin(), body.enclosed_by.end(),
      [&](const std::string& name) { return is_among(surfaces, name); });
  for (const FilmEntry& film : input.films) {
    known = known && (film.spec.kind == films::FilmKind::Facets ||
                      film.spec.kind == films::FilmKind::Spines ||
                      !film.spec.curves.empty());
  }
  for (const CapEntry& cap : input.caps) {
    const bool named = cap.is_file || !cap.spec.curve.empty() ||
                       (cap.wetted && cap.wetted->cuts);
    known = known && (named || !is_among(body.enclosed_by, cap.spec.name));
  }
  const auto is_curve = [&](const std::string& name) {
    return std::any_of(input.curves.begin(), input.curves.end(),
                       [&](const CurveEntry& c) { return c.name == name; });
  };
  for (const auto& [curve, at] : surfaces_at_curves(input, body)) {
    known = known && is_curve(curve);
  }
  return known;
}

void check_closed(const Case& input, const BodyEntry& body,
                  CaseProblems& problems) {
  if (!names_are_known(input, body) || has_facets(input, body)) {
    return;  // facets may join elsewhere than on curves: see check_start()
  }
  const SurfacesAtCurves at_curve = surfaces_at_curves(input, body);
  for (const auto& [curve, surfaces] : at_curve) {
    if (surfaces.size() == 1 && may_join_by_sides(input, curve)) {
      continue;  // other faces may have its sides: check_sides() knows
    }
    if (is_cell(input, curve)) {
      continue;  // its walls end where they meet
    }
    if (surfaces.size() != 2) {
      problems.add(
          body.enclosure_line,
          fmt::format("body '{}' is not closed at curve '{}': {} of its "
                      "surfaces meet{} there ({}), two must; {}",
                      body.name, curve, surfaces.size(),
                      surfaces.size() == 1 ? "s" : "",
                      fmt::join(surfaces, ", "),
                      surfaces.size() == 1
                          ? closing_advice(input, body, at_curve, curve)
                          : parting_advice(at_curve)));
    }
  }
}

}  // namespace

void check_wetted_walls(const Case& input, CaseProblems& problems) {
  for (const WallEntry& wall : input.walls) {
    const std::vector<std::string> curves = curves_of_wall(input, wall);
    for (const CapEntry& cap : input.caps) {
      const std::vector<std::string> rims = cap.spec.curves();
      if (cap.wetted && cap.wetted->kind != films::WallKind::Plane &&
          std::any_of(rims.begin(), rims.end(), [&](const std::string& rim) {
            return is_among(curves, rim);
          })) {
        problems.add(
            wall.line,
            fmt::format("walls.{} is of a film that slides on the bent wall of "
                        "'{}'; films with a thickness slide on planes only: "
                        "make '{}' a cap, or fill a body instead",
                        wall.name, cap.spec.name, cap.spec.name));
      }
    }
  }
}

void check_bodies(const Case& input, CaseProblems& problems) {
  check_caps(input, problems);
  check_wetted(input, problems);
  std::map<std::string, std::vector<std::string>> bodies_of;
  for (const BodyEntry& body : input.bodies) {
    check_closed(input, body, problems);
    for (const std::string& surface : body.enclosed_by) {
      bodies_of[surface].push_back(body.name);
    }
  }
  for (const BodyEntry& body : input.bodies) {
    for (const std::string& surface : body.enclosed_by) {
      const std::vector<std::string>& bodies = bodies_of[surface];
      if (bodies.size() > 2 && bodies.back() == body.name) {
        problems.add(
            body.enclosure_line,
            fmt::format("'{}' encloses {} bodies ({}); it has two "
                        "sides, so at most two can share it",
                        surface, bodies.size(), fmt::join(bodies, ", ")));
      }
    }
  }
}

}  // namespace meniscus::case_data
