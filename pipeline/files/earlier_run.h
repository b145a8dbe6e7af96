/// Where the films of an earlier run stood, out of its results folder.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus::files {

/// Of a result.json what read_earlier_run() reads, as short JSON: what a case
/// keeps of a run that it begins from. Throws InvalidInput where the text is no
/// result.json or its run has no answer.
std::string earlier_run_text(const std::string& result_json);

struct EarlierRun {
  std::string units;  // name of its unit system
  /// One value per name, at the designs that its models were frozen at, in
  /// order, and at its answer: NaN where the run has nothing of that name.
  std::vector<VectorX> values;
};

/// `names`: of design variables and parameters, "foot" or "t[2,1]". A parameter
/// has its value at the answer everywhere. Throws as earlier_run_text().
EarlierRun read_earlier_run(const std::string& text,
                            const std::vector<std::string>& names);

}  // namespace meniscus::files
