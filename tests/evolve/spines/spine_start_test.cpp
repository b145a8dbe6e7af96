// First facets about spines.
#include "evolve/spines/spine_start.h"

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "evolve/films/loft.h"

namespace meniscus::spine_start_test {
namespace {

constexpr double kPi = std::numbers::pi;

films::SpineSpec spine(const std::string& name) {
  return {.name = name, .body = "part", .smooth = true};
}

spines::SpineRim rim(const std::string& name, const Vec3& middle,
                     const Vec3& normal, double radius, int bore) {
  spines::SpineRim result{name, {}, bore};
  const Vec3 u = normal.unitOrthogonal();
  for (int k = 0; k < 24; ++k) {
    const double a = k * kPi / 12.0;
    result.points.push_back(
        middle + radius * (std::cos(a) * u + std::sin(a) * normal.cross(u)));
  }
  return result;
}

/// Edges that one facet has in the one direction and none in the other.
int border_edges(const SurfaceMesh& mesh) {
  std::map<Edge, int> uses;
  for (const Triangle& t : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      uses[{t[k], t[(k + 1) % 3]}] += 1;
    }
  }
  int result = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    result += static_cast<int>(uses.count({edge[1], edge[0]}) == 0);
  }
  return result;
}

// Rings of six points about a washer, at random thinner beside it than the
// first facets are wide or not, with an arm that rises beside the bore or leans
// over it, so that the bore's cut pierces its side.
TEST(SpineStart, LiquidAboutABoreMayBeThinOrPiercedByTheCut) {
  std::mt19937 random(20261128);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (int sample = 0; sample < 40; ++sample) {
    const double way = draw(0.0, 2.0 * kPi);
    const Vec3 out(std::cos(way), std::sin(way), 0.0);
    films::SpineSpec arm = spine("arm");
    arm.points.push_back(draw(11.0, 16.0) * out);
    arm.points.push_back(arm.points[0] + draw(-3.0, 12.0) * out +
                         Vec3(0, 0, 14));
    arm.points.push_back(arm.points[1] + Vec3(50, 0, 8));
    arm.radii = {4.5, 4.5, 4.5};
    films::SpineSpec ring = spine("ring");
    for (int k = 0; k < 6; ++k) {
      const double a = k * kPi / 3.0;
      ring.points.push_back(draw(10.5, 12.5) *
                                Vec3(std::cos(a), std::sin(a), 0.0) +
                            Vec3(0, 0, draw(-1.0, 1.0)));
      ring.radii.push_back(draw(3.2, 4.4));
    }
    ring.points.push_back(ring.points.front());
    ring.radii.push_back(ring.radii.front());
    const std::vector<spines::SpineRim> rims = {
        rim("top", Vec3(0, 0, 3), Vec3::UnitZ(), 12.0, 1),
        rim("under", Vec3(0, 0, -3), -Vec3::UnitZ(), 11.5, 0),
        rim("end", arm.points.back(), Vec3::UnitX(), 4.5, -1)};
    EXPECT_EQ(border_edges(spines::spine_start({ring, arm}, rims, "skin")),
              3 * 24)
        << sample;
  }
}

// A border as high as its rim and a little askew, as one of a bracket's was:
// the line between their middles says nothing of how they run, and the band
// came out with one side.
TEST(SpineStart, BandsRunAsTheyAreTold) {
  const Vec3 askew = Vec3(-0.042, -0.053, -0.998).normalized();
  const Points border =
      rim("border", Vec3(-0.143, -0.101, 0.011), askew, 12.8, -1).points;
  const Points ring = rim("rim", Vec3::Zero(), Vec3::UnitZ(), 12.84, -1).points;
  Points all = border;
  all.insert(all.end(), ring.begin(), ring.end());
  const auto area = [&](std::optional<bool> same_way) {
    double sum = 0.0;
    for (const Triangle& t : films::loft_band(border, ring, same_way)) {
      sum += 0.5 * (all[t[1]] - all[t[0]]).cross(all[t[2]] - all[t[0]]).norm();
    }
    return sum;
  };
  EXPECT_LT(area(false), 100.0);
  EXPECT_GT(area(true), 500.0);
  EXPECT_GT(area(std::nullopt), 500.0);  // by the line
}

}  // namespace
}  // namespace meniscus::spine_start_test
