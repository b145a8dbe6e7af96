#include "evolve/energy/flux_jet.h"

#include <cmath>

namespace meniscus::energy {

const std::array<QuadraturePoint, 7>& facet_rule() {
  static const std::array<QuadraturePoint, 7> kRule = [] {
    const double root = std::sqrt(15.0);
    const double a = (6.0 - root) / 21.0;
    const double b = (6.0 + root) / 21.0;
    const double wa = (155.0 - root) / 1200.0;
    const double wb = (155.0 + root) / 1200.0;
    const double third = 1.0 / 3.0;
    return std::array<QuadraturePoint, 7>{{{{third, third, third}, 9.0 / 40.0},
                                           {{1 - 2 * a, a, a}, wa},
                                           {{a, 1 - 2 * a, a}, wa},
                                           {{a, a, 1 - 2 * a}, wa},
                                           {{1 - 2 * b, b, b}, wb},
                                           {{b, 1 - 2 * b, b}, wb},
                                           {{b, b, 1 - 2 * b}, wb}}};
  }();
  return kRule;
}

const std::array<QuadraturePoint, 3>& three_points() {
  static const std::array<QuadraturePoint, 3> kRule = [] {
    const double a = 2.0 / 3.0;
    const double b = 1.0 / 6.0;
    const double third = 1.0 / 3.0;
    return std::array<QuadraturePoint, 3>{
        {{{a, b, b}, third}, {{b, a, b}, third}, {{b, b, a}, third}}};
  }();
  return kRule;
}

const std::array<QuadraturePoint, 1>& middle_rule() {
  static const std::array<QuadraturePoint, 1> kRule = {
      {{{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}, 1.0}}};
  return kRule;
}

}  // namespace meniscus::energy
