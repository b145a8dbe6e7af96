/// Internal to find_equilibrium: from a raw film to one that Newton can take.
#pragma once

#include <optional>
#include <string>

#include "evolve/curvature_flow.h"

namespace meniscus {

/// Flow and, with `edge` [length], remeshing in turn, at most `rounds` times;
/// adds its steps to `steps`. Empty when the film came near rest; else why
/// not: it tears, or grows without end. With flow.most_motion the neck is
/// looked at after every step.
std::string bring_near(FilmComplex& complex, std::optional<double> edge,
                       int rounds, int& steps, FlowOptions flow);

}  // namespace meniscus
