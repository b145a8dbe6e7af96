#include "evolve/start/fill_patch.h"

#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr int kSteps = 64;  // of a side whose length is summed

/// Mean lengths of the sides that lines join, and of the first and last line.
struct PatchSize {
  double along = 0.0;
  double across = 0.0;
};

PatchSize size_of(const films::RuledBand& patch,
                  const std::vector<curves::Curve>& curves) {
  const auto point = [&](double part, double share) {
    return films::point_on_band(patch, curves, part * patch.span, share);
  };
  PatchSize size;
  for (int k = 0; k < kSteps; ++k) {
    for (const double share : {0.0, 1.0}) {
      size.along += 0.5 * (point((k + 1.0) / kSteps, share) -
                           point(static_cast<double>(k) / kSteps, share))
                              .norm();
    }
  }
  for (const double end : {0.0, 1.0}) {
    size.across += 0.5 * (point(end, 1.0) - point(end, 0.0)).norm();
  }
  return size;
}

}  // namespace

PatchFilling fill_patch(const films::RuledBand& patch,
                        const std::vector<curves::Curve>& curves,
                        const std::vector<films::BandPlace>& around,
                        double edge) {
  const PatchSize size = size_of(patch, curves);
  Points unrolled;
  for (const films::BandPlace& place : around) {
    unrolled.emplace_back(place.t / patch.span * size.along,
                          place.share * size.across, 0.0);
  }
  const SurfaceMesh disk = fill_disk(unrolled, edge);
  PatchFilling filling{disk.facets, {}};
  for (std::size_t k = unrolled.size(); k < disk.points.size(); ++k) {
    const Vec3& p = disk.points[k];
    filling.between.push_back(
        {p.x() / size.along * patch.span, p.y() / size.across});
  }
  return filling;
}

}  // namespace meniscus::start
