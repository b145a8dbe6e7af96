/// From a datafile to a film complex that can be evolved.
#pragma once

#include <map>
#include <string>

#include "evolve/datafile/fe_file.h"
#include "evolve/films/film_complex.h"

namespace meniscus::datafile {

/// The complex that the file describes when its parameters have their values
/// in the file, those named in `parameters` (any case) others; "G" there is
/// the gravity constant.
///
/// Vertices and edges in no face are left out. Faces of more than three edges
/// are cut about the mean of their vertices, as Evolver does; what is born
/// there is fixed or on constraints like its face. Vertices are put onto their
/// constraints. One surface per kind of face (tension, fixed, no_refine,
/// constraints, quantities, bodies in front and behind): "film_1", "film_2",
/// ..., fixed ones "solid_1", ... (not liquid, yet with the face's tension);
/// bodies "body_<number>", level sets "constraint_<name>", curves
/// "boundary_<name>".
///
/// Throws InvalidInput with file, line and column: an unknown parameter, a
/// formula without finite value, a vertex that cannot be put onto its
/// constraints, two edges between the same vertices, a fixed face with free
/// vertices, a face twice on one side, a quantity on no face.
films::FilmComplex complex_of(
    const FeFile& file, const std::map<std::string, double>& parameters = {});

/// Puts the file's formulas with other parameter values into a complex made
/// from it by complex_of(), perhaps refined since: curves, level sets, line
/// integrals, integrands. Neither moves vertices nor changes tensions,
/// targets and gravity, which Evolver evaluates once, on reading.
void recalculate(films::FilmComplex& complex, const FeFile& file,
                 const std::map<std::string, double>& parameters);

}  // namespace meniscus::datafile
