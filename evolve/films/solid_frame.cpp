#include "evolve/films/solid_frame.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/exact_points.h"

namespace meniscus::films {

namespace {

struct Motion {
  Mat3 turn;
  Vec3 from;
  Vec3 to;

  Vec3 point(const Vec3& p) const { return to + turn * (p - from); }
  void move(Points& points) const {
    for (Vec3& p : points) {
      p = point(p);
    }
  }
  void operator()(ExactLine& c) const {
    c.point = point(c.point);
    c.direction = turn * c.direction;
  }
  void operator()(ExactEllipse& c) const {
    c.center = point(c.center);
    c.u = turn * c.u;
    c.v = turn * c.v;
  }
  void operator()(ExactSpline& c) const { move(c.poles); }
  void operator()(ExactSplineSurface& s) const { move(s.poles); }
  template <class Surface>
  void operator()(Surface& s) const {
    s.frame = {point(s.frame.origin), turn * s.frame.x, turn * s.frame.y,
               turn * s.frame.z};
  }
};

}  // namespace

std::array<Vec3, 4> frame_at(const curves::CurveShape& frame) {
  std::array<Vec3, 4> result;
  for (int k = 0; k < 4; ++k) {
    result[k] = curves::point_at(frame, frame_parameter(k));
  }
  return result;
}

std::array<double, 4> frame_weights(const std::array<Vec3, 4>& frame,
                                    const Vec3& at) {
  Mat3 ways;
  for (int k = 0; k < 3; ++k) {
    ways.col(k) = frame[k + 1] - frame[0];
  }
  const Vec3 share = ways.inverse() * (at - frame[0]);
  return {1.0 - share.sum(), share[0], share[1], share[2]};
}

ExactShape moved_shape(const ExactShape& shape, const std::array<Vec3, 4>& to) {
  const Points from = frame_points(shape);
  Motion motion;
  Mat3 before;
  Mat3 after;
  for (int k = 0; k < 3; ++k) {
    before.col(k) = (from[k + 1] - from[0]).normalized();
    after.col(k) = (to[k + 1] - to[0]).normalized();
  }
  motion.turn = after * before.transpose();
  motion.from = from[0];
  motion.to = to[0];
  ExactShape result = shape;
  motion.move(result.vertices);
  for (ExactEdge& edge : result.edges) {
    std::visit(motion, edge.curve);
  }
  for (ExactFace& face : result.faces) {
    std::visit(motion, face.surface);
  }
  return result;
}

ExactShape shape_at(const SolidSpec& solid,
                    const std::vector<curves::Curve>& curves) {
  if (solid.frame.empty()) {
    return *solid.shape;
  }
  for (const curves::Curve& curve : curves) {
    if (curve.name == solid.frame) {
      return moved_shape(*solid.shape, frame_at(curve.shape));
    }
  }
  throw InvalidInput(
      fmt::format("solid '{}' names the curve '{}', which does not exist",
                  solid.name, solid.frame));
}

}  // namespace meniscus::films
