#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/expression.h"
#include "core/math/place_shape.h"

namespace meniscus {

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) {
    throw InvalidInput(message);
  }
}

/// The five quartic B-splines that are not 0 at a place of one axis, and their
/// derivatives by the length along it.
struct SplineRow {
  static constexpr int kCount = 5;
  std::array<int, kCount> index = {};
  std::array<double, kCount> value = {1.0};
  std::array<double, kCount> first = {};
  std::array<double, kCount> second = {};
  int size = 1;

  SplineRow() = default;
  /// `s`: the place in spacings; `per`: spacings per length.
  SplineRow(double s, double per, int count, bool periodic) {
    if (count == 1) {
      return;
    }
    if (!periodic) {  // all is flat two and a half spacings beyond the ends
      s = std::clamp(s, -4.0, count + 3.0);
    }
    const double middle = std::round(s);
    const double f = s - middle;
    const double low = 0.5 - f;
    const double high = 0.5 + f;
    size = kCount;
    value = {low * low * low * low / 24.0, inner(f),
             115.0 / 192.0 + f * f * (0.25 * f * f - 0.625), inner(-f),
             high * high * high * high / 24.0};
    first = {-low * low * low / 6.0, inner_slope(f), f * (f * f - 1.25),
             -inner_slope(-f), high * high * high / 6.0};
    second = {0.5 * low * low, 0.5 + f - 2.0 * f * f, 3.0 * f * f - 1.25,
              0.5 - f - 2.0 * f * f, 0.5 * high * high};
    for (int k = 0; k < kCount; ++k) {
      const int at = static_cast<int>(middle) - 2 + k;
      index[k] = periodic ? ((at % count) + count) % count
                          : std::clamp(at, 0, count - 1);
      first[k] *= per;
      second[k] *= per * per;
    }
  }

 private:
  static double inner(double f) {
    return 19.0 / 96.0 + f * (-11.0 / 24.0 + f * (0.25 + f * (1.0 - f) / 6.0));
  }
  static double inner_slope(double f) {
    return -11.0 / 24.0 + f * (0.5 + f * (0.5 - 2.0 / 3.0 * f));
  }
};

class BoxSplines : public PlaceShape {
 public:
  explicit BoxSplines(const SplineBox& box) : box_(box) {
    for (int m = 0; m < 3; ++m) {
      const double size = box.to[m] - box.from[m];
      require(box.counts[m] >= 1,
              fmt::format("splines over a box: {} along {}; expected 1 or more",
                          box.counts[m], "xyz"[m]));
      require(box.counts[m] == 1 || (std::isfinite(size) && size > 0.0),
              fmt::format("splines over a box: it runs from {:g} to {:g} along "
                          "{}; expected a length above 0",
                          box.from[m], box.to[m], "xyz"[m]));
      per_[m] = box.counts[m] == 1 ? 0.0 : (box.counts[m] - 1) / size;
    }
  }
  int coefficients() const override {
    return box_.counts[0] * box_.counts[1] * box_.counts[2];
  }
  double spacing() const override { return 1.0 / per_.maxCoeff(); }

  PlaceJet jet(const Vec3& at, std::span<const double> c) const override {
    const Rows r = rows(at);
    PlaceJet sum;
    for (int i = 0; i < r[0].size; ++i) {
      // Of the sum over the two inner axes: value, by y, by z, yy, yz, zz.
      std::array<double, 6> across = {};
      for (int j = 0; j < r[1].size; ++j) {
        const std::size_t row = row_of(r, i, j);
        double v = 0.0, d = 0.0, dd = 0.0;
        for (int k = 0; k < r[2].size; ++k) {
          const double x = c[row + static_cast<std::size_t>(r[2].index[k])];
          v += r[2].value[k] * x;
          d += r[2].first[k] * x;
          dd += r[2].second[k] * x;
        }
        across[0] += r[1].value[j] * v;
        across[1] += r[1].first[j] * v;
        across[2] += r[1].value[j] * d;
        across[3] += r[1].second[j] * v;
        across[4] += r[1].first[j] * d;
        across[5] += r[1].value[j] * dd;
      }
      const double v = r[0].value[i];
      const double d = r[0].first[i];
      sum.value += v * across[0];
      sum.gradient += Vec3(d * across[0], v * across[1], v * across[2]);
      Eigen::Matrix3d& h = sum.hessian;
      h(0, 0) += r[0].second[i] * across[0];
      h(0, 1) += d * across[1];
      h(0, 2) += d * across[2];
      h(1, 1) += v * across[3];
      h(1, 2) += v * across[4];
      h(2, 2) += v * across[5];
    }
    sum.hessian(1, 0) = sum.hessian(0, 1);
    sum.hessian(2, 0) = sum.hessian(0, 2);
    sum.hessian(2, 1) = sum.hessian(1, 2);
    return sum;
  }

  void add_transposed(const Vec3& at, double by_value, const Vec3& by_gradient,
                      std::span<double> sum) const override {
    const Rows r = rows(at);
    for (int i = 0; i < r[0].size; ++i) {
      for (int j = 0; j < r[1].size; ++j) {
        const std::size_t row = row_of(r, i, j);
        const double plain = r[0].value[i] * r[1].value[j];
        const double other = by_value * plain +
                             by_gradient.x() * r[0].first[i] * r[1].value[j] +
                             by_gradient.y() * r[0].value[i] * r[1].first[j];
        for (int k = 0; k < r[2].size; ++k) {
          sum[row + static_cast<std::size_t>(r[2].index[k])] +=
              other * r[2].value[k] + by_gradient.z() * plain * r[2].first[k];
        }
      }
    }
  }

 private:
  using Rows = std::array<SplineRow, 3>;
  Rows rows(const Vec3& at) const {
    Rows r;
    for (int m = 0; m < 3; ++m) {
      r[m] = SplineRow((at[m] - box_.from[m]) * per_[m], per_[m],
                       box_.counts[m], false);
    }
    return r;
  }
  std::size_t row_of(const Rows& r, int i, int j) const {
    return static_cast<std::size_t>(
        (r[0].index[i] * box_.counts[1] + r[1].index[j]) * box_.counts[2]);
  }

  SplineBox box_;
  Vec3 per_;  // spacings per length
};

class AxisSplines : public PlaceShape {
 public:
  explicit AxisSplines(const SplineAxis& axis) : axis_(axis) {
    const Vec3 way = axis.to - axis.from;
    const double length = way.norm();
    require(axis.along >= 1 && axis.around >= 1,
            fmt::format("splines around an axis: {} along and {} around it; "
                        "expected 1 or more of both",
                        axis.along, axis.around));
    require(std::isfinite(length) && length > 0.0,
            "splines around an axis: it has no length");
    w_ = way / length;
    const Vec3 across = axis.zero - axis.zero.dot(w_) * w_;
    require(axis.around == 1 || across.norm() > 1e-9 * axis.zero.norm(),
            "splines around an axis: zero has no length across the axis; "
            "expected a direction across it");
    u_ = axis.around == 1 ? Vec3(w_.unitOrthogonal()) : across.normalized();
    v_ = w_.cross(u_);
    per_along_ = axis.along == 1 ? 0.0 : (axis.along - 1) / length;
    per_around_ = axis.around == 1 ? 0.0 : axis.around / (2 * std::numbers::pi);
  }
  int coefficients() const override { return axis_.along * axis_.around; }
  /// Around it where the axis is as far as it is long.
  double spacing() const override {
    return 1.0 /
           std::max(per_along_, per_around_ / (axis_.to - axis_.from).norm());
  }

  PlaceJet jet(const Vec3& at, std::span<const double> c) const override {
    const Coordinates x = coordinates(at);
    double value = 0.0, h = 0.0, a = 0.0, hh = 0.0, ha = 0.0, aa = 0.0;
    for (int i = 0; i < x.along.size; ++i) {
      double v = 0.0, d = 0.0, dd = 0.0;
      for (int k = 0; k < x.around.size; ++k) {
        const double here = c[at_of(x, i, k)];
        v += x.around.value[k] * here;
        d += x.around.first[k] * here;
        dd += x.around.second[k] * here;
      }
      value += x.along.value[i] * v;
      h += x.along.first[i] * v;
      a += x.along.value[i] * d;
      hh += x.along.second[i] * v;
      ha += x.along.first[i] * d;
      aa += x.along.value[i] * dd;
    }
    PlaceJet sum;
    sum.value = value;
    sum.gradient = h * w_ + a * x.turn;
    sum.hessian = hh * w_ * w_.transpose() + aa * x.turn * x.turn.transpose() +
                  ha * (w_ * x.turn.transpose() + x.turn * w_.transpose()) -
                  a * (x.out * x.turn.transpose() + x.turn * x.out.transpose());
    return sum;
  }

  void add_transposed(const Vec3& at, double by_value, const Vec3& by_gradient,
                      std::span<double> sum) const override {
    const Coordinates x = coordinates(at);
    const double by_h = by_gradient.dot(w_);
    const double by_a = by_gradient.dot(x.turn);
    for (int i = 0; i < x.along.size; ++i) {
      for (int k = 0; k < x.around.size; ++k) {
        sum[at_of(x, i, k)] +=
            (by_value * x.along.value[i] + by_h * x.along.first[i]) *
                x.around.value[k] +
            by_a * x.along.value[i] * x.around.first[k];
      }
    }
  }

 private:
  struct Coordinates {
    SplineRow along;
    SplineRow around;
    Vec3 turn = Vec3::Zero();  // gradient of the angle: e_t / r
    Vec3 out = Vec3::Zero();   // e_r / r
  };
  Coordinates coordinates(const Vec3& at) const {
    const Vec3 from = at - axis_.from;
    Coordinates x;
    x.along =
        SplineRow(from.dot(w_) * per_along_, per_along_, axis_.along, false);
    if (axis_.around > 1) {
      const double a = from.dot(u_);
      const double b = from.dot(v_);
      const double r2 = a * a + b * b;
      if (!(r2 > 1e-24 * (axis_.to - axis_.from).squaredNorm())) {
        throw ExpressionError("splines around an axis have no value on it", 1);
      }
      x.around = SplineRow(std::atan2(b, a) * per_around_, per_around_,
                           axis_.around, true);
      x.out = (a * u_ + b * v_) / r2;
      x.turn = (a * v_ - b * u_) / r2;
    }
    return x;
  }
  std::size_t at_of(const Coordinates& x, int i, int k) const {
    return static_cast<std::size_t>(x.along.index[i] * axis_.around +
                                    x.around.index[k]);
  }

  SplineAxis axis_;
  Vec3 u_, v_, w_;  // across and along the axis, unit
  double per_along_ = 0.0;
  double per_around_ = 0.0;
};

class RadialFunctions : public PlaceShape {
 public:
  explicit RadialFunctions(const RadialShape& shape) : shape_(shape) {
    require(!shape.points.empty(), "radial functions: there is no point");
    require(std::isfinite(shape.width) && shape.width > 0.0,
            fmt::format("radial functions: the width is {:g}; expected a "
                        "length above 0",
                        shape.width));
    for (const Vec3& p : shape.points) {
      require(p.allFinite(), "radial functions: a point is not finite");
    }
  }
  int coefficients() const override {
    return static_cast<int>(shape_.points.size());
  }
  double spacing() const override {
    return shape_.points.size() > 1 ? shape_.width
                                    : std::numeric_limits<double>::infinity();
  }

  PlaceJet jet(const Vec3& at, std::span<const double> c) const override {
    PlaceJet sum;
    Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
    for (const auto& [j, share, way] : shares_at(at)) {
      const double here = share * c[j];
      sum.value += here;
      sum.gradient += here * way;
      sum.hessian += here * way * way.transpose();
      bend += share * way * way.transpose();
    }
    sum.hessian -= sum.value * bend;
    return sum;
  }

  void add_transposed(const Vec3& at, double by_value, const Vec3& by_gradient,
                      std::span<double> sum) const override {
    for (const auto& [j, share, way] : shares_at(at)) {
      sum[j] += share * (by_value + by_gradient.dot(way));
    }
  }

 private:
  /// Those that count: share q of the sum, and gradient of log q,
  /// (p - mean p) / width^2.
  struct Share {
    std::size_t point;
    double share;
    Vec3 way;
  };
  /// Until the next call in this thread.
  const std::vector<Share>& shares_at(const Vec3& at) const {
    static thread_local std::vector<Share> shares;
    shares.clear();
    constexpr double kFaint = 45.0;  // e^-45 of the nearest one's is nothing
    const double over = 1.0 / (shape_.width * shape_.width);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& p : shape_.points) {
      nearest = std::min(nearest, (at - p).squaredNorm());
    }
    double sum = 0.0;
    Vec3 mean = Vec3::Zero();
    for (std::size_t j = 0; j < shape_.points.size(); ++j) {
      const Vec3& p = shape_.points[j];
      const double fall = 0.5 * over * ((at - p).squaredNorm() - nearest);
      if (fall < kFaint) {
        const double w = std::exp(-fall);
        sum += w;
        mean += w * (p - at);
        shares.push_back({j, w, p - at});
      }
    }
    mean /= sum;
    for (Share& share : shares) {
      share.share /= sum;
      share.way = over * (share.way - mean);
    }
    return shares;
  }

  RadialShape shape_;
};

}  // namespace

std::shared_ptr<const PlaceShape> box_splines(const SplineBox& box) {
  return std::make_shared<BoxSplines>(box);
}

std::shared_ptr<const PlaceShape> axis_splines(const SplineAxis& axis) {
  return std::make_shared<AxisSplines>(axis);
}

std::shared_ptr<const PlaceShape> radial_functions(const RadialShape& shape) {
  return std::make_shared<RadialFunctions>(shape);
}

double usual_width(const Points& points) {
  double sum = 0.0;
  for (const Vec3& p : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& q : points) {
      const double d = (p - q).norm();
      nearest = d > 0.0 ? std::min(nearest, d) : nearest;
    }
    sum += std::isfinite(nearest) ? nearest : 1.0;
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace meniscus
