#include <limits>
#include <map>

#include <Model/COM/NMR_DLLInterfaces.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/obj.h"
#include "io/three_mf.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::surface_files_test {
namespace {

using testing::HasSubstr;

constexpr double kRounding = 1e-12;  // of sums of a few hundred numbers

io::FileNotes notes(const std::string& unit) {
  return {.program = "Meniscus 1.2",
          .title = "A b\nlock",
          .unit = unit,
          .unit_system = "",
          .lines = {"width = 20"}};
}

/// Two unit cubes side by side, of a body each.
SurfaceMesh two_cubes() {
  return shapes::cubes({2, 1, 1}, 1, [](int x, int y, int z) {
    return x >= 0 && x < 2 && y == 0 && z == 0 ? x : -1;
  });
}

TEST(Obj, ComesBackWithNamesAndAllDigits) {
  const TempFolder folder;
  SurfaceMesh ball = shapes::sphere(0.1 + 0.2, 2);
  ball.labels = {"north cap"};
  io::write_obj(folder / "a.obj", ball, {.notes = notes("mm"), .bodies = {}});
  const std::string text = read_file(folder / "a.obj");
  EXPECT_THAT(text, testing::AllOf(HasSubstr("# written by Meniscus 1.2\n"),
                                   HasSubstr("# case: A b lock\n"),
                                   HasSubstr("# unit of length: mm\n"),
                                   HasSubstr("o body_1\ng north_cap\n")));
  const SurfaceMesh again = io::read_obj(folder / "a.obj");
  EXPECT_EQ(again.points, ball.points);
  EXPECT_EQ(again.facets, ball.facets);
  EXPECT_EQ(again.labels, std::vector<std::string>({"north_cap"}));
}

TEST(Obj, EachBodyIsAClosedObject) {
  const TempFolder folder;
  const SurfaceMesh mesh = two_cubes();
  io::write_obj(folder / "a.obj", mesh,
                {.notes = {}, .bodies = {"steel", "foam"}});
  const std::string text = read_file(folder / "a.obj");
  const std::size_t second = text.find("o foam");
  ASSERT_NE(second, std::string::npos);
  const std::size_t first = text.find("o steel");
  for (const std::string& body :
       {text.substr(0, second), text.substr(0, first) + text.substr(second)}) {
    const SurfaceMesh one = io::read_obj_text(body, "a.obj");
    EXPECT_EQ(one.facets.size(), 12U);
    EXPECT_NEAR(enclosed_volume(one), 1.0, kRounding);
    EXPECT_GE(one.label_of("inside"), 0);
  }
}

TEST(Obj, TakesWhatOtherProgramsWrite) {
  const SurfaceMesh mesh = io::read_obj_text(
      "# cube\r\nmtllib a.mtl\r\no cube\r\nv 0 0 0\r\nv 1 0 0 1\r\nv 1 1 0\r\n"
      "v 0 1 0\r\nvt 0 0\r\nvn 0 0 1\r\nusemtl red\r\ns off\r\n"
      "f 1/1/1 2/1/1 \\\r\n 3/1/1 4/1/1\r\ng roof top\r\nv 0 0 +1\r\n"
      "f -1//1 2//1 3//1\r\nf 1 1 2\r\n",
      "a.obj");
  EXPECT_EQ(mesh.points.size(), 5U);
  EXPECT_EQ(mesh.labels, std::vector<std::string>({"cube", "roof"}));
  EXPECT_EQ(mesh.facets,
            std::vector<Triangle>({{0, 1, 2}, {0, 2, 3}, {4, 1, 2}}));
  EXPECT_EQ(mesh.facet_label, std::vector<int>({0, 0, 1}));
}

TEST(Obj, WrongFilesAreToldByLine) {
  const std::map<std::string, std::string> told = {
      {"", "a.obj:1: the file has no faces"},
      {"v 0 0 0\nsolid x\n", "a.obj:2: found 'solid'"},
      {"v 0 nan 0\n", "a.obj:1: found 'nan'"},
      {"v 0 0\n", "a.obj:1: a vertex with 2"},
      {"v 0 0 0\nf 1 2 1\n", "a.obj:2: found '2'"},
      {"v 0 0 0\nf 1 0 1\n", "a.obj:2: found '0'"},
      {"v 0 0 0\nf -2 1 1\n", "a.obj:2: found '-2'"},
      {"v 0 0 0\nf 1 1\n", "a.obj:2: a face with 2"},
      {std::string("\0\1", 2), "a.obj:1: found"}};
  for (const auto& [text, message] : told) {
    try {
      io::read_obj_text(text, "a.obj");
      FAIL() << text;
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
}

/// What lib3mf's own reader finds.
struct Read {
  DWORD unit = 0;
  std::vector<std::string> names;
  std::vector<SurfaceMesh> objects;
  bool closed = true;
  int items = 0;  // on the build plate
};

Read read_3mf(const std::filesystem::path& path) {
  using namespace NMR;
  Read result;
  PLib3MFModel* model = nullptr;
  PLib3MFModelReader* reader = nullptr;
  lib3mf_createmodel(&model);
  lib3mf_model_queryreader(model, "3mf", &reader);
  EXPECT_EQ(lib3mf_reader_readfromfileutf8(reader, path.c_str()), 0);
  lib3mf_model_getunit(model, &result.unit);
  PLib3MFModelResourceIterator* objects = nullptr;
  lib3mf_model_getmeshobjects(model, &objects);
  BOOL more = 0;
  while (lib3mf_resourceiterator_movenext(objects, &more) == 0 && more != 0) {
    PLib3MFModelResource* object = nullptr;
    lib3mf_resourceiterator_getcurrent(objects, &object);
    std::array<char, 200> name{};
    ULONG length = 0;
    lib3mf_object_getnameutf8(object, name.data(), name.size(), &length);
    result.names.emplace_back(name.data());
    BOOL closed = 0;
    lib3mf_meshobject_ismanifoldandoriented(object, &closed);
    result.closed = result.closed && closed != 0;
    SurfaceMesh& mesh = result.objects.emplace_back();
    DWORD count = 0;
    lib3mf_meshobject_getvertexcount(object, &count);
    for (DWORD k = 0; k < count; ++k) {
      MODELMESHVERTEX v{};
      lib3mf_meshobject_getvertex(object, k, &v);
      mesh.points.emplace_back(v.m_fPosition[0], v.m_fPosition[1],
                               v.m_fPosition[2]);
    }
    lib3mf_meshobject_gettrianglecount(object, &count);
    for (DWORD k = 0; k < count; ++k) {
      MODELMESHTRIANGLE t{};
      lib3mf_meshobject_gettriangle(object, k, &t);
      mesh.facets.push_back({static_cast<int>(t.m_nIndices[0]),
                             static_cast<int>(t.m_nIndices[1]),
                             static_cast<int>(t.m_nIndices[2])});
    }
    lib3mf_release(object);
  }
  lib3mf_release(objects);
  PLib3MFModelBuildItemIterator* items = nullptr;
  lib3mf_model_getbuilditems(model, &items);
  while (lib3mf_builditemiterator_movenext(items, &more) == 0 && more != 0) {
    ++result.items;
  }
  lib3mf_release(items);
  lib3mf_release(reader);
  lib3mf_release(model);
  return result;
}

TEST(ThreeMf, IsReadByItsLibraryWithUnitNamesAndVolume) {
  const TempFolder folder;
  const SurfaceMesh ball = shapes::sphere(25.0, 3);
  const std::map<std::string, DWORD> units = {{"mm", NMR::MODELUNIT_MILLIMETER},
                                              {"m", NMR::MODELUNIT_METER},
                                              {"in", NMR::MODELUNIT_INCH}};
  for (const auto& [unit, number] : units) {
    io::write_3mf(folder / "a.3mf", ball,
                  {.notes = notes(unit), .bodies = {"bäll"}});
    const Read read = read_3mf(folder / "a.3mf");
    EXPECT_EQ(read.unit, number);
    EXPECT_EQ(read.names, std::vector<std::string>({"bäll"}));
    EXPECT_TRUE(read.closed);
    EXPECT_EQ(read.items, 1);
    ASSERT_EQ(read.objects.size(), 1U);
    constexpr double kDecimals = 1e-6;  // six of them, at 25
    EXPECT_NEAR(enclosed_volume(read.objects[0]) / enclosed_volume(ball), 1.0,
                kDecimals);
  }
}

// Which slicers keep together: one item of all.
TEST(ThreeMf, HasAClosedObjectForEachBody) {
  const TempFolder folder;
  io::write_3mf(folder / "a.3mf", two_cubes(),
                {.notes = notes("mm"), .bodies = {"steel", "foam"}});
  const Read read = read_3mf(folder / "a.3mf");
  EXPECT_EQ(read.names, std::vector<std::string>({"steel", "foam"}));
  EXPECT_TRUE(read.closed);
  EXPECT_EQ(read.items, 1);
  for (const SurfaceMesh& object : read.objects) {
    EXPECT_EQ(object.points.size(), 8U);
    EXPECT_NEAR(enclosed_volume(object), 1.0, kRounding);
  }
}

TEST(ThreeMf, IsTheSameBytesAgainAndRefusesWhatItCannotHold) {
  const TempFolder folder;
  SurfaceMesh mesh = two_cubes();
  io::write_3mf(folder / "a.3mf", mesh, {.notes = notes("mm"), .bodies = {}});
  io::write_3mf(folder / "b.3mf", mesh, {.notes = notes("mm"), .bodies = {}});
  EXPECT_EQ(read_file(folder / "a.3mf"), read_file(folder / "b.3mf"));
  const auto refused = [&] {
    EXPECT_THROW(io::write_3mf(folder / "c.3mf", mesh,
                               {.notes = notes("mm"), .bodies = {}}),
                 InvalidInput);
  };
  EXPECT_THROW(io::write_3mf(folder / "c.3mf", mesh,
                             {.notes = notes("ft"), .bodies = {}}),
               InvalidInput);
  mesh.points[0].x() = std::numeric_limits<double>::quiet_NaN();
  refused();
  mesh = two_cubes();
  mesh.facets[0][0] = 99;
  refused();
  mesh.facets.clear();
  refused();
  EXPECT_FALSE(std::filesystem::exists(folder / "c.3mf"));
}

}  // namespace
}  // namespace meniscus::surface_files_test
