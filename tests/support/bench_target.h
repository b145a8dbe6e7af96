/// What a benchmark must reach: docs/performance.md states it, the program's
/// exit code holds it.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace meniscus {

class BenchTargets {
 public:
  /// Values that are not numbers miss any bound.
  void at_most(const std::string& what, double value, double bound) {
    judge(what, value <= bound, fmt::format("{:.4g} above {:g}", value, bound));
  }
  void at_least(const std::string& what, double value, double bound) {
    judge(what, value >= bound, fmt::format("{:.4g} below {:g}", value, bound));
  }
  void holds(const std::string& what, bool fine, const std::string& instead) {
    judge(what, fine, instead);
  }

  static constexpr const char* kMissed = "MISSED: ";

  /// What was missed, a line each.
  std::string told() const {
    std::string text;
    for (const std::string& line : missed_) {
      text += kMissed + line + "\n";
    }
    return text +
           fmt::format("{} targets, {} missed\n", judged_, missed_.size());
  }

  /// Prints it. The program's exit code: 1 where something was missed, else 0.
  int finish() const {
    std::fputs(told().c_str(), stdout);
    std::fflush(stdout);
    return missed_.empty() ? 0 : 1;
  }

 private:
  void judge(const std::string& what, bool fine, const std::string& instead) {
    ++judged_;
    if (!fine) {
      missed_.push_back(what + ": " + instead);
    }
  }

  int judged_ = 0;
  std::vector<std::string> missed_;
};

}  // namespace meniscus
