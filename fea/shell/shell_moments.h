/// Where a shell's mass is: its moments, and integrals over it with their
/// derivatives.
#pragma once

#include <vector>

#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// About a point, at all heights in the wall; r: from there.
struct MassMoments {
  double mass = 0.0;
  Vec3 first = Vec3::Zero();   // of r [mass length]
  Mat3 second = Mat3::Zero();  // of r r^T [mass length^2]
};

/// The same bits for any number of threads. Throws as ShellSystem does.
MassMoments mass_moments(const ShellMesh& mesh,
                         const std::vector<Section>& sections,
                         const Vec3& from);

/// What is summed over mass: constant + linear . r + r . square r, `square`
/// symmetric.
struct MassForm {
  double constant = 0.0;
  Vec3 linear = Vec3::Zero();
  Mat3 square = Mat3::Zero();
};

/// Exact derivatives with `from` held. As mass_moments().
ShellGradient mass_integral(const ShellMesh& mesh,
                            const std::vector<Section>& sections,
                            const MassForm& form, const Vec3& from);

}  // namespace meniscus::shell
