/// The compromises that a study of two objectives found.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/case_data/case.h"

namespace meniscus::study {

/// Both objectives on a mesh that was made for the design.
struct OwnMesh {
  double first = 0.0;
  double second = 0.0;
  bool kept = true;  // every constraint, there
};

struct FrontPoint {
  VectorX design;
  double first = 0.0;  // value of study.objectives[0]
  double second = 0.0;
  std::string end;  // how its minimisation ended: "converged", "stalled", ...
  std::optional<OwnMesh> own_mesh = {};
};

struct FrontFigures {
  std::vector<FrontPoint> points;  // no other beats them; `first` ascending
  int left_out = 0;  // minima that keep a constraint badly or are beaten
};

/// The index of the point nearest to the best of both objectives, each over
/// its range on the front; `points` must not be empty.
int middle_of_front(const std::vector<FrontPoint>& points);

/// The part `front` of result.json (docs/results.md).
nlohmann::ordered_json front_json(const case_data::Case& input,
                                  const FrontFigures& figures);

/// A line per point for people.
std::string front_text(const case_data::Case& input,
                       const FrontFigures& figures);

}  // namespace meniscus::study
