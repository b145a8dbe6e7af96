#include "pipeline/case_films/film_advice.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/geometry/mesh_checks.h"
#include "evolve/energy/energy.h"
#include "evolve/frozen/film_model.h"
#include "evolve/settle/find_equilibrium.h"
#include "evolve/start/start_complex.h"

namespace meniscus::case_films {

namespace {

using Names = std::set<std::string>;

/// Films and caps that the message names; all films where it names none.
Names surfaces_named(const films::FilmSystem& system,
                     const std::string& message) {
  Names named;
  Names films;
  const auto look = [&](const std::string& name) {
    if (message.find("'" + name + "'") != std::string::npos) {
      named.insert(name);
    }
  };
  for (const films::FilmSpec& film : system.films) {
    films.insert(film.name);
    look(film.name);
  }
  if (named.empty()) {
    for (const films::CapSpec& cap : system.caps) {
      look(cap.name);
    }
  }
  return named.empty() ? films : named;
}

/// Where the case has the volume of the body of that name.
case_data::SourceLine volume_line(const case_data::Case& input,
                                  const std::string& name) {
  for (const case_data::BodyEntry& body : input.bodies) {
    if (body.name == name && body.volume) {
      return body.volume->line;
    }
  }
  return 0;
}

/// Bodies of given volume that these surfaces enclose, by index.
std::vector<std::size_t> bodies_beside(const films::FilmSystem& system,
                                       const Names& surfaces) {
  std::vector<std::size_t> found;
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    const films::BodySpec& body = system.bodies[b];
    if (body.volume &&
        std::any_of(body.enclosed_by.begin(), body.enclosed_by.end(),
                    [&](const std::string& name) {
                      return surfaces.count(name) > 0;
                    })) {
      found.push_back(b);
    }
  }
  return found;
}

/// Circles and ellipses that the films end on, `factor` times as large.
bool enlarge_rims(films::FilmSystem& system, const Names& films,
                  double factor) {
  bool any = false;
  for (const films::FilmSpec& film : system.films) {
    if (films.count(film.name) == 0) {
      continue;
    }
    for (curves::Curve& curve : system.curves) {
      if (std::find(film.curves.begin(), film.curves.end(), curve.name) ==
          film.curves.end()) {
        continue;
      }
      if (auto* circle = std::get_if<curves::Circle>(&curve.shape)) {
        circle->radius *= factor;
        any = true;
      } else if (auto* ellipse = std::get_if<curves::Ellipse>(&curve.shape)) {
        ellipse->radius_1 *= factor;
        ellipse->radius_2 *= factor;
        any = true;
      }
    }
  }
  return any;
}

/// One change of the case. `factor` and `of` say it in words: "1.3", "times the
/// volume of 'part'".
struct Trial {
  films::FilmSystem system;
  std::string factor;
  std::string of;
  std::string detail;    // "volume = 1.17e+05 mm3, case.toml:27"
  bool is_more = false;  // of every volume
};

/// Multiplies volumes of bodies, by index.
using Factors = std::vector<std::pair<std::size_t, double>>;

Trial volume_trial(const case_data::Case& input,
                   const films::FilmSystem& system, const Factors& factors) {
  Trial trial{.system = system, .factor = "", .of = "", .detail = ""};
  std::vector<std::string> numbers;
  std::vector<std::string> names;
  std::vector<std::string> details;
  for (const auto& [b, factor] : factors) {
    films::BodySpec& body = trial.system.bodies[b];
    // Tried as it is told: beside a collapse digits matter.
    const std::string volume = fmt::format("{:.4g}", *body.volume * factor);
    std::from_chars(volume.data(), volume.data() + volume.size(), *body.volume);
    numbers.push_back(fmt::format("{:.3g}", factor));
    names.push_back("'" + body.name + "'");
    details.push_back(fmt::format("volume = {} {}, {}", volume,
                                  input.units.unit_of(Dimension::Volume),
                                  place(input, volume_line(input, body.name))));
  }
  if (std::count(numbers.begin(), numbers.end(), numbers.front()) ==
      static_cast<std::ptrdiff_t>(numbers.size())) {
    numbers.resize(1);
  }
  trial.factor = fmt::format("{}", fmt::join(numbers, " and "));
  trial.of = fmt::format("times the volume of {}", fmt::join(names, " and "));
  trial.is_more = std::all_of(factors.begin(), factors.end(),
                              [](const auto& f) { return f.second > 1.0; });
  trial.detail = fmt::format("{}", fmt::join(details, "; "));
  return trial;
}

/// "1.3, 1.7 times the volume of 'part'; rims of skin 1.3 times as large".
std::string listed(const std::vector<Trial>& trials) {
  std::string text;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    text += k == 0 ? "" : trials[k].of == trials[k - 1].of ? ", " : "; ";
    text += trials[k].factor;
    if (k + 1 == trials.size() || trials[k + 1].of != trials[k].of) {
      text += (trials[k].factor.empty() ? "" : " ") + trials[k].of;
    }
  }
  return text;
}

/// What the first facets between the curves enclose of each body, over the
/// volume that is asked of it; nothing where they cannot be made.
std::vector<double> fills_of_start(const films::FilmSystem& system,
                                   double edge) {
  std::vector<double> fills;
  try {
    const std::string prevented = what_prevents([&] {
      const films::FilmComplex start = start::build_start(system, edge);
      const VectorX volumes =
          energy::FilmEnergy(start).volumes(start.mesh.points);
      for (std::size_t b = 0; b < system.bodies.size(); ++b) {
        fills.push_back(volumes[static_cast<Eigen::Index>(b)] /
                        system.bodies[b].volume.value_or(1.0));
      }
    });
    return prevented.empty() ? fills : std::vector<double>();
  } catch (const ExpressionError&) {  // of a field
    return {};
  }
}

std::vector<Trial> trials_of(const case_data::Case& input,
                             const case_data::EvaluatedCase& inputs,
                             const Names& named, bool of_films, double edge) {
  constexpr std::array<double, 4> kVolumes = {1.3, 1.7, 2.2, 0.75};
  constexpr double kFar = 2.2;  // times what the first facets enclose
  constexpr double kRims = 1.3;
  const films::FilmSystem& system = inputs.film_system;
  const std::vector<std::size_t> bodies = bodies_beside(system, named);
  const std::vector<double> fills = fills_of_start(system, edge);
  Factors far;     // to the volume of the first facets
  Factors others;  // the same of bodies that the message does not name
  Factors same;
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    const bool beside =
        std::find(bodies.begin(), bodies.end(), b) != bodies.end();
    if (beside) {
      same.emplace_back(b, 1.0);
    }
    if (system.bodies[b].volume && !fills.empty() && fills[b] > 0.0 &&
        std::abs(std::log(fills[b])) > std::log(kFar)) {
      (beside ? far : others).emplace_back(b, fills[b]);
    }
  }
  std::vector<Trial> trials;
  const auto add = [&](const Factors& factors, double power, double times) {
    Factors own = factors;
    for (auto& [b, factor] : own) {
      factor = times * std::pow(factor, power);
    }
    trials.push_back(volume_trial(input, system, own));
  };
  const auto add_way = [&](const Factors& factors) {
    if (!factors.empty()) {
      add(factors, 1.0 / 3.0, 1.0);
      add(factors, 2.0 / 3.0, 1.0);
      for (const double times : {1.0, 2.2, 4.0}) {
        add(factors, 1.0, times);
      }
    }
  };
  add_way(far);
  if (far.empty() && !same.empty()) {
    for (const double times : kVolumes) {
      add(same, 1.0, times);
    }
  }
  Trial trial{.system = system, .factor = "", .of = "", .detail = ""};
  if (of_films && enlarge_rims(trial.system, named, kRims)) {
    trial.of = fmt::format("rims of {} {:g} times as large",
                           fmt::join(named, " and "), kRims);
    trials.push_back(std::move(trial));
  }
  add_way(others);
  return trials;
}

bool is_meeting(const Finding& finding) {
  return finding.kind == FindingKind::Crossing ||
         finding.kind == FindingKind::TooClose ||
         finding.kind == FindingKind::BodyMismatch;
}

/// Passes on a stop and says nothing.
class QuietMonitor : public Monitor {
 public:
  explicit QuietMonitor(const Monitor& outer) : outer_(outer) {}
  bool stop_requested() const override { return outer_.stop_requested(); }

 private:
  const Monitor& outer_;
};

bool stands(const films::FilmSystem& system, double edge, int refinements,
            Monitor& monitor) {
  bool stands = false;
  // Rims that meet, a body that stays open, modes that are not found.
  what_prevents([&] {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        system,
        {.edge = edge, .refinements = refinements, .monitor = &monitor});
    const settle::FilmState& film = model.reference();
    stands = !film.failure &&
             (system.bodies.empty() ||
              check_surface(model.surface(film.points).base).empty());
  });
  return stands;
}

/// On coarse facets first, which tells most that do not.
bool stands(const films::FilmSystem& system, const AdviceOptions& options,
            Monitor& monitor) {
  return stands(system, options.edge, 0, monitor) &&
         (options.refinements == 0 ||
          stands(system, options.edge, options.refinements, monitor));
}

}  // namespace

bool is_of_films(const Failure& failure) {
  return failure.kind == FailureKind::FilmPinched ||
         failure.kind == FailureKind::FilmUnstable ||
         failure.kind == FailureKind::FilmNotFound ||
         failure.kind == FailureKind::FilmRejoins;
}

std::string tried_advice(const case_data::Case& input,
                         const case_data::EvaluatedCase& inputs,
                         const Failure& failure, const AdviceOptions& options) {
  const bool of_films = is_of_films(failure);
  const bool meets =
      failure.kind == FailureKind::SurfaceInvalid &&
      std::any_of(options.findings.begin(), options.findings.end(), is_meeting);
  if ((!of_films && !meets) || inputs.film_system.films.empty()) {
    return "";
  }
  Monitor& outer =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  QuietMonitor quiet(outer);
  const Names named = surfaces_named(inputs.film_system, failure.message);
  std::vector<Trial> in_vain;
  outer.progress({.stage = "film", .detail = failure.message});
  std::vector<Trial> trials =
      trials_of(input, inputs, named, of_films, options.edge);
  if (failure.message.find(settle::kPopHelps) != std::string::npos) {
    Trial trial{.system = inputs.film_system, .of = "resolution.pop = true"};
    trial.system.pop = true;
    trials.insert(trials.begin(), std::move(trial));
  }
  for (const Trial& trial : trials) {
    outer.progress({.stage = "film", .detail = "trying " + listed({trial})});
    if (stands(trial.system, options, quiet)) {
      return fmt::format(
          "tried: with {}{} the film stands{}{}", listed({trial}),
          trial.detail.empty() ? "" : " (" + trial.detail + ")",
          in_vain.empty() ? "" : "; not with " + listed(in_vain),
          of_films && trial.is_more
              ? "; an arm longer than six times its radius stands with "
                "less by a cap in its middle (docs/arms.md)"
              : "");
    }
    in_vain.push_back(trial);
  }
  const std::string tried =
      in_vain.empty() ? "" : "tried in vain: " + listed(in_vain) + "; ";
  return tried + (of_films ? "arms that pinch stand when each has liquid of "
                             "its own, a cap at its waist and a body on either "
                             "side (docs/arms.md), or a spine (docs/spines.md)"
                           : "move or turn the curves there");
}

}  // namespace meniscus::case_films
