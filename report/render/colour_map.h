/// Colours and round figures for pictures.
#pragma once

#include <array>

namespace meniscus::render {

using Colour = std::array<double, 3>;  // red, green, blue, 0..1

/// Viridis at t in 0..1: dark to bright, even steps to the eye, safe for the
/// colour-blind (Smith and van der Walt, 2015).
Colour viridis(double t);

/// 1, 2 or 5 times a power of ten: the largest not above `value` > 0.
double round_down_nice(double value);

}  // namespace meniscus::render
