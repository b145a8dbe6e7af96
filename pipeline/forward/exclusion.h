/// The elements and nodes that stress figures leave out: chosen once, on the
/// frozen model, so that the same ones count in every design.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/tet_mesh.h"
#include "fea/stress/exclusion_zones.h"
#include "pipeline/case_data/case.h"

namespace meniscus::forward {

struct ExclusionShare {
  std::string where;  // "within 5 mm of 'foot'"
  int elements = 0;
  double volume_share = 0.0;  // of the part's volume
};

struct Exclusion {
  stress::Excluded what;
  ExclusionShare all;  // of elements; zones may overlap
  std::vector<ExclusionShare> zones;
};

enum class EmptyZones { Refused, Allowed };

/// Throws InvalidInput, naming the zone with its place in the case, where a
/// zone holds no element, or all zones hold every one. `Allowed` is for coarser
/// models of a case that was checked.
Exclusion choose_exclusion(const case_data::Case& input, const TetMesh& mesh,
                           EmptyZones empty = EmptyZones::Refused);

/// result.json's "exclusion" (docs/results.md).
nlohmann::ordered_json exclusion_json(const Exclusion& exclusion);

}  // namespace meniscus::forward
