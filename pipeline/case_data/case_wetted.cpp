#include "pipeline/case_data/case_wetted.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "evolve/films/shared_sides.h"
#include "evolve/start/wetted_faces.h"
#include "pipeline/case_data/case_symmetry.h"

namespace meniscus::case_data {

namespace {

constexpr int kPlacesOnRim = 16;
constexpr double kSameEnergy = 1e-12;  // of films of one tension, or at 90 deg

/// The films that end at the curves of a wetted face; without those whose
/// tension is not one number, of which check_bodies() tells.
std::vector<const FilmEntry*> films_at(const Case& input, const CapEntry& cap) {
  const std::vector<std::string> curves = cap.spec.curves();
  std::vector<const FilmEntry*> result;
  for (const FilmEntry& film : input.films) {
    if (film.has_one_tension() &&
        std::any_of(curves.begin(), curves.end(), [&](const auto& curve) {
          return std::find(film.spec.curves.begin(), film.spec.curves.end(),
                           curve) != film.spec.curves.end();
        })) {
      result.push_back(&film);
    }
  }
  return result;
}

/// What a film needs of the wall, -T cos(contact angle) (Young).
Dual1 energy_for(const FilmEntry& film, const WettedWall& wall,
                 const CaseValues& values) {
  return -(values.dual(film.tension.quantity) *
           cos(values.dual(wall.contact_angle)));
}

/// A face has one energy per area for all films that end on it.
void check_one_energy(const Case& input, const CapEntry& cap,
                      const std::vector<const FilmEntry*>& films,
                      const CaseValues& values) {
  const double first = energy_for(*films[0], *cap.wetted, values).value;
  for (const FilmEntry* film : films) {
    const double energy = energy_for(*film, *cap.wetted, values).value;
    const double tension = values.dual(film->tension.quantity).value;
    if (!(std::abs(energy - first) <= kSameEnergy * std::abs(tension))) {
      values.problems().push_back(fmt::format(
          "{}: films '{}' and '{}' end on the wall of '{}' and need {:.6g} and "
          "{:.6g} of energy per area there; give them one tension, or a "
          "contact angle of 90 deg",
          place(input, cap.line), films[0]->spec.name, film->spec.name,
          cap.spec.name, first, energy));
    }
  }
}

Points places_on(const curves::Curve& curve) {
  Points result;
  for (int k = 0; k < kPlacesOnRim; ++k) {
    result.push_back(
        curves::point_at(curve.shape, static_cast<double>(k) / kPlacesOnRim));
  }
  return result;
}

void check_on_wall(const Case& input, const CapEntry& cap,
                   const films::FilmWall& wall, const curves::Curve& curve,
                   const CaseValues& values) {
  const Points places = places_on(curve);
  const auto off = [&](const Vec3& p) {
    return std::abs(start::off_wall(wall, p));
  };
  const double reach = start::wall_reach(wall, bounding_diagonal(places));
  const auto worst = std::max_element(
      places.begin(), places.end(),
      [&](const Vec3& a, const Vec3& b) { return off(a) < off(b); });
  if (!(off(*worst) <= reach)) {
    values.problems().push_back(fmt::format(
        "{}: curve '{}' is {:.4g} off the wall of '{}' at ({:.4g}, {:.4g}, "
        "{:.4g}); expected one {}, where the film begins",
        place(input, cap.line), curve.name, off(*worst), cap.spec.name,
        worst->x(), worst->y(), worst->z(),
        wall.bent() ? fmt::format("within {:.4g} of it", reach)
                    : "in its plane"));
  }
}

}  // namespace

bool is_cell(const Case& input, const std::string& curve) {
  const auto walls =
      std::count_if(input.caps.begin(), input.caps.end(),
                    [&](const CapEntry& cap) {
                      return cap.wetted && cap.symmetry < 0 &&
                             cap.spec.curve == curve;
                    }) +
      std::count_if(input.symmetry.begin(), input.symmetry.end(),
                    [&](const SymmetryPlane& plane) {
                      return std::find(plane.curves.begin(), plane.curves.end(),
                                       curve) != plane.curves.end();
                    });
  return walls > 1;
}

bool slides_at(const Case& input, const std::string& curve) {
  return is_cell(input, curve) ||
         std::any_of(
             input.caps.begin(), input.caps.end(), [&](const CapEntry& cap) {
               const std::vector<std::string> curves = cap.spec.curves();
               return cap.wetted && std::find(curves.begin(), curves.end(),
                                              curve) != curves.end();
             });
}

namespace {

/// A plane that cuts, its normal away from the curve.
void make_cell_wall(const curves::Curve& curve, films::CapSpec& cap) {
  double most = 0.0;  // off the plane, of its points
  for (const Vec3& point : places_on(curve)) {
    const double off = start::off_wall(*cap.wall, point);
    most = std::abs(off) > std::abs(most) ? off : most;
  }
  if (most > 0.0) {
    cap.wall->normal = -cap.wall->normal;
  }
  cap.wall->cuts = true;
  cap.wall->tension = 0.0;
  cap.curve.clear();
}

}  // namespace

void make_cells(const Case& input, films::FilmSystem& system) {
  for (curves::Curve& curve : system.curves) {
    if (!is_cell(input, curve.name)) {
      continue;
    }
    curve.free = true;
    for (films::CapSpec& cap : system.caps) {
      if (cap.wall && cap.curve == curve.name) {
        make_cell_wall(curve, cap);
      }
    }
  }
}

films::FilmWall wall_of(const Case& input, const CapEntry& cap,
                        const CaseValues& values) {
  const WettedWall& wetted = *cap.wetted;
  films::FilmWall wall{.at = values.at(wetted.at),
                       .normal = values.at(wetted.normal),
                       .cuts = wetted.cuts,
                       .kind = wetted.kind,
                       .rim = cap.symmetry < 0
                                  ? "rim:" + cap.spec.name
                                  : wall_end("", cap.symmetry).substr(1)};
  if (wetted.kind == films::WallKind::Sphere) {
    wall.normal = Vec3::UnitZ();
  } else if (!values.are_rates() && !(wall.normal.norm() > 0.0)) {
    const bool plane = wetted.kind == films::WallKind::Plane;
    values.problems().push_back(
        fmt::format("{}: solids.{}.{} is 0; expected a direction {} the wall",
                    place(input, wetted.normal[0].line), cap.spec.name,
                    plane ? "normal" : "axis", plane ? "across" : "along"));
  }
  if (wetted.radius) {
    wall.radius = values.at(
        *wetted.radius, [](double r) { return r > 0.0; }, "above 0");
  }
  if (wetted.half_angle) {
    wall.half_angle = values.at(
        *wetted.half_angle,
        [](double a) { return a > 0.0 && a < 0.5 * std::numbers::pi; },
        "above 0 and below pi/2 rad (90 deg)");
  }
  values.at(
      wetted.contact_angle,
      [](double a) {
        return a > 0.0 && a < std::numbers::pi && std::abs(std::cos(a)) < 1.0;
      },
      "above 0 and below pi rad (180 deg)");
  const std::vector<const FilmEntry*> films = films_at(input, cap);
  if (films.empty()) {
    return wall;  // check_bodies() has told so
  }
  const Dual1 energy = energy_for(*films[0], wetted, values);
  if (!values.are_rates()) {
    wall.tension = energy.value;
    check_one_energy(input, cap, films, values);
  } else {
    wall.tension = energy.is_constant() ? 0.0 : energy.gradient[0];
  }
  return wall;
}

namespace {

/// Sides of a cell's curve lie in planes, each of these on one side of it.
void check_cell(const Case& input, const CurveEntry& entry,
                const films::FilmSystem& system, const CaseValues& values) {
  const auto tell = [&](SourceLine line, const std::string& what) {
    values.problems().push_back(place(input, line) + ": " + what);
  };
  const auto curve = std::find_if(
      system.curves.begin(), system.curves.end(),
      [&](const curves::Curve& c) { return c.name == entry.name; });
  if (curve == system.curves.end()) {
    return;
  }
  const std::vector<films::CurveSide> sides = films::sides_of(curve->shape);
  double size = 0.0;
  for (const films::CurveSide& side : sides) {
    size = std::max(size, (side.to - sides[0].from).norm());
  }
  std::vector<char> lies(sides.size(), 0);
  for (std::size_t k = 0; k < input.caps.size(); ++k) {
    const CapEntry& cap = input.caps[k];
    const auto& wall = system.caps[k].wall;
    if (!wall || (cap.symmetry < 0 && cap.spec.curve != entry.name)) {
      continue;
    }
    if (wall->bent() || !cap.spec.more.empty() ||
        std::abs(std::cos(values.dual(cap.wetted->contact_angle).value)) >
            kSameEnergy) {
      tell(cap.line,
           fmt::format("solid '{}' is one of the walls of a cell, at curve "
                       "'{}'; expected planes without holes, met at 90 deg",
                       cap.spec.name, entry.name));
      return;
    }
    const double reach = start::wall_reach(*wall, size);
    bool has = false;
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const double from = start::off_wall(*wall, sides[s].from);
      const double to = start::off_wall(*wall, sides[s].to);
      const bool in =
          std::abs(from) <= reach && std::abs(to) <= reach &&
          std::abs(start::off_wall(*wall, sides[s].middle)) <= reach;
      lies[s] = in ? 1 : lies[s];
      has = has || in;
      if (std::max(from, to) > reach) {
        tell(cap.line,
             fmt::format("curve '{}' lies on both sides of the wall of '{}'; "
                         "films lie within the planes on which they slide",
                         entry.name, cap.spec.name));
        return;
      }
    }
    if (!has && cap.symmetry < 0) {
      tell(cap.line,
           fmt::format("no side of curve '{}' lies in the plane of '{}'; "
                       "expected one between two of its corners",
                       entry.name, cap.spec.name));
    }
  }
  const auto open = std::find(lies.begin(), lies.end(), 0);
  if (sides.empty() || open != lies.end()) {
    tell(entry.line,
         sides.empty()
             ? fmt::format("curve '{}' has no sides, of which one lies in the "
                           "plane of each solid wetted there; expected a "
                           "polygon or polyline",
                           entry.name)
             : fmt::format("side {} of curve '{}' lies in the plane of none of "
                           "the solids that are wetted there; give it one",
                           open - lies.begin() + 1, entry.name));
  }
}

}  // namespace

void check_on_walls(const Case& input, const films::FilmSystem& system,
                    const CaseValues& values) {
  for (const CurveEntry& curve : input.curves) {
    if (is_cell(input, curve.name)) {
      check_cell(input, curve, system, values);
    }
  }
  for (std::size_t k = 0; k < input.caps.size(); ++k) {
    const films::CapSpec& spec = system.caps[k];
    for (const std::string& name : spec.curves()) {
      const auto curve =
          std::find_if(system.curves.begin(), system.curves.end(),
                       [&](const curves::Curve& c) { return c.name == name; });
      if (spec.wall && curve != system.curves.end()) {
        check_on_wall(input, input.caps[k], *spec.wall, *curve, values);
      }
    }
  }
}

}  // namespace meniscus::case_data
