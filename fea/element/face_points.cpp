#include "fea/element/face_points.h"

#include <cmath>

#include <Eigen/Geometry>

namespace meniscus::element {

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

/// Corners, then mid-sides (01) (12) (20).
std::vector<Point> node_points() {
  std::vector<Point> points;
  for (int c = 0; c < 3; ++c) {
    points.push_back({{0.0, 0.0, 0.0}, 0.5});
    points.back().L[c] = 1.0;
  }
  for (int m = 0; m < 3; ++m) {
    points.push_back({{0.5, 0.5, 0.5}, 0.5});
    points.back().L[(m + 2) % 3] = 0.0;
  }
  return points;
}

std::vector<Point> rule_points(FaceRule rule) {
  if (rule == FaceRule::Nodes) {
    return node_points();
  }
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
      point.shape[3 + a] = order == 1 ? 0.0 : 4.0 * L[a] * L[b];
      for (int k = 0; k < 2; ++k) {
        point.slope[a][k] =
            kSlope[a][k] * (order == 1 ? 1.0 : 4.0 * L[a] - 1.0);
        point.slope[3 + a][k] =
            order == 1 ? 0.0
                       : 4.0 * (kSlope[a][k] * L[b] + kSlope[b][k] * L[a]);
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

void FaceQuadrature::pull_back(const TetMesh& mesh, int face, int point,
                               const Vec3& by_position, const Vec3& by_normal,
                               Points& gradient) const {
  const Reference& from = points_[point];
  Vec3 u = Vec3::Zero();
  Vec3 v = Vec3::Zero();
  const auto ids = mesh.face(face);
  for (std::size_t a = 0; a < ids.size(); ++a) {
    const Vec3& x = mesh.nodes[ids[a]];
    u += from.slope[a][0] * x;
    v += from.slope[a][1] * x;
  }
  const Vec3 by_u = from.weight * v.cross(by_normal);
  const Vec3 by_v = from.weight * by_normal.cross(u);
  for (std::size_t a = 0; a < ids.size(); ++a) {
    gradient[ids[a]] += from.shape[a] * by_position + from.slope[a][0] * by_u +
                        from.slope[a][1] * by_v;
  }
}

}  // namespace meniscus::element
