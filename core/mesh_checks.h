/// Is a surface fit to be filled? Every finding names facets and place.
#pragma once

#include <string>
#include <vector>

#include "core/surface_mesh.h"

namespace meniscus {

enum class FindingKind {
  NotFinite,
  BadIndex,
  OpenEdge,         // an edge with one facet
  NonManifoldEdge,  // an edge with more than two facets
  Misoriented,      // two facets run along an edge the same way
  Duplicate,        // two facets with the same corners
  Degenerate,       // area zero or angle below the needle bound
  Crossing,         // two facets cross or overlap
  TooClose,         // two facets nearer than the tolerance, not neighbours
  NegativeVolume    // a closed component that is inside out
};

struct Finding {
  FindingKind kind;
  std::vector<int> facets;
  Vec3 position = Vec3::Zero();
  std::string message;  // kind, facet ids, surface names, position, advice
};

struct SurfaceCheckOptions {
  double closeness = 1e-6;         // x bounding-box diagonal
  double needle_angle_deg = 0.05;  // smallest facet angle accepted
  int max_findings = 100;
};

/// Findings in order of facet id; empty when the surface can be meshed.
/// Deterministic; at most O(n log n) for reasonable meshes.
std::vector<Finding> check_surface(const SurfaceMesh& mesh,
                                   const SurfaceCheckOptions& options = {});

/// The findings as one message of at most `most` sentences.
std::string summary(const std::vector<Finding>& findings, int most = 3);

}  // namespace meniscus
