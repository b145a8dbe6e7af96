/// Loads from any direction: which is the worst, response by response, and what
/// it comes to.
#pragma once

#include <string>
#include <vector>

#include "pipeline/responses/responses.h"

namespace meniscus::responses {

struct WorstLoad {
  int response = 0;                // index
  std::string load_case;           // of the load from any direction
  Vec3 direction = Vec3::UnitZ();  // unit; of stress at the worst node
};

/// One for each response that is of a load from any direction, in their order.
/// The opposite direction is as bad for energies and stress.
std::vector<WorstLoad> worst_loads(const case_data::Case& input,
                                   const ResponseContext& fields);

/// The load in direction d of three unit loads, which have one force each and
/// begin at `first`.
loads::LoadCase combined_load(const std::vector<loads::LoadCase>& load_cases,
                              int first, const Vec3& d);

/// What is linear in the load, in direction d.
VectorX combined(const std::vector<VectorX>& of_load_cases, int first,
                 const Vec3& d);

/// "[0.6, 0, -0.8]".
std::string direction_text(const Vec3& direction);

}  // namespace meniscus::responses
