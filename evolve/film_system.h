/// What a design asks of the liquid at one set of parameters: curves, the
/// films between them, the solid caps and the bodies that they enclose.
/// Numbers only. For one model the names, kinds and order never change; the
/// numbers do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/expression.h"
#include "evolve/curve.h"
#include "evolve/field_spec.h"

namespace meniscus {

enum class FilmKind {
  Branch,  // convex hull of any number of closed curves, less their caps
  Loft,    // band between two closed curves
  Disk     // flat start across one closed curve
};

struct FilmSpec {
  std::string name;
  FilmKind kind = FilmKind::Branch;
  std::vector<std::string> curves;
  double tension = 1.0;  // energy per area of the whole film [force/length]
  // Over x, y, z; replaces tension, the same for every design of a model.
  std::optional<Expression> tension_field;
};

/// Flat solid disk across a planar closed curve; carries no tension. Caps of one
/// name, which follow each other, are one surface: a curve that lies within
/// another one's disk is a hole in it. Where polygons have the same side their
/// disks are joined (evolve/shared_sides.h).
struct CapSpec {
  std::string name;
  std::string curve;
};

struct BodySpec {
  std::string name;
  std::vector<std::string> enclosed_by;  // films and caps
  // At most one of the two; none means pressure 0.
  std::optional<double> volume;    // [length^3]
  std::optional<double> pressure;  // inside minus outside [force/length^2]
  bool is_void = false;            // of no material: not part of what is meshed
};

struct FilmSystem {
  std::vector<Curve> curves;
  std::vector<FilmSpec> films;
  std::vector<CapSpec> caps;
  std::vector<BodySpec> bodies;
  // Field energies; like tension fields, the same for every design of a model.
  std::vector<FieldSpec> fields;
  std::vector<PressureSpec> pressures;
};

}  // namespace meniscus
