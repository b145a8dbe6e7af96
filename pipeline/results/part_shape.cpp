#include "pipeline/results/part_shape.h"

#include <algorithm>
#include <limits>

#include "core/geometry/edge_key.h"

namespace meniscus::results {

namespace {

constexpr double kFarthest = 0.25;  // of an edge, from its middle

Vec3 nearest_of(const std::array<Vec3, 2>& piece, const Vec3& at) {
  const Vec3 way = piece[1] - piece[0];
  const double length2 = way.squaredNorm();
  const double share =
      length2 > 0.0 ? std::clamp((at - piece[0]).dot(way) / length2, 0.0, 1.0)
                    : 0.0;
  return piece[0] + share * way;
}

}  // namespace

PartShape::PartShape(SurfaceMesh fine) : fine_(std::move(fine)) {
  std::vector<std::vector<int>> facets(fine_.labels.size());
  for (std::size_t f = 0; f < fine_.facets.size(); ++f) {
    facets[fine_.facet_label[f]].push_back(static_cast<int>(f));
  }
  for (const std::vector<int>& of_label : facets) {
    faces_.push_back(std::make_unique<FacetTree>(fine_, of_label));
  }
  std::map<Edge, int> label_beside;  // of each edge's first facet
  for (std::size_t f = 0; f < fine_.facets.size(); ++f) {
    const Triangle& t = fine_.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      const int label = fine_.facet_label[f];
      const auto [first, is_new] =
          label_beside.try_emplace(edge_key(a, b), label);
      if (!is_new && first->second != label) {
        lines_[edge_key(first->second, label)].push_back(
            {fine_.points[a], fine_.points[b]});
      }
    }
  }
}

Vec3 PartShape::nearest(const Vec3& at, const Edge& labels) const {
  if (labels[0] == labels[1]) {
    const auto nearest = faces_[labels[0]]->nearest(at);
    return nearest ? nearest->point : at;
  }
  const auto line = lines_.find(edge_key(labels[0], labels[1]));
  if (line == lines_.end()) {
    return at;
  }
  Vec3 place = at;
  double least = std::numeric_limits<double>::infinity();
  for (const std::array<Vec3, 2>& piece : line->second) {
    const Vec3 point = nearest_of(piece, at);
    if ((point - at).squaredNorm() < least) {
      least = (point - at).squaredNorm();
      place = point;
    }
  }
  return place;
}

Vec3 PartShape::middle(const Vec3& a, const Vec3& b, const Edge& labels) const {
  const Vec3 straight = 0.5 * (a + b);
  const Vec3 place = nearest(straight, labels);
  return (place - straight).norm() <= kFarthest * (b - a).norm() ? place
                                                                 : straight;
}

}  // namespace meniscus::results
