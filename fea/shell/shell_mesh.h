/// A shell as values: six-node facets on the nodes of a surface.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "fea/shell/laminate.h"

namespace meniscus::shell {

/// How a wall lies about its surface, and what it is made of.
struct Section {
  Laminate laminate;
  /// Middle of the wall over the surface along the facet's normal, in
  /// thicknesses: 0.5 where the surface is the negative face.
  double offset = 0.0;
  /// Angles of plies count from this direction's projection on the surface, any
  /// length but 0; nothing: from the facet's first edge, for isotropic plies.
  std::optional<Vec3> direction = {};
};

struct ShellMesh {
  Points nodes;                            // [length]
  std::vector<std::array<int, 6>> facets;  // corners, middles (01) (12) (20)
  std::vector<int> section;                // one per facet
  std::vector<Vec3> thickness;  // at each facet's corners, linear between
                                // them [length], > 0
};

/// The edge of a facet from its corner `edge` to the next.
struct FacetEdge {
  int facet = 0;
  int edge = 0;
};

/// From, to, middle.
std::array<int, 3> edge_nodes(const ShellMesh& mesh, const FacetEdge& edge);

/// The facets of a surface as a shell of one section: its corners keep their
/// numbers, mid-side nodes follow in the order of edges. `thickness`: one per
/// corner of the surface. Surfaces that share edges are joined there rigidly.
ShellMesh shell_mesh(const QuadraticSurface& surface, const VectorX& thickness,
                     int section = 0);

/// At a facet's six nodes [length].
std::array<double, 6> facet_thicknesses(const ShellMesh& mesh,
                                        std::size_t facet);

/// Facets at each node: those of node n stand in `facet` from start[n] to
/// start[n + 1], ascending.
struct NodeFacets {
  std::vector<int> start;
  std::vector<int> facet;
};

NodeFacets node_facets(const ShellMesh& mesh);

/// laminate_law() of each.
std::vector<LaminateLaw> laminate_laws(const std::vector<Section>& sections);

/// Throws MeshError, naming facet or node, for nodes out of range or of no
/// facet, a section that is not there, a thickness that is not positive, a
/// facet that is folded, and a section's direction that is normal to a facet.
void check_shell(const ShellMesh& mesh, const std::vector<Section>& sections);

}  // namespace meniscus::shell
