#include "fea/stress/exclusion_zones.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/point_grid.h"
#include "fea/element/surface_faces.h"

namespace meniscus::stress {

namespace {

Vec3 centre(const TetMesh& mesh, int e) {
  Vec3 sum = Vec3::Zero();
  for (const int i : mesh.element(e).first<4>()) {
    sum += 0.25 * mesh.nodes[i];
  }
  return sum;
}

/// `holds`(place): in the zone.
template <class Holds>
void exclude(const TetMesh& mesh, const Holds& holds, Excluded& excluded) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (holds(centre(mesh, e))) {
      excluded.element[static_cast<std::size_t>(e)] = 1;
    }
  }
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (holds(mesh.nodes[n])) {
      excluded.node[n] = 1;
    }
  }
}

void exclude_near(const TetMesh& mesh, const ExclusionZone& zone,
                  Excluded& excluded) {
  if (!(zone.distance > 0.0)) {
    throw InvalidInput(fmt::format(
        "exclusion zone about surface '{}': distance is {}; it must be above 0",
        zone.surface, zone.distance));
  }
  Points points;
  for (const int node : element::surface_nodes(
           mesh, element::surface_label(mesh, zone.surface))) {
    points.push_back(mesh.nodes[node]);
  }
  const element::PointGrid nearest(points);
  exclude(
      mesh,
      [&](const Vec3& x) {
        return (points[nearest.of(x)] - x).norm() <= zone.distance;
      },
      excluded);
}

void exclude_box(const TetMesh& mesh, const ExclusionZone::Box& box,
                 Excluded& excluded) {
  if (!((box.high - box.low).minCoeff() > 0.0)) {
    throw InvalidInput(fmt::format(
        "exclusion zone: the box from ({}, {}, {}) to ({}, {}, {}) is empty",
        box.low.x(), box.low.y(), box.low.z(), box.high.x(), box.high.y(),
        box.high.z()));
  }
  exclude(
      mesh,
      [&](const Vec3& x) {
        return (x - box.low).minCoeff() >= 0.0 &&
               (box.high - x).minCoeff() >= 0.0;
      },
      excluded);
}

void exclude_ball(const TetMesh& mesh, const ExclusionZone::Ball& ball,
                  Excluded& excluded) {
  if (!(ball.radius > 0.0)) {
    throw InvalidInput(fmt::format(
        "exclusion zone: the ball about ({}, {}, {}) has radius {}; it must be "
        "above 0",
        ball.center.x(), ball.center.y(), ball.center.z(), ball.radius));
  }
  exclude(
      mesh,
      [&](const Vec3& x) { return (x - ball.center).norm() <= ball.radius; },
      excluded);
}

}  // namespace

Excluded excluded_by(const TetMesh& mesh,
                     const std::vector<ExclusionZone>& zones) {
  Excluded excluded;
  excluded.element.assign(static_cast<std::size_t>(mesh.element_count()), 0);
  excluded.node.assign(mesh.nodes.size(), 0);
  for (const ExclusionZone& zone : zones) {
    if (zone.surface.empty() && !zone.box && !zone.ball) {
      throw InvalidInput(
          "exclusion zone: give a surface with a distance, a box or a ball");
    }
    if (!zone.surface.empty()) {
      exclude_near(mesh, zone, excluded);
    }
    if (zone.box) {
      exclude_box(mesh, *zone.box, excluded);
    }
    if (zone.ball) {
      exclude_ball(mesh, *zone.ball, excluded);
    }
  }
  return excluded;
}

}  // namespace meniscus::stress
