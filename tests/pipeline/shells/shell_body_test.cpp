/// The body that a shell stands for: closed, where it lies, how it moves.
#include "pipeline/shells/shell_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/shell_shapes.h"

namespace meniscus::shell_body_test {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kRadius = 10.0;
constexpr double kLength = 8.0;

/// A quarter of a cylinder about y, normals outwards, in two films of which
/// the second begins at half the angle; thickness from 1 to 2 along y.
void make_part(double offset, shells::ShellPart& part) {
  const shell_shapes::MappedShell drawn = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double a = 0.5 * 3.14159265358979323846 * s;
        return {kRadius * std::sin(a), kLength * t, kRadius * std::cos(a)};
      },
      1.0, {.m = 8, .n = 4});
  part.mesh = drawn.mesh;
  part.skin.nodes = drawn.mesh.nodes;
  part.skin.order = 2;
  part.skin.labels = {"unused", "first", "second"};
  for (std::size_t f = 0; f < part.mesh.facets.size(); ++f) {
    const std::array<int, 6>& facet = part.mesh.facets[f];
    double s = 0.0;
    for (int k = 0; k < 3; ++k) {
      s += drawn.place[facet[k]][0] / 3.0;
      part.mesh.thickness[f][k] = 1.0 + drawn.place[facet[k]][1];
    }
    part.skin.faces.insert(part.skin.faces.end(), facet.begin(), facet.end());
    part.skin.face_label.push_back(s < 0.5 ? 1 : 2);
  }
  part.sections = {shell_shapes::isotropic(1e3, 0.3)};
  part.sections[0].offset = offset;
  part.rims["first/rim:foot"] =
      drawn.edges([](double s, double) { return s < 1e-9; });
}

// The wall's mean radius is R + offset t, its volume that of Pappus.
TEST(ShellBody, IsClosedAndLiesWhereTheWallDoes) {
  for (const double offset : {0.0, 0.5, -0.5}) {
    shells::ShellPart part;
    make_part(offset, part);
    const shells::ShellBody body = shells::shell_body(part);
    const SurfaceMesh surface = shells::body_surface(body);
    EXPECT_EQ(body_count(surface), 2);
    // Each has points of its own: every edge once in each direction.
    std::map<Edge, int> uses;
    for (const Triangle& facet : surface.facets) {
      for (int k = 0; k < 3; ++k) {
        const int a = facet[k];
        const int b = facet[(k + 1) % 3];
        uses[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      }
    }
    for (const auto& [edge, sum] : uses) {
      EXPECT_EQ(sum, 0);
    }
    double exact = 0.0;
    constexpr int kSteps = 1000;
    for (int k = 0; k < kSteps; ++k) {
      const double t = 1.0 + (k + 0.5) / kSteps;
      exact += 0.5 * 3.14159265358979323846 * (kRadius + offset * t) * t *
               kLength / kSteps;
    }
    EXPECT_NEAR(enclosed_volume(surface) / exact, 1.0, 2e-3);
    EXPECT_EQ(
        (std::set<std::string>(surface.labels.begin(), surface.labels.end())),
        (std::set<std::string>{"first", "first/back", "first/rim",
                               "first/rim:foot", "second", "second/back",
                               "second/rim"}));
    for (std::size_t p = 0; p < body.points.size(); ++p) {
      const Vec3& x = body.mesh.nodes[p];
      const double t = 1.0 + x.y() / kLength;
      EXPECT_NEAR(std::hypot(x.x(), x.z()),
                  kRadius + t * (offset + 0.5 * body.points[p].side), 1e-2);
    }
  }
}

TEST(ShellBody, TurnsAsOneWithItsShell) {
  shells::ShellPart part;
  make_part(0.5, part);
  const Vec3 turn(0.3, -0.2, 0.5);
  const Vec3 shift(1.0, 2.0, -3.0);
  VectorX six(6 * std::ssize(part.mesh.nodes));
  for (std::size_t n = 0; n < part.mesh.nodes.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(6 * n);
    six.segment<3>(at) = shift + turn.cross(part.mesh.nodes[n]);
    six.segment<3>(at + 3) = turn;
  }
  const shells::ShellBody body = shells::shell_body(part);
  const VectorX u = shells::body_displacements(body, six);
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const Vec3 exact = shift + turn.cross(body.mesh.nodes[p]);
    EXPECT_LT((u.segment<3>(static_cast<Eigen::Index>(3 * p)) - exact).norm(),
              kRounding * exact.norm());
  }
}

// Each face has its own stress, the middle that between them.
TEST(ShellBody, FacesHaveTheirOwnStress) {
  shells::ShellPart part;
  make_part(0.0, part);
  part.cases.resize(1);
  shell::FacetStress facet;
  for (shell::WallStress& wall : facet) {
    wall.negative.fill(0.0);
    wall.middle.fill(0.0);
    wall.positive.fill(0.0);
    wall.negative[0] = 1.0;
    wall.middle[0] = 2.0;
    wall.positive[0] = 3.0;
  }
  part.cases[0].stress.assign(part.mesh.facets.size(), facet);
  const shells::ShellBody body = shells::shell_body(part);
  const std::vector<double> found = shells::body_von_mises(body, part, 0);
  for (std::size_t p = 0; p < found.size(); ++p) {
    EXPECT_NEAR(found[p], 2.0 + body.points[p].side, kRounding);
  }
}

}  // namespace
}  // namespace meniscus::shell_body_test
