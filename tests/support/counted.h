/// Numbers that count what is done with them: for tests of the ledger's
/// formulas (core/operation_count.h) against textbook versions of their
/// kernels.
#pragma once

#include <cmath>

#include "core/operation_count.h"

namespace meniscus {

/// Counts its additions, multiplications, divisions and roots.
struct Counted {
  double value = 0.0;
  static inline long long done = 0;

  Counted& operator+=(Counted b) { return *this = {(++done, value + b.value)}; }
  Counted& operator-=(Counted b) { return *this = {(++done, value - b.value)}; }
};

inline Counted operator+(Counted a, Counted b) { return a += b; }
inline Counted operator-(Counted a, Counted b) { return a -= b; }
inline Counted operator*(Counted a, Counted b) {
  ++Counted::done;
  return {a.value * b.value};
}
inline Counted operator/(Counted a, Counted b) {
  ++Counted::done;
  return {a.value / b.value};
}
inline Counted root(Counted a) {
  ++Counted::done;
  return {std::sqrt(a.value)};
}

/// What `work` does, by the account and by counting.
template <class Work>
double accounted(const Work& work) {
  const double before = operations_done();
  work();
  return operations_done() - before;
}
template <class Work>
double counted(const Work& work) {
  const long long before = Counted::done;
  work();
  return static_cast<double>(Counted::done - before);
}

}  // namespace meniscus
