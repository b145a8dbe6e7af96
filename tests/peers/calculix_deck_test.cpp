#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/calculix_inp.h"
#include "tests/support/calculix.h"
#include "tests/support/not_here.h"
#include "tests/support/shapes.h"

namespace meniscus::calculix_deck_test {
namespace {

constexpr double kPrinted = 2e-6;  // CalculiX prints 7 digits

class CalculixDeckTest : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!have_calculix()) {
      MENISCUS_NOT_HERE("ccx (Debian package calculix-ccx) is not installed");
    }
  }

  /// A brick standing on z0.
  TetMesh mesh() const {
    const TetMesh linear = shapes::brick(Vec3(20, 30, 40), 2, 3, 4);
    return GetParam() == 1 ? linear : shapes::straight_quadratic(linear);
  }

  static io::CalculixDeck deck() {
    io::CalculixDeck deck;
    deck.comments = {"brick under pressure", "units mm-N-MPa"};
    deck.materials = {{"aluminium", 71700.0, 0.33, 2.8e-9}};
    return deck;
  }
};

/// Mean of the displacement over the nodes of a surface.
Vec3 mean_over(const TetMesh& mesh, const std::string& surface,
               const VectorX& u) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] == mesh.label_of(surface)) {
      for (const int node : mesh.face(f)) {
        sum += u.segment<3>(Eigen::Index{3} * node);
        ++count;
      }
    }
  }
  return sum / count;
}

// Every side in turn, so that each local face number of the elements occurs.
// The support is the opposite side: CalculiX leaves load that acts on
// supported nodes out of its reactions.
TEST_P(CalculixDeckTest, PressureOnEverySideIsTakenUpByTheSupport) {
  const TetMesh brick = mesh();
  io::CalculixDeck input = deck();
  const std::vector<std::string> sides = {"x0", "x1", "y0", "y1", "z0", "z1"};
  for (std::size_t s = 0; s < sides.size(); ++s) {
    input.steps.push_back({"pressure on " + sides[s],
                           {{sides[s ^ 1], {}, true, true, true}},
                           {},
                           {{sides[s], 3.0}}});
  }
  const auto results = run_calculix(io::calculix_deck(brick, input),
                                    static_cast<int>(brick.nodes.size()));
  ASSERT_EQ(results.size(), sides.size());
  const std::vector<double> areas = {1200, 800, 600};
  for (std::size_t s = 0; s < sides.size(); ++s) {
    Vec3 load = Vec3::Zero();
    load[s / 2] = 3.0 * areas[s / 2] * (s % 2 == 0 ? 1.0 : -1.0);
    EXPECT_LT((results[s].reaction + load).norm(), kPrinted * load.norm())
        << sides[s] << ": " << results[s].reaction.transpose();
    // It moves with the load, but for little: clamping tilts it slightly.
    const Vec3 mean = mean_over(brick, sides[s], results[s].displacement);
    EXPECT_GT(mean.dot(load), 0.9 * mean.norm() * load.norm()) << sides[s];
  }
}

// Sliding supports and an end pressure: uniaxial stress, exact to print.
TEST_P(CalculixDeckTest, UniaxialPressureGivesTheExactShortening) {
  const TetMesh brick = mesh();
  io::CalculixDeck input = deck();
  input.steps.push_back({"press",
                         {{"x0", {}, true, false, false},
                          {"y0", {}, false, true, false},
                          {"z0", {}, false, false, true}},
                         {},
                         {{"z1", 100.0}}});
  const auto results = run_calculix(io::calculix_deck(brick, input),
                                    static_cast<int>(brick.nodes.size()));
  ASSERT_EQ(results.size(), 1u);
  const double strain = 100.0 / 71700.0;
  for (std::size_t i = 0; i < brick.nodes.size(); ++i) {
    const Vec3& x = brick.nodes[i];
    const Vec3 exact(0.33 * strain * x.x(), 0.33 * strain * x.y(),
                     -strain * x.z());
    EXPECT_LT((results[0].displacement.segment<3>(3 * i) - exact).norm(),
              kPrinted * strain * 40);
  }
}

TEST_P(CalculixDeckTest, NodalForcesAndExplicitNodesArrive) {
  const TetMesh brick = mesh();
  io::CalculixDeck input = deck();
  io::DeckStep step{"pull", {{"", {}, true, true, true}}, {}, {}};
  step.nodal_forces = VectorX::Zero(3 * brick.nodes.size());
  for (std::size_t i = 0; i < brick.nodes.size(); ++i) {
    if (brick.nodes[i].z() == 0.0) {
      step.supports[0].nodes.push_back(static_cast<int>(i));
    }
    if (brick.nodes[i].z() == 40.0) {
      step.nodal_forces[3 * i] = 10.0 + static_cast<double>(i);
      step.nodal_forces[3 * i + 2] = -5.0;
    }
  }
  const VectorX forces = step.nodal_forces;
  input.steps.push_back(step);
  const auto results = run_calculix(io::calculix_deck(brick, input),
                                    static_cast<int>(brick.nodes.size()));
  Vec3 total = Vec3::Zero();
  for (std::size_t i = 0; i < brick.nodes.size(); ++i) {
    total += forces.segment<3>(3 * i);
  }
  EXPECT_LT((results.at(0).reaction + total).norm(), kPrinted * total.norm());
}

INSTANTIATE_TEST_SUITE_P(Orders, CalculixDeckTest, ::testing::Values(1, 2),
                         [](const auto& order) {
                           return "tet" +
                                  std::to_string(order.param == 1 ? 4 : 10);
                         });

}  // namespace
}  // namespace meniscus::calculix_deck_test
