/// Triangles on the ruled band between two rims.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"
#include "evolve/films/ruled_band.h"

namespace meniscus::start {

/// A rim of a band: its points in order around, and where each stands, by the
/// parameter of the band's outer curve.
struct BandRim {
  Points points;
  std::vector<double> t;
};

struct BandFilling {
  SurfaceMesh mesh;  // points: the outer rim's, the inner's, those between
  std::vector<films::BandPlace> between;
};

/// Facets of about `edge`, finer where a rim is cut finer; no other points lie
/// on the rims, and facets run along the outer rim in its direction. Rows along
/// the band where its lines are of about one length, else isotropic facets
/// (fill_ring) put on the band.
BandFilling fill_band(const films::RuledBand& band,
                      const std::vector<curves::Curve>& curves,
                      const BandRim& outer, const BandRim& inner, double edge);

}  // namespace meniscus::start
