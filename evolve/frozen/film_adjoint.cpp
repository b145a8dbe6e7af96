#include "evolve/frozen/film_adjoint.h"

#include "core/error.h"

namespace meniscus::frozen {

namespace {

void add(double factor, const Points& more, Points& sum) {
  if (factor != 0.0) {
    flat(sum) += factor * flat(more);
  }
}

double entry(const VectorX& values, Eigen::Index at) {
  return values.size() > 0 ? values[at] : 0.0;
}

}  // namespace

FilmAdjoint::FilmAdjoint(const energy::FilmEnergy& energy,
                         const films::FilmTargets& targets, const Points& base,
                         const energy::FilmPaths& paths, const Points& points,
                         const VectorX& heights, const VectorX& pressure)
    : energy_(energy),
      targets_(targets),
      base_(base),
      paths_(paths),
      points_(points),
      heights_(heights),
      pressure_(pressure),
      products_(energy, targets, pressure),
      saddle_(energy, targets, points, paths, pressure),
      energy_slope_(energy.gradient(points, targets)),
      slope_(energy_slope_) {
  if (!saddle_.factored()) {
    throw energy::ModesNotFound(
        "the film's Hessian is not finite: it has no gradient by its design");
  }
  for (int b = 0; b < energy.functionals(); ++b) {
    add(-pressure[b], saddle_.functional_slopes()[b], slope_);
  }
}

/// dJ/dx at fixed pressures and directions.
Points FilmAdjoint::direct(const FilmCovector& response) const {
  Points sum = response.points;
  sum.resize(points_.size(), Vec3::Zero());
  add(response.energy, energy_slope_, sum);
  for (Eigen::Index b = 0; b < response.volumes.size(); ++b) {
    add(response.volumes[b], saddle_.functional_slopes()[b], sum);
  }
  if (response.areas.size() > 0) {
    add(1.0, energy_.area_gradient(points_, response.areas), sum);
  }
  return sum;
}

/// What the response knows of a bent path by X + h n.
Vec3 FilmAdjoint::by_place_of(const energy::FilmPaths::Bent& path,
                              const FilmCovector& response) {
  const auto i = static_cast<std::size_t>(path.unknown);
  Vec3 sum = Vec3::Zero();
  if (!response.directions.empty()) {
    sum += path.onto.bend_along(path.direction).transpose() *
           response.directions[i];
  }
  if (!response.bends.empty()) {
    sum +=
        films::bend_slope(path.wall, path.place, path.direction).transpose() *
        response.bends[i];
  }
  return sum;
}

FilmAdjoint::Result FilmAdjoint::transpose(const FilmCovector& response) const {
  Result result;
  // g: what the response knows by the vertices; areas, volumes and the energy
  // folded in.
  result.base = direct(response);
  // The saddle system [A -B; B' 0] [mu; -nu] = [-n . g; j], that of Newton's
  // steps, solved with the factor at the film.
  const std::vector<int>& held = saddle_.held();
  VectorX by_pressure = VectorX::Zero(saddle_.constraints().cols());
  for (std::size_t k = 0; k < held.size(); ++k) {
    by_pressure[static_cast<Eigen::Index>(k)] =
        entry(response.pressures, held[k]);
  }
  // On bent walls dx/dh and d2x/dh2 change with the place X + h n.
  VectorX slope = energy_.along(result.base, paths_.first);
  std::vector<Vec3> by_place;
  for (const energy::FilmPaths::Bent& path : paths_.bent) {
    by_place.push_back(by_place_of(path, response));
    slope[path.unknown] += by_place.back().dot(path.direction);
  }
  const energy::ConstrainedHessian::Step step =
      saddle_.solve(slope, by_pressure);
  const VectorX& mu = step.dh;
  // G = g + (E_xx - sum p V_xx) d + sum nu V_x with d = sum mu n: the
  // derivative by the film's base at fixed directions.
  Points motion(points_.size(), Vec3::Zero());  // sum mu n
  for (int i = 0; i < energy_.unknowns(); ++i) {
    motion[energy_.vertices()[i]] += mu[i] * paths_.first[i];
  }
  add(1.0, products_.hessian_times(points_, motion), result.base);
  result.volumes = VectorX::Zero(energy_.functionals());
  result.pressures = VectorX::Zero(energy_.functionals());
  for (std::size_t k = 0; k < held.size(); ++k) {
    const double nu = -step.dp[static_cast<Eigen::Index>(k)];
    result.volumes[held[k]] = -nu;
    add(nu, saddle_.functional_slopes()[held[k]], result.base);
  }
  // dJ/dp = j - d . V_x where a pressure is given, and dJ/dT_s = d . dA_s/dx +
  // dJ/dE A_s.
  for (int b = 0; b < energy_.functionals(); ++b) {
    if (!targets_.bodies[b].volume) {
      result.pressures[b] =
          entry(response.pressures, b) -
          flat(saddle_.functional_slopes()[b]).dot(flat(motion));
    }
  }
  result.tensions = products_.area_rates(points_, motion) +
                    response.energy * energy_.areas(points_);
  for (Eigen::Index s = 0; s < result.tensions.size(); ++s) {
    result.tensions[s] = energy_.has_tension(static_cast<int>(s))
                             ? result.tensions[s] + entry(response.tensions, s)
                             : 0.0;
  }
  result.numbers = products_.number_slopes(points_, motion, response.energy);
  for (std::size_t q = 0; q < response.numbers.size(); ++q) {
    result.numbers[q] += response.numbers[q];
  }
  // N_i = h_i G_i + mu_i (E_x - sum p V_x)_i by the directions, carried on to
  // the base points that make them.
  Points by_first = response.directions;  // by dx/dh
  by_first.resize(paths_.first.size(), Vec3::Zero());
  for (int i = 0; i < energy_.unknowns(); ++i) {
    by_first[i] += mu[i] * slope_[energy_.vertices()[i]];
  }
  // On bent walls x = P(y), y = X + h n: back through P, P' n and P'' n n.
  for (std::size_t k = 0; k < paths_.bent.size(); ++k) {
    const energy::FilmPaths::Bent& path = paths_.bent[k];
    const int i = path.unknown;
    const Eigen::Matrix3d bend = path.onto.bend_along(path.direction);
    Vec3& by = result.base[path.vertex];
    by = path.onto.slope.transpose() * by +
         mu[i] * bend.transpose() * slope_[path.vertex] + by_place[k];
    by_first[i] = path.onto.slope.transpose() * by_first[i];
    if (!response.bends.empty()) {
      by_first[i] += 2.0 * bend.transpose() * response.bends[i];
    }
  }
  Points by_directions = by_first;
  for (int i = 0; i < energy_.unknowns(); ++i) {
    by_directions[i] += heights_[i] * result.base[energy_.vertices()[i]];
  }
  energy_.space().transpose_directions(base_, by_directions, result.base);
  return result;
}

Points FilmAdjoint::tangent(const Rates& rates) const {
  const Points turning = energy_.space().direction_rates(base_, rates.base);
  Points motion = rates.base;  // at fixed heights
  for (int i = 0; i < energy_.unknowns(); ++i) {
    motion[energy_.vertices()[i]] += heights_[i] * turning[i];
  }
  Points turned = turning;  // dx/dh
  for (const energy::FilmPaths::Bent& path : paths_.bent) {
    Vec3& move = motion[path.vertex];
    Vec3& turn = turned[path.unknown];
    turn = path.onto.slope * turn + path.onto.bend_along(path.direction) * move;
    move = path.onto.slope * move;
  }
  Points slope_rate = products_.hessian_times(points_, motion);
  VectorX tensions = rates.tensions;
  for (Eigen::Index s = 0; s < tensions.size(); ++s) {
    tensions[s] = energy_.has_tension(static_cast<int>(s)) ? tensions[s] : 0.0;
  }
  if (!tensions.isZero(0.0)) {
    add(1.0, energy_.area_gradient(points_, tensions), slope_rate);
  }
  add(1.0, products_.number_motion(points_, rates.numbers), slope_rate);
  const std::vector<int>& held = saddle_.held();
  VectorX missing = VectorX::Zero(saddle_.constraints().cols());
  for (std::size_t k = 0; k < held.size(); ++k) {
    missing[static_cast<Eigen::Index>(k)] =
        rates.volumes[held[k]] -
        flat(saddle_.functional_slopes()[held[k]]).dot(flat(motion));
  }
  for (int b = 0; b < energy_.functionals(); ++b) {
    if (!targets_.bodies[b].volume) {
      add(-rates.pressures[b], saddle_.functional_slopes()[b], slope_rate);
    }
  }
  VectorX residual = energy_.along(slope_rate, paths_.first);
  for (int i = 0; i < energy_.unknowns(); ++i) {
    residual[i] += turned[i].dot(slope_[energy_.vertices()[i]]);
  }
  const energy::ConstrainedHessian::Step step =
      saddle_.solve(residual, missing);
  for (int i = 0; i < energy_.unknowns(); ++i) {
    motion[energy_.vertices()[i]] += step.dh[i] * paths_.first[i];
  }
  return motion;
}

}  // namespace meniscus::frozen
