#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/child_process.h"
#include "core/find_program.h"
#include "io/stl.h"
#include "tests/support/not_here.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::stl_admesh_test {
namespace {

TEST(StlAdmesh, FindsTheSurfaceClosedAndItsVolume) {
  if (!find_program("admesh")) {
    MENISCUS_NOT_HERE("admesh is not installed");
  }
  const TempFolder folder;
  const SurfaceMesh mesh = shapes::sphere(25.0, 3);
  io::write_stl(folder / "ball.stl", mesh, {"ball", "mm"});
  ChildOptions options;
  options.argv = {"admesh", (folder / "ball.stl").string()};
  options.environment = {{"LC_ALL", "C"}};
  const ChildResult result = run_child(options);
  ASSERT_TRUE(result.succeeded()) << describe_end(result);
  // Facets with 1, 2, 3 unconnected edges, before and after: none.
  EXPECT_THAT(result.output,
              ::testing::ContainsRegex("Total disconnected facets +: +0 +0"));
  EXPECT_THAT(result.output, ::testing::ContainsRegex("Number of parts +: +1"));
  const auto at = result.output.find("Volume   :");
  ASSERT_NE(at, std::string::npos) << result.output;
  const double volume = std::stod(result.output.substr(at + 10));
  constexpr double kFloats = 1e-5;  // 32-bit coordinates and sums
  EXPECT_NEAR(volume, enclosed_volume(mesh), kFloats * volume);
}

}  // namespace
}  // namespace meniscus::stl_admesh_test
