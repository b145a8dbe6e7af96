#include "cad/step/step_writer.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cad/step/mirror_brep.h"
#include "cad/step/step_edges.h"
#include "cad/step/step_reader.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "core/monitor.h"
#include "tests/support/temp_folder.h"

namespace meniscus::step_writer_test {
namespace {

/// A box with a corner at the origin, of planes and lines.
solid::Brep box(const Vec3& size) {
  solid::Brep brep;
  for (int k = 0; k < 8; ++k) {
    brep.vertices.emplace_back((k & 1) * size[0], (k >> 1 & 1) * size[1],
                               (k >> 2) * size[2]);
  }
  const std::vector<std::array<int, 4>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6},
                                                 {0, 1, 5, 4}, {2, 6, 7, 3},
                                                 {0, 4, 6, 2}, {1, 3, 7, 5}};
  const auto edge_of = [&](int a, int b) {
    for (std::size_t e = 0; e < brep.edges.size(); ++e) {
      if (brep.edges[e].from == std::min(a, b) &&
          brep.edges[e].to == std::max(a, b)) {
        return static_cast<int>(e);
      }
    }
    const Vec3 from = brep.vertices[std::min(a, b)];
    const Vec3 way = brep.vertices[std::max(a, b)] - from;
    brep.edges.push_back({std::min(a, b), std::max(a, b),
                          solid::StraightLine{from, way.normalized()}, 0.0,
                          way.norm()});
    return static_cast<int>(brep.edges.size()) - 1;
  };
  for (const auto& corners : faces) {
    const Vec3 a = brep.vertices[corners[0]];
    const Vec3 u = brep.vertices[corners[1]] - a;
    const Vec3 v = brep.vertices[corners[3]] - a;
    solid::BrepFace face{"side_" + std::to_string(brep.faces.size()),
                         solid::PlaneSurface{a, Vec3(u.cross(v)).normalized()},
                         {{}}};
    for (int k = 0; k < 4; ++k) {
      const int from = corners[k];
      const int to = corners[(k + 1) % 4];
      face.loops[0].push_back({edge_of(from, to), from < to});
    }
    brep.faces.push_back(face);
  }
  return brep;
}

class StepWriter : public testing::Test {
 protected:
  TempFolder folder_;
};

TEST_F(StepWriter, WritesAClosedSolidWithNamesAndUnit) {
  const auto file = folder_.path() / "box.step";
  const step::StepReport report = step::write_step(
      file, box({1.0, 2.0, 3.0}), {.name = "A box", .unit = "m"});
  EXPECT_EQ(report.shells, 1);
  EXPECT_NEAR(report.volume, 6.0, 1e-12);
  EXPECT_LT((report.mass_center - Vec3(0.5, 1.0, 1.5)).norm(), 1e-12);
  const std::string text = read_file(file);
  EXPECT_THAT(text, testing::HasSubstr("ADVANCED_FACE('side_3'"));
  EXPECT_THAT(text, testing::HasSubstr("PRODUCT('A box'"));
  EXPECT_THAT(text, testing::HasSubstr("LENGTH_UNIT"));
  EXPECT_THAT(text, testing::HasSubstr("(1.,2.,3.)"));
  EXPECT_THAT(text, testing::HasSubstr("1970-01-01"));
}

TEST_F(StepWriter, WritesASolidWithItsMirrorImage) {
  solid::Brep brep = box({1.0, 2.0, 3.0});
  const step::MirrorPlane plane{
      .at = Vec3(0, 2, 0), .normal = Vec3::UnitY(), .cuts = {"side_3"}};
  const solid::Brep whole = step::with_mirror_image(
      brep, plane, [](const std::string& name) { return name + " too"; });
  EXPECT_EQ(whole.faces.size(), 10U);
  EXPECT_EQ(whole.edges.size(), 20U);
  const auto file = folder_.path() / "boxes.step";
  const step::StepReport report =
      step::write_step(file, whole, {.name = "Two"});
  EXPECT_EQ(report.shells, 1);
  EXPECT_NEAR(report.volume, 12.0, 1e-12);
  EXPECT_LT((report.mass_center - Vec3(0.5, 2.0, 1.5)).norm(), 1e-12);
  EXPECT_THAT(read_file(file), testing::HasSubstr("'side_2 too'"));
}

TEST_F(StepWriter, WritesSeveralSolidsByTheirNames) {
  const auto file = folder_.path() / "boxes.step";
  const step::StepReport report = step::write_step(
      file, {{"small", box({1.0, 1.0, 1.0})}, {"large", box({1.0, 2.0, 3.0})}},
      {.name = "Boxes"});
  EXPECT_EQ(report.shells, 2);
  EXPECT_NEAR(report.volume, 7.0, 1e-12);
  EXPECT_LT((report.mass_center - Vec3(3.5, 6.5, 9.5) / 7.0).norm(), 1e-12);
  const std::string text = read_file(file);
  EXPECT_THAT(text, testing::HasSubstr("PRODUCT('small'"));
  EXPECT_THAT(text, testing::HasSubstr("PRODUCT('large'"));
}

TEST_F(StepWriter, WritesTheSameBitsTwice) {
  const auto one = folder_.path() / "one.step";
  const auto two = folder_.path() / "two.step";
  step::write_step(one, box({1.0, 2.0, 3.0}), {.name = "box"});
  step::write_step(two, box({1.0, 2.0, 3.0}), {.name = "box"});
  EXPECT_EQ(read_file(one), read_file(two));
}

TEST_F(StepWriter, WhatIsWrittenIsReadWithItsNames) {
  const auto file = folder_.path() / "box.step";
  step::write_step(file, box({1.0, 2.0, 3.0}), {.name = "box", .unit = "in"});
  const SurfaceMesh mesh =
      step::read_step_part(file, {.unit = "in", .edge = 0.5});
  EXPECT_EQ(mesh.points.size(), 8U);
  EXPECT_EQ(mesh.facets.size(), 12U);
  EXPECT_NEAR(enclosed_volume(mesh), 6.0, 1e-12);
  ASSERT_EQ(mesh.labels.size(), 6U);
  EXPECT_NEAR(surface_area(mesh, mesh.label_of("side_0")), 2.0, 1e-12);
  const SurfaceMesh metric =
      step::read_step_part(file, {.unit = "mm", .edge = 10});
  EXPECT_NEAR(enclosed_volume(metric), 6.0 * 25.4 * 25.4 * 25.4, 1e-8);
}

/// Of a loop, closing side included.
double perimeter(const step::StepLoop& loop) {
  double length = 0.0;
  for (const step::StepPiece& piece : loop.pieces) {
    length += piece.length;
    EXPECT_EQ(piece.kind, step::StepPiece::Kind::Line);
  }
  return length;
}

TEST_F(StepWriter, EdgesAndRimsAreReadAsLoops) {
  const auto file = folder_.path() / "box.step";
  step::write_step(file, box({1.0, 2.0, 3.0}), {.unit = "in"});
  const step::StepEdges edges(file, "in");
  // The first face uses the first four edges: about z = 0.
  const step::StepLoop loop = edges.loop({"4", "2", "1", "3"});
  EXPECT_FALSE(loop.whole);
  ASSERT_EQ(loop.pieces.size(), 4U);
  EXPECT_NEAR(perimeter(loop), 6.0, 1e-12);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((loop.pieces[k].samples.back() -
               loop.pieces[(k + 1) % 4].samples.front())
                  .norm(),
              1e-12);
  }
  EXPECT_NEAR(perimeter(step::StepEdges(file, "mm").rim("side_1")), 6.0 * 25.4,
              1e-10);
  EXPECT_THROW(edges.loop({"1"}), InvalidInput);
  EXPECT_THROW(edges.loop({"1", "2", "3"}), InvalidInput);
  EXPECT_THROW(edges.loop({"13"}), InvalidInput);
  EXPECT_THROW(edges.loop({"rim"}), InvalidInput);
  EXPECT_THROW(edges.rim("side_6"), InvalidInput);
}

/// Rims run counter-clockwise seen from outside.
TEST_F(StepWriter, RimsOfPlanesRunAroundTheirOutwardNormal) {
  const auto file = folder_.path() / "box.step";
  step::write_step(file, box({1.0, 2.0, 3.0}));
  const step::StepEdges edges(file, "mm");
  const Vec3 middle(0.5, 1.0, 1.5);
  for (int f = 0; f < 6; ++f) {
    const step::StepLoop loop = edges.rim("side_" + std::to_string(f));
    Vec3 area = Vec3::Zero();
    for (const step::StepPiece& piece : loop.pieces) {
      area += 0.5 * piece.samples.front().cross(piece.samples.back());
    }
    EXPECT_GT(area.dot(loop.pieces[0].samples.front() - middle), 0.0) << f;
  }
}

TEST_F(StepWriter, ReadersRefuseWhatIsNoStep) {
  const auto file = folder_.path() / "text.step";
  write_file(file, "solid x\n");
  EXPECT_THROW(step::read_step_part(file, {.edge = 1.0}), InvalidInput);
  write_file(file, "ISO-10303-21;\nHEADER;\n");
  EXPECT_THROW(step::read_step_part(file, {.edge = 1.0}), InvalidInput);
  EXPECT_THROW(step::read_step_part(folder_.path() / "none", {.edge = 1.0}),
               IoError);
  step::write_step(file, box({1.0, 1.0, 1.0}));
  EXPECT_THROW(step::read_step_part(file, {.edge = 0.0}), InvalidInput);
}

TEST_F(StepWriter, RefusesWhatIsNoSolid) {
  const auto file = folder_.path() / "open.step";
  solid::Brep open = box({1.0, 1.0, 1.0});
  open.faces.pop_back();
  EXPECT_THROW(step::write_step(file, open), MeshError);
  solid::Brep inside_out = box({1.0, 1.0, -1.0});
  EXPECT_THROW(step::write_step(file, inside_out), MeshError);
  EXPECT_THROW(step::write_step(file, box({1.0, 1.0, 1.0}), {.unit = "ell"}),
               InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(file));
}

/// The message of the MeshError that writing it throws.
std::string fault_of(const solid::Brep& brep) {
  const TempFolder folder;
  try {
    step::write_step(folder / "part.step", brep);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "";
}

/// As the process that finds them says them.
TEST(StepFaults, ComeThroughTheHelperUnchanged) {
  solid::Brep open = box({1.0, 1.0, 1.0});
  open.faces.pop_back();
  EXPECT_EQ(fault_of(open),
            "the solid is not closed: edge 2 of face 'side_0' is used 1 times; "
            "settle it with another --edge, or export it as step-faceted");
  EXPECT_EQ(fault_of(box({1.0, 1.0, -1.0})),
            "the part has 0 outer shells; a STEP solid has one");
  solid::Brep moved = box({1.0, 1.0, 1.0});
  moved.vertices[7][2] += 0.1;
  EXPECT_EQ(fault_of(moved),
            "the faces make no valid solid: face 1 'side_1' "
            "(BRepCheck 7:1 7:1 7:1 7:1 7:1 7:1)");
  solid::Brep no_plane = box({1.0, 1.0, 1.0});
  std::get<solid::PlaneSurface>(no_plane.faces[1].surface).normal.setZero();
  EXPECT_EQ(fault_of(no_plane),
            "OpenCASCADE makes no solid of the faces: "
            "Standard_ConstructionError");
}

/// Asks to stop when it is asked for the third time.
class SoonStopped : public Monitor {
 public:
  bool stop_requested() const override { return ++asked_ >= 3; }

 private:
  mutable int asked_ = 0;
};

/// A helper of the test's own for write_step.
class OtherHelper : public StepWriter {
 protected:
  void take(const std::string& script) {
    const auto helper = folder_ / "helper";
    write_file(helper, "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(helper, std::filesystem::perms::owner_all);
    ::setenv("MENISCUS_STEP", helper.c_str(), 1);
  }
  void TearDown() override { ::unsetenv("MENISCUS_STEP"); }
};

TEST_F(OtherHelper, AStopIsHeardWhileItWrites) {
  take("exec sleep 600");
  const auto file = folder_ / "part.step";
  write_file(file, "before");
  SoonStopped monitor;
  EXPECT_THROW(
      step::write_step(file, box({1.0, 1.0, 1.0}), {.monitor = &monitor}),
      Interrupted);
  EXPECT_EQ(read_file(file), "before");
}

TEST_F(OtherHelper, OneThatEndsIsNoFaultOfAFile) {
  take("exit 3");
  const auto file = folder_ / "part.step";
  try {
    step::write_step(file, box({1.0, 1.0, 1.0}));
    FAIL() << "written";
  } catch (const MeshError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("ended with exit code 3"),
                               testing::HasSubstr("another format"),
                               testing::Not(testing::HasSubstr("damaged"))));
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  ::setenv("MENISCUS_STEP", "/no/such/file", 1);
  EXPECT_THROW(step::write_step(file, box({1.0, 1.0, 1.0})), IoError);
}

}  // namespace
}  // namespace meniscus::step_writer_test
