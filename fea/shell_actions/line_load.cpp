#include "fea/shell_actions/line_load.h"

#include <array>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "fea/shell/shell_loads.h"

namespace meniscus::shell {

namespace {

/// A point of the line with what its edge has there.
struct Point {
  std::array<int, 3> nodes;  // from, to, middle
  FacetEdge edge;
  LinePoint line;
  Vec3 place = Vec3::Zero();
  Vec3 along = Vec3::Zero();        // unit
  double length = 0.0;              // its share
  std::array<double, 2> ends = {};  // linear functions of from and to
  double thickness = 0.0;
};

std::vector<Point> points_of(const ShellMesh& mesh, const LineLoad& load) {
  std::vector<Point> points;
  for (const FacetEdge& edge : load.edges) {
    const std::array<int, 3> nodes = edge_nodes(mesh, edge);
    const int from = edge.edge;
    const int to = (edge.edge + 1) % 3;
    const Vec3& thickness = mesh.thickness[edge.facet];
    for (const LinePoint& line : line_points(mesh, nodes)) {
      Point point{nodes, edge, line};
      for (int k = 0; k < 3; ++k) {
        point.place += line.shape[k] * mesh.nodes[nodes[k]];
      }
      point.length = line.weight * line.tangent.norm();
      point.along = line.tangent.normalized();
      // The middle's function is shared by both ends.
      point.ends = {line.shape[0] + 0.5 * line.shape[2],
                    line.shape[1] + 0.5 * line.shape[2]};
      point.thickness =
          point.ends[0] * thickness[from] + point.ends[1] * thickness[to];
      points.push_back(point);
    }
  }
  return points;
}

/// The line as a rigid body that resists.
struct Body {
  std::vector<Point> points;
  double length = 0.0;
  Vec3 centre = Vec3::Zero();
  Mat3 inverse = Mat3::Zero();  // of the second moments [1/length^3]
};

/// Square of a wall's radius of gyration.
double bending(const Point& point) {
  return point.thickness * point.thickness / 12.0;
}

Body body_of(const ShellMesh& mesh, const LineLoad& load) {
  Body body;
  body.points = points_of(mesh, load);
  for (const Point& p : body.points) {
    body.length += p.length;
    body.centre += p.length * p.place;
  }
  if (!(body.length > 0.0)) {
    throw InvalidInput(fmt::format(
        "'{}' has no length that a load could be spread along", load.name));
  }
  body.centre /= body.length;
  Mat3 inertia = Mat3::Zero();
  for (const Point& p : body.points) {
    const Vec3 d = p.place - body.centre;
    inertia +=
        p.length * (d.squaredNorm() * Mat3::Identity() - d * d.transpose() +
                    bending(p) * p.along * p.along.transpose());
  }
  const auto eigen = symmetric_eigen(inertia);
  body.inverse = eigen.vectors * eigen.values.cwiseInverse().asDiagonal() *
                 eigen.vectors.transpose();
  return body;
}

Vec3 arm_of(const Body& body, const LineLoad& load) {
  return load.point ? Vec3(*load.point - body.centre) : Vec3(Vec3::Zero());
}

/// About the centre.
Vec3 moment_of(const Body& body, const LineLoad& load) {
  return load.moment + arm_of(body, load).cross(load.force);
}

struct Motion {
  Vec3 moved = Vec3::Zero();
  Vec3 turned = Vec3::Zero();
};

Motion motion_at(const Point& point, const VectorX& v) {
  Motion motion;
  for (int k = 0; k < 3; ++k) {
    const auto at = 6L * point.nodes[k];
    motion.moved += point.line.shape[k] * v.segment<3>(at);
    motion.turned += point.line.shape[k] * v.segment<3>(at + 3);
  }
  return motion;
}

/// With L the length, I the second moments and m = M + (p - c) x F:
///   v . f = F . mean(v) + m . s,  s = I^-1 sum (d x v + t^2/12 e (e . turn)).
struct Works {
  Vec3 mean;  // of v
  Vec3 b;     // what the moment turns by
  Vec3 s;     // what v turns by
};

void add_gradient(const Body& body, const LineLoad& load, const Works& works,
                  const VectorX& v, ShellGradient& gradient) {
  const auto& [mean, b, s] = works;
  const double bs = b.dot(s);
  Vec3 by_centre = -body.length * mean.cross(b);
  if (load.point) {
    by_centre -= load.force.cross(s);
  }
  for (const Point& p : body.points) {
    const Vec3 d = p.place - body.centre;
    const Motion motion = motion_at(p, v);
    const Vec3& u = motion.moved;
    const Vec3 left = motion.turned - s;
    const double bd = b.dot(d);
    const double sd = s.dot(d);
    const double eb = p.along.dot(b);
    const double el = p.along.dot(left);
    const double by_length =
        ((u - mean).dot(load.force) + by_centre.dot(d)) / body.length +
        b.dot(d.cross(u)) - d.squaredNorm() * bs + bd * sd +
        bending(p) * eb * el;
    const Vec3 by_place = p.length * (by_centre / body.length + u.cross(b) -
                                      2.0 * bs * d + sd * b + bd * s);
    const Vec3 by_along = p.length * bending(p) * (el * b + eb * left);
    const Vec3 by_tangent =
        p.line.weight * by_length * p.along +
        (by_along - p.along.dot(by_along) * p.along) / p.line.tangent.norm();
    for (int k = 0; k < 3; ++k) {
      gradient.by_nodes[p.nodes[k]] +=
          p.line.shape[k] * by_place + p.line.slope[k] * by_tangent;
    }
    const double by_thickness = p.length * p.thickness / 6.0 * eb * el;
    Vec3& at = gradient.by_thickness[p.edge.facet];
    at[p.edge.edge] += p.ends[0] * by_thickness;
    at[(p.edge.edge + 1) % 3] += p.ends[1] * by_thickness;
  }
}

}  // namespace

VectorX line_forces(const ShellMesh& mesh, const LineLoad& load) {
  const Body body = body_of(mesh, load);
  const Vec3 b = body.inverse * moment_of(body, load);
  VectorX f = VectorX::Zero(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  for (const Point& p : body.points) {
    const Vec3 force =
        p.length * (load.force / body.length + b.cross(p.place - body.centre));
    const Vec3 moment = p.length * bending(p) * p.along.dot(b) * p.along;
    for (int k = 0; k < 3; ++k) {
      const auto at = 6L * p.nodes[k];
      f.segment<3>(at) += p.line.shape[k] * force;
      f.segment<3>(at + 3) += p.line.shape[k] * moment;
    }
  }
  return f;
}

LineGradient line_gradient(const ShellMesh& mesh, const LineLoad& load,
                           const VectorX& v, ShellGradient* gradient) {
  const Body body = body_of(mesh, load);
  const Vec3 moment = moment_of(body, load);
  Works works{Vec3::Zero(), body.inverse * moment, Vec3::Zero()};
  for (const Point& p : body.points) {
    const Motion motion = motion_at(p, v);
    works.mean += p.length / body.length * motion.moved;
    works.s += p.length * ((p.place - body.centre).cross(motion.moved) +
                           bending(p) * p.along.dot(motion.turned) * p.along);
  }
  works.s = (body.inverse * works.s).eval();
  if (gradient != nullptr) {
    add_gradient(body, load, works, v, *gradient);
  }
  return {.value = load.force.dot(works.mean) + moment.dot(works.s),
          .by_point =
              load.point ? Vec3(load.force.cross(works.s)) : Vec3(Vec3::Zero()),
          .by_force = works.mean + works.s.cross(arm_of(body, load)),
          .by_moment = works.s};
}

}  // namespace meniscus::shell
