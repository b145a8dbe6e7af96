#include "report/render/colour_map.h"

#include <algorithm>
#include <cmath>

namespace meniscus::render {

Colour viridis(double t) {
  constexpr std::array<std::array<double, 3>, 11> kStops = {{{68, 1, 84},
                                                             {72, 36, 117},
                                                             {65, 68, 135},
                                                             {53, 95, 141},
                                                             {42, 120, 142},
                                                             {33, 145, 140},
                                                             {34, 168, 132},
                                                             {68, 191, 112},
                                                             {122, 209, 81},
                                                             {189, 223, 38},
                                                             {253, 231, 37}}};
  const double at = std::clamp(t, 0.0, 1.0) * (kStops.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double part = at - static_cast<double>(low);
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] =
        ((1 - part) * kStops[low][c] + part * kStops[low + 1][c]) / 255.0;
  }
  return colour;
}

double round_down_nice(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= value) {
      return factor * power;
    }
  }
  return power;
}

}  // namespace meniscus::render
