#include "evolve/start/rim_stitcher.h"

#include <algorithm>

namespace meniscus::start {

namespace {

// A point may be this far off a straight side [size of all rims].
constexpr double kReach = 1e-6;

}  // namespace

RimStitcher::RimStitcher(const Points& points, std::vector<Triangle>& facets)
    : points_(points),
      facets_(facets),
      reach_(kReach * bounding_diagonal(points)),
      used_(points.size(), 0) {
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    list(f);
    for (const int v : facets[f]) {
      used_[v] = 1;
    }
  }
}

int RimStitcher::stitch(int first, int n) {
  int start = 0;
  while (start < n && used_[first + start] == 0) {
    ++start;
  }
  if (start == n) {
    return first;
  }
  for (int i = start; i < start + n;) {
    std::vector<int> chain = {first + i % n};
    do {
      ++i;
      chain.push_back(first + i % n);
    } while (used_[chain.back()] == 0);
    const int off = stitch_side(chain);
    if (off >= 0) {
      return off;
    }
  }
  return -1;
}

std::size_t RimStitcher::open_edges() const {
  return std::count_if(side_.begin(), side_.end(), [&](const auto& s) {
    return side_.count({s.first[1], s.first[0]}) == 0;
  });
}

void RimStitcher::list(int f) {
  for (int k = 0; k < 3; ++k) {
    side_[{facets_[f][k], facets_[f][(k + 1) % 3]}] = f;
  }
}

// Cuts the facet along the chain's ends into a fan over its points.
int RimStitcher::stitch_side(const std::vector<int>& chain) {
  const int a = chain.front();
  const int b = chain.back();
  const bool backward = side_.count({b, a}) > 0;
  const Edge edge = backward ? Edge{b, a} : Edge{a, b};
  const auto at = side_.find(edge);
  if (a == b || at == side_.end() || side_.count({edge[1], edge[0]}) > 0) {
    return chain[1];
  }
  const int f = at->second;
  const Triangle t = facets_[f];
  const int apex = t[0] + t[1] + t[2] - a - b;
  const Vec3 along = (points_[b] - points_[a]).normalized();
  for (const int v : chain) {
    const Vec3 off = points_[v] - points_[a];
    if ((off - along * along.dot(off)).norm() > reach_) {
      return v;
    }
  }
  if (chain.size() > 2) {
    side_.erase(at);
  }
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    const Triangle piece = backward ? Triangle{chain[k + 1], chain[k], apex}
                                    : Triangle{chain[k], chain[k + 1], apex};
    const int id = k == 0 ? f : static_cast<int>(facets_.size());
    if (k == 0) {
      facets_[f] = piece;
    } else {
      facets_.push_back(piece);
    }
    list(id);
  }
  return -1;
}

}  // namespace meniscus::start
