/// Stiffness and mass of a facet.
#pragma once

#include <array>

#include <Eigen/Core>

#include "fea/shell/facet_rule.h"
#include "fea/shell/facet_strain.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/wall_state.h"

namespace meniscus::shell {

/// Six numbers per node: displacement along x y z, rotation vector.
inline constexpr int kUnknowns = 36;
using FacetMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using FacetVector = Eigen::Matrix<double, kUnknowns, 1>;

/// One facet with all that its matrices depend on.
struct Facet {
  std::array<Vec3, kNodes> nodes;
  Vec3 thickness;  // at the corners
  double offset = 0.0;
  const Vec3* direction = nullptr;   // not owned; may be null
  const LaminateLaw* law = nullptr;  // not owned
};

/// How much of the in-plane shear stiffness resists a difference between the
/// rotation about the normal and the surface's own turn (Hughes and Brezzi,
/// Comput. Methods Appl. Mech. Eng. 72, 1989, gamma over mu). Any share
/// converges; much of it stiffens thin doubly curved shells on coarse meshes
/// (decision 0034).
inline constexpr double kDrilling = 1e-3;

/// With the two numbers of the bubble's rotation last: about the axes of the
/// facet's center, as a bubble about the normal would let a rotation about it
/// go without any stretch.
inline constexpr int kWhole = kUnknowns + 2;
using WholeMatrix = Eigen::Matrix<double, kWhole, kWhole>;
using WholeVector = Eigen::Matrix<double, kWhole, 1>;
WholeMatrix whole_stiffness(const Facet& facet,
                            const FacetRule& rule = facet_rule());

/// The bubble takes the rotation of least energy: K u = f of the facet without
/// it. `f` may be null.
FacetMatrix condensed(const WholeMatrix& K, WholeVector* f = nullptr);

/// The bubble's rotation that goes with the nodes' numbers and the loads.
Eigen::Vector2d bubble_rotation(const WholeMatrix& K, const WholeVector& f,
                                const FacetVector& u);

/// Consistent, with the inertia of turning walls; the bubble has none.
FacetMatrix facet_mass(const Facet& facet,
                       const FacetRule& rule = facet_rule());

/// Forces that hold the free strains back.
WholeVector holding_forces(const Facet& facet, const WallStates& states,
                           const FacetRule& rule = facet_rule());

/// The linear functions of the corners at a point, and the thickness there.
Vec3 corner_shares(const FacetPoint& p);
double thickness_at(const Facet& facet, const FacetPoint& p);

/// Density times powers 0, 1, 2 of the height over the surface, integrated over
/// the wall there per area of the surface.
std::array<double, 3> wall_moments(const Facet& facet,
                                   const FacetFrame<double>& frame,
                                   double thickness);

std::array<Triple<double>, kNodes> triples(const Facet& facet);

/// A facet of a mesh that passed check_shell(); `laws` as laminate_laws().
Facet facet_of(const ShellMesh& mesh, const std::vector<Section>& sections,
               const std::vector<LaminateLaw>& laws, int facet);

/// The facet's numbers of 6 per node.
FacetVector numbers_of(const ShellMesh& mesh, int facet, const VectorX& nodal);

}  // namespace meniscus::shell
