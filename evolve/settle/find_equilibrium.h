/// From a raw start to a settled film, without a recipe.
#pragma once

#include "evolve/settle/equilibrium.h"

namespace meniscus::settle {

struct FindOptions {
  /// Edge of the film that comes out [length], > 0. Empty: the start's
  /// triangulation stays as it is.
  std::optional<double> edge;
  int halvings = 1;  // the start's edge is edge x 2^halvings
  /// Without `edge`: nested 1:4 refinements of the start, each film settled
  /// from the one before. The facet count is 4^refinements x the start's.
  int refinements = 0;
  int max_rounds = 10;  // of flow and remeshing on the coarsest level
  SettleOptions settle;
};

/// What is said of junctions that no film keeps (evolve/groom/junctions.h).
inline constexpr const char* kPopHelps =
    "popping it splits it and lowers the energy";

/// Throws InvalidInput where no vertex of the film can move.
void require_motion(const films::FilmComplex& complex);

/// Coarse to fine: curvature flow with remeshing until the film is near rest
/// at its volumes, nested refinement, remeshing to the next edge, and Newton
/// along current normals at the end. A film that this does not find is looked
/// for once more, from the fat side by short steps, where no edge is asked for
/// and 1500 facets or more are. `complex` becomes the settled film. The state's
/// failure tells when there is none: FilmPinched, FilmUnstable, FilmNotFound,
/// in a bounded number of steps. Throws InvalidInput when the edge is so long
/// that no vertex is free, and Interrupted.
FilmState find_equilibrium(films::FilmComplex& complex,
                           const FindOptions& options);

}  // namespace meniscus::settle
