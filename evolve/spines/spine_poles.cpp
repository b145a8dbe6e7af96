#include "evolve/spines/spine_poles.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/gauss_rule.h"

namespace meniscus::spines {

namespace {

constexpr double kPanel = 2.0;  // most length of the Gauss points below [radii]
constexpr int kPanelPoints = 5;
constexpr double kStrength =
    0.75 * (1.0 + kCore * kCore) * (1.0 + kCore * kCore);
constexpr double kBeyond = 3.0;  // how far a spine goes on [radii]
constexpr int kBeyondPoints = 6;
constexpr double kMostPoints = 2000;  // of one spine

/// Weights of the points of a curve at u in [0, count - 1]: a natural cubic
/// through points one apart, a periodic one where it is closed, or straight
/// pieces.
class PointWeights {
 public:
  PointWeights(int count, bool smooth, bool closed) : count_(count) {
    // Second derivatives M of the cubic: M_(k-1) + 4 M_k + M_(k+1) =
    // 6 (P_(k-1) - 2 P_k + P_(k+1)); 0 at both ends, or the same there.
    bend_ = Eigen::MatrixXd::Zero(count, count);
    if (!smooth || count < 3) {
      return;
    }
    Eigen::MatrixXd left = Eigen::MatrixXd::Identity(count, count);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, count);
    for (int k = 1; k + 1 < count; ++k) {
      left.row(k).segment<3>(k - 1) << 1.0, 4.0, 1.0;
      right.row(k).segment<3>(k - 1) << 6.0, -12.0, 6.0;
    }
    if (closed) {
      left(0, 0) = 4.0;
      left(0, 1) = left(0, count - 2) = 1.0;
      right(0, 0) = -12.0;
      right(0, 1) = right(0, count - 2) = 6.0;
      left(count - 1, 0) = -1.0;
    }
    for (int c = 0; c < count; ++c) {
      bend_.col(c) = least_squares(left, right.col(c)).x;
    }
  }

  VectorX value(double u) const {
    const auto [k, t] = piece(u);
    const double s = 1.0 - t;
    VectorX w = (s * s * s - s) / 6.0 * bend_.row(k).transpose() +
                (t * t * t - t) / 6.0 * bend_.row(k + 1).transpose();
    w[k] += s;
    w[k + 1] += t;
    return w;
  }

  VectorX slope(double u) const {
    const auto [k, t] = piece(u);
    const double s = 1.0 - t;
    VectorX w = (1.0 - 3.0 * s * s) / 6.0 * bend_.row(k).transpose() +
                (3.0 * t * t - 1.0) / 6.0 * bend_.row(k + 1).transpose();
    w[k] -= 1.0;
    w[k + 1] += 1.0;
    return w;
  }

 private:
  std::pair<int, double> piece(double u) const {
    const int k = std::clamp(static_cast<int>(u), 0, count_ - 2);
    return {k, u - k};
  }
  int count_;
  Eigen::MatrixXd bend_;  // of the points: second derivatives at each
};

void require(bool holds, const std::string& spine, const std::string& what) {
  if (!holds) {
    throw InvalidInput(fmt::format("spine '{}': {}", spine, what));
  }
}

void check_spine(const films::SpineSpec& spine) {
  const std::size_t count = spine.points.size();
  require(count >= 2, spine.name,
          fmt::format("it needs two points or more, found {}", count));
  require(spine.radii.size() == count, spine.name,
          fmt::format("{} radii for {} points; give one of each point, or one "
                      "number for all",
                      spine.radii.size(), count));
  for (std::size_t k = 0; k < count; ++k) {
    require(spine.points[k].allFinite(), spine.name,
            fmt::format("point {} is not finite", k + 1));
    require(std::isfinite(spine.radii[k]) && spine.radii[k] > 0.0, spine.name,
            fmt::format("radius {} is {:.6g}, must be above 0", k + 1,
                        spine.radii[k]));
    require(k == 0 || (spine.points[k] - spine.points[k - 1]).norm() >
                          1e-6 * spine.radii[k],
            spine.name, fmt::format("points {} and {} coincide", k, k + 1));
  }
  require(std::isfinite(spine.tension) && spine.tension > 0.0, spine.name,
          fmt::format("its tension is {:.6g}, must be above 0", spine.tension));
}

Vec3 weighted(const VectorX& weights, const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    sum += weights[k] * points[static_cast<std::size_t>(k)];
  }
  return sum;
}

double weighted(const VectorX& weights, const std::vector<double>& values) {
  return weights.dot(
      VectorX::Map(values.data(), static_cast<Eigen::Index>(values.size())));
}

/// A sample at a design: place, radius, and length of its step.
struct Place {
  Vec3 at, slope, way;  // c or beyond it; dc/du; unit tangent
  double radius, length;
};

Place place_of(const films::SpineSample& sample,
               const films::SpineSpec& spine) {
  Place p;
  p.slope = weighted(sample.slope, spine.points);
  p.way = p.slope.normalized();
  p.radius = weighted(sample.radius, spine.radii);
  p.at =
      weighted(sample.place, spine.points) + sample.beyond * p.radius * p.way;
  p.length = sample.step * (sample.beyond == 0.0 ? p.slope.norm() : p.radius);
  return p;
}

const films::SpineSpec& spine_named(const std::vector<films::SpineSpec>& spines,
                                    const std::string& name) {
  const auto spine =
      std::find_if(spines.begin(), spines.end(),
                   [&](const films::SpineSpec& s) { return s.name == name; });
  if (spine == spines.end()) {
    throw InvalidInput(
        fmt::format("the design has no spine '{}', which its model has", name));
  }
  return *spine;
}

/// `of_spine`: a sampling -> its poles.
template <class OfSpine>
std::vector<films::Pole> poles_of_body(
    const std::vector<films::SpineSampling>& samplings, int body,
    const OfSpine& of_spine) {
  std::vector<films::Pole> poles;
  for (const films::SpineSampling& sampling : samplings) {
    if (sampling.body == body) {
      const std::vector<films::Pole> more = of_spine(sampling);
      poles.insert(poles.end(), more.begin(), more.end());
    }
  }
  return poles;
}

}  // namespace

bool is_closed(const films::SpineSpec& spine) {
  // Expressions of whole turns close to the last figures.
  return spine.points.size() > 3 && !spine.radii.empty() &&
         (spine.points.front() - spine.points.back()).norm() <
             1e-6 * spine.radii.front();
}

films::SpineSampling sample_spine(const films::SpineSpec& spine, int body,
                                  const std::array<bool, 2>& beyond) {
  check_spine(spine);
  const auto count = static_cast<int>(spine.points.size());
  const bool closed = is_closed(spine);
  const PointWeights curve(count, spine.smooth, closed);
  const PointWeights radius(count, false, false);
  films::SpineSampling result{.name = spine.name,
                              .body = body,
                              .beyond = beyond,
                              .closed = closed,
                              .samples = {}};
  const auto add = [&](double u, double step, double past) {
    result.samples.push_back(
        {curve.value(u), curve.slope(u), radius.value(u), step, past});
  };
  const auto past_end = [&](double u, double side) {
    for (const GaussPoint& g : gauss_rule(kBeyondPoints)) {
      add(u, kBeyond * g.weight, side * kBeyond * g.at);
    }
  };
  if (beyond[0]) {
    past_end(0.0, -1.0);
  }
  for (int k = 0; k + 1 < count; ++k) {
    const double least = std::min(spine.radii[k], spine.radii[k + 1]);
    const double length = (spine.points[k + 1] - spine.points[k]).norm();
    const double panels = std::ceil(length / (kPanel * least));
    const auto before = static_cast<double>(result.samples.size());
    require(before + panels * kPanelPoints <= kMostPoints, spine.name,
            fmt::format("it is {:.3g} times as long as wide between points {} "
                        "and {}",
                        0.5 * length / least, k + 1, k + 2));
    for (int panel = 0; panel < panels; ++panel) {
      for (const GaussPoint& g : gauss_rule(kPanelPoints)) {
        add(k + (panel + g.at) / panels, g.weight / panels, 0.0);
      }
    }
  }
  if (beyond[1]) {
    past_end(count - 1.0, 1.0);
  }
  return result;
}

std::vector<films::Pole> poles_of(const films::SpineSampling& sampling,
                                  const films::SpineSpec& spine) {
  check_spine(spine);
  require(is_closed(spine) == sampling.closed, spine.name,
          "a design closes or opens it, which its model cannot follow");
  std::vector<films::Pole> poles;
  poles.reserve(sampling.samples.size());
  for (const films::SpineSample& sample : sampling.samples) {
    require(
        sample.place.size() == static_cast<Eigen::Index>(spine.points.size()),
        spine.name, "a design has another number of points than its model");
    const Place p = place_of(sample, spine);
    const double cube = p.radius * p.radius * p.radius;
    poles.push_back({p.at, kStrength * spine.tension * cube * p.length,
                     kCore * kCore * p.radius * p.radius});
  }
  return poles;
}

std::vector<films::Pole> pole_rates(const films::SpineSampling& sampling,
                                    const films::SpineSpec& spine,
                                    const films::SpineSpec& rates) {
  std::vector<films::Pole> result;
  result.reserve(sampling.samples.size());
  for (const films::SpineSample& sample : sampling.samples) {
    const Place p = place_of(sample, spine);
    const double speed = p.slope.norm();
    const Vec3 slope_rate = weighted(sample.slope, rates.points);
    const Vec3 way_rate = (slope_rate - p.way.dot(slope_rate) * p.way) / speed;
    const double radius_rate = weighted(sample.radius, rates.radii);
    const double length_rate =
        sample.step *
        (sample.beyond == 0.0 ? p.way.dot(slope_rate) : radius_rate);
    const double square = p.radius * p.radius;
    films::Pole rate;
    rate.at = weighted(sample.place, rates.points) +
              sample.beyond * (radius_rate * p.way + p.radius * way_rate);
    rate.strength = kStrength * square *
                    (rates.tension * p.radius * p.length +
                     spine.tension * (3.0 * radius_rate * p.length +
                                      p.radius * length_rate));
    rate.core2 = 2.0 * kCore * kCore * p.radius * radius_rate;
    result.push_back(rate);
  }
  return result;
}

std::vector<films::Pole> poles_of(
    const std::vector<films::SpineSampling>& samplings, int body,
    const std::vector<films::SpineSpec>& spines) {
  return poles_of_body(samplings, body, [&](const auto& sampling) {
    return poles_of(sampling, spine_named(spines, sampling.name));
  });
}

std::vector<films::Pole> pole_rates(
    const std::vector<films::SpineSampling>& samplings, int body,
    const std::vector<films::SpineSpec>& spines,
    const std::vector<films::SpineSpec>& rates) {
  return poles_of_body(samplings, body, [&](const auto& sampling) {
    return pole_rates(sampling, spine_named(spines, sampling.name),
                      spine_named(rates, sampling.name));
  });
}

void sample_again(const std::vector<films::SpineSpec>& spines,
                  std::vector<films::SpineSampling>& samplings) {
  for (films::SpineSampling& sampling : samplings) {
    sampling = sample_spine(spine_named(spines, sampling.name), sampling.body,
                            sampling.beyond);
  }
}

}  // namespace meniscus::spines
