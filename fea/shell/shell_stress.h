/// Stresses of a solved shell at both faces and in the middle of the wall, or
/// of each ply.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "fea/element/stress_measures.h"
#include "fea/shell/facet_rule.h"
#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// Along x y z [pressure]. At the faces in the outer plies, with the pressures
/// there along the normal; in the middle in the lower of two plies. Transverse
/// shears are their mean times the parabola of a homogeneous wall: 0 at its
/// faces, 3/2 in the middle.
struct WallStress {
  element::Stress negative, middle, positive;
};

/// Three points inside, where strains of quadratic facets are of one order more
/// (Barlow, Int. J. Numer. Methods Eng. 10, 1976).
const std::array<FacetPoint, 3>& stress_points();
/// At a node: of point q of the linear function through the three.
double node_share(int node, int q);

/// At a facet's six nodes, by these.
using FacetStress = std::array<WallStress, kNodes>;

/// `displacement`: 6 per node, the solution under `loads` (whose temperature
/// counts). One per facet; the same bits for any number of threads. Throws
/// MeshError and InvalidInput as ShellSystem does.
std::vector<FacetStress> shell_stress(const ShellMesh& mesh,
                                      const std::vector<Section>& sections,
                                      const ShellLoads& loads,
                                      const VectorX& displacement);

/// The same of each ply in turn, from the negative face on: `visit`ed with its
/// number and its stresses at both its faces and half way between. Facets with
/// fewer plies have none: 0.
void visit_ply_stresses(
    const ShellMesh& mesh, const std::vector<Section>& sections,
    const ShellLoads& loads, const VectorX& displacement,
    const std::function<void(int ply, const std::vector<FacetStress>& stress)>&
        visit);

/// Means over the facets at each node that are of one section and lie in one
/// smooth surface there: of those whose normals turn less than `fold` from the
/// facet's own [rad]. As shell_stress() returns them.
std::vector<FacetStress> averaged_stress(const ShellMesh& mesh,
                                         const std::vector<FacetStress>& stress,
                                         double fold = 0.35);

}  // namespace meniscus::shell
