/// Smooth stand-ins for a shell's peak stress.
#pragma once

#include <vector>

#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

enum class NormDerivatives { None, All };

/// Its derivatives, all else held: nodal displacements too, not the bubbles,
/// which follow them.
struct StressNorm {
  double value = 0.0;              // [pressure]
  Points by_nodes;                 // one per node [pressure/length]
  std::vector<Vec3> by_thickness;  // at each facet's corners [the same]
  VectorX by_displacement;         // 6 per node
  PlyGradients by_ply;
  ActionGradient by_actions;
};

/// (mean of s^p)^(1/p) over both faces of the wall, of a laminate over both of
/// each ply, s the von Mises stress there as shell_stress() has it, by the area
/// of the surface; three points a facet.
/// `displacement`: 6 per node, the solution under `loads`. Below the peak of
/// these points, and near to it for a large power. Exact derivatives; the same
/// bits for any number of threads. Throws as shell_stress(), and InvalidInput
/// for a power that is not above 1.
StressNorm von_mises_norm(const ShellMesh& mesh,
                          const std::vector<Section>& sections,
                          const ShellLoads& loads, const VectorX& displacement,
                          double power, NormDerivatives derivatives);

/// scale / sharpness ln(mean of exp(sharpness s / scale)) of the same
/// (Kreisselmeier and Steinhauser's, as functionals/stress_functionals.h).
/// Throws likewise, and for a sharpness or a scale that is not above 0.
struct StressKs {
  double sharpness = 50.0;
  double scale = 1.0;  // [pressure]
};
StressNorm von_mises_ks(const ShellMesh& mesh,
                        const std::vector<Section>& sections,
                        const ShellLoads& loads, const VectorX& displacement,
                        const StressKs& options, NormDerivatives derivatives);

}  // namespace meniscus::shell
