#include "evolve/fillets/section_walk.h"

#include <algorithm>

namespace meniscus::fillets {

namespace {

Mean mixed(const Mean& a, const Mean& b, double part) {
  Mean sum;
  for (const auto& [point, weight] : a) {
    sum.emplace_back(point, (1.0 - part) * weight);
  }
  for (const auto& of_b : b) {
    const auto same = std::find_if(
        sum.begin(), sum.end(),
        [&](const auto& of_a) { return of_a.first == of_b.first; });
    if (same == sum.end()) {
      sum.emplace_back(of_b.first, part * of_b.second);
    } else {
      same->second += part * of_b.second;
    }
  }
  return sum;
}

/// One plane's way over the facets. A point on the plane counts as behind it,
/// so that the plane always leaves a facet by an edge.
class Walker {
 public:
  Walker(const LabelledFacets& facets, int point, const Vec3& along)
      : facets_(facets),
        x_(facets.mesh().points),
        origin_(x_[point]),
        along_(along.normalized()) {
    walk_.points = {{{point, 1.0}}};
    walk_.lengths = {0.0};
  }

  std::optional<Walk> run(double most) {
    if (!begin()) {
      return std::nullopt;
    }
    const std::size_t facets = facets_.mesh().facets.size();
    while (walk_.length() < most && walk_.points.size() <= facets) {
      const int next = facets_.across(edge_, facet_);
      if (next < 0) {
        walk_.end = edge_;
        break;
      }
      facet_ = next;
      const Triangle& t = facets_.mesh().facets[facet_];
      const int third = t[0] + t[1] + t[2] - edge_[0] - edge_[1];
      const int other = ahead(third) == ahead(edge_[0]) ? edge_[1] : edge_[0];
      cross(edge_key(other, third));
    }
    return std::move(walk_);
  }

 private:
  double height(int v) const { return along_.dot(x_[v] - origin_); }
  bool ahead(int v) const { return height(v) > 0.0; }

  /// The first facet that the plane cuts opposite of its corner at the start.
  bool begin() {
    const int start = walk_.points[0][0].first;
    for (const int f : facets_.about(start)) {
      const Triangle& t = facets_.mesh().facets[f];
      const int k = t[0] == start ? 0 : (t[1] == start ? 1 : 2);
      const int a = t[(k + 1) % 3];
      const int b = t[(k + 2) % 3];
      if (ahead(a) != ahead(b)) {
        facet_ = f;
        cross(edge_key(a, b));
        return true;
      }
    }
    return false;
  }

  void cross(const Edge& edge) {
    edge_ = edge;
    const double a = height(edge[0]);
    const double b = height(edge[1]);
    const double part = a / (a - b);
    Mean place = {{edge[0], 1.0 - part}, {edge[1], part}};
    const double step =
        (at_mean(place, x_) - at_mean(walk_.points.back(), x_)).norm();
    walk_.lengths.push_back(walk_.length() + step);
    walk_.points.push_back(std::move(place));
  }

  const LabelledFacets& facets_;
  const Points& x_;
  Vec3 origin_;
  Vec3 along_;
  int facet_ = -1;
  Edge edge_ = {-1, -1};
  Walk walk_;
};

}  // namespace

Vec3 at_mean(const Mean& mean, const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const auto& [point, weight] : mean) {
    sum += weight * points[static_cast<std::size_t>(point)];
  }
  return sum;
}

LabelledFacets::LabelledFacets(const SurfaceMesh& mesh, int label)
    : mesh_(mesh), about_(mesh.points.size()) {
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      for (const int v : mesh.facets[f]) {
        about_[v].push_back(static_cast<int>(f));
        points_.push_back(v);
      }
    }
  }
  std::sort(points_.begin(), points_.end());
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
}

const std::vector<int>& LabelledFacets::about(int point) const {
  return about_[static_cast<std::size_t>(point)];
}

int LabelledFacets::across(const Edge& edge, int facet) const {
  for (const int f : about(edge[0])) {
    const Triangle& t = mesh_.facets[f];
    if (f != facet && std::find(t.begin(), t.end(), edge[1]) != t.end()) {
      return f;
    }
  }
  return -1;
}

std::vector<int> LabelledFacets::inner_points() const {
  std::vector<int> inner;
  std::copy_if(points_.begin(), points_.end(), std::back_inserter(inner),
               [&](int v) {
                 const std::vector<int>& facets = about(v);
                 return std::all_of(facets.begin(), facets.end(), [&](int f) {
                   const Triangle& t = mesh_.facets[f];
                   return std::all_of(t.begin(), t.end(), [&](int other) {
                     return other == v || across(edge_key(v, other), f) >= 0;
                   });
                 });
               });
  return inner;
}

Mean Walk::at(double length) const {
  std::size_t k = 1;
  while (k + 1 < lengths.size() && lengths[k] < length) {
    ++k;
  }
  const double step = lengths[k] - lengths[k - 1];
  const double part = step > 0.0 ? (length - lengths[k - 1]) / step : 0.0;
  return mixed(points[k - 1], points[k], part);
}

std::optional<Walk> walk_section(const LabelledFacets& facets, int point,
                                 const Vec3& along, double most) {
  return Walker(facets, point, along).run(most);
}

}  // namespace meniscus::fillets
