/// A shell as the body that it stands for: both faces of its walls, and rims.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/tet_mesh.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

/// Of each film a closed surface. Where films meet, their bodies overlap; a
/// wall thicker than its radius of curvature crosses itself.
struct ShellBody {
  /// A node over a node of the shell.
  struct Point {
    int node = 0;
    int side = 0;              // -1: inside, 0: middle of the wall, 1: outside
    Vec3 over = Vec3::Zero();  // from the shell's node [length]
  };
  /// No elements: six-node faces, outward. Labels as walls have them: "FILM"
  /// outside, "FILM/back" inside, "FILM/rim:CURVE", and "FILM/rim" where an
  /// edge is on no curve.
  TetMesh mesh;
  std::vector<Point> points;  // per node of the mesh
  std::vector<int> film;      // per face: which of body_names()
};

/// Nodes lie over those of the shell along the film's mean normal there, by
/// the thickness at the side of the film that the section has.
ShellBody shell_body(const ShellPart& part);

/// Its displacements, 3 per node, from 6 per node of the shell: fibres turn
/// rigidly.
VectorX body_displacements(const ShellBody& body, const VectorX& six);

/// Of a load case with stresses, per node: that of the face it is on
/// [pressure].
std::vector<double> body_von_mises(const ShellBody& body, const ShellPart& part,
                                   std::size_t load_case);

/// Films of the part: a body each.
std::vector<std::string> body_names(const ShellPart& part);

/// As a surface of bodies, one a film, each face cut in four.
SurfaceMesh body_surface(const ShellBody& body);

/// The bodies of the part's walls, behind the boundary of the solids where it
/// has some.
SurfaceMesh part_surface(const ShellPart& part, SurfaceMesh solids);

}  // namespace meniscus::shells
