// What a run leaves behind when its surface could not be filled.
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "pipeline/results/results.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::unfilled_test {

namespace {

forward::EvaluationFields fields_of(SurfaceMesh surface) {
  forward::EvaluationFields fields;
  fields.findings = check_surface(surface);
  fields.surface.base = std::move(surface);
  return fields;
}

TEST(Unfilled, SurfaceAndFindingsAreWritten) {
  const TempFolder folder;
  SurfaceMesh open = shapes::box(Vec3::Ones(), 2);
  open.facets.pop_back();
  open.facet_label.pop_back();
  const auto names = results::write_unfilled(fields_of(open), folder.path());
  ASSERT_EQ(names.size(), 2U);
  for (const std::string& name : names) {
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  }
}

TEST(Unfilled, BrokenCornersLeaveTheFindings) {
  const TempFolder folder;
  SurfaceMesh broken = shapes::box(Vec3::Ones(), 2);
  broken.points[3].x() = std::numeric_limits<double>::quiet_NaN();
  broken.facets[20][1] = -7;
  const auto names = results::write_unfilled(fields_of(broken), folder.path());
  EXPECT_EQ(names, std::vector<std::string>{"findings.vtp"});
}

TEST(Unfilled, NothingWhenTheSurfaceWasFilled) {
  const TempFolder folder;
  EXPECT_TRUE(results::write_unfilled({}, folder.path()).empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace

}  // namespace meniscus::unfilled_test
