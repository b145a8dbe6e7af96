// Gradients of a FilmModel by its design.
#include "evolve/frozen/film_gradient.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "evolve/energy/pole_field.h"
#include "evolve/frozen/film_adjoint.h"
#include "evolve/frozen/film_margin.h"
#include "evolve/frozen/film_model_impl.h"
#include "evolve/frozen/film_radius.h"
#include "evolve/spines/spine_poles.h"

namespace meniscus::frozen {

namespace {

/// A state's heights must put its points where they are.
constexpr double kSamePlace = 1e-9;  // of the film's size

void check_size(const char* what, std::size_t found, std::size_t expected) {
  if (found != 0 && found != expected) {
    throw InvalidInput(fmt::format(
        "a film response has {} derivatives by {}, expected {} or none", found,
        what, expected));
  }
}

std::string no_curve(const std::string& name) {
  return fmt::format(
      "the design or its rates have no curve '{}', which the model has", name);
}

template <class Named>
const Named* find_named(const std::vector<Named>& list,
                        const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(),
                   [&](const Named& item) { return item.name == name; });
  return found == list.end() ? nullptr : &*found;
}

/// How fast the energy per wetted area of a cap's wall changes.
double wall_tension(const films::FilmSystem& rates, const std::string& cap) {
  const films::CapSpec* moving = find_named(rates.caps, cap);
  return moving != nullptr && moving->wall ? moving->wall->tension : 0.0;
}

}  // namespace

void FilmModel::Impl::check_response(const FilmCovector& response) const {
  const auto size = [](const VectorX& v) {
    return static_cast<std::size_t>(v.size());
  };
  check_size("points", response.points.size(), complex.vertices.size());
  check_size("pressures", size(response.pressures), complex.bodies.size());
  check_size("volumes", size(response.volumes), complex.bodies.size());
  check_size("areas", size(response.areas), complex.surfaces.size());
  check_size("tensions", size(response.tensions), complex.surfaces.size());
  check_size("directions", response.directions.size(),
             static_cast<std::size_t>(energy->unknowns()));
  check_size("numbers", response.numbers.size(), targets.numbers.size());
  check_size("bends", response.bends.size(),
             static_cast<std::size_t>(energy->unknowns()));
}

FilmModel::Impl::AtRest FilmModel::Impl::at_rest(
    const settle::FilmState& state, const films::FilmSystem& system) const {
  if (!carry || state.failure) {
    throw InvalidInput("a film that was not found has no gradient: " +
                       state.report.verdict);
  }
  if (state.points.size() != complex.vertices.size() ||
      state.heights.size() != energy->unknowns() ||
      state.report.bodies.size() != complex.bodies.size()) {
    throw InvalidInput("the film's state is not of this model");
  }
  AtRest film;
  film.targets = targets_of_system(system);
  film.base =
      base_at(carry->rim_moves(curves_of_system(system)), film.targets, 1.0);
  film.directions = energy->space().directions(film.base);
  film.pressure.resize(energy->functionals());
  for (int b = 0; b < energy->functionals(); ++b) {
    film.pressure[b] =
        state.report.bodies[static_cast<std::size_t>(b)].pressure;
  }
  film.paths = energy->space().paths(film.base, film.directions, state.heights);
  Points there =
      energy->space().moved(film.base, film.directions, state.heights);
  carry->follow(there);
  const double off = (flat(there) - flat(state.points)).cwiseAbs().maxCoeff();
  if (!(off <= kSamePlace * bounding_diagonal(state.points))) {
    throw InvalidInput(fmt::format(
        "the film's state is not of this design: its points are {:.3g} away "
        "from where its curves and heights put them",
        off));
  }
  return film;
}

FilmGradient FilmModel::Impl::gradient_of(FilmAdjoint::Result found) const {
  Points by_rim = carry->transpose(found.base);
  if (lead) {
    // The base follows lines, which follow all else to first order.
    const FilmAdjoint::Result by = lead->transpose(by_rim);
    flat(by_rim) += flat(carry->transpose_over_lines(by.base));
    found.tensions += by.tensions;
    found.volumes += by.volumes;
    found.pressures += by.pressures;
    for (std::size_t q = 0; q < found.numbers.size(); ++q) {
      found.numbers[q] += by.numbers[q];
    }
  }
  return {rim_gradients(by_rim), found.tensions, found.volumes, found.pressures,
          found.numbers};
}

std::vector<RimGradient> FilmModel::Impl::rim_gradients(
    const Points& by_rim) const {
  std::vector<RimGradient> result(complex.curves.size());
  for (std::size_t c = 0; c < result.size(); ++c) {
    result[c].curve = complex.curves[c].name;
  }
  for (std::size_t c = 0; c < result.size(); ++c) {
    for (const Carry::Stand& stand : carry->stands()[c]) {
      result[c].parameters.push_back(stand.t);
      result[c].by_points.push_back(stand.weight * by_rim[stand.vertex]);
    }
  }
  return result;
}

std::vector<FilmGradient> FilmModel::transpose(
    const settle::FilmState& state, const films::FilmSystem& system,
    const std::vector<FilmCovector>& responses) const {
  const Impl::AtRest film = impl_->at_rest(state, system);
  for (const FilmCovector& response : responses) {
    impl_->check_response(response);
  }
  if (impl_->energy->unknowns() == 0) {
    return impl_->rigid_gradients(responses);
  }
  const FilmAdjoint adjoint(*impl_->energy, film.targets, film.base, film.paths,
                            state.points, state.heights, film.pressure);
  std::vector<FilmGradient> result;
  result.reserve(responses.size());
  for (FilmCovector response : responses) {
    impl_->carry->fold_caps(state.points, response.points);
    result.push_back(impl_->gradient_of(adjoint.transpose(response)));
  }
  return result;
}

std::vector<Points> FilmModel::tangents(
    const settle::FilmState& state, const films::FilmSystem& system,
    const std::vector<films::FilmSystem>& rates) const {
  const Impl::AtRest film = impl_->at_rest(state, system);
  std::vector<Points> result;
  result.reserve(rates.size());
  if (impl_->energy->unknowns() == 0) {
    for (const films::FilmSystem& moving : rates) {
      result.push_back(impl_->rates_of(system, moving).base);
    }
    return result;
  }
  const FilmAdjoint adjoint(*impl_->energy, film.targets, film.base, film.paths,
                            state.points, state.heights, film.pressure);
  for (const films::FilmSystem& moving : rates) {
    result.push_back(adjoint.tangent(impl_->rates_of(system, moving)));
    impl_->carry->follow_rates(state.points, result.back());
  }
  return result;
}

std::vector<VectorX> FilmModel::Impl::number_rates(
    const films::FilmSystem& system, const films::FilmSystem& rates) const {
  std::vector<VectorX> result;
  for (std::size_t q = 0; q < complex.quantities.size(); ++q) {
    result.push_back(complex.quantities[q].kind ==
                             films::FilmQuantity::Kind::BodyPoles
                         ? energy::pole_rate_numbers(spines::pole_rates(
                               complex.spines, complex.quantities[q].body,
                               system.spines, rates.spines))
                         : scalar_numbers(rates, q));
  }
  for (const films::ComplexSurface& surface : complex.surfaces) {
    const films::FilmSpec* film =
        surface.liquid ? find_named(rates.films, surface.name) : nullptr;
    result.push_back(film != nullptr ? films::tension_numbers(*film)
                                     : VectorX());
  }
  return result;
}

FilmAdjoint::Rates FilmModel::Impl::rates_of(
    const films::FilmSystem& system, const films::FilmSystem& rates) const {
  const auto bodies = static_cast<Eigen::Index>(complex.bodies.size());
  FilmAdjoint::Rates result{
      .base = Points(complex.vertices.size(), Vec3::Zero()),
      .tensions =
          VectorX::Zero(static_cast<Eigen::Index>(complex.surfaces.size())),
      .volumes = VectorX::Zero(energy->functionals()),
      .pressures = VectorX::Zero(energy->functionals())};
  // Rim points move at fixed parameters of their curves.
  for (std::size_t c = 0; c < complex.curves.size(); ++c) {
    const std::string& name = complex.curves[c].name;
    const curves::Curve* curve = find_named(system.curves, name);
    const curves::Curve* moving = find_named(rates.curves, name);
    if (curve == nullptr || moving == nullptr) {
      throw InvalidInput(no_curve(name));
    }
    const std::vector<Carry::Stand>& stands = carry->stands()[c];
    std::vector<double> parameters;
    parameters.reserve(stands.size());
    for (const Carry::Stand& stand : stands) {
      parameters.push_back(stand.t);
    }
    const Points moves =
        curves::point_rates(curve->shape, moving->shape, parameters);
    for (std::size_t k = 0; k < stands.size(); ++k) {
      result.base[stands[k].vertex] += stands[k].weight * moves[k];
    }
  }
  const Points of_rims = result.base;
  // Tensions, volumes and pressures are direct numbers of the system.
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    const films::FilmSpec* film =
        find_named(rates.films, complex.surfaces[s].numbers_of());
    if (film != nullptr && complex.surfaces[s].liquid) {
      result.tensions[static_cast<Eigen::Index>(s)] = film->tension;
    } else if (complex.surfaces[s].wetted) {
      result.tensions[static_cast<Eigen::Index>(s)] =
          wall_tension(rates, complex.surfaces[s].name);
    }
  }
  // Fields follow the design by their numbers, poles by their spines.
  result.numbers = number_rates(system, rates);
  for (Eigen::Index b = 0; b < bodies; ++b) {
    const films::BodySpec* body = find_named(
        rates.bodies, complex.bodies[static_cast<std::size_t>(b)].name);
    if (body != nullptr) {
      result.volumes[b] = body->volume.value_or(0.0);
      result.pressures[b] = body->pressure.value_or(0.0);
    }
  }
  // The rest of the base follows by the constant weights of the discrete
  // harmonic extension, dX = C dr, of rims and of lines where they are led to.
  Points given = of_rims;
  if (lead) {
    result.base = carry->rates_over_lines(of_rims);
    flat(given) += flat(lead->moves(result));
  }
  result.base = carry->rates(given);
  return result;
}

double FilmModel::rate(const FilmGradient& gradient,
                       const films::FilmSystem& system,
                       const films::FilmSystem& rates) const {
  double sum = 0.0;
  for (const RimGradient& rim : gradient.rims) {
    const curves::Curve* curve = find_named(system.curves, rim.curve);
    const curves::Curve* moving = find_named(rates.curves, rim.curve);
    if (curve == nullptr || moving == nullptr) {
      throw InvalidInput(no_curve(rim.curve));
    }
    const Points moves =
        curves::point_rates(curve->shape, moving->shape, rim.parameters);
    sum += flat(moves).dot(flat(rim.by_points));
  }
  for (std::size_t s = 0; s < impl_->complex.surfaces.size(); ++s) {
    const films::FilmSpec* film =
        find_named(rates.films, impl_->complex.surfaces[s].numbers_of());
    if (film != nullptr && impl_->complex.surfaces[s].liquid) {
      sum += gradient.tensions[static_cast<Eigen::Index>(s)] * film->tension;
    } else if (impl_->complex.surfaces[s].wetted) {
      sum += gradient.tensions[static_cast<Eigen::Index>(s)] *
             wall_tension(rates, impl_->complex.surfaces[s].name);
    }
  }
  const std::vector<VectorX> numbers = impl_->number_rates(system, rates);
  for (std::size_t q = 0; q < gradient.numbers.size(); ++q) {
    if (gradient.numbers[q].size() > 0) {
      sum += gradient.numbers[q].dot(numbers[q]);
    }
  }
  for (std::size_t b = 0; b < impl_->complex.bodies.size(); ++b) {
    const films::BodySpec* body =
        find_named(rates.bodies, impl_->complex.bodies[b].name);
    if (body != nullptr) {
      const auto at = static_cast<Eigen::Index>(b);
      sum += gradient.volumes[at] * body->volume.value_or(0.0) +
             gradient.pressures[at] * body->pressure.value_or(0.0);
    }
  }
  return sum;
}

FilmResponse FilmModel::margin(const settle::FilmState& state,
                               const films::FilmSystem& system,
                               const MarginOptions& options) const {
  const Impl::AtRest film = impl_->at_rest(state, system);
  const energy::SaddleSystem saddle(*impl_->energy, film.targets, state.points,
                                    film.paths, film.pressure);
  return film_margin(*impl_->energy, film.targets, state.points, film.paths,
                     film.pressure, saddle, impl_->margin_scale, options);
}

FilmResponse FilmModel::smallest_radius(const Points& points, int power) const {
  return film_radius(*impl_->energy, points, power);
}

VectorX FilmModel::areas(const Points& points) const {
  return impl_->energy->areas(points);
}

const std::vector<std::string>& FilmModel::labels() const {
  return impl_->complex.mesh.labels;
}

Points FilmModel::transpose_surface(const Points& by_corners,
                                    const Points& by_mid_sides) const {
  return impl_->nodes.transpose(by_corners, by_mid_sides,
                                impl_->complex.vertices.size());
}

}  // namespace meniscus::frozen
