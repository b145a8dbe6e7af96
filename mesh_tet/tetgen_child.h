/// Runs the helper `meniscus-tetgen` on one surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "core/types.h"

namespace meniscus::mesh_tet {

struct TetgenInput {
  const Points* points = nullptr;  // finite
  const std::vector<Triangle>* facets = nullptr;
  // With the switches r and a: the mesh to refine, its corners among `points`,
  // and the largest volume per element.
  const std::vector<int>* elements = nullptr;
  const std::vector<double>* largest = nullptr;
  Points holes = {};     // one point strictly inside each cavity
  std::string switches;  // TetGen's own; see its manual, section 3.2
};

struct TetgenLimits {
  double time = 300.0;         // wall clock [s]
  double memory = 8e9;         // address space [byte]
  Monitor* monitor = nullptr;  // asked every 50 ms whether to stop
};

struct TetgenOutput {
  Points nodes;               // the input's points first
  std::vector<int> elements;  // 4 valid node ids each, in TetGen's order
  std::optional<std::string> failure;  // why there is no mesh, in words
};

/// The helper is looked for at the path in the environment variable
/// MENISCUS_TETGEN; else beside the running program, in ../libexec/meniscus
/// from there, and where the program was installed. Throws IoError when it is
/// not there or does not start, Interrupted when the monitor asks to stop.
/// Thread safe.
TetgenOutput run_tetgen(const TetgenInput& input, const TetgenLimits& limits);

}  // namespace meniscus::mesh_tet
