/// What acts on a part, with what holds it: plain data, by surface name.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "fea/loads/support.h"
#include "fea/loads/surfaces.h"

namespace meniscus::loads {

/// Values at places [length]. They may throw ExpressionError; what is not
/// finite is refused with the place.
using NumberOfPlace = std::function<double(const Vec3&)>;
using VectorOfPlace = std::function<Vec3(const Vec3&)>;
using MatrixOfPlace = std::function<Mat3(const Vec3&)>;

/// A field and, needed for derivatives only, its gradient [value/length].
struct SlopedField {
  NumberOfPlace value;
  VectorOfPlace slope;
};

/// A total force spread as uniform traction over all of the surfaces [force].
struct SurfaceForce {
  Surfaces surfaces;
  Vec3 total = Vec3::Zero();
};

/// Pressure on a surface, positive into the solid [pressure].
struct SurfacePressure {
  std::string surface;
  double pressure = 0.0;
  NumberOfPlace field;  // instead of `pressure`, where it is set
  VectorOfPlace slope;  // the field's gradient, for derivatives only
};

/// Force per area of a surface [pressure].
struct SurfaceTraction {
  std::string surface;
  Vec3 traction = Vec3::Zero();
  VectorOfPlace field;  // instead of `traction`, where it is set
  MatrixOfPlace slope;  // dt_i/dx_j of the field, for derivatives only
};

/// Of shells: force per length of a film's rim along its conormal, in the film
/// and out of it where it is positive [force/length].
struct RimTension {
  std::string rim;
  double tension = 0.0;
};

/// A force at a point and a moment, carried by surfaces together without
/// stiffening them: the nodal forces are those of the same force and moment
/// that are least in the norm weighted by area (RBE3).
struct RemoteLoad {
  Surfaces surfaces;
  Vec3 point = Vec3::Zero();   // where the force acts [length]
  Vec3 force = Vec3::Zero();   // [force]
  Vec3 moment = Vec3::Zero();  // beside the force's own [force length]
};

/// A force that a round pin presses into its bores without friction, as a
/// cosine over the half that it is pressed against (bearing_load.h); what it
/// has along the axis is spread evenly. Surfaces share it as the pressures
/// balance: with a point about it, else by area.
struct BearingLoad {
  Surfaces surfaces;
  Vec3 force = Vec3::Zero();       // not 0 [force]
  std::optional<Vec3> point = {};  // on the axis [length]
  std::optional<Vec3> axis = {};   // any length but 0; else the surfaces' own
};

/// Centrifugal forces, as seen from a part that turns steadily.
struct Spin {
  Vec3 point = Vec3::Zero();  // on the axis [length]
  Vec3 axis = Vec3::UnitZ();  // any length but 0
  double rate = 0.0;          // [rad/time]
};

/// Temperature at the nodes, linear or quadratic between them as displacements
/// are. Free expansion is the material's expansion times (T - reference).
struct Temperature {
  double value = 0.0;
  NumberOfPlace field;  // instead of `value`, where it is set
  double reference = 0.0;
  VectorOfPlace slope;  // the field's gradient, for derivatives only
  VectorX nodal;        // instead of both, one per node, where it has any
};

struct LoadCase {
  std::string name;
  std::vector<Support> supports;
  std::vector<HeldNode> held_nodes;
  std::vector<SurfaceForce> forces;
  std::vector<SurfacePressure> pressures;
  std::vector<SurfaceTraction> tractions;
  std::vector<RimTension> rim_tensions;
  std::vector<RemoteLoad> remote_loads;
  std::vector<BearingLoad> bearings;
  Vec3 gravity = Vec3::Zero();  // force per mass [length/time^2]
  std::optional<Spin> spin;
  std::optional<Temperature> temperature;
  std::vector<SpringBed> springs;
  std::vector<NodeSpring> node_springs;
  std::vector<RigidPin> pins;
  VectorX nodal;  // forces at nodes, 3 per node; empty: none [force]
};

/// A support or a pin says at what displacement it holds, if only at 0 now.
bool enforces(const LoadCase& load_case);

}  // namespace meniscus::loads
