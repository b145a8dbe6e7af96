#include "pipeline/case_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "optimize/problem.h"

namespace meniscus {

namespace {

constexpr std::size_t kMostProblems = 20;
constexpr double kNesting = 0.01;  // film may miss fea / 2^k by 1 %
constexpr int kMostRefinements = 4;

template <class Entries>
std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) {
    names.push_back(entry.spec.name);
  }
  return names;
}

std::vector<std::string> surface_names(const Case& input) {
  std::vector<std::string> names = names_of(input.caps);
  for (const std::string& film : names_of(input.films)) {
    names.push_back(film);
  }
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void check_films(const Case& input, CaseProblems& problems) {
  std::vector<std::string> curves;
  for (const CurveEntry& curve : input.curves) {
    curves.push_back(curve.name);
  }
  for (const FilmEntry& film : input.films) {
    const auto refuse = [&](const std::string& needs) {
      problems.add(film.line,
                   fmt::format("films.{} names {} curves; {}", film.spec.name,
                               film.spec.curves.size(), needs));
    };
    const std::size_t count = film.spec.curves.size();
    if (film.spec.kind == FilmKind::Branch && count < 2) {
      refuse("a branch needs at least two");
    } else if (film.spec.kind == FilmKind::Loft && count != 2) {
      refuse("a loft needs exactly two");
    } else if (film.spec.kind == FilmKind::Disk && count != 1) {
      refuse("a disk needs exactly one");
    }
    std::set<std::string> seen;
    for (const std::string& curve : film.spec.curves) {
      if (!contains(curves, curve)) {
        problems.unknown(film.line, "curve", curve, curves);
      } else if (!seen.insert(curve).second) {
        problems.add(film.line, fmt::format("films.{} names curve '{}' twice",
                                            film.spec.name, curve));
      }
    }
  }
  for (const CapEntry& cap : input.caps) {
    if (!contains(curves, cap.spec.curve)) {
      problems.unknown(cap.line, "curve", cap.spec.curve, curves);
    }
  }
}

/// A body closes when each curve of its surfaces bounds two of them.
void check_closed(const Case& input, const BodyEntry& body,
                  CaseProblems& problems) {
  std::map<std::string, std::vector<std::string>> at_curve;
  const std::vector<std::string> known = surface_names(input);
  bool good = true;
  for (const std::string& surface : body.enclosed_by) {
    if (!contains(known, surface)) {
      problems.unknown(body.line, "film or solid", surface, known);
      good = false;
    }
    for (const FilmEntry& film : input.films) {
      if (film.spec.name == surface) {
        for (const std::string& curve : film.spec.curves) {
          at_curve[curve].push_back(surface);
        }
      }
    }
    for (const CapEntry& cap : input.caps) {
      if (cap.spec.name == surface) {
        at_curve[cap.spec.curve].push_back(surface);
      }
    }
  }
  for (const auto& [curve, surfaces] : at_curve) {
    if (good && surfaces.size() != 2) {
      std::string near;
      for (const CapEntry& cap : input.caps) {
        if (cap.spec.curve == curve && surfaces.size() == 1 &&
            surfaces[0] != cap.spec.name) {
          near = fmt::format("; add '{}' to enclosed_by", cap.spec.name);
        }
      }
      problems.add(body.line,
                   fmt::format("body '{}' is not closed at curve '{}': {} of "
                               "its surfaces meet there ({}), two must{}",
                               body.name, curve, surfaces.size(),
                               fmt::join(surfaces, ", "), near));
    }
  }
}

void check_bodies(const Case& input, CaseProblems& problems) {
  std::map<std::string, int> uses;
  for (const BodyEntry& body : input.bodies) {
    check_closed(input, body, problems);
    for (const std::string& surface : body.enclosed_by) {
      ++uses[surface];
    }
  }
  for (const std::string& surface : surface_names(input)) {
    if (uses[surface] > 2) {
      problems.add(1, fmt::format("surface '{}' encloses {} bodies; at most "
                                  "two can share it",
                                  surface, uses[surface]));
    }
  }
}

/// Parameters in an order in which each stands after those it uses.
void order_parameters(Case& input, CaseProblems& problems) {
  const int first = static_cast<int>(input.design.size());
  const int count = static_cast<int>(input.parameters.size());
  std::vector<int> state(count, 0);  // 0 new, 1 under way, 2 done
  std::vector<int> trail;
  const auto visit = [&](const auto& self, int at) -> bool {
    if (state[at] != 0) {
      return state[at] == 2;
    }
    state[at] = 1;
    trail.push_back(at);
    for (const int name : input.parameters[at].value.expression.names_used()) {
      if (name >= first && !self(self, name - first)) {
        return false;
      }
    }
    trail.pop_back();
    state[at] = 2;
    input.parameter_order.push_back(at);
    return true;
  };
  for (int k = 0; k < count; ++k) {
    if (!visit(visit, k)) {
      std::vector<std::string> cycle;
      for (const int at : trail) {
        cycle.push_back(input.parameters[at].name);
      }
      problems.add(input.parameters[k].value.line,
                   fmt::format("parameters depend on each other in a circle: "
                               "{}",
                               fmt::join(cycle, " -> ")));
      return;
    }
  }
}

void check_materials(const Case& input, const EvaluatedCase& numbers,
                     CaseProblems& problems) {
  for (std::size_t k = 0; k < numbers.materials.size(); ++k) {
    const Material& m = numbers.materials[k];
    const MaterialEntry& entry = input.materials[input.bodies[k].material];
    if (!(m.youngs_modulus > 0.0)) {
      problems.add(entry.youngs_modulus.line,
                   fmt::format("materials.{}.youngs_modulus is {:g}; it must "
                               "be above 0",
                               m.name, m.youngs_modulus));
    }
    if (!(m.poisson_ratio > -1.0 && m.poisson_ratio < 0.5)) {
      problems.add(entry.poisson_ratio.line,
                   fmt::format("materials.{}.poisson_ratio is {:g}; it must "
                               "lie above -1 and below 0.5",
                               m.name, m.poisson_ratio));
    }
    if (!(m.density >= 0.0)) {
      problems.add(entry.density.line,
                   fmt::format("materials.{}.density is {:g}; it cannot be "
                               "negative",
                               m.name, m.density));
    }
    if (m.yield_strength && !(*m.yield_strength > 0.0)) {
      problems.add(entry.yield_strength->line,
                   fmt::format("materials.{}.yield_strength is {:g}; it must "
                               "be above 0",
                               m.name, *m.yield_strength));
    }
  }
}

void check_loads(const Case& input, const EvaluatedCase& numbers,
                 CaseProblems& problems) {
  for (std::size_t k = 0; k < numbers.load_cases.size(); ++k) {
    const LoadCase& load_case = numbers.load_cases[k];
    const bool loaded =
        std::any_of(load_case.forces.begin(), load_case.forces.end(),
                    [](const SurfaceForce& f) { return f.total.norm() > 0; }) ||
        std::any_of(load_case.pressures.begin(), load_case.pressures.end(),
                    [](const SurfacePressure& p) { return p.pressure != 0; });
    if (!loaded) {
      problems.add(input.load_cases[k].line,
                   fmt::format("load case '{}' has no load that is not 0; a "
                               "part without load has nothing to report",
                               load_case.name));
    }
  }
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    if (input.responses[k].kind == ResponseKind::MeanDisplacement &&
        !(numbers.response_directions[k].norm() > 0.0)) {
      problems.add(input.responses[k].line,
                   fmt::format("responses.{}.direction has length 0",
                               input.responses[k].name));
    }
  }
}

/// The stiffness of the frozen model belongs to its materials.
void check_fixed_materials(const Case& input, const EvaluatedCase& initial,
                           const EvaluatedCase& other, CaseProblems& problems) {
  for (std::size_t k = 0; k < initial.materials.size(); ++k) {
    const Material& a = initial.materials[k];
    const Material& b = other.materials[k];
    if (a.youngs_modulus != b.youngs_modulus ||
        a.poisson_ratio != b.poisson_ratio) {
      problems.add(input.materials[input.bodies[k].material].line,
                   fmt::format("materials.{}: youngs_modulus and "
                               "poisson_ratio cannot depend on a design "
                               "variable in this version",
                               a.name));
    }
  }
}

/// The case's numbers at the initial design and, one variable at a time, at
/// the ends of the bounds.
void check_numbers(const Case& input, CaseProblems& problems) {
  const VectorX initial = initial_design(input);
  const auto at = [&](const VectorX& design) -> std::optional<EvaluatedCase> {
    try {
      return evaluate(input, design);
    } catch (const InvalidInput& error) {
      problems.add_text(error.what());
      return std::nullopt;
    }
  };
  const auto numbers = at(initial);
  if (!numbers) {
    return;
  }
  check_materials(input, *numbers, problems);
  check_loads(input, *numbers, problems);
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    for (const double end : {input.design[k].lower, input.design[k].upper}) {
      VectorX design = initial;
      design[static_cast<Eigen::Index>(k)] = end;
      const auto there = at(design);
      if (!there) {
        return;
      }
      check_fixed_materials(input, *numbers, *there, problems);
    }
  }
}

void warn_of_unused(const Case& input, CaseProblems& problems) {
  // A name is used when the evaluated numbers' text mentions it; asking the
  // expressions of every entry would list each field once more.
  const std::size_t count = input.design.size() + input.parameters.size();
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_design = k < input.design.size();
    const std::string& name =
        is_design ? input.design[k].name
                  : input.parameters[k - input.design.size()].name;
    const int line = is_design
                         ? input.design[k].line
                         : input.parameters[k - input.design.size()].value.line;
    std::size_t mentions = 0;
    for (std::size_t from = input.text.find(name); from != std::string::npos;
         from = input.text.find(name, from + 1)) {
      ++mentions;
    }
    if (mentions < 2) {
      problems.warn(
          line, fmt::format("{} '{}' is not used",
                            is_design ? "design variable" : "parameter", name));
    }
  }
}

}  // namespace

void CaseProblems::add(int line, const std::string& message) {
  problems_.push_back({line, fmt::format("{}:{}: {}", path_, line, message)});
}

void CaseProblems::add_text(const std::string& message) {
  const auto same = [&](const Entry& e) { return e.text == message; };
  if (std::none_of(problems_.begin(), problems_.end(), same)) {
    problems_.push_back({0, message});
  }
}

void CaseProblems::warn(int line, const std::string& message) {
  warnings_.push_back(
      {line, fmt::format("{}:{}: warning: {}", path_, line, message)});
}

void CaseProblems::unknown(int line, const char* what, const std::string& name,
                           const std::vector<std::string>& known) {
  const std::string near = nearest_name(name, known);
  add(line, fmt::format("there is no {} '{}'; {}", what, name,
                        !near.empty()   ? "did you mean '" + near + "'?"
                        : known.empty() ? "none is defined"
                                        : fmt::format("there are {}",
                                                      fmt::join(known, ", "))));
}

std::vector<std::string> CaseProblems::take() {
  std::stable_sort(
      problems_.begin(), problems_.end(),
      [](const Entry& a, const Entry& b) { return a.line < b.line; });
  std::vector<std::string> texts;
  for (const Entry& entry : problems_) {
    if (texts.size() == kMostProblems) {
      texts.push_back(fmt::format("... and {} more problems",
                                  problems_.size() - kMostProblems));
      break;
    }
    texts.push_back(entry.text);
  }
  return texts;
}

std::vector<std::string> CaseProblems::take_warnings() {
  std::vector<std::string> texts;
  for (const Entry& entry : warnings_) {
    texts.push_back(entry.text);
  }
  return texts;
}

void check_bounds(const DesignVariable& variable, int line,
                  CaseProblems& problems) {
  if (!(variable.lower < variable.upper)) {
    problems.add(line,
                 fmt::format("design.{}.bounds are [{:g}, {:g}]; the "
                             "first must be below the second",
                             variable.name, variable.lower, variable.upper));
  } else if (variable.initial < variable.lower ||
             variable.initial > variable.upper) {
    problems.add(line, fmt::format("design.{}.initial is {:g}, outside its "
                                   "bounds [{:g}, {:g}]",
                                   variable.name, variable.initial,
                                   variable.lower, variable.upper));
  }
}

void check_nesting(Resolution& resolution, int line, CaseProblems& problems) {
  if (!(resolution.fea > 0.0) || !(resolution.film > 0.0)) {
    return;
  }
  const double levels = std::log2(resolution.fea / resolution.film);
  const int nearest = static_cast<int>(std::lround(levels));
  resolution.refinements = std::clamp(nearest, 0, kMostRefinements);
  const double film = resolution.fea / std::exp2(resolution.refinements);
  if (std::abs(resolution.film - film) > kNesting * film) {
    problems.warn(line, fmt::format("resolution.film = {:g} is not fea / 2^k; "
                                    "the nested film's edge is {:g}",
                                    resolution.film, film));
    resolution.film = film;
  }
}

void check_surface_name(const Case& input, const std::string& surface, int line,
                        CaseProblems& problems) {
  const std::vector<std::string> known = surface_names(input);
  if (!contains(known, surface)) {
    problems.unknown(line, "surface", surface, known);
    return;
  }
  const bool on_body = std::any_of(input.bodies.begin(), input.bodies.end(),
                                   [&](const BodyEntry& body) {
                                     return contains(body.enclosed_by, surface);
                                   });
  if (!on_body && !input.bodies.empty()) {
    problems.add(line, fmt::format("surface '{}' encloses no body, so nothing "
                                   "can act on it; add it to a body's "
                                   "enclosed_by",
                                   surface));
  }
}

void check_study(const Case& input, CaseProblems& problems) {
  const StudyEntry& study = input.study;
  std::vector<std::string> known = response_names(input);
  std::vector<std::string> wanted = study.equal;
  for (const auto& [name, value] : study.targets) {
    wanted.push_back(name);
  }
  for (const std::string& name : wanted) {
    if (!contains(known, name)) {
      problems.unknown(study.line, "response", name, known);
    }
  }
  if (study.kind == StudyKind::Analyse) {
    return;
  }
  if (study.equal.size() == 1) {
    problems.add(study.line,
                 "study.equal names one response; two or more can "
                 "be made equal");
  }
  if (wanted.empty()) {
    problems.add(study.line,
                 "a match needs study.equal = [\"a\", \"b\"] or "
                 "study.targets = { a = value }");
  }
  if (input.design.empty()) {
    problems.add(study.line,
                 "a match needs a design variable to move: add "
                 "[design.NAME] with initial and bounds");
  }
  if (!(study.tolerance > 0.0)) {
    problems.add(study.line, fmt::format("study.tolerance is {:g}; it must be "
                                         "above 0",
                                         study.tolerance));
  }
  const std::vector<std::string> methods = match_methods();
  if (!contains(methods, study.method)) {
    problems.unknown(study.line, "method", study.method, methods);
  }
}

void check_case(Case& input, CaseProblems& problems) {
  check_films(input, problems);
  check_bodies(input, problems);
  order_parameters(input, problems);
  if (problems.empty()) {
    check_numbers(input, problems);
    warn_of_unused(input, problems);
  }
}

bool is_later_study(const std::string& kind) {
  constexpr std::array<const char*, 5> kLater = {"minimize", "sweep", "family",
                                                 "pareto", "tolerance"};
  return std::find(kLater.begin(), kLater.end(), kind) != kLater.end();
}

std::string case_name(const std::string& path) {
  const std::filesystem::path file =
      std::filesystem::absolute(path).lexically_normal();
  return file.filename() == "case.toml" && file.has_parent_path()
             ? file.parent_path().filename().string()
             : file.stem().string();
}

}  // namespace meniscus
