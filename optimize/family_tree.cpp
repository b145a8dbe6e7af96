#include "optimize/family_tree.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::optimize {
namespace {

void check_members(const std::vector<VectorX>& members) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].size() != members[0].size() || !members[i].allFinite()) {
      throw InvalidInput(fmt::format(
          "family: member {} has {} numbers{}; expected {} finite ones as in "
          "member 0",
          i, members[i].size(),
          members[i].allFinite() ? "" : ", not all finite", members[0].size()));
    }
  }
}

// Each number divided by its range over the family; what does not differ
// between members has no say.
std::vector<VectorX> normalised(const std::vector<VectorX>& members) {
  VectorX low = members[0];
  VectorX high = members[0];
  for (const VectorX& member : members) {
    low = low.cwiseMin(member);
    high = high.cwiseMax(member);
  }
  std::vector<VectorX> points = members;
  for (VectorX& point : points) {
    for (Eigen::Index j = 0; j < point.size(); ++j) {
      point[j] =
          high[j] > low[j] ? (point[j] - low[j]) / (high[j] - low[j]) : 0.0;
    }
  }
  return points;
}

}  // namespace

std::vector<FamilyStep> family_tree(const std::vector<VectorX>& members) {
  std::vector<FamilyStep> steps;
  if (members.empty()) {
    return steps;
  }
  check_members(members);
  const std::vector<VectorX> points = normalised(members);
  const std::size_t count = members.size();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<FamilyStep> best(count);
  std::vector<bool> joined(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    best[i].member = static_cast<int>(i);
    best[i].distance = i == 0 ? 0.0 : kFar;
  }
  steps.reserve(count);
  for (std::size_t round = 0; round < count; ++round) {
    std::size_t next = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (!joined[i] &&
          (next == count || best[i].distance < best[next].distance)) {
        next = i;
      }
    }
    joined[next] = true;
    steps.push_back(best[next]);
    for (std::size_t i = 0; i < count; ++i) {
      const double distance = (points[i] - points[next]).norm();
      if (!joined[i] && distance < best[i].distance) {
        best[i].parent = static_cast<int>(next);
        best[i].depth = best[next].depth + 1;
        best[i].distance = distance;
      }
    }
  }
  return steps;
}

std::vector<std::vector<int>> family_waves(
    const std::vector<FamilyStep>& steps) {
  std::vector<std::vector<int>> waves;
  for (const FamilyStep& step : steps) {
    const auto depth = static_cast<std::size_t>(step.depth);
    if (waves.size() <= depth) {
      waves.resize(depth + 1);
    }
    waves[depth].push_back(step.member);
  }
  return waves;
}

}  // namespace meniscus::optimize
