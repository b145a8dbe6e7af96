#include "evolve/energy/facet_size.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "evolve/films/drop_shape.h"

namespace meniscus::energy {

namespace {

/// s = sqrt(q N.N + r (a.N)^2) with q = across^2, r = along^2 - across^2 and a
/// of length 1.
class Support {
 public:
  Support(const Vec3& n, Numbers spheroid)
      : n_(n),
        axis_(spheroid[0], spheroid[1], spheroid[2]),
        length_(axis_.norm()),
        along_(spheroid[3]),
        across_(spheroid[4]) {
    axis_ /= length_;
    q_ = across_ * across_;
    r_ = along_ * along_ - q_;
    height_ = axis_.dot(n);
    value_ = std::sqrt(q_ * n.squaredNorm() + r_ * height_ * height_);
  }

  double value() const { return value_; }
  Vec3 slope() const { return (q_ * n_ + r_ * height_ * axis_) / value_; }
  Eigen::Matrix3d curve() const {
    const Vec3 g = slope();
    return (q_ * Eigen::Matrix3d::Identity() + r_ * axis_ * axis_.transpose() -
            g * g.transpose()) /
           value_;
  }

  FacetSize rate(Numbers rates) const {
    const Vec3 moving(rates[0], rates[1], rates[2]);
    const Vec3 turn = (moving - axis_.dot(moving) * axis_) / length_;
    const double q = 2.0 * across_ * rates[4];
    const double r = 2.0 * along_ * rates[3] - q;
    const double rise = turn.dot(n_);
    FacetSize result;
    result.value = (0.5 * (q * n_.squaredNorm() + r * height_ * height_) +
                    r_ * height_ * rise) /
                   value_;
    result.slope = (q * n_ + r * height_ * axis_ + r_ * rise * axis_ +
                    r_ * height_ * turn - result.value * slope()) /
                   value_;
    return result;
  }

 private:
  Vec3 n_, axis_;
  double length_, along_, across_;
  double q_ = 0.0, r_ = 0.0, height_ = 0.0, value_ = 0.0;
};

/// Calls each(spheroid's numbers, index of their first).
template <class Each>
void over_spheroids(Numbers spheroids, const Each& each) {
  for (std::size_t k = 0; k < spheroids.size(); k += films::kSpheroidNumbers) {
    each(spheroids.subspan(k, films::kSpheroidNumbers), k);
  }
}

}  // namespace

FacetSize facet_size(const Vec3& n, Numbers spheroids) {
  FacetSize sum;
  const double size = n.norm();
  if (!(size > 0.0)) {
    return sum;
  }
  if (spheroids.empty()) {
    sum.value = size;
    sum.slope = n / size;
    sum.curve =
        (Eigen::Matrix3d::Identity() - sum.slope * sum.slope.transpose()) /
        size;
    return sum;
  }
  over_spheroids(spheroids, [&](Numbers spheroid, std::size_t /*first*/) {
    const Support part(n, spheroid);
    sum.value += part.value();
    sum.slope += part.slope();
    sum.curve += part.curve();
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
