/// Discretisation errors of figures from what they are on several meshes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/math/dense.h"
#include "pipeline/accuracy/mesh_sequence.h"
#include "pipeline/case_data/case.h"

namespace meniscus::accuracy {

/// A figure on the meshes of kEdgeFactors, in that order; NaN where it has
/// none.
using MeshValues = std::array<double, 4>;

/// What the figure is of decides what may be assumed of its order.
enum class FigureKind {
  Film,      // areas, energies, pressures, margins of films: no singular rims
  Integral,  // displacements, masses, energies, frequencies
  Extreme,   // peaks, necks, gaps, buckling factors: local, of no known order
  Peak       // of stress, where geometry knows of no edge without a limit
};

struct FigureError {
  double bound = 0.0;   // of the first value, both ways, >= 0; NaN where only
                        // that one is known, or all meshes agree to rounding
  bool settles = true;  // false: its changes do not shrink with the edges, as
                        // where there is no limit; a Peak that falls has one
};

/// From the changes between the meshes and the order p that they show:
/// F change / (2^p - 1), after P. J. Roache, Verification and validation in
/// computational science and engineering (1998), 5.6, and L. Eca, M. Hoekstra,
/// J. Comput. Phys. 262 (2014) 104. How often it holds, and its constants:
/// docs/decisions/0006-mesh-error.md.
FigureError figure_error(const MeshValues& values, FigureKind kind);

/// How a figure of films comes to its limit as facets are halved: with the
/// square of their edges; a margin to collapse with the root of that, as it
/// falls to 0 (docs/theory.md, Margins).
enum class FilmLaw { Smooth, Root };

/// The error of `own` by `finer`, the same on the same facets halved
/// (Richardson at order 2), times the safety that figure_error() has. NaN where
/// one is.
double finer_film_error(double own, double finer, FilmLaw law);

/// The margin to collapse whose value less its error is `lower`, from one whose
/// error is known: in designs near each other halved facets change its square
/// by the same.
double margin_to_hold(double lower, double own, double error);

/// Of each response; figures of films by their finer film where it is there,
/// all others by the meshes; `dual`: of the elements alone where estimated (NaN
/// where not; empty: none), no bound is below it. `peaks`: by load case, for
/// its max_von_mises (empty: by the meshes as any extreme).
std::vector<FigureError> response_errors(
    const case_data::Case& input, const MeshSequence& meshes,
    const VectorX& dual, const std::vector<FigureError>& peaks = {});

/// Their bounds, in order.
VectorX bounds_of(const std::vector<FigureError>& errors);

/// Gives the figures of the first mesh their errors.
void add_eigen_errors(MeshSequence& meshes);

/// "NAME may have no limit: ...", with its values; `unit`: as they are shown.
std::string unsettled_text(const case_data::Case& input,
                           const std::string& name, const MeshValues& values,
                           const ShownUnit& unit, Dimension dimension);

/// A sentence for each response whose changes do not shrink, with its values.
std::vector<std::string> unsettled_warnings(
    const case_data::Case& input, const MeshSequence& meshes,
    const std::vector<FigureError>& errors);

}  // namespace meniscus::accuracy
