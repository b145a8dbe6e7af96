#include "core/math/gauss_rule.h"

#include <cmath>
#include <numbers>

namespace meniscus {

std::vector<GaussPoint> gauss_rule(int points) {
  std::vector<GaussPoint> rule;
  for (int i = 0; i < points; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 10; ++step) {
      double before = 1.0;
      double legendre = x;
      for (int k = 2; k <= points; ++k) {
        const double next = ((2 * k - 1) * x * legendre - (k - 1) * before) / k;
        before = legendre;
        legendre = next;
      }
      slope = points * (x * legendre - before) / (x * x - 1.0);
      x -= legendre / slope;
    }
    rule.push_back({0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)});
  }
  return rule;
}

}  // namespace meniscus
