#include "fea/face_points.h"

#include <cmath>

#include <Eigen/Geometry>

namespace meniscus {

namespace {

struct Point {
  std::array<double, 3> L;
  double weight;  // of the reference triangle, whose area is 1/2
};

void add_turns(double a, double weight, std::vector<Point>& points) {
  for (int c = 0; c < 3; ++c) {
    points.push_back({{a, a, a}, 0.5 * weight});
    points.back().L[c] = 1.0 - 2.0 * a;
  }
}

std::vector<Point> rule_points(FaceRule rule) {
  std::vector<Point> points;
  if (rule == FaceRule::Three) {
    add_turns(1.0 / 6.0, 1.0 / 3.0, points);
    return points;
  }
  const double root = std::sqrt(15.0);
  points.push_back({{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}, 0.5 * 9.0 / 40.0});
  add_turns((6.0 - root) / 21.0, (155.0 - root) / 1200.0, points);
  add_turns((6.0 + root) / 21.0, (155.0 + root) / 1200.0, points);
  return points;
}

}  // namespace

FaceQuadrature::FaceQuadrature(int order, FaceRule rule) {
  constexpr double kSlope[3][2] = {{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};
  for (const auto& [L, weight] : rule_points(rule)) {
    Reference point{.weight = weight};
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      point.shape[a] = order == 1 ? L[a] : L[a] * (2.0 * L[a] - 1.0);
      point.shape[3 + a] = 4.0 * L[a] * L[b];
      for (int k = 0; k < 2; ++k) {
        point.slope[a][k] =
            kSlope[a][k] * (order == 1 ? 1.0 : 4.0 * L[a] - 1.0);
        point.slope[3 + a][k] =
            4.0 * (kSlope[a][k] * L[b] + kSlope[b][k] * L[a]);
      }
    }
    points_.push_back(point);
  }
}

FacePoint FaceQuadrature::at(const TetMesh& mesh, int face, int point) const {
  const Reference& from = points_[point];
  FacePoint result{.shape = from.shape};
  Vec3 u = Vec3::Zero();
  Vec3 v = Vec3::Zero();
  const auto ids = mesh.face(face);
  for (std::size_t a = 0; a < ids.size(); ++a) {
    const Vec3& x = mesh.nodes[ids[a]];
    result.position += from.shape[a] * x;
    u += from.slope[a][0] * x;
    v += from.slope[a][1] * x;
  }
  result.normal = from.weight * u.cross(v);
  return result;
}

}  // namespace meniscus
