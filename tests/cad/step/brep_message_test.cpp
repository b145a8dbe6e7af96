#include "cad/step/brep_message.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::brep_message_test {
namespace {

/// Every kind of curve and surface, each number another; it need not close.
solid::Brep one_of_each() {
  solid::Brep brep;
  brep.vertices = {Vec3(0.1, -0.0, 1e-300), Vec3(3, 4, 5)};
  const solid::EllipseCurve arc{Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9)};
  const solid::SplineCurve spline{{0, 0, 0, 0, 0.3, 1, 1, 1, 1},
                                  Points(5, Vec3(1.0 / 3.0, 2, 3))};
  brep.edges = {{0, 1, solid::StraightLine{Vec3(1, 1, 2), Vec3(0, 1, 0)}, -1.5,
                 2.5, 1e-9},
                {1, 0, arc, 0.25, 6.5},
                {1, 1, spline, 0.0, 0.75}};
  const std::vector<std::vector<solid::BrepUse>> loops = {
      {{0, true, {0.1, 0.2}, {0.3, 0.4}}, {2, false, {1, 2}, {3, 4}}},
      {{solid::kPole, true, {5, 6}, {7, 8}}, {1, true, {}, {}}}};
  const Vec3 a(1, 2, 3);
  const Vec3 b(4, 5, 6);
  const Vec3 c(7, 8, 9);
  const solid::SplineSurface patch{{0, 0, 0, 0, 1, 1, 1, 1},
                                   {0, 0, 0, 0, 0.5, 1, 1, 1, 1},
                                   Points(20, Vec3(0.1, 0.2, 0.7))};
  brep.faces = {{"a plane", solid::PlaneSurface{a, b}, loops},
                {"tube", solid::CylinderSurface{a, b, c, 2.5, true}, loops},
                {"", solid::ConeSurface{a, b, c, 3.5, -0.2, true}, {}},
                {"ball", solid::SphereSurface{a, b, c, 4.5, true}, {{}}},
                {"\xC3\xBC", patch, loops}};
  ExactShape shape;
  shape.vertices = {a, b};
  shape.edges = {{.name = "e", .from = 0, .to = 1, .curve = ExactLine{a, c}}};
  shape.faces = {{.name = "f",
                  .surface = ExactSphere{.frame = {}, .radius = 0.1},
                  .loops = {{{.edge = 0}}}}};
  brep.exact = {{shape, {0, 0}, {"one", "two"}}, {shape, {}, {}}};
  return brep;
}

std::string message_of(const solid::Brep& brep) {
  FrameWriter out;
  step::put_brep(out, brep);
  return out.bytes();
}

solid::Brep brep_of(const std::string& message) {
  FrameReader in(message);
  solid::Brep brep = step::get_brep(in);
  EXPECT_TRUE(in.at_end());
  return brep;
}

TEST(BrepMessage, ComesBackWithTheSameBits) {
  const std::string message = message_of(one_of_each());
  const solid::Brep back = brep_of(message);
  EXPECT_EQ(message_of(back), message);
  // What both ways might leave out alike.
  EXPECT_EQ(back.edges[0].gap, 1e-9);
  EXPECT_EQ(std::get<solid::EllipseCurve>(back.edges[1].curve).v[2], 9.0);
  EXPECT_EQ(std::get<solid::SplineCurve>(back.edges[2].curve).knots[4], 0.3);
  EXPECT_TRUE(std::get<solid::CylinderSurface>(back.faces[1].surface).inward);
  EXPECT_EQ(std::get<solid::ConeSurface>(back.faces[2].surface).angle, -0.2);
  EXPECT_TRUE(std::get<solid::SphereSurface>(back.faces[3].surface).inward);
  EXPECT_EQ(std::get<solid::SplineSurface>(back.faces[4].surface).poles.size(),
            20U);
  EXPECT_EQ(back.faces[4].name, "\xC3\xBC");
  EXPECT_EQ(back.faces[0].loops[0][1].at_last, solid::Vec2(3, 4));
  EXPECT_FALSE(back.faces[0].loops[0][1].forward);
  EXPECT_EQ(back.exact[0].names[1], "two");
  EXPECT_EQ(std::get<ExactSphere>(back.exact[0].shape.faces[0].surface).radius,
            0.1);
}

TEST(BrepMessage, OneThatEndsEarlyIsRefused) {
  const std::string message = message_of(one_of_each());
  for (std::size_t size = 0; size < message.size(); size += 7) {
    FrameReader in(std::string_view(message).substr(0, size));
    EXPECT_THROW(step::get_brep(in), IoError) << size;
  }
}

TEST(BrepMessage, NumbersBeyondTheListsAreRefused) {
  constexpr int kFar = std::numeric_limits<int>::max();
  const auto refused = [](const auto& change) {
    solid::Brep brep = one_of_each();
    change(brep);
    EXPECT_THROW(brep_of(message_of(brep)), IoError);
  };
  refused([](solid::Brep& brep) { brep.edges[1].to = 2; });
  refused([](solid::Brep& brep) { brep.edges[0].from = -1; });
  refused([](solid::Brep& brep) { brep.faces[0].loops[0][0].edge = 3; });
  refused([](solid::Brep& brep) { brep.faces[0].loops[1][1].edge = -2; });
  refused([](solid::Brep& brep) { brep.exact[0].faces[1] = kFar; });
  refused([](solid::Brep& brep) { brep.exact[0].names.pop_back(); });
}

}  // namespace
}  // namespace meniscus::brep_message_test
