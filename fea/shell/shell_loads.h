/// What acts on a shell, as forces and moments at its nodes.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fea/loads/load_case.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/wall_state.h"

namespace meniscus::shell {

/// Where in the wall a pressure acts. Its area is that of the place; on a face
/// it presses or pulls the wall across as well, which strains it by Poisson's
/// ratios.
enum class WallSide { Negative, Middle, Positive };

/// Pressure along the facet's normal where it is positive: from within where
/// normals point outwards.
struct FacetPressure {
  int facet = 0;
  double pressure = 0.0;  // [pressure]
  WallSide side = WallSide::Negative;
};

/// The same of a field, on a face: not in the middle.
struct FieldPressure {
  int facet = 0;
  NodeValues pressure;  // [pressure]
  WallSide side = WallSide::Negative;
};

/// Force per length of an edge of a facet along the edge's conormal, out of the
/// facet and in its surface, where it is positive.
struct EdgePull {
  int facet = 0;
  int edge = 0;        // 0: (01), 1: (12), 2: (20)
  double force = 0.0;  // [force/length]
};

/// On the end of the wall along an edge, over its thickness: force per area,
/// and pressure into the wall. By the edge's length on the surface.
struct EdgeTraction {
  int facet = 0;
  int edge = 0;                  // as EdgePull has it
  Vec3 traction = Vec3::Zero();  // [pressure]
  double pressure = 0.0;         // [pressure]
};

/// Force and moment per length of an edge.
struct EdgeLoad {
  std::array<int, 3> nodes = {};  // from, to, middle
  Vec3 force = Vec3::Zero();      // [force/length]
  Vec3 moment = Vec3::Zero();     // [force]
};

/// Change of temperature from the state free of stress.
struct WallTemperature {
  double mean = 0.0;    // at the middle of the wall
  double across = 0.0;  // at the positive face less that at the negative one
};

/// Beside the mean one, a field at the middle of the wall.
struct NodalTemperature {
  VectorX value;  // one per node
  Points slope;   // its gradient there, for derivatives only; may be empty
};

/// Force per mass at x: at_origin + slope x.
struct MassForce {
  Vec3 at_origin = Vec3::Zero();  // [length/time^2]
  Mat3 slope = Mat3::Zero();      // [1/time^2]
};
/// Of the place's distance from the axis. Throws InvalidInput for a spin
/// without an axis.
MassForce mass_force(const loads::Spin& spin);
/// What it changes by when the spin's numbers do at `rates`.
MassForce mass_force_rate(const loads::Spin& spin, const loads::Spin& rates);

struct ShellLoads {
  std::vector<FacetPressure> pressures;
  std::vector<FieldPressure> field_pressures;
  std::vector<EdgePull> pulls;
  std::vector<EdgeTraction> tractions;
  std::vector<EdgeLoad> edges;
  Vec3 gravity = Vec3::Zero();  // force per mass [length/time^2]
  std::optional<loads::Spin> spin;
  std::optional<MassForce> mass_force;
  std::optional<WallTemperature> temperature;
  std::optional<NodalTemperature> nodal_temperature;
  VectorX nodal;  // forces and moments, 6 per node; empty: none
};

/// Consistent forces, 6 per node: force, moment. The same bits for any number
/// of threads. Throws InvalidInput for facets and nodes that are not there, a
/// spin without an axis, and nodal forces or temperatures of another length.
VectorX nodal_forces(const ShellMesh& mesh,
                     const std::vector<Section>& sections,
                     const ShellLoads& loads);

/// As nodal_forces() does.
void check_loads(const ShellMesh& mesh, const ShellLoads& loads);

/// Functions of an edge's nodes, from, to, middle, at s from 0 to 1.
Vec3 edge_shapes(double s);

/// A point of an edge's rule (three, on [0, 1]).
struct LinePoint {
  double weight;
  std::array<double, 3> shape;
  std::array<double, 3> slope;
  Vec3 tangent;
};
std::array<LinePoint, 3> line_points(const ShellMesh& mesh,
                                     const std::array<int, 3>& nodes);

}  // namespace meniscus::shell
