#include "pipeline/case_data/film_advice.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/geometry/mesh_checks.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::case_data {

namespace {

using Names = std::set<std::string>;

/// Films that the message names; all where it names none.
Names films_named(const films::FilmSystem& system, const std::string& message) {
  Names named;
  Names all;
  for (const films::FilmSpec& film : system.films) {
    all.insert(film.name);
    if (message.find("'" + film.name + "'") != std::string::npos) {
      named.insert(film.name);
    }
  }
  return named.empty() ? all : named;
}

/// Bodies of given volume that these films enclose, by index.
std::vector<std::size_t> bodies_beside(const films::FilmSystem& system,
                                       const Names& films) {
  std::vector<std::size_t> found;
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    const films::BodySpec& body = system.bodies[b];
    if (body.volume &&
        std::any_of(
            body.enclosed_by.begin(), body.enclosed_by.end(),
            [&](const std::string& name) { return films.count(name) > 0; })) {
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

/// One change of the case and what it is called.
struct Trial {
  std::string what;  // "1.3 times the volume of 'part' (1.17e+05 mm3)"
  films::FilmSystem system;
};

std::vector<Trial> trials_of(const EvaluatedCase& inputs, const Names& films) {
  constexpr std::array<double, 4> kVolumes = {1.3, 1.7, 2.2, 0.75};
  constexpr double kRims = 1.3;
  std::vector<Trial> trials;
  const films::FilmSystem& system = inputs.film_system;
  const std::vector<std::size_t> bodies = bodies_beside(system, films);
  for (const double factor : kVolumes) {
    if (bodies.empty()) {
      break;
    }
    Trial trial{"", system};
    std::vector<std::string> names;
    for (const std::size_t b : bodies) {
      films::BodySpec& body = trial.system.bodies[b];
      *body.volume *= factor;
      names.push_back(
          fmt::format("'{}' (volume = {:.4g})", body.name, *body.volume));
    }
    trial.what = fmt::format("{:g} times the volume of {}", factor,
                             fmt::join(names, " and "));
    trials.push_back(std::move(trial));
  }
  Trial trial{"", system};
  if (enlarge_rims(trial.system, films, kRims)) {
    trial.what = fmt::format("rims of {} {:g} times as large",
                             fmt::join(films, " and "), kRims);
    trials.push_back(std::move(trial));
  }
  return trials;
}

/// Passes on a stop and says nothing.
class QuietMonitor : public Monitor {
 public:
  explicit QuietMonitor(const Monitor& outer) : outer_(outer) {}
  bool stop_requested() const override { return outer_.stop_requested(); }

 private:
  const Monitor& outer_;
};

bool stands(const films::FilmSystem& system, double edge, Monitor& monitor) {
  try {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        system, {.edge = edge, .refinements = 0, .monitor = &monitor});
    return !model.reference().failure &&
           (system.bodies.empty() ||
            check_surface(model.boundary(model.reference().points)).empty());
  } catch (const InvalidInput&) {  // rims that meet, a body that stays open
    return false;
  } catch (const MeshError&) {
    return false;
  }
}

}  // namespace

bool is_of_films(const Failure& failure) {
  return failure.kind == FailureKind::FilmPinched ||
         failure.kind == FailureKind::FilmUnstable ||
         failure.kind == FailureKind::FilmNotFound;
}

std::string tried_advice(const EvaluatedCase& inputs, const Failure& failure,
                         const AdviceOptions& options) {
  if (!is_of_films(failure) || inputs.film_system.films.empty()) {
    return "";
  }
  Monitor& outer =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  QuietMonitor quiet(outer);
  const Names films = films_named(inputs.film_system, failure.message);
  std::vector<std::string> in_vain;
  for (const Trial& trial : trials_of(inputs, films)) {
    outer.progress({.stage = "film", .detail = "trying " + trial.what});
    if (stands(trial.system, options.edge, quiet)) {
      return fmt::format(
          "tried: with {} the film stands{}; an arm longer than six times its "
          "radius stands with less by a cap in its middle (docs/arms.md)",
          trial.what,
          in_vain.empty() ? ""
                          : fmt::format("; not with {}",
                                        fmt::join(in_vain, ", nor with ")));
    }
    in_vain.push_back(trial.what);
  }
  const std::string tried =
      in_vain.empty()
          ? ""
          : fmt::format("tried in vain: {}; ", fmt::join(in_vain, "; "));
  return tried +
         "arms that pinch stand when each has liquid of its own: a cap at its "
         "waist, a body on either side (docs/arms.md)";
}

}  // namespace meniscus::case_data
