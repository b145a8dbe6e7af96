#include "evolve/films/loft.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/geometry/surface_mesh.h"
#include "core/heed_stop.h"

namespace meniscus::films {

namespace {

// Share of the length from point 0 to each point, and 1 at the end.
std::vector<double> shares(const Points& points) {
  std::vector<double> along = {0.0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& next = points[(i + 1) % points.size()];
    along.push_back(along.back() + (next - points[i]).norm());
  }
  const double total = along.back();
  for (double& a : along) {
    a /= total;
  }
  return along;
}

Vec3 point_at_share(const Points& points, const std::vector<double>& along,
                    double share, std::size_t& hint) {
  while (along[hint + 1] < share) {
    ++hint;
  }
  const double w = (share - along[hint]) / (along[hint + 1] - along[hint]);
  return (1.0 - w) * points[hint] + w * points[(hint + 1) % points.size()];
}

// Do both curves turn the same way around the band? Seen along the line of
// centres; where that lies in a curve's plane, by their normals.
bool same_way(const Vec3& low_area, const Vec3& high_area, const Vec3& line) {
  const double seen_low = low_area.normalized().dot(line);
  const double seen_high = high_area.normalized().dot(line);
  const double least = 1e-6 * line.norm();
  if (std::abs(seen_low) > least && std::abs(seen_high) > least) {
    return (seen_low > 0.0) == (seen_high > 0.0);
  }
  return low_area.dot(high_area) >= 0.0;
}

// The rotation that brings the curves' planes together, so that a bend does
// not count as a twist.
Mat3 turn_between(const Vec3& from, const Vec3& to) {
  if (!(from.norm() > 0.0) || !(to.norm() > 0.0)) {
    return Mat3::Identity();  // a curve whose shadows cancel (a figure eight)
  }
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

// The order in which to walk `high` beside `low`, and the share of the length
// at each of its points.
struct Walk {
  std::vector<int> order;
  std::vector<double> along;
};

// Of all starts on `high` the one with the least sum of squared distances.
Walk matched_walk(const Points& low, const std::vector<double>& low_along,
                  const Points& high, std::optional<bool> along) {
  const int m = static_cast<int>(high.size());
  const Vec3 low_centre = mean_of(low);
  const Vec3 high_centre = mean_of(high);
  const Vec3 low_area = polygon_area_vector(low);
  const Vec3 high_area = polygon_area_vector(high);
  const bool forward =
      along.value_or(same_way(low_area, high_area, high_centre - low_centre));
  const Mat3 turn =
      turn_between(low_area, forward ? high_area : Vec3(-high_area));
  Walk best;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < m; ++start) {
    heed_stop("film");
    Walk walk;
    Points path;
    for (int j = 0; j < m; ++j) {
      walk.order.push_back(((forward ? start + j : start - j) % m + m) % m);
      path.push_back(high[walk.order.back()]);
    }
    walk.along = shares(path);
    std::size_t hint = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < low.size(); ++i) {
      const Vec3 turned = turn * (low[i] - low_centre) + high_centre;
      sum += (point_at_share(path, walk.along, low_along[i], hint) - turned)
                 .squaredNorm();
    }
    if (best.order.empty() || sum < least * (1.0 - 1e-9)) {
      least = sum;
      best = std::move(walk);
    }
  }
  return best;
}

}  // namespace

std::vector<Triangle> loft_band(const Points& low, const Points& high,
                                std::optional<bool> same_way) {
  std::vector<Triangle> facets;
  if (low.empty() || high.empty()) {
    return facets;
  }
  const int n = static_cast<int>(low.size());
  const int m = static_cast<int>(high.size());
  const std::vector<double> along = shares(low);
  const Walk walk = matched_walk(low, along, high, same_way);
  int i = 0;
  int j = 0;
  while (i < n || j < m) {
    const int a = i < n ? i : 0;
    const int b = n + walk.order[j < m ? j : 0];
    // Advance on the side whose next piece has its middle first.
    const bool on_low =
        j == m || (i < n && along[i] + along[i + 1] <=
                                walk.along[j] + walk.along[j + 1] + 1e-12);
    if (on_low) {
      facets.push_back({a, i + 1 < n ? i + 1 : 0, b});
      ++i;
    } else {
      facets.push_back({a, n + walk.order[j + 1 < m ? j + 1 : 0], b});
      ++j;
    }
  }
  return facets;
}

}  // namespace meniscus::films
