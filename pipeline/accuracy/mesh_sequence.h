/// One design on the case's own mesh and on others, for the errors of its
/// figures (mesh_errors.h).
#pragma once

#include <array>
#include <string>

#include "core/math/dense.h"
#include "core/monitor.h"
#include "pipeline/accuracy/finer_film.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/eigen_figures.h"
#include "pipeline/forward/stage_meter.h"

namespace meniscus::accuracy {

/// Edges of the meshes, times the case's own. The last is made only where
/// neither of the two before can be, or both cut the part as the first does.
inline constexpr std::array<double, 4> kEdgeFactors = {
    1.0, 1.4142135623730951, 2.0, 0.70710678118654752};
inline constexpr std::size_t kFinerMesh = 3;

/// Meshes whose figures differ by less, relative, cut the part alike (the least
/// number of facets on a rim, plane faces): they tell nothing of its error.
inline constexpr double kAlike = 1e-12;

struct MeshSequence {
  /// By mesh, one each in the case's order; empty: that model failed, or was
  /// not made.
  std::array<VectorX, kEdgeFactors.size()> responses;
  std::array<forward::EigenFigures, kEdgeFactors.size()> eigen;
  /// Of each load case, the highest reading of its peak stress (peak_stress.h)
  /// [pressure]; empty as responses are. That of the first mesh is the
  /// caller's.
  std::array<std::vector<double>, kEdgeFactors.size()> peaks;
  std::array<std::string, kEdgeFactors.size()> failures;  // why it failed
  FinerFilm finer_film;           // where the caller adds it
  forward::StageSeconds seconds;  // of the models that were made for it

  bool has_coarser() const {
    return responses[1].size() > 0 || responses[2].size() > 0;
  }
  bool has_others() const {
    return has_coarser() || responses[kFinerMesh].size() > 0;
  }
};

/// The design on the other meshes; `responses` are those of the first, which
/// is of `input`'s own edges. `with_eigen`: buckling and frequencies of the
/// others, too. Throws Interrupted.
MeshSequence evaluate_on_other_meshes(const case_data::Case& input,
                                      const VectorX& design,
                                      const VectorX& responses, bool with_eigen,
                                      Monitor& monitor);

}  // namespace meniscus::accuracy
