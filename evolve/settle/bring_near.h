/// Internal to find_equilibrium: from a raw film to one that Newton can take.
#pragma once

#include <optional>
#include <string>

#include "evolve/settle/curvature_flow.h"

namespace meniscus::settle {

inline constexpr const char* kFilmTears = "the film pinched while it flowed";
inline constexpr const char* kFilmGrows =
    "the film grows without end: a pressure or field is more than its tension "
    "can hold";

/// Flow and, with `edge` [length], remeshing in turn, at most `rounds` times;
/// adds its steps to `steps`. Empty when the film came near rest; else why
/// not: one of the two above. With flow.most_motion the neck is
/// looked at after every step.
std::string bring_near(films::FilmComplex& complex, std::optional<double> edge,
                       int rounds, int& steps, FlowOptions flow);

}  // namespace meniscus::settle
