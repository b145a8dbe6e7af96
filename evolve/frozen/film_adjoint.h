/// The implicit function theorem for a film at rest along fixed directions
/// (docs/theory.md, The film's adjoint). With x = X + h n and
///   F_i = n_i . (dE/dx - sum p dV/dx) = 0,  V(x) = V*,
/// dJ by X, tensions, volumes and pressures follows from one solve with
///   [ H   -B ] [mu ]   [-n . dJ/dx]
///   [ B^T  0 ] [-nu] = [ dJ/dp    ].
#pragma once

#include "evolve/energy/film_products.h"
#include "evolve/energy/saddle_system.h"
#include "evolve/frozen/film_gradient.h"

namespace meniscus::frozen {

/// A film at rest, factored once for any number of responses.
class FilmAdjoint {
 public:
  /// `base`, `paths`: X and x(h) along n(X); `points`: the film at `heights`,
  /// at rest under `pressure` (one per functional). References must outlive
  /// this. Throws SolverError for a Hessian that is not finite.
  FilmAdjoint(const energy::FilmEnergy& energy,
              const films::FilmTargets& targets, const Points& base,
              const energy::FilmPaths& paths, const Points& points,
              const VectorX& heights, const VectorX& pressure);

  struct Result {
    Points base;                   // dJ/dX, one per vertex
    VectorX tensions;              // one per surface
    VectorX volumes;               // one per functional, 0 where none is held
    VectorX pressures;             // one per functional, 0 where it is held
    std::vector<VectorX> numbers;  // of the fields (films::FilmTargets)
  };
  /// Lists of `response` that are not empty must fit.
  Result transpose(const FilmCovector& response) const;

  /// How fast what the film rests on changes with a design variable.
  struct Rates {
    Points base;        // dX, one per vertex
    VectorX tensions;   // one per surface; not read where a field is
    VectorX volumes;    // one per functional; read where one is held
    VectorX pressures;  // one per functional; read where none is held
    std::vector<VectorX> numbers = {};  // of the fields (films::FilmTargets)
  };
  /// dx, one per vertex: the other way through the same system, so that
  /// transpose() of it is transpose().
  Points tangent(const Rates& rates) const;

 private:
  Points direct(const FilmCovector& response) const;
  static Vec3 by_place_of(const energy::FilmPaths::Bent& path,
                          const FilmCovector& response);

  const energy::FilmEnergy& energy_;
  const films::FilmTargets& targets_;
  const Points& base_;
  const energy::FilmPaths& paths_;
  const Points& points_;
  const VectorX& heights_;
  const VectorX& pressure_;
  energy::FilmProducts products_;
  energy::SaddleSystem saddle_;
  Points energy_slope_;  // dE/dx
  Points slope_;         // dE/dx - sum p dV/dx
};

}  // namespace meniscus::frozen
