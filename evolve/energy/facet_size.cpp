#include "evolve/energy/facet_size.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "evolve/films/drop_shape.h"

namespace meniscus::energy {

namespace {

/// s = sqrt(along^2 h^2 + across^2 |N - h a|^2), h = a.N, a of length 1.
class Support {
 public:
  Support(const Vec3& n, Numbers spheroid)
      : n_(n),
        axis_(spheroid[0], spheroid[1], spheroid[2]),
        length_(axis_.norm()),
        along_(spheroid[3]),
        across_(spheroid[4]) {
    axis_ /= length_;
    height_ = axis_.dot(n);
    aside_ = n - height_ * axis_;
    value_ = std::hypot(along_ * height_, across_ * aside_.norm());
    slope_ = (along_ * along_ * height_ * axis_ + across_ * across_ * aside_) /
             value_;
  }

  double value() const { return value_; }
  const Vec3& slope() const { return slope_; }
  Eigen::Matrix3d curve() const {
    const Eigen::Matrix3d along = axis_ * axis_.transpose();
    return (across_ * across_ * (Eigen::Matrix3d::Identity() - along) +
            along_ * along_ * along - slope_ * slope_.transpose()) /
           value_;
  }

  FacetSize rate(Numbers rates) const {
    const Vec3 moving(rates[0], rates[1], rates[2]);
    const Vec3 turn = (moving - axis_.dot(moving) * axis_) / length_;
    const double along = 2.0 * along_ * rates[3];  // of the squares
    const double across = 2.0 * across_ * rates[4];
    const double longer = along_ * along_ - across_ * across_;
    const double rise = turn.dot(n_);
    FacetSize result;
    result.value =
        (0.5 * (along * height_ * height_ + across * aside_.squaredNorm()) +
         longer * height_ * rise) /
        value_;
    result.slope =
        (along * height_ * axis_ + across * aside_ +
         longer * (rise * axis_ + height_ * turn) - result.value * slope_) /
        value_;
    return result;
  }

 private:
  Vec3 n_, axis_;
  double length_, along_, across_;
  double height_ = 0.0, value_ = 0.0;
  Vec3 aside_, slope_;
};

/// Calls each(spheroid's numbers, index of their first).
template <class Each>
void over_spheroids(Numbers spheroids, const Each& each) {
  for (std::size_t k = 0; k < spheroids.size(); k += films::kSpheroidNumbers) {
    each(spheroids.subspan(k, films::kSpheroidNumbers), k);
  }
}

}  // namespace

FacetSize facet_size(const Vec3& n, Numbers spheroids, bool curved) {
  FacetSize sum;
  const double size = n.norm();
  if (!(size > 0.0)) {
    return sum;
  }
  if (spheroids.empty()) {
    sum.value = size;
    sum.slope = n / size;
    if (curved) {
      sum.curve =
          (Eigen::Matrix3d::Identity() - sum.slope * sum.slope.transpose()) /
          size;
    }
    return sum;
  }
  over_spheroids(spheroids, [&](Numbers spheroid, std::size_t /*first*/) {
    const Support part(n, spheroid);
    sum.value += part.value();
    sum.slope += part.slope();
    if (curved) {
      sum.curve += part.curve();
    }
  });
  return sum;
}

FacetSize facet_size_rate(const Vec3& n, Numbers spheroids, Numbers rates) {
  FacetSize sum;
  if (n.isZero(0.0)) {
    return sum;
  }
  over_spheroids(spheroids, [&](Numbers spheroid, std::size_t first) {
    const FacetSize part =
        Support(n, spheroid)
            .rate(rates.subspan(first, films::kSpheroidNumbers));
    sum.value += part.value;
    sum.slope += part.slope;
  });
  return sum;
}

void add_by_spheroids(const Vec3& n, Numbers spheroids, double by_value,
                      const Vec3& by_slope, VectorX& sum, std::size_t first) {
  if (n.isZero(0.0)) {
    return;
  }
  over_spheroids(spheroids, [&](Numbers spheroid, std::size_t at) {
    const Support part(n, spheroid);
    std::array<double, films::kSpheroidNumbers> unit{};
    for (std::size_t k = 0; k < unit.size(); ++k) {
      unit.fill(0.0);
      unit[k] = 1.0;
      const FacetSize rate = part.rate(unit);
      sum[static_cast<Eigen::Index>(first + at + k)] +=
          by_value * rate.value + by_slope.dot(rate.slope);
    }
  });
}

}  // namespace meniscus::energy
