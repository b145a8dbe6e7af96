/// Is a surface fit to be filled? Every finding names facets and place.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus {

enum class FindingKind {
  NotFinite,
  BadIndex,         // of a point, a label or a body
  OpenEdge,         // an edge with one facet
  NonManifoldEdge,  // an edge with more than two facets of one body
  Misoriented,      // two facets run along an edge the same way
  Duplicate,        // two facets with the same corners
  Degenerate,       // area zero or angle below the needle bound
  Crossing,         // two facets cross or overlap
  TooClose,         // two facets nearer than the tolerance, not neighbours
  NegativeVolume,   // a closed component that is inside out
  BodyMismatch,     // facets that follow each other about an edge look at
                    // different bodies
  BadNesting,       // a solid in a solid, or in another body than it says
  Crowded           // so many facets at a place that they were not compared
};

/// Stable name of a kind ("open_edge").
const char* name_of(FindingKind kind);

struct Finding {
  FindingKind kind;
  std::vector<int> facets;  // at most 8 of those concerned, the first lowest
  Vec3 position = Vec3::Zero();
  std::string message;  // kind, facet ids, surface names, position, advice
  std::vector<std::string> surfaces = {};  // names of the facets' surfaces
};

struct SurfaceCheckOptions {
  double closeness = 1e-6;         // x bounding-box diagonal
  double needle_angle_deg = 0.05;  // smallest facet angle accepted
  int max_findings = 100;          // of each kind and in all
};

/// Findings in order of facet id; empty when the surface can be meshed: its
/// facets are sound, close the bodies on their sides, all the same way round,
/// and neither cross nor come too near. Where edges are at fault or facets
/// cross, inside and outside mean nothing, so nesting is not looked at.
/// Deterministic; O(n log n) for reasonable meshes, and never more than some
/// 200 box comparisons per facet (a soup beyond that is Crowded).
std::vector<Finding> check_surface(const SurfaceMesh& mesh,
                                   const SurfaceCheckOptions& options = {});

/// The findings as one message of at most `most` sentences.
std::string summary(const std::vector<Finding>& findings, int most = 3);

}  // namespace meniscus
