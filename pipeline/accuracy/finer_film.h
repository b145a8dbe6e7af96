/// One design's film on its own facets with edges half as long, for the errors
/// of its figures (mesh_errors.h). Nested facets show an order from the first
/// halving on, where those of other meshes may agree by chance.
#pragma once

#include "core/math/dense.h"
#include "core/monitor.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::accuracy {

struct FinerFilm {
  /// The figures of films on these facets and the expressions of them, all
  /// others as they were given; empty where there are none.
  VectorX responses;
  bool is_lost = false;  // the film is not there
  double seconds = 0.0;
};

/// `responses`: of the design by that model. Throws Interrupted.
FinerFilm evaluate_finer_film(const forward::ForwardModel& model,
                              const VectorX& design, const VectorX& responses,
                              Monitor& monitor);

}  // namespace meniscus::accuracy
