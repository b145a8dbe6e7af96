// Flat faces with holes, drawn at random: what fills them has their area, keeps
// to the edges beside it, and comes to an end.
#include "evolve/start/cap_faces.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "evolve/start/disk_fill.h"

namespace meniscus::cap_faces_test {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

/// A long plate with two holes across most of it, all cut into straight pieces
/// of very different lengths.
class RandomPlate {
 public:
  explicit RandomPlate(unsigned seed) : random_(seed) {}

  std::vector<Points> draw() {
    const double length = within(60.0, 160.0);
    const double width = within(12.0, 30.0);
    const double piece = within(4.0, 12.0);
    std::vector<Points> loops(1);
    const int around =
        std::max(8, static_cast<int>(2.0 * (length + width) / piece));
    const double waist = within(0.0, 0.4);
    for (int k = 0; k < around; ++k) {
      const double t = kWholeTurn * k / around;
      const double x = 0.5 * length * std::cos(t);
      const double y = 0.5 * width * std::sin(t) *
                       (1.0 + waist * std::cos(3.0 * t) + within(0.0, 0.05));
      loops[0].push_back({x, y, 0.0});
    }
    for (const double side : {-0.2, 0.2}) {
      loops.push_back(hole(side * length + within(-4.0, 4.0),
                           0.25 * (1.0 - waist) * width));
    }
    return loops;
  }

 private:
  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  Points hole(double x, double radius) {
    const int pieces = std::uniform_int_distribution<int>(5, 16)(random_);
    const double stretch = within(0.4, 1.0);
    Points rim;
    for (int k = 0; k < pieces; ++k) {
      const double t = kWholeTurn * k / pieces;
      rim.push_back(
          {x + stretch * radius * std::cos(t), radius * std::sin(t), 0.0});
    }
    return rim;
  }

  std::mt19937 random_;
};

double longest_edge(const SurfaceMesh& face) {
  double longest = 0.0;
  for (const Triangle& t : face.facets) {
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(
          longest, (face.points[t[k]] - face.points[t[(k + 1) % 3]]).norm());
    }
  }
  return longest;
}

TEST(CapFaces, RandomPlatesWithHolesAreFilled) {
  constexpr int kPlates = 200;
  for (unsigned seed = 0; seed < kPlates; ++seed) {
    const std::vector<Points> loops = RandomPlate(seed).draw();
    double area = polygon_area_vector(loops[0]).norm();
    for (std::size_t k = 1; k < loops.size(); ++k) {
      area -= polygon_area_vector(loops[k]).norm();
    }
    SurfaceMesh face;
    ASSERT_NO_THROW(face = start::fill_face(loops, 10.0, true, "rim"))
        << "plate " << seed;
    EXPECT_NEAR(surface_area(face), area, 1e-9 * area) << "plate " << seed;
    EXPECT_LT(face.facets.size(), 2000U) << "plate " << seed;
    EXPECT_LT(longest_edge(face), 20.0) << "plate " << seed;
  }
}

}  // namespace
}  // namespace meniscus::cap_faces_test
