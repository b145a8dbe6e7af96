/// A scan divided along the lines where it bends most
/// (evolve/scan/scan_rims.h).
#pragma once

#include <map>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::scan {

/// A closed border of a part, along edges of the scan.
struct PartBorder {
  Points points;
  double turn = 0.0;  // of the surface across it, mean by length [radian]
};

class ScanParts {
 public:
  /// Finds how far the surface turns at each edge: the angle between the mean
  /// normals within `radius` on its two sides. Throws MeshError for a scan
  /// without area.
  ScanParts(const SurfaceMesh& scan, double radius);

  /// A part number per facet, -1 without area: basins that are deeper than
  /// `turn` [radian] and larger than the disk of the radius.
  std::vector<int> merged(double turn) const;

  /// Every border once, those that just two parts share too.
  std::vector<PartBorder> borders(const std::vector<int>& part) const;

 private:
  /// Along a border of a part.
  struct Step {
    int to = 0;
    int edge = 0;
    bool used = false;
  };
  using Steps = std::map<int, std::vector<Step>>;  // by the point they leave

  /// `seen`: per facet, the last edge that asked for it.
  double turn_at(int edge, std::vector<int>& seen) const;
  PartBorder trace_border(Steps& steps, int start,
                          std::vector<int>& along) const;

  const SurfaceMesh& scan_;
  double radius_;
  std::vector<Edge> edges_;
  std::vector<Triangle> facet_edges_;
  std::vector<std::vector<int>> at_edge_;  // facets
  std::vector<double> area_;               // per facet
  Points normal2_;                         // per facet
  Points center_;                          // per facet
  std::vector<double> turn_;               // per edge [radian]
};

}  // namespace meniscus::scan
