#include "io/stl.h"

#include <cstring>
#include <limits>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::stl_test {
namespace {

constexpr double kFloat = 1e-6;  // 32-bit coordinates

Vec3 vector_at(const std::string& bytes, std::size_t offset) {
  std::array<float, 3> raw;
  std::memcpy(raw.data(), bytes.data() + offset, sizeof raw);
  return {raw[0], raw[1], raw[2]};
}

TEST(Stl, HasTheSizeAndTheVolumeOfItsSurface) {
  const TempFolder folder;
  const SurfaceMesh mesh = shapes::box(Vec3(20, 30, 40), 3);
  io::write_stl(folder / "box.stl", mesh, {"box", "mm"});
  const std::string bytes = read_file(folder / "box.stl");
  ASSERT_EQ(bytes.size(), 84 + 50 * mesh.facets.size());
  EXPECT_THAT(bytes.substr(0, 80),
              testing::AllOf(testing::HasSubstr("box unit=mm"),
                             testing::Not(testing::StartsWith("solid"))));
  double volume = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::size_t at = 84 + 50 * f;
    const Vec3 a = vector_at(bytes, at + 12);
    const Vec3 b = vector_at(bytes, at + 24);
    const Vec3 c = vector_at(bytes, at + 36);
    volume += a.dot(b.cross(c)) / 6.0;
    const Vec3 normal = (b - a).cross(c - a).normalized();
    EXPECT_LT((normal - vector_at(bytes, at)).norm(), kFloat);
  }
  EXPECT_NEAR(volume, 24000.0, kFloat * 24000.0);
}

TEST(Stl, CutsALongNameBetweenCharacters) {
  const TempFolder folder;
  const SurfaceMesh mesh = shapes::box(Vec3(1, 1, 1), 1);
  for (int length = 20; length < 60; ++length) {
    std::string name;
    for (int i = 0; i < length; ++i) {
      name += "ü";
    }
    io::write_stl(folder / "a.stl", mesh, {name, "mm"});
    const std::string bytes = read_file(folder / "a.stl");
    EXPECT_EQ(bytes.size(), 84u + 50u * 12u);
    EXPECT_THAT(bytes.substr(0, 80), testing::HasSubstr("ü unit=mm"));
  }
}

TEST(Stl, RefusesWhatItCannotHold) {
  const TempFolder folder;
  SurfaceMesh mesh = shapes::box(Vec3(1, 1, 1), 1);
  EXPECT_THROW(io::write_stl(folder / "a.stl", SurfaceMesh{}), InvalidInput);
  mesh.points[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(io::write_stl(folder / "a.stl", mesh), InvalidInput);
  mesh.points[0].x() = 1e39;
  EXPECT_THROW(io::write_stl(folder / "a.stl", mesh), InvalidInput);
  mesh.points[0].x() = 0.0;
  mesh.facets[3][1] = 99;
  EXPECT_THROW(io::write_stl(folder / "a.stl", mesh), InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.stl"));
}

}  // namespace
}  // namespace meniscus::stl_test
