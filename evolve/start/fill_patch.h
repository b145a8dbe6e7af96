/// Triangles on the ruled patch between two opposite sides of a curve.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"
#include "evolve/films/ruled_band.h"

namespace meniscus::start {

struct PatchFilling {
  std::vector<Triangle> facets;  // of the rim's points, then those between
  std::vector<films::BandPlace> between;
};

/// Facets of about `edge` in the patch unrolled by the mean lengths of its
/// sides. `around`: where the rim's points stand, in order along the curve; no
/// other points lie on it, and facets run along it in its direction. Throws
/// MeshError where the rim crosses itself there.
PatchFilling fill_patch(const films::RuledBand& patch,
                        const std::vector<curves::Curve>& curves,
                        const std::vector<films::BandPlace>& around,
                        double edge);

}  // namespace meniscus::start
