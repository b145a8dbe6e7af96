#include "pipeline/case_data/case_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/films/joined_sides.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/case_data/case_loads.h"
#include "pipeline/case_data/case_sides.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/case_wetted.h"
#include "pipeline/case_data/design_vectors.h"

namespace meniscus::case_data {

namespace {

constexpr double kNesting = 0.01;  // film may miss fea / 2^k by 1 %
constexpr int kMostRefinements = 4;

/// A film without liquid is no mistake, but seldom what a part is meant to be.
void check_liquid(const Case& input, CaseProblems& problems) {
  const bool inflated = std::any_of(input.fields.begin(), input.fields.end(),
                                    [](const FieldEntry& field) {
                                      return field.kind == FieldKind::Pressure;
                                    });
  for (const BodyEntry& body : input.bodies) {
    const bool held = std::any_of(
        input.spines.begin(), input.spines.end(),
        [&](const SpineEntry& spine) { return spine.body == body.name; });
    if (inflated || held || body.volume || body.pressure) {
      continue;
    }
    const auto film = std::find_if(
        input.films.begin(), input.films.end(), [&](const FilmEntry& entry) {
          return std::find(body.enclosed_by.begin(), body.enclosed_by.end(),
                           entry.spec.name) != body.enclosed_by.end();
        });
    if (film != input.films.end()) {
      problems.warn(body.line,
                    fmt::format("body '{}' has neither volume nor pressure: "
                                "film '{}' settles without liquid, as a soap "
                                "film between its curves; give a volume",
                                body.name, film->spec.name));
    }
  }
}

void check_use(const Case& input, CaseProblems& problems) {
  std::set<std::string> used_curves;
  std::set<std::string> used_surfaces;
  std::set<int> used_materials;
  for (const BodyEntry& body : input.bodies) {
    used_surfaces.insert(body.enclosed_by.begin(), body.enclosed_by.end());
    used_materials.insert(body.material);
  }
  for (const WallEntry& wall : input.walls) {
    used_surfaces.insert(wall.films.begin(), wall.films.end());
    used_materials.insert(wall.material);
  }
  for (const ShellEntry& shell : input.shells) {
    used_surfaces.insert(shell.films.begin(), shell.films.end());
    for (const LayerEntry& layer : shell.layers) {
      used_materials.insert(layer.material);
    }
  }
  for (const FilmEntry& film : input.films) {
    used_curves.insert(film.spec.curves.begin(), film.spec.curves.end());
    if (used_surfaces.count(film.spec.name) == 0) {
      problems.warn(film.line, fmt::format("film '{}' encloses no body and is "
                                           "no wall or shell",
                                           film.spec.name));
    }
  }
  for (const CapEntry& cap : input.caps) {
    const std::vector<std::string> curves = cap.spec.curves();
    used_curves.insert(curves.begin(), curves.end());
    if (used_surfaces.count(cap.spec.name) == 0 && cap.symmetry < 0) {
      problems.add(cap.line,
                   fmt::format("solid '{}' encloses no body; add it to a "
                               "body's enclosed_by or take it out",
                               cap.spec.name));
    }
  }
  for (const MergedCurves& pair : input.merged) {
    used_curves.insert(
        input.curves[static_cast<std::size_t>(pair.dropped)].name);
  }
  for (const StepSolidEntry& solid : input.step_solids) {
    used_curves.insert(solid.spec.frame);
    for (const films::SolidSpec::Rim& rim : solid.spec.rims) {
      used_curves.insert(rim.curve);
    }
  }
  for (const CurveEntry& curve : input.curves) {
    if (curve.copy.of >= 0) {
      used_curves.insert(
          input.curves[static_cast<std::size_t>(curve.copy.of)].name);
    }
  }
  for (const auto& [curve, other] : input.sharing_sides) {
    used_curves.insert(curve);  // it may name the rims of walls
  }
  for (const CurveEntry& curve : input.curves) {
    if (used_curves.count(curve.name) == 0) {
      problems.warn(curve.line, fmt::format("curve '{}' holds no film or solid",
                                            curve.name));
    }
  }
  for (std::size_t k = 0; k < input.materials.size(); ++k) {
    if (used_materials.count(static_cast<int>(k)) == 0) {
      problems.warn(
          input.materials[k].line,
          fmt::format("material '{}' fills no body", input.materials[k].name));
    }
  }
}

/// Where fewer than three films meet, or a solid's face, nothing balances a
/// line that moves.
void check_free_curves(const Case& input, CaseProblems& problems) {
  for (const CurveEntry& curve : input.curves) {
    const bool is_dropped = std::any_of(
        input.merged.begin(), input.merged.end(), [&](const MergedCurves& m) {
          return &input.curves[static_cast<std::size_t>(m.dropped)] == &curve;
        });
    if (is_dropped || !curve.is_free_somewhere()) {
      continue;
    }
    const auto names_it = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), curve.name) != names.end();
    };
    const auto films = std::count_if(
        input.films.begin(), input.films.end(),
        [&](const FilmEntry& film) { return names_it(film.spec.curves); });
    const bool joins =
        films == 1 && std::any_of(input.films.begin(), input.films.end(),
                                  [&](const FilmEntry& film) {
                                    return names_it(film.spec.curves) &&
                                           !film.spec.joins.empty();
                                  });
    const bool has_sides =
        curve.kind == CurveKind::Polygon || curve.kind == CurveKind::Polyline;
    if (films < 3 && !has_sides &&
        !joins) {  // of sides with others', by their places
      problems.add(
          curve.line,
          fmt::format("curve '{}' is free and {} film{} there; lines "
                      "balance where three films or more meet: let "
                      "more end there, name the film that it joins (joins = "
                      "[\"FILM\"]), or hold it (free = false)",
                      curve.name, films, films == 1 ? " ends" : "s end"));
    }
    if (curve.pieces > 0.0) {
      problems.add(curve.line,
                   fmt::format("curve '{}' has pieces and is free: edges along "
                               "a line that moves are the films'; take pieces "
                               "out, or hold it (free = false)",
                               curve.name));
    }
    for (const CapEntry& cap : input.caps) {
      if (names_it(cap.spec.curves())) {
        problems.add(
            cap.line,
            fmt::format("solid '{}' ends at curve '{}', which is free; "
                        "solids' faces do not follow films: end them "
                        "at a curve that is held",
                        cap.spec.name, curve.name));
      }
    }
    for (const FilletEntry& fillet : input.fillets) {
      if (names_it(fillet.curves)) {
        problems.add(fillet.line,
                     fmt::format("fillet '{}' is along curve '{}', which is "
                                 "free: films meet there at angles of their "
                                 "own; walls have a fillet of theirs",
                                 fillet.name, curve.name));
      }
    }
  }
}

/// What acts on a surface between two solid bodies acts within the part.
void check_inner_surfaces(const Case& input, CaseProblems& problems) {
  std::map<std::string, std::vector<std::string>> solids;  // by surface
  for (const BodyEntry& body : input.bodies) {
    for (const std::string& surface : body.enclosed_by) {
      if (body.material != kVoid) {
        solids[surface].push_back(body.name);
      }
    }
  }
  const auto look = [&](const std::string& what, const std::string& surface,
                        SourceLine line) {
    const auto found = solids.find(surface);
    if (found != solids.end() && found->second.size() == 2) {
      problems.warn(
          line, fmt::format("the {} on '{}' acts within the part: it lies "
                            "between bodies '{}' and '{}'",
                            what, surface, found->second[0], found->second[1]));
    }
  };
  for (const LoadCaseEntry& load_case : input.load_cases) {
    for (const LoadEntry& load : load_case.loads) {
      for (const std::string& surface : load.surfaces) {
        look("load", surface, load.line);
      }
    }
    for (const SupportEntry& entry : load_case.supports) {
      look("support", entry.support.surface, entry.line);
    }
    for (const loads::SpringBed& springs : load_case.springs) {
      look("spring bed", springs.surface, load_case.line);
    }
  }
}

/// Is `surface` held along all axes in which `push` is not 0?
bool is_held(const loads::LoadCase& load_case, const std::string& surface,
             const Vec3& push) {
  std::array<bool, 3> fixed = {false, false, false};
  for (const loads::Support& support : load_case.supports) {
    if (support.surface != surface || support.at ||
        support.kind != loads::SupportKind::Components) {
      continue;
    }
    const bool all = support.fix_x && support.fix_y && support.fix_z;
    if (all || !support.axes) {
      fixed[0] = fixed[0] || support.fix_x;
      fixed[1] = fixed[1] || support.fix_y;
      fixed[2] = fixed[2] || support.fix_z;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!fixed[static_cast<std::size_t>(axis)] && push[axis] != 0.0) {
      return false;
    }
  }
  return true;
}

/// A load on what is held moves nothing.
void check_held_loads(const Case& input, const EvaluatedCase& inputs,
                      CaseProblems& problems) {
  for (std::size_t k = 0; k < inputs.load_cases.size(); ++k) {
    const loads::LoadCase& load_case = inputs.load_cases[k];
    for (const LoadEntry& load : input.load_cases[k].loads) {
      if (load.surfaces.empty()) {
        continue;
      }
      // Of several forces there: along all that any pushes.
      Vec3 push = Vec3::Zero();
      for (const loads::SurfaceForce& force : load_case.forces) {
        if (load.kind == LoadKind::Force &&
            are_same_surfaces(force.surfaces, load.surfaces)) {
          push += force.total.cwiseAbs();
        }
      }
      if (push.isZero(0.0)) {
        push.setOnes();
      }
      const auto held = [&](const std::string& surface) {
        return is_held(load_case, surface, push);
      };
      // A bolt whose head is on what is held still pulls at its thread.
      if (std::all_of(load.surfaces.begin(), load.surfaces.end(), held) &&
          std::all_of(load.thread.begin(), load.thread.end(), held)) {
        problems.warn(
            load.line,
            fmt::format("the load on '{}' moves nothing: load case '{}' holds "
                        "that surface the way it pushes",
                        load.surfaces.text(), load_case.name));
      }
    }
  }
}

bool asks_for_frequencies(const Case& input) {
  return input.analysis.frequencies > 0 ||
         std::any_of(input.responses.begin(), input.responses.end(),
                     [](const ResponseEntry& response) {
                       return response.kind == ResponseKind::Frequency;
                     });
}

void check_loads(const Case& input, const EvaluatedCase& inputs,
                 CaseProblems& problems) {
  for (std::size_t k = 0; k < inputs.load_cases.size(); ++k) {
    const loads::LoadCase& load_case = inputs.load_cases[k];
    if (!is_loaded(load_case)) {
      problems.add(input.load_cases[k].line,
                   fmt::format("load case '{}' has no load that is not 0; a "
                               "part without load has nothing to report",
                               load_case.name));
    }
  }
  const bool expands =
      std::any_of(inputs.materials.begin(), inputs.materials.end(),
                  [](const element::Material& m) {
                    return !m.thermal_expansion.isZero(0.0);
                  });
  for (std::size_t k = 0; k < inputs.load_cases.size() && !expands; ++k) {
    if (inputs.load_cases[k].temperature) {
      problems.add(input.load_cases[k].line,
                   fmt::format("load case '{}' has a temperature, but no "
                               "material has a thermal expansion; give one",
                               inputs.load_cases[k].name));
    }
  }
  const std::vector<BodyEntry> solid = solid_bodies(input);
  for (std::size_t k = 0; k < inputs.materials.size(); ++k) {
    const MaterialEntry& entry =
        input.materials[static_cast<std::size_t>(solid[k].material)];
    if (inputs.materials[k].density != 0.0) {
      continue;
    }
    const auto weighs =
        std::find_if(inputs.load_cases.begin(), inputs.load_cases.end(),
                     [](const loads::LoadCase& c) { return has_weight(c); });
    if (weighs != inputs.load_cases.end()) {
      problems.add(entry.density.line,
                   fmt::format("materials.{}.density is 0, but load case '{}' "
                               "has gravity or spin; give its mass per volume",
                               entry.name, weighs->name));
    } else if (asks_for_frequencies(input)) {
      problems.add(entry.density.line,
                   fmt::format("materials.{}.density is 0, but natural "
                               "frequencies are asked for; give its mass per "
                               "volume",
                               entry.name));
    } else {
      problems.warn(entry.density.line,
                    fmt::format("materials.{}.density is 0; masses will be 0",
                                entry.name));
    }
  }
}

/// Plain numbers are in the units of the case, which nothing can check: what
/// nature has none of is told.
void check_plausible(const Case& input, const EvaluatedCase& inputs,
                     CaseProblems& problems) {
  const auto one = [&](const char* unit, Dimension dimension) {
    return parse_quantity(fmt::format("1 {}", unit), dimension, input.units);
  };
  const auto check = [&](SourceLine line, const std::string& what, double value,
                         Dimension dimension, const char* unit, double least,
                         double most, const char* example) {
    const double in_unit = value / one(unit, dimension);
    if (value != 0.0 && !(in_unit >= least && in_unit <= most)) {
      problems.warn(line,
                    fmt::format("{} is {:g} {}, which is {:.3g} {}: is its "
                                "unit meant? It can be given, as \"{}\"",
                                what, value, input.units.unit_of(dimension),
                                in_unit, unit, example));
    }
  };
  const std::vector<BodyEntry> solid = solid_bodies(input);
  for (std::size_t k = 0; k < inputs.materials.size(); ++k) {
    const MaterialEntry& entry =
        input.materials[static_cast<std::size_t>(solid[k].material)];
    const element::Material& material = inputs.materials[k];
    const std::string name = "materials." + entry.name;
    check(entry.density.line, name + ".density", material.density,
          Dimension::Density, "kg/m3", 1.0, 25000.0, "2800 kg/m3");
    if (!material.orthotropic) {
      check(entry.youngs_modulus.line, name + ".youngs_modulus",
            material.youngs_modulus, Dimension::Pressure, "GPa", 1e-6, 2000.0,
            "71.7 GPa");
      // No solid is as dense as a metal and as soft as rubber.
      const double stiffness =
          material.youngs_modulus / one("GPa", Dimension::Pressure);
      const double density =
          material.density / one("kg/m3", Dimension::Density);
      if (density > 2000.0 && stiffness < 0.5 && stiffness > 1e-6) {
        problems.warn(entry.youngs_modulus.line,
                      fmt::format("{}.youngs_modulus is {:.4g} GPa at {:.4g} "
                                  "kg/m3, as soft as rubber and as dense as "
                                  "metal: is GPa meant?",
                                  name, stiffness, density));
      }
    }
  }
  for (std::size_t k = 0; k < inputs.load_cases.size(); ++k) {
    check(input.load_cases[k].line,
          "the gravity of load case '" + inputs.load_cases[k].name + "'",
          inputs.load_cases[k].gravity.norm(), Dimension::Acceleration, "m/s2",
          0.1, 1e6, "9.81 m/s2");
  }
}

bool takes_scale_of_yield(const Case& input) {
  return std::any_of(
      input.responses.begin(), input.responses.end(),
      [](const ResponseEntry& r) {
        return (r.kind == ResponseKind::VonMisesKs && !r.scale) ||
               (r.kind == ResponseKind::StressRatio && !r.allowable);
      });
}

/// What of a material has no derivatives.
void check_fixed_materials(const Case& input, const EvaluatedCase& initial,
                           const EvaluatedCase& other, CaseProblems& problems) {
  const std::vector<BodyEntry> solid = solid_bodies(input);
  for (std::size_t k = 0; k < initial.materials.size(); ++k) {
    const element::Material& a = initial.materials[k];
    const element::Material& b = other.materials[k];
    const MaterialEntry& entry =
        input.materials[static_cast<std::size_t>(solid[k].material)];
    if (a.poisson_ratio != b.poisson_ratio) {
      const Quantity& ratio = entry.poisson_ratio;
      problems.add_text(fmt::format(
          "{}: {} depends on a design variable; it cannot in this version, "
          "youngs_modulus and density can",
          place(input, ratio.line), ratio.key));
    }
    if (a.yield_strength != b.yield_strength && takes_scale_of_yield(input)) {
      const Quantity& strength = *entry.yield_strength;
      problems.add_text(fmt::format(
          "{}: {} depends on a design variable, and a von_mises_ks without a "
          "'scale' or a stress_ratio without an 'allowable' is measured by it; "
          "give that response one",
          place(input, strength.line), strength.key));
    }
  }
}

/// A model frozen with a sharp corner has no facets for a round one.
void check_fillets(const Case& input, const EvaluatedCase& initial,
                   const EvaluatedCase& other, CaseProblems& problems) {
  const auto& first = initial.film_system.fillets;
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k].radius > 0.0 || !(other.film_system.fillets[k].radius > 0.0)) {
      continue;
    }
    for (const FilletEntry& entry : input.fillets) {
      if (entry.name == first[k].name) {
        problems.add_text(fmt::format(
            "{}: {} follows the design and is 0 at the initial one; begin with "
            "a radius above 0, from which it may become 0",
            place(input, entry.radius.line), entry.radius.key));
      }
    }
  }
}

/// The mesh along a curve is as fine as its fillet is small, refine_curves().
void check_small_fillets(const Case& input, const EvaluatedCase& inputs,
                         CaseProblems& problems) {
  constexpr double kDear = 1000.0;  // edges around: half a million elements
  constexpr double kMost = 20000.0;
  for (const films::FilletSpec& fillet : inputs.film_system.fillets) {
    const auto entry = std::find_if(
        input.fillets.begin(), input.fillets.end(),
        [&](const FilletEntry& e) { return e.name == fillet.name; });
    const auto curve = std::find_if(
        inputs.film_system.curves.begin(), inputs.film_system.curves.end(),
        [&](const curves::Curve& c) { return c.name == fillet.curve; });
    const double edges = 3.0 * curves::length_of(curve->shape) / fillet.radius;
    if (!(fillet.radius > 0.0) || !(edges > kDear)) {
      continue;
    }
    const std::string text = fmt::format(
        "{} is {:.4g}: edges of a third of it go {:.2g} times around '{}'; "
        "make it larger, or leave so small a fillet out",
        entry->radius.key, fillet.radius, edges, fillet.curve);
    if (edges > kMost) {
      problems.add(entry->radius.line, text);
    } else {
      problems.warn(entry->radius.line, text);
    }
  }
}

/// A rim's middle and the radius of a circle of its length.
std::pair<Vec3, double> middle_and_radius(const curves::CurveShape& shape) {
  constexpr int kPoints = 64;
  Vec3 middle = Vec3::Zero();
  for (int k = 0; k < kPoints; ++k) {
    middle += curves::point_at(shape, k / double{kPoints}) / kPoints;
  }
  const double radius = curves::length_of(shape) / (2.0 * std::numbers::pi);
  for (double& x : middle) {
    x = std::abs(x) < 1e-9 * radius ? 0.0 : x;
  }
  return {middle, radius};
}

/// Proposes a spine for a loft that is longer than its liquid alone can stand:
/// 2 pi radii of a cylinder (Plateau).
void check_arms(const Case& input, const EvaluatedCase& inputs,
                CaseProblems& problems) {
  const films::FilmSystem& system = inputs.film_system;
  for (std::size_t f = 0; f < system.films.size(); ++f) {
    const films::FilmSpec& film = system.films[f];
    const auto body = std::find_if(
        system.bodies.begin(), system.bodies.end(),
        [&](const auto& b) { return b.is_enclosed_by(film.name); });
    if (film.kind != films::FilmKind::Loft || body == system.bodies.end() ||
        !body->volume ||
        std::any_of(system.films.begin(), system.films.end(),
                    [&](const films::FilmSpec& other) {
                      return other.name != film.name &&
                             body->is_enclosed_by(other.name);
                    }) ||
        std::any_of(system.spines.begin(), system.spines.end(),
                    [&](const auto& s) { return s.body == body->name; })) {
      continue;
    }
    std::vector<std::pair<Vec3, double>> ends;
    for (const std::string& name : film.curves) {
      for (const curves::Curve& curve : system.curves) {
        if (curve.name == name) {
          ends.push_back(middle_and_radius(curve.shape));
        }
      }
    }
    if (ends.size() != 2) {
      continue;
    }
    const double length = (ends[1].first - ends[0].first).norm();
    const double radius =
        std::max(0.5 * (ends[0].second + ends[1].second),
                 std::sqrt(*body->volume / (std::numbers::pi * length)));
    if (length > 2.0 * std::numbers::pi * radius) {
      const auto place = [](const Vec3& p) {
        return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", p.x(), p.y(), p.z());
      };
      problems.warn(
          input.films[f].line,
          fmt::format("film '{}' is {:.3g} times as long as its radius, and a "
                      "liquid alone falls apart beyond 6.28; a spine holds it: "
                      "[spines.{}] with {}points = [{}, {}], radius = "
                      "[{:.4g}, {:.4g}]",
                      film.name, length / radius, film.name,
                      system.bodies.size() > 1
                          ? fmt::format("body = \"{}\", ", body->name)
                          : std::string(),
                      place(ends[0].first), place(ends[1].first),
                      ends[0].second, ends[1].second));
    }
  }
}

/// Does a shape of fields take them all?
bool are_coefficients(const Case& input, const DesignRow& row) {
  const auto takes = [&](const ShapeEntry& shape) {
    std::set<int> used;
    for (const Quantity& coefficient : shape.coefficients) {
      const std::vector<int> names = coefficient.expression.names_used();
      used.insert(names.begin(), names.end());
    }
    const auto first = static_cast<int>(row.first);
    const auto last = static_cast<int>(row.first + row.count) - 1;
    return used.count(first) > 0 && used.count(last) > 0;
  };
  return std::any_of(input.shapes.begin(), input.shapes.end(), takes);
}

/// The case's numbers at the initial design and, one variable at a time, at
/// the ends of the bounds.
void check_numbers(const Case& input, CaseProblems& problems) {
  const auto at = [&](const VectorX& design, const std::string& which) {
    std::vector<std::string> found;
    EvaluatedCase inputs = evaluate(input, design, found);
    for (const std::string& problem : found) {
      problems.add_text(problem + which);
    }
    return inputs;
  };
  const VectorX initial = initial_design(input);
  const EvaluatedCase inputs = at(initial, "");
  check_small_fillets(input, inputs, problems);
  if (!problems.empty()) {
    return;
  }
  check_start(input, inputs, problems);
  check_arms(input, inputs, problems);
  check_held_loads(input, inputs, problems);
  check_loads(input, inputs, problems);
  check_plausible(input, inputs, problems);
  const auto check_ends = [&](const DesignVariable& variable, std::size_t k) {
    for (const double end : {variable.lower, variable.upper}) {
      VectorX design = initial;
      design[static_cast<Eigen::Index>(k)] = end;
      const EvaluatedCase there =
          at(design, fmt::format(" (with '{}' at the end of its bounds, {:g})",
                                 variable.name, end));
      if (problems.empty()) {
        check_merged(input, inputs, there, problems);
        check_fixed_materials(input, inputs, there, problems);
        check_fillets(input, inputs, there, problems);
      }
    }
  };
  for (const DesignRow& row : design_rows(input)) {
    const std::size_t before = problems.size();
    // Of a vector the first element that does not fit says it all.
    for (std::size_t k = row.first;
         k < row.first + row.count && problems.size() == before; ++k) {
      check_ends(input.design[k], k);
    }
    // Of a shape no one coefficient says it: the field lies between them all.
    for (const bool upper : {false, true}) {
      if (problems.size() > before || !are_coefficients(input, row)) {
        break;
      }
      VectorX design = initial;
      for (std::size_t k = row.first; k < row.first + row.count; ++k) {
        design[static_cast<Eigen::Index>(k)] =
            upper ? input.design[k].upper : input.design[k].lower;
      }
      at(design,
         fmt::format(" (with all of '{}' at the {} ends of their bounds)",
                     row.name, upper ? "upper" : "lower"));
    }
  }
}

}  // namespace

void order_parameters(Case& input, CaseProblems& problems) {
  const int first = static_cast<int>(input.design.size());
  const int count = static_cast<int>(input.parameters.size());
  std::vector<int> state(input.parameters.size(), 0);  // 1 under way, 2 done
  std::vector<int> trail;
  const auto visit = [&](const auto& self, int at) -> bool {
    const auto k = static_cast<std::size_t>(at);
    if (state[k] != 0) {
      trail.push_back(at);  // closes the circle when under way
      return state[k] == 2 && (trail.pop_back(), true);
    }
    state[k] = 1;
    trail.push_back(at);
    for (const int name : input.parameters[k].value.expression.names_used()) {
      if (name >= first && !self(self, name - first)) {
        return false;
      }
    }
    trail.pop_back();
    state[k] = 2;
    input.parameter_order.push_back(at);
    return true;
  };
  for (int start = 0; start < count; ++start) {
    if (!visit(visit, start)) {
      const auto from = std::find(trail.begin(), trail.end(), trail.back());
      std::vector<std::string> circle;
      for (auto at = from; at != trail.end(); ++at) {
        circle.push_back(input.parameters[static_cast<std::size_t>(*at)].name);
      }
      problems.add(
          input.parameters[static_cast<std::size_t>(trail.back())].value.line,
          fmt::format("parameters depend on each other in a circle: {}; give "
                      "one of them a number",
                      fmt::join(circle, " -> ")));
      return;
    }
  }
}

void nest_film(Resolution& resolution, SourceLine line,
               CaseProblems& problems) {
  const double levels = std::log2(resolution.fea / resolution.film);
  resolution.refinements = static_cast<int>(std::lround(
      std::clamp(levels, 0.0, static_cast<double>(kMostRefinements))));
  const double film = resolution.fea / std::exp2(resolution.refinements);
  if (std::abs(resolution.film - film) > kNesting * film) {
    problems.warn(line,
                  fmt::format("resolution.film = {:g} is not fea / 2^k with k "
                              "from 0 to {}; {:g} is taken (k = {})",
                              resolution.film, kMostRefinements, film,
                              resolution.refinements));
  }
  resolution.film = film;
}

std::vector<std::string> surface_names(const Case& input) {
  std::vector<std::string> names;
  for (const CapEntry& cap : input.caps) {
    names.push_back(cap.spec.name);
  }
  for (const FilmEntry& film : input.films) {
    names.push_back(film.spec.name);
  }
  const std::vector<std::string> walls = wall_surface_names(input);
  names.insert(names.end(), walls.begin(), walls.end());
  const std::vector<std::string> shells = shell_surface_names(input);
  names.insert(names.end(), shells.begin(), shells.end());
  return names;
}

std::vector<std::string> film_names(const Case& input) {
  std::vector<std::string> names;
  for (const FilmEntry& film : input.films) {
    names.push_back(film.spec.name);
  }
  return names;
}

std::vector<std::string> body_names(const Case& input) {
  std::vector<std::string> names;
  for (const BodyEntry& body : input.bodies) {
    names.push_back(body.name);
  }
  return names;
}

void check_case(const Case& input, CaseProblems& problems) {
  if (problems.empty()) {
    check_liquid(input, problems);
    check_use(input, problems);
    check_free_curves(input, problems);
    check_wetted_walls(input, problems);
    check_inner_surfaces(input, problems);
    check_numbers(input, problems);
  }
}

std::string case_name(const std::string& path) {
  const std::filesystem::path file =
      std::filesystem::absolute(path).lexically_normal();
  return file.filename() == "case.toml" && file.has_parent_path()
             ? file.parent_path().filename().string()
             : file.stem().string();
}

std::vector<std::string> curves_of_wall(const Case& input,
                                        const WallEntry& wall) {
  std::vector<std::string> curves;
  for (const FilmEntry& film : input.films) {
    if (std::count(wall.films.begin(), wall.films.end(), film.spec.name) > 0) {
      curves.insert(curves.end(), film.spec.curves.begin(),
                    film.spec.curves.end());
    }
  }
  return curves;
}

namespace {

bool share(const std::vector<std::string>& a,
           const std::vector<std::string>& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& name) {
    return std::find(b.begin(), b.end(), name) != b.end();
  });
}

}  // namespace

void check_joined_films(const Case& input, CaseProblems& problems) {
  std::vector<std::string> films;
  for (const FilmEntry& film : input.films) {
    films.push_back(film.spec.name);
  }
  for (const FilmEntry& film : input.films) {
    for (const std::string& name : film.spec.joins) {
      if (name == film.spec.name) {
        problems.add(
            film.line,
            fmt::format("film '{}' joins itself; name another film", name));
      } else if (std::find(films.begin(), films.end(), name) == films.end()) {
        problems.unknown(film.line, "film", name, films);
      }
    }
    const bool is_free = std::any_of(
        input.curves.begin(), input.curves.end(), [&](const CurveEntry& c) {
          return c.is_free_somewhere() &&
                 std::find(film.spec.curves.begin(), film.spec.curves.end(),
                           c.name) != film.spec.curves.end();
        });
    if (!film.spec.joins.empty() && !is_free) {
      problems.add(film.line,
                   fmt::format("film '{}' joins '{}', and all of its curves "
                               "hold it; say of a curve free = true, or which "
                               "of its sides are free (free = [1])",
                               film.spec.name, film.spec.joins.front()));
    }
  }
  std::vector<films::FilmSpec> specs;
  for (const FilmEntry& film : input.films) {
    specs.push_back(film.spec);
    std::erase(specs.back().joins, film.spec.name);  // told
  }
  const std::vector<int> order = films::joining_order(specs);
  for (std::size_t f = 0; f < specs.size(); ++f) {
    if (!specs[f].joins.empty() &&
        std::count(order.begin(), order.end(), static_cast<int>(f)) == 0) {
      problems.add(
          input.films[f].line,
          fmt::format("film '{}' joins '{}', and films join each other in a "
                      "circle; let one of them have curves of its own there",
                      specs[f].name, specs[f].joins.front()));
      break;
    }
  }
}

namespace {

bool is_among_films(const FilmEntry& film,
                    const std::vector<std::string>& films) {
  return std::count(films.begin(), films.end(), film.spec.name) > 0;
}

/// The film's back and its rims, where it has a thickness; none at curves that
/// are of several, as `uses` says, and of those that it does not know all.
void add_sides(const Case& input, const FilmEntry& film,
               const std::set<std::string>& held,
               const std::map<std::string, int>& uses,
               std::vector<std::string>& names) {
  names.push_back(film.spec.name + "/back");
  for (const std::string& curve : film.spec.curves) {
    const bool is_free = std::any_of(
        input.curves.begin(), input.curves.end(),
        [&](const CurveEntry& c) { return c.free && c.name == curve; });
    const auto known = uses.find(curve);
    const bool is_own = known == uses.end() || known->second == 1;
    if (is_own && !is_free && !slides_at(input, curve)) {
      names.push_back(film.spec.name + "/rim:" + curve);
    }
    for (auto at = input.sharing_sides.lower_bound({curve, ""});
         at != input.sharing_sides.end() && at->first == curve; ++at) {
      if (!held.contains(at->second)) {
        names.push_back(film.spec.name + "/rim:" + at->second);
      }
    }
  }
}

void add_ends(const Case& input, std::vector<std::string>& names) {
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    const auto ends = wall_ends(input, static_cast<int>(p));
    names.insert(names.end(), ends.begin(), ends.end());
  }
}

}  // namespace

std::vector<std::string> shell_surface_names(const Case& input) {
  const std::set<std::string> held = held_curves(input);
  std::vector<std::string> names;
  for (const ShellEntry& shell : input.shells) {
    for (const FilmEntry& film : input.films) {
      if (is_among_films(film, shell.films)) {
        add_sides(input, film, held, {}, names);
      }
    }
  }
  add_ends(input, names);
  return names;
}

std::vector<std::string> wall_surface_names(const Case& input) {
  std::map<std::string, int> uses;  // of curves by films with walls
  for (const WallEntry& wall : input.walls) {
    for (const std::string& curve : curves_of_wall(input, wall)) {
      ++uses[curve];
    }
  }
  const std::set<std::string> held = held_curves(input);
  std::vector<std::string> names;
  for (const WallEntry& wall : input.walls) {
    for (const FilmEntry& film : input.films) {
      if (!is_among_films(film, wall.films)) {
        continue;
      }
      add_sides(input, film, held, uses, names);
      for (const CapEntry& cap : input.caps) {
        if (cap.wetted && cap.symmetry < 0 &&
            share(cap.spec.curves(), film.spec.curves)) {
          names.push_back(film.spec.name + "/rim:" + cap.spec.name);
        }
      }
    }
  }
  add_ends(input, names);
  return names;
}

}  // namespace meniscus::case_data
