/// First facets of a film from the spines that hold its liquid: a level set of
/// their own field, cut at the rims and joined to them.
#pragma once

#include "core/geometry/surface_mesh.h"
#include "evolve/spines/spine_poles.h"

namespace meniscus::spines {

/// A rim that a film ends at.
struct SpineRim {
  std::string curve;
  Points points;  // around it
  /// Of one that a bore runs through to another rim: that one, by index.
  int bore = -1;
};

/// Per end of the spine: does it lie in a rim, so that the spine goes on beyond
/// it? Where the rim's plane is less than half the spine's radius away and the
/// end lies within the rim, which is no bore's. The index of the rim, or -1; so
/// of closed spines.
std::array<int, 2> rims_at_ends(const films::SpineSpec& spine,
                                const std::vector<SpineRim>& rims);

/// Facets between the rims, whose points come first, in order. Their size is
/// that of the thinnest spine. Throws InvalidInput for a rim at which no spine
/// or more than one ends and which is no bore's (by name), where the liquid
/// does not reach a rim, and where a piece of it reaches none.
SurfaceMesh spine_start(const std::vector<films::SpineSpec>& spines,
                        const std::vector<SpineRim>& rims,
                        const std::string& film);

}  // namespace meniscus::spines
