/// Field energies, in both readings of "singularity functions" (this
/// project's interpretation, docs/decisions/0008-singularity-functions.md):
/// poles that attract or repel films and liquid, and pressures of place. The
/// other reading, Macaulay brackets, is a function of expressions
/// (core/math/expression.h).
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

/// An expression over x, y, z. Throws InvalidInput with text and column.
Expression place_expression(const std::string& text);

}  // namespace meniscus::energy
