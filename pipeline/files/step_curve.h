/// A boundary curve from the edges of a STEP file.
#pragma once

#include <string>
#include <vector>

#include "cad/step/step_edges.h"
#include "core/types.h"
#include "core/units.h"
#include "evolve/curves/curve.h"

namespace meniscus::files {

struct StepCurve {
  curves::CurveShape shape;  // Circle, Ellipse, Polyline or Spline
  double deviation = 0.0;    // of the edges from it at most [length]; 0: exact
  std::string description;   // "a circle of radius 10 mm, exact"
};

/// Circles, ellipses and loops of lines and arcs come out exactly. A smooth
/// loop becomes a spline through points of its edges, so many that it misses
/// them by 1e-6 of its size if 2048 can; a loop with corners a polyline whose
/// arcs miss the edges by 1e-4 of its size. `unit`: for the description.
StepCurve fit_step_loop(const step::StepLoop& loop, const std::string& unit);

/// The curve as a text of rows "what,x,y,z", to the last bit, that the case
/// keeps in the file's place.
std::string step_curve_text(const StepCurve& curve);

/// It back. Throws InvalidInput for a text that is none.
StepCurve read_step_curve_text(const std::string& text);

}  // namespace meniscus::files
