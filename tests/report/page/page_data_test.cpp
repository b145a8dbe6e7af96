#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/vtk_files.h"
#include "report/page/packed_array.h"
#include "report/page/page_film.h"
#include "report/page/page_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::page_data_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;
// Half a step of 65534 over the range, and rounding.
constexpr double kHalfStep = 0.51 / 65534.0;
// Four-fold refinement of an icosahedron: facets of 4 degrees.
constexpr double kCurvatureError = 0.01;

/// The level that the page reads at a place of packed numbers.
int level_at(const std::string& base64_text, std::size_t item) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  for (std::size_t i = 0; i < base64_text.size(); i += 4) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t digit = kDigits.find(base64_text[i + k]);
      group =
          group * 64U +
          (digit == std::string_view::npos ? 0U : static_cast<unsigned>(digit));
    }
    for (const unsigned shift : {16U, 8U, 0U}) {
      bytes.push_back(static_cast<char>((group >> shift) & 0xFFU));
    }
  }
  return static_cast<unsigned char>(bytes.at(2 * item)) +
         256 * static_cast<unsigned char>(bytes.at(2 * item + 1));
}

TEST(PackedArray, Base64IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(page::base64(""), "");
  EXPECT_EQ(page::base64("f"), "Zg==");
  EXPECT_EQ(page::base64("fo"), "Zm8=");
  EXPECT_EQ(page::base64("foo"), "Zm9v");
  EXPECT_EQ(page::base64("foobar"), "Zm9vYmFy");
}

TEST(PackedArray, NumbersComeBackToHalfAStep) {
  std::vector<double> values;
  for (int i = 0; i < 50; ++i) {
    values.push_back(std::sin(i));
    values.push_back(1e6 + i);
  }
  values[7] = NAN;
  const auto packed = page::pack_reals(values, 2);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int level = level_at(packed["data"], i);
    if (i == 7) {
      EXPECT_EQ(level, 65535);
      continue;
    }
    const double step = packed["step"][i % 2];
    const double offset = packed["offset"][i % 2];
    EXPECT_NEAR(offset + level * step, values[i], kHalfStep * 65534.0 * step);
  }
  EXPECT_THROW(page::pack_reals({1.0, 2.0, 3.0}, 2), InvalidInput);
}

TEST(PackedArray, IdsTakeAsFewBytesAsTheyCan) {
  EXPECT_EQ(page::pack_ids({0, 255})["type"], "u8");
  EXPECT_EQ(page::pack_ids({0, 256})["type"], "u16");
  EXPECT_EQ(page::pack_ids({0, 65536})["type"], "u32");
  EXPECT_EQ(page::pack_ids({})["data"], "");
}

TEST(PageFilm, ASphereIsCurvedByOneOverItsRadius) {
  const SurfaceMesh ball = shapes::sphere(2.5, 4);
  for (const double h : page::mean_curvature(ball.points, ball.facets)) {
    EXPECT_NEAR(h, 0.4, 0.4 * kCurvatureError);
  }
}

TEST(PageFilm, RimsHaveNoCurvature) {
  SurfaceMesh ball = shapes::sphere(1.0, 2);
  const Triangle gone = ball.facets.back();
  ball.facets.pop_back();
  const auto curvature = page::mean_curvature(ball.points, ball.facets);
  for (std::size_t i = 0; i < curvature.size(); ++i) {
    const bool rim =
        std::find(gone.begin(), gone.end(), static_cast<int>(i)) != gone.end();
    EXPECT_EQ(std::isnan(curvature[i]), rim);
  }
}

/// A brick under uniform tension of 3 along x, in a folder.
struct StoredBrick {
  StoredBrick() {
    io::MeshFields fields;
    fields.points = {{"displacement", "mm", 3, {}},
                     {"stress", "MPa", 6, {}},
                     {"von_mises", "MPa", 1, {}}};
    for (const Vec3& p : mesh.nodes) {
      auto& u = fields.points[0].values;
      u.insert(u.end(), {p.x(), 0.0, 0.0});
      auto& s = fields.points[1].values;
      s.insert(s.end(), {3.0, 0.0, 0.0, 0.0, 0.0, 0.0});
      fields.points[2].values.push_back(3.0);
    }
    const auto count = static_cast<std::size_t>(mesh.element_count());
    fields.cells = {{"energy_error", "", 1, std::vector<double>(count, 0.1)}};
    io::write_vtu(folder / "part.vtu", mesh, fields);
    io::MeshFields on_surface = fields;
    on_surface.cells.clear();
    io::write_boundary_vtp(folder / "part_surface.vtp", mesh, on_surface);
  }
  page::PageMesh load(const std::vector<element::Material>& materials) const {
    return page::load_page_part(folder / "part_surface.vtp",
                                folder / "part.vtu", materials);
  }
  TempFolder folder;
  TetMesh mesh =
      shapes::straight_quadratic(shapes::brick(Vec3(2, 4, 1), 2, 4, 2));
  element::Material steel{
      .name = "steel", .youngs_modulus = 200.0, .poisson_ratio = 0.3};
};

TEST(PageMesh, HoldsSurfaceElementsAndFields) {
  const StoredBrick brick;
  const page::PageMesh part = brick.load({brick.steel});
  EXPECT_EQ(static_cast<int>(part.tets.size()), brick.mesh.element_count());
  EXPECT_EQ(static_cast<int>(part.triangles.size()),
            4 * brick.mesh.face_count());
  EXPECT_TRUE(part.four_a_face);
  EXPECT_EQ(part.names, brick.mesh.labels);
  for (std::size_t i = 0; i < part.nodes.size(); ++i) {
    EXPECT_EQ(part.displacement[3 * i], part.nodes[i].x());
    EXPECT_NEAR(part.energy_density[i], 3.0 * 3.0 / (2.0 * 200.0), kRounding);
    EXPECT_GT(part.stress_error[i], 0.0);
  }
}

TEST(PageMesh, EachReductionIsSmallerAndKeepsTheBox) {
  const StoredBrick brick;
  const page::PageMesh whole = brick.load({brick.steel});
  const page::PageMesh flat_faces = page::without_midsides(whole);
  const page::PageMesh hollow = page::without_inside(flat_faces);
  const page::PageMesh coarse = page::clustered(hollow, 1.1);
  EXPECT_EQ(4 * flat_faces.triangles.size(), whole.triangles.size());
  EXPECT_LT(page::page_bytes(flat_faces), page::page_bytes(whole));
  EXPECT_LT(page::page_bytes(hollow), page::page_bytes(flat_faces));
  EXPECT_LT(page::page_bytes(coarse), page::page_bytes(hollow));
  EXPECT_TRUE(hollow.tets.empty());
  EXPECT_GT(coarse.triangles.size(), 10u);
  EXPECT_EQ(coarse.displacement.size(), 3 * coarse.nodes.size());
  // The estimate is of the text's size, but for the ranges.
  EXPECT_NEAR(page::page_bytes(whole),
              static_cast<double>(page::to_json(whole).dump().size()), 2000.0);
}

TEST(PageMesh, WithoutThePartTheSurfaceStands) {
  const StoredBrick brick;
  const page::PageMesh part = page::load_page_part(
      brick.folder / "part_surface.vtp", {}, {brick.steel});
  EXPECT_TRUE(part.tets.empty());
  EXPECT_FALSE(part.von_mises.empty());
  EXPECT_TRUE(part.energy_density.empty());
}

TEST(PageMesh, RefusesWhatIsOfAnotherPart) {
  const StoredBrick brick;
  io::write_vtu(brick.folder / "part.vtu",
                shapes::brick(Vec3(1, 1, 1), 1, 1, 1));
  EXPECT_THAT([&] { brick.load({}); },
              ThrowsMessage<InvalidInput>(HasSubstr("another part")));
}

TEST(PageFrames, StayInTheirFolder) {
  const TempFolder folder;
  EXPECT_TRUE(page::page_frames(folder.path()).empty());
  write_file(folder / "frames.pvd",
             "<VTKFile><Collection>\n<DataSet timestep=\"3\" part=\"0\" "
             "file=\"frames/film_0003.vtp\"/></Collection></VTKFile>\n");
  const auto frames = page::page_frames(folder.path());
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].evaluation, 3);
  EXPECT_EQ(frames[0].file, "frames/film_0003.vtp");
  write_file(folder / "frames.pvd",
             "<DataSet timestep=\"3\" file=\"../../secret.vtp\"/>");
  EXPECT_THAT([&] { page::page_frames(folder.path()); },
              ThrowsMessage<InvalidInput>(HasSubstr("secret")));
}

}  // namespace
}  // namespace meniscus::page_data_test
