/// Field energies, in both readings of "singularity functions" (this
/// project's interpretation, docs/decisions/0008-singularity-functions.md):
/// poles that attract or repel films and liquid, and Macaulay brackets that
/// ramp or switch tension and pressure by region.
#pragma once

#include <string>

#include "evolve/films/field_spec.h"
#include "evolve/films/film_complex.h"

namespace meniscus::energy {

/// phi, its numbers those of the spec where that moves. Throws InvalidInput:
/// numbers that are not finite or out of range, a shape without length or
/// normal, a polyline whose formula grows longer than expressions may be (about
/// 35 segments; 8 where its points move).
PlaceField place_field(const films::FieldSpec& field);
/// Its numbers, or its rates where the spec has these, unchecked.
VectorX field_numbers(const films::FieldSpec& field);

/// The field's energy, to be put into complex.quantities. Throws InvalidInput
/// also for surfaces and bodies that the complex has not.
films::FilmQuantity field_quantity(const films::FilmComplex& complex,
                                   const films::FieldSpec& field);

/// The work of a pressure [force/length^2] that varies:
/// minus its integral over the body (empty: over every body), on top of the
/// body's own pressure. Positive: inflates. Throws InvalidInput.
films::FilmQuantity pressure_quantity(const films::FilmComplex& complex,
                                      const std::string& name,
                                      const std::string& body,
                                      const PlaceField& pressure);

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

}  // namespace meniscus::energy
