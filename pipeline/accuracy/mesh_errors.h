/// Discretisation errors of figures from what they are on several meshes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math/dense.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/eigen_figures.h"

namespace meniscus::study {

/// Edges of the meshes, times the case's own. The last is made only where
/// neither of the two before can be.
inline constexpr std::array<double, 4> kEdgeFactors = {
    1.0, 1.4142135623730951, 2.0, 0.70710678118654752};
inline constexpr std::size_t kFinerMesh = 3;

/// A figure on these meshes, in that order; NaN where it has none.
using MeshValues = std::array<double, 4>;

/// What the figure is of decides what may be assumed of its order.
enum class FigureKind {
  Film,      // areas, energies, pressures, margins of films: no singular rims
  Integral,  // displacements, masses, energies, frequencies
  Extreme    // peaks, necks, gaps, buckling factors: local, of no known order
};

struct FigureError {
  double bound = 0.0;   // of the first value, both ways, >= 0; NaN where only
                        // that one is known
  bool settles = true;  // false: its changes do not shrink with the edges, as
                        // where there is no limit
};

/// From the changes between the meshes and the order p that they show:
/// F change / (2^p - 1), after P. J. Roache, Verification and validation in
/// computational science and engineering (1998), 5.6, and L. Eca, M. Hoekstra,
/// J. Comput. Phys. 262 (2014) 104. How often it holds, and its constants:
/// docs/decisions/0006-mesh-error.md.
FigureError figure_error(const MeshValues& values, FigureKind kind);

/// The same design on the model and others.
struct MeshSequence {
  /// By mesh, one each in the case's order; empty: that model failed, or was
  /// not made.
  std::array<VectorX, kEdgeFactors.size()> responses;
  std::array<forward::EigenFigures, kEdgeFactors.size()> eigen;
  std::array<std::string, kEdgeFactors.size()> failures;  // why it failed

  bool has_coarser() const {
    return responses[1].size() > 0 || responses[2].size() > 0;
  }
  bool has_others() const {
    return has_coarser() || responses[kFinerMesh].size() > 0;
  }
};

/// Of each response; `dual`: of the elements alone where estimated (NaN where
/// not; empty: none), no bound is below it.
std::vector<FigureError> response_errors(const case_data::Case& input,
                                         const MeshSequence& meshes,
                                         const VectorX& dual);

/// Gives the figures of the first mesh their errors.
void add_eigen_errors(MeshSequence& meshes);

/// A sentence for each response whose changes do not shrink, with its values.
std::vector<std::string> unsettled_warnings(
    const case_data::Case& input, const MeshSequence& meshes,
    const std::vector<FigureError>& errors);

}  // namespace meniscus::study
