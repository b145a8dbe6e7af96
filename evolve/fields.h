/// Field energies, in both readings of "singularity functions" (this
/// project's interpretation, docs/decisions/0008-singularity-functions.md):
/// poles that attract or repel films and liquid, and Macaulay brackets that
/// ramp or switch tension and pressure by region.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "evolve/film_complex.h"

namespace meniscus {

struct PointPole {
  Vec3 at = Vec3::Zero();
};
struct SegmentPole {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::UnitX();
};
/// A curve, sampled: segments from point to point; closed when the last point
/// is the first.
struct PolylinePole {
  Points points;
};
struct PlanePole {
  Vec3 at = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // any length but 0
};
using PoleShape = std::variant<PointPole, SegmentPole, PolylinePole, PlanePole>;

/// Energy per film area, of the named surfaces; none: of every liquid one.
struct PerArea {
  std::vector<std::string> surfaces;
};
/// Energy per volume of the named body; empty: of every body.
struct PerVolume {
  std::string body;
};

/// phi = -strength (1 + (d / core)^2)^(-power / 2), d the distance to the
/// shape. Strength > 0 attracts, < 0 repels; it is the depth of phi on the
/// pole [force/length per area, force/length^2 per volume]. Far away phi falls
/// as d^-power. Per area, phi adds to the tension: an attracting strength
/// must stay below it, or films crumple on the pole.
///
/// Points and planes: smooth. A segment: the second derivatives jump across
/// the planes through its ends, normal to it. A polyline also has a kink where
/// its nearest segment changes, on the inner side of its bends.
struct FieldSpec {
  std::string name;
  PoleShape shape;
  double strength = 0.0;
  double power = 2.0;  // > 0
  double core = 1.0;   // softening length, > 0 [length]
  std::variant<PerArea, PerVolume> per;
};

/// phi as an expression over x, y, z. Throws InvalidInput: numbers that are
/// not finite or out of range, a shape without length or normal, a polyline
/// whose formula grows longer than expressions may be (about 35 segments).
Expression field_expression(const FieldSpec& field);

/// The field's energy, to be put into complex.quantities. Throws InvalidInput
/// also for surfaces and bodies that the complex has not.
FilmQuantity field_quantity(const FilmComplex& complex, const FieldSpec& field);

/// The work of a pressure [force/length^2] that is an expression over x, y, z:
/// minus its integral over the body (empty: over every body), on top of the
/// body's own pressure. Positive: inflates. Throws InvalidInput.
FilmQuantity pressure_quantity(const FilmComplex& complex,
                               const std::string& name, const std::string& body,
                               const Expression& pressure);

/// Text of the Macaulay bracket <s - offset>^power over x, y, z, s the
/// distance along `direction` from the origin: 0 where s < offset. Power 0
/// switches, 1 ramps. Not smooth at s = offset for powers up to 2. Throws
/// InvalidInput for a direction of length 0 and a power below 0.
std::string macaulay(const Vec3& direction, double offset, double power);

/// The same without the corner: <s> becomes (s + sqrt(s^2 + width^2)) / 2,
/// and power 0 its derivative. Off by less than width / 2 at the corner and by
/// width^2 / (4 |s|) far from it. Throws InvalidInput also for a width not
/// above 0.
std::string smooth_macaulay(const Vec3& direction, double offset, double power,
                            double width);

/// An expression over x, y, z. Throws InvalidInput with text and column.
Expression place_expression(const std::string& text);

}  // namespace meniscus
