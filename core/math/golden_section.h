/// The least value of a function of one number.
#pragma once

namespace meniscus {

/// Where `value` is least between low and high, to 1e-10 of their distance, if
/// it falls and then rises there (Kiefer 1953).
template <typename Function>
double golden_section(double low, double high, const Function& value) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 48;
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double fa = value(a);
  double fb = value(b);
  for (int step = 0; step < kSteps; ++step) {
    if (fa <= fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - kGolden * (high - low);
      fa = value(a);
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + kGolden * (high - low);
      fb = value(b);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace meniscus
