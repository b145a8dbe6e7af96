/// Where the lines along which films meet go, to first order in the design.
/// Other vertices of a film move along its normal only; a line that moved
/// alone would run over those beside it after one edge. So the base film X(p)
/// is carried by rims and lines, and lines begin where the reference film's
/// own first-order response has them:
///   u(p) = dx/dX C (r(p) - r(p0)) + dx/dT (T(p) - T(p0)) + ...
/// a constant linear map of the design's numbers (docs/theory.md, Lines).
#pragma once

#include <vector>

#include "evolve/frozen/film_adjoint.h"

namespace meniscus::frozen {

/// Vertices that move in more directions than one, in order: of lines where
/// three films or more meet.
std::vector<int> lines_of(const films::FilmComplex& reference,
                          const energy::FilmSpace& space);

/// Neither copied nor moved: what it is factored from stays in it.
class LineLead {
 public:
  /// A film at rest. `energy` must outlive this; throws as FilmAdjoint.
  LineLead(const energy::FilmEnergy& energy, films::FilmTargets targets,
           Points base, energy::FilmPaths paths, Points points, VectorX heights,
           VectorX pressure, std::vector<int> lines);
  LineLead(const LineLead&) = delete;
  LineLead& operator=(const LineLead&) = delete;

  /// From the reference's numbers to `goal`, without the base.
  FilmAdjoint::Rates differences(const films::FilmTargets& goal) const;

  /// u, zero beside the lines: linear in `rates`, of the base as carried over
  /// lines and of all else that the film rests on.
  Points moves(const FilmAdjoint::Rates& rates) const;

  /// moves() transposed; of `by_moves` only the lines' count.
  FilmAdjoint::Result transpose(const Points& by_moves) const;

 private:
  Points at_lines(const Points& all) const;

  films::FilmTargets targets_;
  Points base_;
  energy::FilmPaths paths_;
  Points points_;
  VectorX heights_;
  VectorX pressure_;
  std::vector<int> lines_;
  FilmAdjoint adjoint_;  // of all these
};

}  // namespace meniscus::frozen
