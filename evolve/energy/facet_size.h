/// What a facet's area counts for, as a function of N, twice its area vector:
/// |N|, or of a tension that depends on the normal the support function of its
/// drop shape at N (evolve/films/drop_shape.h). Both grow as N does.
#pragma once

#include "core/math/place_field.h"
#include "core/types.h"

namespace meniscus::energy {

struct FacetSize {
  double value = 0.0;
  Vec3 slope = Vec3::Zero();  // by N
  Eigen::Matrix3d curve = Eigen::Matrix3d::Zero();
};

/// `spheroids`: as films::tension_numbers has them; none: |N|. All zero for a
/// facet without area. The curve stays 0 where it is not asked for.
FacetSize facet_size(const Vec3& n, Numbers spheroids, bool curved = true);

/// How fast value and slope change as the spheroids do.
FacetSize facet_size_rate(const Vec3& n, Numbers spheroids, Numbers rates);

/// Adds by_value x the derivative of the value and that of by_slope . slope,
/// by each number of the spheroids, to `sum` from `first` on.
void add_by_spheroids(const Vec3& n, Numbers spheroids, double by_value,
                      const Vec3& by_slope, VectorX& sum, std::size_t first);

}  // namespace meniscus::energy
