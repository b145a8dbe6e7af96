#include "pipeline/forward/work_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::work_estimate_test {
namespace {

// Of elements that TetGen makes; it is for refusing what is far too much.
constexpr double kShare = 0.4;

TEST(WorkEstimate, IsNearWhatTheMesherMakes) {
  const double edge = 0.25;
  const SurfaceMesh ball = shapes::sphere(2.0, 4);
  const mesh_tet::Tetrahedralization filled =
      mesh_tet::tetrahedralize(ball, {.edge = edge});
  ASSERT_FALSE(filled.failure);
  const double made = filled.mesh.element_count();
  const forward::WorkEstimate work =
      forward::estimate_work(enclosed_volume(ball), ball.facets.size(), edge);
  EXPECT_NEAR(work.elements, made, kShare * made);
}

TEST(WorkEstimate, RefusesWhatMemoryDoesNotHold) {
  forward::require_work(forward::estimate_work(1e6, 0, 5.0), 5.0);
  try {
    forward::require_work(forward::estimate_work(1e6, 0, 0.01), 0.01);
    FAIL() << "8.2e12 elements were not refused";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("elements"),
                               testing::HasSubstr("GB are free"),
                               testing::HasSubstr("resolution.fea")));
  }
  EXPECT_EQ(forward::text_of({112840.0, 4.7e8}),
            "about 110,000 elements, 0.47 GB");
}

TEST(WorkEstimate, RefusesShellsThatMemoryDoesNotHold) {
  forward::require_shell_work(1000, 5.0);
  try {
    forward::require_shell_work(2'000'000'000, 0.01);
    FAIL() << "30 TB were not refused";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("2,000,000,000 facets"),
                               testing::HasSubstr("GB are free"),
                               testing::HasSubstr("resolution.fea")));
  }
}

}  // namespace
}  // namespace meniscus::work_estimate_test
