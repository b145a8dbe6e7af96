#include "evolve/frozen/film_margin.h"

#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "evolve/energy/film_products.h"

namespace meniscus::frozen {

namespace {

/// Modes that count less are below the others' rounding.
constexpr double kNoWeight = 1e-14;

/// Derivatives of one eigenvalue,
///   d lambda = v' (dH - lambda dM) v - 2 kappa' dB' v,
/// with H v = lambda M v + B kappa, v' M v = 1.
class EigenvalueSlope {
 public:
  EigenvalueSlope(const energy::FilmEnergy& energy,
                  const films::FilmTargets& targets, const Points& points,
                  const energy::FilmPaths& paths, const VectorX& pressure,
                  const energy::SaddleSystem& saddle)
      : energy_(energy),
        points_(points),
        paths_(paths),
        saddle_(saddle),
        products_(energy, targets, pressure),
        slope_(energy.gradient(points, targets)) {
    for (int b = 0; b < energy.functionals(); ++b) {
      flat(slope_) -= pressure[b] * flat(saddle.functional_slopes()[b]);
    }
  }

  /// Adds `weight` of them to `by`, whose lists have their sizes.
  void add(double lambda, const VectorX& v, double weight,
           FilmCovector& by) const {
    Points motion(points_.size(), Vec3::Zero());
    for (int i = 0; i < energy_.unknowns(); ++i) {
      motion[energy_.vertices()[i]] += v[i] * paths_.first[i];
    }
    const VectorX kappa = multipliers(lambda, v);
    // H v less what holds the volumes, in all directions.
    Points pull = products_.hessian_times(points_, motion);
    const energy::FilmProducts holding(energy_, -kappa);
    flat(by.points) +=
        weight *
        (flat(products_.third_times(points_, motion)) -
         lambda * flat(products_.metric_gradient(points_, v.cwiseProduct(v))) -
         2.0 * flat(holding.hessian_times(points_, motion)));
    for (int b = 0; b < energy_.functionals(); ++b) {
      flat(pull) -= kappa[b] * flat(saddle_.functional_slopes()[b]);
      const energy::FilmProducts one(energy_,
                                     VectorX::Unit(energy_.functionals(), b));
      // L = E - p V: by the pressure, minus the volume's bend.
      by.pressures[b] +=
          weight * flat(one.hessian_times(points_, motion)).dot(flat(motion));
    }
    for (int i = 0; i < energy_.unknowns(); ++i) {
      by.directions[i] += 2.0 * weight * v[i] * pull[energy_.vertices()[i]];
    }
    by.tensions += weight * products_.area_curvatures(points_, motion);
    add_numbers(products_.number_curvatures(points_, motion), weight, by);
    add_bends(v, weight, by);
  }

 private:
  /// Of v' H v what bent walls add, sum v_i^2 L_x . d2x/dh2.
  void add_bends(const VectorX& v, double weight, FilmCovector& by) const {
    Points bend(points_.size(), Vec3::Zero());
    for (const energy::FilmPaths::Bent& path : paths_.bent) {
      const double square = v[path.unknown] * v[path.unknown];
      bend[path.vertex] += square * paths_.second[path.unknown];
      by.bends[path.unknown] += weight * square * slope_[path.vertex];
    }
    if (paths_.bent.empty()) {
      return;
    }
    flat(by.points) += weight * flat(products_.hessian_times(points_, bend));
    for (int b = 0; b < energy_.functionals(); ++b) {
      by.pressures[b] -=
          weight * flat(saddle_.functional_slopes()[b]).dot(flat(bend));
    }
    by.tensions += weight * products_.area_rates(points_, bend);
    add_numbers(products_.number_slopes(points_, bend, 0.0), weight, by);
  }

  static void add_numbers(const std::vector<VectorX>& more, double weight,
                          FilmCovector& by) {
    by.numbers.resize(more.size());
    for (std::size_t q = 0; q < more.size(); ++q) {
      if (by.numbers[q].size() == 0) {
        by.numbers[q] = weight * more[q];
      } else {
        by.numbers[q] += weight * more[q];
      }
    }
  }

  /// kappa, one per functional: 0 where none is held.
  VectorX multipliers(double lambda, const VectorX& v) const {
    VectorX result = VectorX::Zero(energy_.functionals());
    const Eigen::MatrixXd& b = saddle_.constraints();
    if (b.cols() == 0) {
      return result;
    }
    const VectorX left = saddle_.hessian().selfadjointView<Eigen::Lower>() * v -
                         lambda * saddle_.metric().cwiseProduct(v);
    const VectorX found = least_squares(b, left).x;
    for (std::size_t k = 0; k < saddle_.held().size(); ++k) {
      result[saddle_.held()[k]] = found[static_cast<Eigen::Index>(k)];
    }
    return result;
  }

  const energy::FilmEnergy& energy_;
  const Points& points_;
  const energy::FilmPaths& paths_;
  const energy::SaddleSystem& saddle_;
  energy::FilmProducts products_;
  Points slope_;  // dE/dx - sum p dV/dx
};

}  // namespace

FilmResponse film_margin(const energy::FilmEnergy& energy,
                         const films::FilmTargets& targets,
                         const Points& points, const energy::FilmPaths& paths,
                         const VectorX& pressure,
                         const energy::SaddleSystem& saddle, double scale,
                         const MarginOptions& options) {
  if (options.modes < 1 || !(options.sharpness > 0.0) || !(scale > 0.0)) {
    throw InvalidInput(fmt::format(
        "a film's margin needs modes, sharpness and scale above 0, found {}, "
        "{} and {}",
        options.modes, options.sharpness, scale));
  }
  if (!saddle.factored() || saddle.system().index() != 0) {
    throw energy::ModesNotFound(
        "the margin of an unstable film is not defined");
  }
  const energy::LowestModes lowest =
      saddle.system().lowest_modes(saddle.metric(), options.modes);
  const VectorX& lambda = lowest.eigenvalues;
  if (lambda.size() == 0) {
    throw InvalidInput("a film without free vertices has no margin");
  }
  const double s = options.sharpness / scale;
  VectorX weight = (-s * (lambda.array() - lambda[0])).exp();
  FilmResponse result;
  result.value = lambda[0] - std::log(weight.sum()) / s;
  weight /= weight.sum();
  result.by.points.assign(points.size(), Vec3::Zero());
  result.by.directions.assign(paths.first.size(), Vec3::Zero());
  result.by.bends.assign(paths.first.size(), Vec3::Zero());
  result.by.pressures = VectorX::Zero(energy.functionals());
  result.by.tensions =
      VectorX::Zero(static_cast<Eigen::Index>(targets.tension.size()));
  const EigenvalueSlope slope(energy, targets, points, paths, pressure, saddle);
  for (Eigen::Index j = 0; j < lambda.size() && weight[j] > kNoWeight; ++j) {
    slope.add(lambda[j], lowest.modes.col(j), weight[j], result.by);
  }
  return result;
}

}  // namespace meniscus::frozen
