/// Which member of a family starts from which other one's answer, fixed before
/// the first is computed: any number of jobs gives the same answers.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus::samples {

struct FamilyStep {
  int member = 0;
  std::optional<int> parent;  // none: from the case's own initial values
  int depth = 0;              // members of one depth are independent
  double distance = 0.0;      // to the parent, each number by its range
};

/// Members by nearness: the tree of least total length (R. C. Prim, Bell Syst.
/// Tech. J. 36, 1957) over the members' numbers (parameters, loads, bounds),
/// each divided by its range over the family; it grows from member 0, ties go
/// to the lower index. Steps come in the order in which they joined, so a
/// parent precedes its children. Each member: same length, finite; else
/// InvalidInput naming the member.
std::vector<FamilyStep> family_tree(const std::vector<VectorX>& members);

/// The same tree grown on: members of `kept` have their place, a parent (-1:
/// none) that is among them; the others join them as they would join each
/// other. Throws InvalidInput for a parent that is not kept, or a circle.
std::vector<FamilyStep> family_tree(
    const std::vector<VectorX>& members,
    const std::map<int, int>& kept);  // member -> parent

/// The steps by depth: what can run side by side, one wave after another.
std::vector<std::vector<int>> family_waves(
    const std::vector<FamilyStep>& steps);

}  // namespace meniscus::samples
