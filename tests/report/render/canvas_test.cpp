#include "report/render/canvas.h"

#include <gtest/gtest.h>

#include "report/render/eye_view.h"

namespace meniscus::canvas_test {
namespace {

constexpr double kPixel = 1.0;  // what rounding and perspective may leave

TEST(EyeView, AllThatIsShownFillsTheBox) {
  Points points;
  for (int i = 0; i < 8000; ++i) {  // enough for the outermost to be chosen
    const double t = 0.001 * i;
    points.emplace_back(100 * std::cos(7 * t), 30 * std::sin(11 * t), 40 * t);
  }
  const render::Box box = {0.1, 0.2, 0.8, 0.9};
  const render::EyeView view =
      render::fit_view(points, Vec3(0.3, -1, 0.6), box, 2000, 1000);
  Eigen::Array2d low(1e300, 1e300), high(-1e300, -1e300);
  for (const Vec3& p : points) {
    const Eigen::Array2d at = view.project(p).array();
    low = low.min(at);
    high = high.max(at);
  }
  EXPECT_GT(low.x(), 200 - kPixel);
  EXPECT_GT(low.y(), 200 - kPixel);
  EXPECT_LT(high.x(), 1600 + kPixel);
  EXPECT_LT(high.y(), 900 + kPixel);
  // One of the two directions is filled.
  EXPECT_LT(std::min(1400 - (high - low).x(), 700 - (high - low).y()),
            2 * kPixel);
}

TEST(EyeView, APixelIsWhatTwoPixelsAreApart) {
  const render::EyeView view = render::fit_view(
      {Vec3(-1, 0, -1), Vec3(1, 0, 1)}, Vec3(0, -1, 0), {0, 0, 1, 1}, 500, 500);
  const Vec3 at(0.1, 0, 0.2);
  const double pixel = view.pixel_at(at);
  const Eigen::Vector2d step =
      view.project(at + pixel * view.right) - view.project(at);
  EXPECT_NEAR(step.x(), 1.0, 1e-9);
  EXPECT_NEAR(step.y(), 0.0, 1e-9);
}

TEST(Canvas, BoxesCoverWhatTheyCover) {
  render::Canvas canvas(10, 6);
  EXPECT_EQ(canvas.taken({0, 0, 10, 6}), 0);
  canvas.fill(2.0, 1.0, 4.5, 3.0, {0.0, 0.0, 0.0});
  EXPECT_EQ(canvas.taken({0, 0, 10, 6}), 6);
  EXPECT_EQ(canvas.taken({5, 0, 10, 6}), 0);
  EXPECT_EQ(canvas.taken({-1, 5, 1, 6}), 1);  // beyond the rim nothing is free
  const std::vector<unsigned char>& bytes = canvas.bytes();
  EXPECT_EQ(bytes[3 * (10 + 3)], 0);
  EXPECT_EQ(bytes[3 * (10 + 4)], 128);  // half of the pixel
}

TEST(Canvas, LettersStandAtTheirPlace) {
  const render::TextImage centred =
      render::text_image("40 kN", {.size = 20,
                                   .justify = render::Justify::Centre,
                                   .stand = render::Stand::Centred});
  ASSERT_FALSE(centred.cover.empty());
  EXPECT_NEAR(centred.box.left + centred.box.right, 0, 3);
  EXPECT_NEAR(centred.box.bottom + centred.box.top, 0, 3);
  const render::TextImage left = render::text_image("40 kN", {.size = 20});
  EXPECT_GE(left.box.left, -1);
  EXPECT_GE(left.box.bottom, -6);
  render::Canvas canvas(100, 40);
  canvas.write(centred, 50, 20, {0.8, 0.1, 0.1});
  EXPECT_GT(canvas.taken({20, 5, 80, 35}), 100);
  EXPECT_EQ(canvas.taken({0, 0, 10, 40}), 0);
  EXPECT_TRUE(render::text_image("", {}).cover.empty());
}

}  // namespace
}  // namespace meniscus::canvas_test
