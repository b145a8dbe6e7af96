#include "report/render/cut_plane.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "core/math/dense.h"

namespace meniscus::render {

namespace {

/// Volumes and middles of the elements.
struct Pieces {
  std::vector<double> volume;
  Points middle;
  double total = 0.0;
};

Pieces pieces_of(const picture::PictureTets& tets) {
  Pieces pieces;
  for (const std::array<int, 4>& tet : tets.corners) {
    std::array<Vec3, 4> x;
    Vec3 middle = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      x[k] = tets.nodes[static_cast<std::size_t>(tet[k])];
      middle += 0.25 * x[k];
    }
    pieces.volume.push_back(
        std::abs((x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0])) / 6.0);
    pieces.middle.push_back(middle);
    pieces.total += pieces.volume.back();
  }
  return pieces;
}

/// The axes, and the directions of the part's own spread, towards the eye.
Points directions(const Pieces& pieces, const Vec3& to_eye) {
  Vec3 centre = Vec3::Zero();
  for (std::size_t e = 0; e < pieces.volume.size(); ++e) {
    centre += pieces.volume[e] / pieces.total * pieces.middle[e];
  }
  Mat3 spread = Mat3::Zero();
  for (std::size_t e = 0; e < pieces.volume.size(); ++e) {
    const Vec3 d = pieces.middle[e] - centre;
    spread += pieces.volume[e] * d * d.transpose();
  }
  const SymmetricEigen<3> eigen = symmetric_eigen(spread);
  Points found = {Vec3::UnitY(), Vec3::UnitX(), Vec3::UnitZ()};
  for (int k = 0; k < 3; ++k) {
    found.push_back(eigen.vectors.col(k));
  }
  for (Vec3& d : found) {
    d = d.dot(to_eye) < 0.0 ? Vec3(-d) : d;
  }
  return found;
}

}  // namespace

CutPlane cut_plane(const picture::PictureTets& tets, const Vec3& view) {
  // Depths, as parts of the volume before the cut: about the middle.
  constexpr std::array<double, 5> kParts = {0.5, 0.4, 0.6, 0.3, 0.7};
  constexpr double kBetter = 1.1;  // than an earlier one, to be taken
  const Pieces pieces = pieces_of(tets);
  const Vec3 to_eye = view.normalized();
  CutPlane best{to_eye, 0.0};
  double most = 0.0;
  if (!(pieces.total > 0.0)) {
    return best;
  }
  std::vector<std::pair<double, double>> along(pieces.volume.size());
  for (const Vec3& direction : directions(pieces, to_eye)) {
    for (std::size_t e = 0; e < along.size(); ++e) {
      along[e] = {direction.dot(pieces.middle[e]), pieces.volume[e]};
    }
    std::sort(along.begin(), along.end());
    // The section's area is how fast volume comes with depth there.
    const double slab = 0.04 * (along.back().first - along.front().first);
    for (const double part : kParts) {
      double before = 0.0;
      std::size_t at = 0;
      while (at + 1 < along.size() && before < part * pieces.total) {
        before += along[at++].second;
      }
      const double level = along[at].first;
      double inside = 0.0;
      for (const auto& [depth, volume] : along) {
        inside += std::abs(depth - level) < slab ? volume : 0.0;
      }
      const double seen =
          inside / std::max(2.0 * slab, 1e-300) * direction.dot(to_eye);
      if (seen > kBetter * most) {
        most = seen;
        best = {direction, level};
      }
    }
  }
  return best;
}

}  // namespace meniscus::render
