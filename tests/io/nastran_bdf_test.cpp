#include "io/nastran_bdf.h"

#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/shapes.h"

namespace meniscus::nastran_bdf_test {
namespace {

using testing::HasSubstr;

/// "1.5-9" is 1.5e-9.
double nastran_value(std::string text) {
  const std::size_t sign = text.find_first_of("+-", 1);
  if (sign != std::string::npos && text[sign - 1] != 'E') {
    text.insert(sign, "E");
  }
  return std::strtod(text.c_str(), nullptr);
}

TEST(NastranReal, HasAPointAndElevenDigits) {
  EXPECT_EQ(io::nastran_real(0.0), "0.");
  EXPECT_EQ(io::nastran_real(71700.0), "71700.");
  EXPECT_EQ(io::nastran_real(-2.8e-9), "-2.8E-9");
  EXPECT_EQ(io::nastran_real(1e300), "1.E+300");
  EXPECT_EQ(io::nastran_real(-0.25), "-0.25");
  constexpr double kEleven = 6e-11;
  constexpr double kTen = 6e-10;  // beside exponents of three figures
  for (int power = -300; power <= 300; ++power) {
    for (const double lead : {1.0 / 3.0, -2.0 / 3.0, 0.99999999999999}) {
      const double value = lead * std::pow(10.0, power);
      const std::string text = io::nastran_real(value);
      EXPECT_LE(text.size(), 16U) << text;
      EXPECT_NE(text.find('.'), std::string::npos) << text;
      EXPECT_NEAR(nastran_value(text) / value, 1.0,
                  std::abs(power) > 98 ? kTen : kEleven)
          << text;
    }
  }
}

class NastranBdf : public testing::Test {
 protected:
  NastranBdf()
      : mesh_(
            shapes::straight_quadratic(shapes::brick(Vec3(1, 2, 3), 1, 1, 1))) {
    mesh_.labels[0] = "süd";
    io::DeckStep step{.name = "push"};
    step.supports = {{.surface = "süd", .fix_x = true, .fix_z = true}};
    deck_.materials = {{.name = "steel",
                        .youngs_modulus = 210000.0,
                        .poisson_ratio = 0.3,
                        .density = 7.85e-9}};
    deck_.steps = {step};
  }

  std::string text() const { return io::nastran_bdf(mesh_, deck_); }

  TetMesh mesh_;
  io::AnalysisDeck deck_;
};

TEST_F(NastranBdf, HasFixedFieldsOfPlainAscii) {
  deck_.comments = {"case: Träger", std::string(200, 'x')};
  std::size_t begin = 0;
  const std::string deck = text();
  for (std::size_t end = deck.find('\n'); end != std::string::npos;
       begin = end + 1, end = deck.find('\n', begin)) {
    EXPECT_LE(end - begin, 72U) << deck.substr(begin, end - begin);
  }
  for (const char c : deck) {
    EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
  }
  EXPECT_THAT(deck, HasSubstr("TITLE = Tr__ger\n"));
  EXPECT_THAT(deck, HasSubstr("CTETRA         1       1       1"));
  EXPECT_THAT(deck, HasSubstr(fmt::format(
                        "MAT1*   {:>16}{:>16}{:>16}{:>16}\n*       {:>16}\n", 1,
                        "210000.", "", "0.3", "7.85E-9")));
  EXPECT_THAT(deck, HasSubstr("SPC1           1      13       "));
  EXPECT_TRUE(deck.ends_with("ENDDATA\n"));
}

TEST_F(NastranBdf, CombinesLoadsOfAStep) {
  io::DeckStep& step = deck_.steps[0];
  step.gravity = Vec3(0, 0, -9810.0);
  step.spin = io::DeckSpin{Vec3(1, 0, 0), Vec3::UnitZ(), 2.0 * EIGEN_PI};
  step.pressures = {{"süd", 5.0}};
  const std::string deck = text();
  EXPECT_THAT(deck, HasSubstr("LOAD          10      1.      1.      11      "
                              "1.      12      1.      13\n"));
  EXPECT_THAT(deck, HasSubstr("GRAV*                 12               0        "
                              "   9810.              0."));
  EXPECT_THAT(deck, HasSubstr("RFORCE*               13              28        "
                              "       0              1."));
  EXPECT_THAT(deck, HasSubstr("PLOAD4*               11 "));
}

// A pin is a grid point with six components along its axes and an RBE2.
TEST_F(NastranBdf, HoldsRigidPinsAndMovedSurfaces) {
  deck_.steps[0].supports[0].displacement = Vec3(0.0, 0.0, 0.125);
  io::DeckPin pin{.nodes = {1, 3, 5}, .point = Vec3(1.0, 1.0, 1.5)};
  pin.axes.col(0) = Vec3::UnitY();
  pin.axes.col(1) = Vec3::UnitZ();
  pin.axes.col(2) = Vec3::UnitX();
  deck_.pins = {pin};
  deck_.steps[0].pins = {{.fixed = {true, false, false, false, true, false},
                          .value = {0.25, 0.0, 0.0, 0.0, -0.5, 0.0}}};
  const std::string deck = text();
  const auto point = static_cast<int>(mesh_.nodes.size()) + 1;
  const auto body = mesh_.element_count() + 1;
  EXPECT_THAT(deck, HasSubstr(fmt::format("RBE2    {:>8}{:>8}     123       2"
                                          "       4       6\n",
                                          body, point)));
  // z of the system is axis 3, from its origin; x lies towards axis 1.
  EXPECT_THAT(
      deck,
      HasSubstr(fmt::format(
          "CORD2R* {:>16}{:>16}{:>16}{:>16}\n*       {:>16}{:>16}{:>16}"
          "{:>16}\n*       {:>16}{:>16}{:>16}\n",
          1, 0, "1.", "1.", "1.5", "2.", "1.", "1.5", "1.", "2.", "1.5")));
  EXPECT_THAT(deck, HasSubstr(fmt::format("GRID*   {:>16}{:>16}", point, 0)));
  EXPECT_THAT(deck, HasSubstr(fmt::format("SPC*    {:>16}{:>16}{:>16}{:>16}\n",
                                          1, point, 1, "0.25")));
  EXPECT_THAT(deck, HasSubstr(fmt::format("SPC*    {:>16}{:>16}{:>16}{:>16}\n",
                                          1, point, 5, "-0.5")));
  EXPECT_THAT(deck, HasSubstr("SPC1           1       1       "));
  EXPECT_THAT(deck, HasSubstr(fmt::format("{:>16}{:>16}\n", 3, "0.125")));
  deck_.steps[0].pins.clear();
  EXPECT_THROW(text(), InvalidInput);
}

TEST_F(NastranBdf, RefusesWhatDoesNotFit) {
  deck_.steps[0].supports = {};
  EXPECT_THROW(text(), InvalidInput);
  deck_.steps[0].supports = {{.surface = "north", .fix_x = true}};
  EXPECT_THROW(text(), InvalidInput);
  deck_.materials.clear();
  EXPECT_THROW(text(), InvalidInput);
}

}  // namespace
}  // namespace meniscus::nastran_bdf_test
