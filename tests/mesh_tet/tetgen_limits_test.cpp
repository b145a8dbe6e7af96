// What the child process may use, and what happens when it is not there.
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "core/timer.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/environment_variable.h"
#include "tests/support/shapes.h"

namespace meniscus::tetgen_limits_test {

namespace {

// Ends come within a tick of 50 ms; the rest is for a loaded machine.
constexpr double kPrompt = 2.0;

/// A mesh that takes many seconds.
mesh_tet::Tetrahedralization fill_finely(
    mesh_tet::TetrahedralizeOptions options) {
  options.edge = 0.01;
  return mesh_tet::tetrahedralize(shapes::sphere(1.0, 5), options);
}

class StopAfter : public Monitor {
 public:
  explicit StopAfter(double seconds) : seconds_(seconds) {}
  bool stop_requested() const override { return timer_.seconds() > seconds_; }

 private:
  double seconds_;
  Timer timer_;
};

TEST(TetgenLimits, TimeLimitEndsTheChild) {
  const Timer timer;
  const auto result = fill_finely({.time_limit = 0.3});
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->kind, FailureKind::MeshingFailed);
  EXPECT_NE(result.failure->message.find("time limit"), std::string::npos);
  EXPECT_TRUE(result.mesh.nodes.empty());
  EXPECT_LT(timer.seconds(), kPrompt);
}

TEST(TetgenLimits, MemoryLimitIsNamed) {
  for (const double limit : {1e5, 1e7, 6e7}) {
    const auto result =
        fill_finely({.time_limit = 10.0, .memory_limit = limit});
    ASSERT_TRUE(result.failure);
    EXPECT_EQ(result.failure->kind, FailureKind::MeshingFailed);
    EXPECT_NE(result.failure->message.find("memory limit"), std::string::npos)
        << limit << ": " << result.failure->message;
  }
}

TEST(TetgenLimits, TooManyElementsAreRefusedAtOnce) {
  const Timer timer;
  const auto result =
      mesh_tet::tetrahedralize(shapes::sphere(1.0, 2), {.edge = 1e-4});
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->kind, FailureKind::MeshingFailed);
  EXPECT_LT(timer.seconds(), kPrompt);
}

TEST(TetgenLimits, MonitorStopsTheChild) {
  StopAfter monitor(0.2);
  const Timer timer;
  EXPECT_THROW(fill_finely({.monitor = &monitor}), Interrupted);
  EXPECT_LT(timer.seconds(), kPrompt);
}

TEST(TetgenLimits, MissingHelperIsAnIoError) {
  const EnvironmentVariable variable("MENISCUS_TETGEN", "/nowhere/tetgen");
  try {
    mesh_tet::tetrahedralize(shapes::sphere(1.0, 1));
    FAIL() << "no exception";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/tetgen"),
              std::string::npos);
  }
}

TEST(TetgenLimits, WrongHelperIsAFailure) {
  for (const char* program : {"/bin/true", "/bin/false", "/bin/cat"}) {
    const EnvironmentVariable variable("MENISCUS_TETGEN", program);
    const auto result = mesh_tet::tetrahedralize(shapes::sphere(1.0, 1));
    ASSERT_TRUE(result.failure) << program;
    EXPECT_EQ(result.failure->kind, FailureKind::MeshingFailed);
  }
}

TEST(TetgenLimits, TwoAtOnce) {
  const SurfaceMesh surface = shapes::sphere(1.0, 3);
  const auto expected = mesh_tet::tetrahedralize(surface);
  std::array<mesh_tet::Tetrahedralization, 2> results;
  {
    std::vector<std::jthread> threads;
    for (auto& result : results) {
      threads.emplace_back([&] { result = mesh_tet::tetrahedralize(surface); });
    }
  }
  for (const auto& result : results) {
    ASSERT_FALSE(result.failure);
    EXPECT_EQ(result.mesh.elements, expected.mesh.elements);
    EXPECT_EQ(result.mesh.nodes, expected.mesh.nodes);
  }
}

}  // namespace

}  // namespace meniscus::tetgen_limits_test
