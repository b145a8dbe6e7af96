#include "optimize/samples/family_tree.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::samples {
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
  return family_tree(members, {});
}

namespace {

// The members that have their place, parents first.
std::vector<FamilyStep> kept_steps(const std::vector<VectorX>& points,
                                   const std::map<int, int>& kept) {
  std::vector<FamilyStep> steps;
  std::map<int, int> depth;
  while (depth.size() < kept.size()) {
    const std::size_t before = depth.size();
    for (const auto& [member, parent] : kept) {
      if (depth.count(member) > 0 ||
          (parent >= 0 && depth.count(parent) == 0)) {
        continue;
      }
      FamilyStep step{.member = member};
      if (parent >= 0) {
        step.parent = parent;
        step.depth = depth[parent] + 1;
        step.distance = (points[static_cast<std::size_t>(member)] -
                         points[static_cast<std::size_t>(parent)])
                            .norm();
      }
      depth[member] = step.depth;
      steps.push_back(step);
    }
    if (depth.size() == before) {
      throw InvalidInput(
          "family: the members that are kept have a parent that is not, or "
          "begin from each other");
    }
  }
  return steps;
}

}  // namespace

std::vector<FamilyStep> family_tree(const std::vector<VectorX>& members,
                                    const std::map<int, int>& kept) {
  if (members.empty()) {
    return {};
  }
  check_members(members);
  const std::vector<VectorX> points = normalised(members);
  const std::size_t count = members.size();
  // Prim's algorithm for the least spanning tree: each member that is not in it
  // knows the nearest one that is.
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<FamilyStep> best(count);
  std::vector<bool> joined(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    best[i].member = static_cast<int>(i);
    best[i].distance = i == 0 && kept.empty() ? 0.0 : kFar;
  }
  const auto join = [&](const FamilyStep& step) {
    const auto next = static_cast<std::size_t>(step.member);
    joined[next] = true;
    for (std::size_t i = 0; i < count; ++i) {
      const double distance = (points[i] - points[next]).norm();
      if (!joined[i] && distance < best[i].distance) {
        best[i].parent = step.member;
        best[i].depth = step.depth + 1;
        best[i].distance = distance;
      }
    }
  };
  // First those that are kept, then again and again the nearest of the rest.
  std::vector<FamilyStep> steps = kept_steps(points, kept);
  steps.reserve(count);
  for (const FamilyStep& step : steps) {
    join(step);
  }
  while (steps.size() < count) {
    std::size_t next = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (!joined[i] &&
          (next == count || best[i].distance < best[next].distance)) {
        next = i;
      }
    }
    steps.push_back(best[next]);
    join(best[next]);
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

}  // namespace meniscus::samples
