#include "evolve/settle/equilibrium.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/timer.h"
#include "evolve/energy/saddle_system.h"
#include "evolve/settle/newton.h"

namespace meniscus::settle {

namespace {

constexpr double kNearRest = 1e-3;   // of the residual / (tension x edge)
constexpr double kUnresolved = 2.0;  // neck below this many edges: pinching
constexpr double kThinned = 0.2;     // a settled film's neck / the usual one
constexpr double kThinning = 0.5;    // the same where no equilibrium was found
constexpr std::array<double, 2> kOffSaddle = {0.1, 0.5};  // x mean edge

std::string place(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

/// Normals that turn at every step make Newton's steps shrink by a factor only,
/// and on a coarse film that may be near 1. From near rest it goes on along the
/// normals as they are, where it converges quadratically.
NewtonResult along_its_normals(const energy::FilmEnergy& energy,
                               const films::FilmTargets& targets,
                               NewtonOptions options, NewtonResult near) {
  options.rule = DirectionRule::Fixed;
  NewtonResult found =
      FilmNewton(energy, targets, options)
          .run(near.points, energy.space().directions(near.points), {});
  if (!found.converged) {
    return near;
  }
  found.iterations += near.iterations;
  return found;
}

bool is_saddle(const FilmState& state) {
  return state.failure && state.failure->kind == FailureKind::FilmUnstable &&
         state.report.index == 1;
}

FilmState settle(const energy::FilmEnergy& energy,
                 const films::FilmComplex& complex,
                 const films::FilmTargets& targets, const Points& base,
                 const Points& directions, const VectorX& start,
                 double usual_neck, const SettleOptions& options,
                 DirectionRule rule) {
  const Timer timer;
  const double tension = films::largest_tension(targets);
  // The bound on the residual is a share of tension x edge, the natural force
  // on a vertex.
  NewtonOptions newton{.rule = rule,
                       .aim = NewtonAim::Minimum,
                       .residual_bound = options.residual_factor * tension *
                                         energy.mean_edge(base),
                       .volume_tolerance = options.volume_tolerance,
                       .max_iterations = options.max_iterations,
                       .monitor = options.monitor};
  NewtonResult found =
      FilmNewton(energy, targets, newton).run(base, directions, start);
  // Normals that turn with the film give linear convergence only: near rest
  // they are fixed.
  if (!found.converged && rule == DirectionRule::CurrentNormals &&
      found.residual <= kNearRest * tension * energy.mean_edge(base)) {
    found = along_its_normals(energy, targets, newton, std::move(found));
  }
  // No minimum: Newton without shifts may still find a saddle, which tells an
  // unstable film from one that does not exist.
  if (!found.converged) {
    newton.aim = NewtonAim::Equilibrium;
    newton.max_iterations = std::min(20, options.max_iterations);
    NewtonResult saddle =
        FilmNewton(energy, targets, newton).run(base, directions, start);
    saddle.iterations += found.iterations;
    if (saddle.converged) {
      found = std::move(saddle);
    }
  }
  // The verdict comes last, from the residual, the index and the neck.
  FilmState state;
  state.report = figures_of(energy, targets, found.points, found.pressure);
  state.report.residual = found.residual;
  state.report.residual_bound = newton.residual_bound;
  state.report.min_eigenvalue = found.min_eigenvalue;
  state.report.index = found.index;
  state.report.iterations = found.iterations;
  state.points = std::move(found.points);
  state.heights = std::move(found.heights);
  set_verdict(energy, complex,
              {found.converged ? "" : found.reason,
               found.mode_position,
               usual_neck,
               {}},
              state);
  state.report.seconds = timer.seconds();
  return state;
}

}  // namespace

FilmReport figures_of(const energy::FilmEnergy& energy,
                      const films::FilmTargets& targets, const Points& points,
                      const VectorX& pressure) {
  FilmReport report;
  report.vertices = static_cast<int>(points.size());
  report.facets = static_cast<int>(energy.facets().size());
  report.energy = energy.value(points, targets);
  report.area = energy.area(points);
  report.tension = films::largest_tension(targets);
  const VectorX volumes = energy.volumes(points);
  for (int b = 0; b < energy.functionals(); ++b) {
    const films::ComplexBody& body = targets.bodies[b];
    report.bodies.push_back(
        {body.name, volumes[b], body.volume.value_or(volumes[b]), pressure[b]});
  }
  return report;
}

VectorX pressures_of(const FilmReport& report) {
  VectorX pressure(std::ssize(report.bodies));
  for (Eigen::Index b = 0; b < pressure.size(); ++b) {
    pressure[b] = report.bodies[static_cast<std::size_t>(b)].pressure;
  }
  return pressure;
}

std::vector<PulledFilm> popped_films(const films::FilmComplex& complex,
                                     const Points& points) {
  std::vector<PulledFilm> result;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    const films::ComplexSurface& surface = complex.surfaces[s];
    if (surface.pulled_from.empty()) {
      continue;
    }
    PulledFilm film{.name = surface.name, .pulled_from = surface.pulled_from};
    for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
      if (complex.mesh.facet_label[f] == static_cast<int>(s)) {
        const auto& [a, b, c] = complex.mesh.facets[f];
        const double area =
            0.5 * (points[b] - points[a]).cross(points[c] - points[a]).norm();
        film.area += area;
        film.place += area / 3.0 * (points[a] + points[b] + points[c]);
      }
    }
    if (film.area > 0.0) {  // else another pop took all of it
      film.place /= film.area;
      result.push_back(std::move(film));
    }
  }
  return result;
}

namespace {

/// Where the film is farthest from rest, by the vertices' residuals.
Vec3 restless_place(const energy::FilmEnergy& energy,
                    const films::FilmComplex& complex, const FilmState& state) {
  const Points directions = energy.space().directions(state.points);
  VectorX residual = energy.along(
      energy.gradient(state.points, energy::targets_of(complex)), directions);
  const VectorX pressure = pressures_of(state.report);
  for (int b = 0; b < energy.functionals(); ++b) {
    residual -=
        pressure[b] *
        energy.along(energy.functional_gradient(state.points, b), directions);
  }
  Eigen::Index at = 0;
  residual.cwiseAbs().maxCoeff(&at);
  return state.points[energy.vertices()[static_cast<std::size_t>(at)]];
}

}  // namespace

void set_verdict(const energy::FilmEnergy& energy,
                 const films::FilmComplex& complex, const VerdictInput& input,
                 FilmState& state) {
  const std::string& reason = input.reason;
  FilmReport& report = state.report;
  const bool finite = std::all_of(state.points.begin(), state.points.end(),
                                  [](const Vec3& p) { return p.allFinite(); });
  const Neck neck =
      input.neck ? *input.neck
      : finite ? narrowest_neck(energy, state.points, complex.mesh.facet_label)
               : Neck{};
  report.popped = popped_films(complex, state.points);
  report.smallest_neck = neck.width;
  report.neck_position = neck.position;
  const double edge = finite ? energy.mean_edge(state.points) : 0.0;
  // A neck is thin by the edges, which no longer resolve it, or by its usual
  // width at the start.
  const double least =
      std::max(kUnresolved * edge,
               input.usual_neck * (reason.empty() ? kThinned : kThinning));
  const bool thin = neck.surface >= 0 && neck.width < least;
  const auto name = [&](int s) { return complex.surfaces[s].name; };
  const std::string where =
      neck.surface < 0
          ? std::string("no neck could be measured")
          : fmt::format("neck of width {:.4g} at {} between '{}' and '{}'",
                        neck.width, place(neck.position), name(neck.surface),
                        name(neck.opposite));
  const auto fail = [&](FailureKind kind, const std::string& verdict) {
    report.verdict = verdict;
    state.failure = Failure{kind, verdict};
  };
  state.failure.reset();
  // A thin neck explains why nothing was found; of a settled film the index
  // counts first.
  if (!reason.empty() && thin) {
    fail(FailureKind::FilmPinched,
         fmt::format("pinching: {} (after {} steps, {})", where,
                     report.iterations, reason));
  } else if (!reason.empty()) {
    fail(FailureKind::FilmNotFound,
         fmt::format("no equilibrium of this topology found after {} steps "
                     "({}; residual {:.3g}, bound {:.3g}{}); {}",
                     report.iterations, reason, report.residual,
                     report.residual_bound,
                     finite && energy.unknowns() > 0
                         ? ", largest at " +
                               place(restless_place(energy, complex, state))
                         : "",
                     where));
  } else if (report.index > 0) {
    fail(FailureKind::FilmUnstable,
         fmt::format("unstable: index {}, lowest eigenvalue {:.4g}, its mode "
                     "is largest at {}; {}",
                     index_text(report), report.min_eigenvalue,
                     place(input.mode_position), where));
  } else if (thin) {
    fail(FailureKind::FilmPinched,
         fmt::format("pinching: {}, below the {:.4g} that this film needs (two "
                     "edges, or a fifth of its neck at the start); shorter "
                     "edges where the part is meant to be this thin",
                     where, least));
  } else {
    report.verdict = "stable";
  }
}

std::string index_text(const FilmReport& film) {
  return fmt::format("{}{}", film.index_at_least ? "at least " : "",
                     film.index);
}

energy::LowestMode lowest_mode_of(const energy::FilmEnergy& energy,
                                  const films::FilmTargets& targets,
                                  const Points& points,
                                  const VectorX& pressure) {
  if (energy.unknowns() == 0) {
    return {};  // nothing moves
  }
  const Points own(points.begin(),
                   points.begin() + energy.space().vertex_count());
  const Points directions = energy.space().directions(own);
  const energy::SaddleSystem saddle(energy, targets, own, {directions, {}, {}},
                                    pressure);
  energy::LowestMode result;
  result.mode = VectorX::Ones(energy.unknowns());
  if (saddle.factored()) {
    result = saddle.system().lowest_mode(saddle.metric());
  }
  return result;
}

FilmState settle_along(const energy::FilmEnergy& energy,
                       const films::FilmComplex& complex,
                       const films::FilmTargets& targets, const Points& base,
                       const Points& directions, const VectorX& start,
                       double usual_neck, const SettleOptions& options) {
  return settle(energy, complex, targets, base, directions, start, usual_neck,
                options, DirectionRule::Fixed);
}

FilmState settle_in_normals(const energy::FilmEnergy& energy,
                            const films::FilmComplex& complex,
                            const films::FilmTargets& targets,
                            const Points& start, const SettleOptions& options,
                            double usual_neck) {
  FilmState state =
      settle(energy, complex, targets, start, energy.space().directions(start),
             {}, usual_neck, options, DirectionRule::CurrentNormals);
  state.heights = VectorX::Zero(energy.unknowns());
  return state;
}

FilmState settle_past_saddles(const energy::FilmEnergy& energy,
                              const films::FilmComplex& complex,
                              const films::FilmTargets& targets,
                              const Points& start, const SettleOptions& options,
                              double usual_neck) {
  const auto settle_from = [&](const Points& points) {
    return settle_in_normals(energy, complex, targets, points, options,
                             usual_neck);
  };
  FilmState saddle = settle_from(start);
  if (!is_saddle(saddle)) {
    return saddle;
  }
  const VectorX mode = lowest_mode_of(energy, targets, saddle.points,
                                      pressures_of(saddle.report))
                           .mode;
  const Points directions = energy.space().directions(saddle.points);
  const double edge = energy.mean_edge(saddle.points);
  for (const double off : kOffSaddle) {
    for (const double height : {off * edge, -off * edge}) {
      Points off_saddle;
      try {
        off_saddle =
            energy.space().moved(saddle.points, directions, height * mode);
      } catch (const energy::OffWalls&) {
        continue;
      }
      FilmState beside = settle_from(off_saddle);
      saddle.report.iterations += beside.report.iterations;
      if (!beside.failure) {
        beside.report.iterations = saddle.report.iterations;
        return beside;
      }
    }
  }
  return saddle;
}

}  // namespace meniscus::settle
