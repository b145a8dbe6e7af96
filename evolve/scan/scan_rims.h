/// Rims proposed from a scan: closed lines along which its surface bends most,
/// as sparse curves.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::scan {

struct ScanRimOptions {
  /// A line counts where the surface turns by so much more than about it
  /// [degrees], above 0 and below 180. Smaller finds more lines.
  double angle = 25.0;
  /// Normals are averaged so far on each side of a line [length]: several
  /// times the noise and the facets, smaller than what is looked for. Empty:
  /// 1/40 of the scan's size, and two mean edges at least.
  std::optional<double> radius;
  /// Points of each curve; empty: as few of 6 to 24 as follow the line within
  /// a mean edge.
  std::optional<int> points;
};

/// A closed line between two parts of the scan.
struct ScanRim {
  Points
      points;  // of a closed cubic through them (evolve/curves/curve.h, Spline)
  double length = 0.0;     // of the line, smoothed [length]
  double turn = 0.0;       // of the surface across it, mean [degrees]
  double deviation = 0.0;  // of the line from the curve, rms [length]
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // of the mean plane; counter-clockwise about it
  double off_plane = 0.0;       // rms [length]
  double radius = 0.0;          // mean distance from the center [length]
};

struct ScanRimReport {
  std::vector<ScanRim> rims;  // where the surface turns most, first
  int parts = 0;              // that the lines divide the scan into
  double radius = 0.0;        // that normals were averaged over [length]
};

/// Heights of a landscape are the angles between the mean normals on both sides
/// of each edge; its basins, the parts, are merged while a basin is shallower
/// than `angle` or smaller than the disk of `radius` (watersheds by
/// persistence). Borders of basins, and of the scan where it is open, are the
/// rims; a Fourier series smooths them. Where three parts meet, the border of
/// each is proposed. Facets without area and edges of more than two facets are
/// no obstacle. Deterministic. Throws InvalidInput for options out of range,
/// MeshError for a scan without area.
ScanRimReport find_rims(const SurfaceMesh& scan,
                        const ScanRimOptions& options = {});

}  // namespace meniscus::scan
