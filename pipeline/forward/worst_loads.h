/// Which direction of a load from any is the worst, response by response.
#pragma once

#include <string>
#include <vector>

#include "pipeline/forward/responses.h"

namespace meniscus::forward {

struct WorstLoad {
  int response = 0;                // index
  std::string load_case;           // of the load from any direction
  Vec3 direction = Vec3::UnitZ();  // unit; of stress at the worst node
};

/// One for each response that is of a load from any direction, in their order.
/// The opposite direction is as bad for energies and stress.
std::vector<WorstLoad> worst_loads(const case_data::Case& input,
                                   const ResponseContext& fields);

/// "[0.6, 0, -0.8]".
std::string direction_text(const Vec3& direction);

}  // namespace meniscus::forward
