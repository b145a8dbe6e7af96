#include "optimize/first_start.h"

#include <fmt/format.h>

namespace meniscus::optimize {
namespace {

// Points tried when the initial one fails: enough to find a region that is a
// fifth of the box or more with 90 % chance.
constexpr int kProbes = 10;

// The radical inverse of `index` in `base`: Halton's sequence, spread evenly.
double radical_inverse(int index, int base) {
  double value = 0.0;
  double digit = 1.0;
  for (int rest = index; rest > 0; rest /= base) {
    digit /= base;
    value += digit * (rest % base);
  }
  return value;
}

}  // namespace

VectorX probe_point(const EvaluatorCore& core, int index) {
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19};
  VectorX t(core.size());
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    t[i] = radical_inverse(index, kPrimes[i % 8]);
  }
  if (index == 1) {
    t.setConstant(0.5);
  }
  return core.lower() + t.cwiseProduct(core.ranges());
}

std::optional<VectorX> find_start(const EvaluatorCore& core,
                                  const AskStart& ask) {
  VectorX x = core.start();
  for (int index = 0; index <= kProbes; ++index) {
    if (index > 0) {
      x = probe_point(core, index);
    }
    const std::optional<bool> answered =
        ask(x, index == 0 ? EvaluationPhase::Start : EvaluationPhase::Probe);
    if (!answered) {
      return std::nullopt;
    }
    if (*answered) {
      return x;
    }
  }
  return std::nullopt;
}

std::string no_start_message(const EvaluatorCore& core) {
  return fmt::format(
      "no design could be evaluated: the initial point {} and {} others "
      "failed, the last with {}: {}. Change what this message names, start "
      "from an initial point known to work, or move the bounds",
      core.describe(core.start()), core.evaluations() - 1,
      name_of(core.last_failure().kind), core.last_failure().message);
}

}  // namespace meniscus::optimize
