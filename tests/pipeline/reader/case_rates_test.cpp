/// Derivatives of a case's numbers against central differences.
#include <cmath>
#include <functional>
#include <variant>

#include <gmock/gmock.h>

#include "pipeline/case_data/case_curves.h"
#include "tests/support/case_text.h"

namespace meniscus::case_rates_test {
namespace {

constexpr double kStep = 1e-4;
// Central differences of these expressions err by the step squared.
constexpr double kDifference = 1e-6;

/// Every number that depends on a design variable, directly or through
/// parameters.
std::string depending() {
  std::string text = changed(strut(), "length = 60.0",
                             "length = \"40 + foot^2 / 30\"\nslope = "
                             "\"sin(length / 20) + lean / foot\"");
  text = changed(text, "[curves.base]",
                 "[design.lean]\ninitial = 3.0\nbounds = [-10.0, 10.0]\n\n"
                 "[curves.base]");
  text = changed(text, "center = [0, 0, \"length\"]",
                 "center = [\"lean\", \"slope * lean\", \"length\"]");
  text = changed(text, "volume = 9e4", "volume = \"3e3 * foot + lean^2\"");
  text = changed(
      text, "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]",
      "[{ on = \"head_pad\", force = [\"load * slope\", 0, \"lean^3\"] },\n"
      "  { on = \"skin\", pressure = \"foot * x + exp(lean / 9) * z^2\" },\n"
      "  { on = \"skin\", traction = [\"lean * y\", 0, \"x / foot\"] }]");
  return changed(text, "density = ", "density = \"1e-9 * sqrt(foot)\" #");
}

using Number = std::function<double(const case_data::StageInputs&)>;

std::vector<Number> numbers_to_look_at() {
  const Vec3 place(3.0, -4.0, 11.0);
  const auto circle = [](const case_data::StageInputs& c, int k) {
    return std::get<curves::Circle>(c.film_system.curves[k].shape);
  };
  return {
      [=](const case_data::StageInputs& c) { return circle(c, 0).radius; },
      [=](const case_data::StageInputs& c) { return circle(c, 1).center.x(); },
      [=](const case_data::StageInputs& c) { return circle(c, 1).center.y(); },
      [=](const case_data::StageInputs& c) { return circle(c, 1).center.z(); },
      [](const case_data::StageInputs& c) {
        return *c.film_system.bodies[0].volume;
      },
      [](const case_data::StageInputs& c) { return c.materials[0].density; },
      [](const case_data::StageInputs& c) {
        return c.load_cases[0].forces[0].total.x();
      },
      [](const case_data::StageInputs& c) {
        return c.load_cases[0].forces[0].total.z();
      },
      [=](const case_data::StageInputs& c) {
        return c.load_cases[0].pressures[0].field(place);
      },
      [=](const case_data::StageInputs& c) {
        return c.load_cases[0].tractions[0].field(place).x();
      },
      [=](const case_data::StageInputs& c) {
        return c.load_cases[0].tractions[0].field(place).z();
      }};
}

TEST(CaseRates, AreTheDerivativesOfTheNumbers) {
  const reader::CaseReading reading =
      reader::read_case_text(depending(), "case.toml");
  ASSERT_THAT(reading.problems, testing::IsEmpty());
  const case_data::Case& input = *reading.input;
  const VectorX design = case_data::initial_design(input);
  for (int j = 0; j < 2; ++j) {
    const case_data::CaseRates rate = case_data::rates(input, design, j);
    VectorX before = design;
    VectorX after = design;
    before[j] -= kStep;
    after[j] += kStep;
    const case_data::EvaluatedCase a = case_data::evaluate(input, before);
    const case_data::EvaluatedCase b = case_data::evaluate(input, after);
    int index = 0;
    for (const Number& number : numbers_to_look_at()) {
      const double expected = (number(b) - number(a)) / (2.0 * kStep);
      EXPECT_NEAR(number(rate), expected,
                  kDifference * std::max(1.0, std::abs(expected)))
          << "number " << index << ", variable " << j;
      ++index;
    }
  }
}

/// Curves that no design variable moves stand beside some that it does.
std::string with_copies() {
  return changed(depending(), "[films.skin]",
                 R"([curves.still]
kind = "circle"
center = [200, 0, 0]
normal = [0, 0, 1]
radius = "load / 20"

[curves.still_too]
kind = "copy"
of = "still"
move = [0, 0, "load / 50"]

[curves.follows]
kind = "copy"
of = "still"
move = [0, 0, "-length / 9"]

[curves.of_that]
kind = "copy"
of = "follows"
move = [0, 0, -9]

[films.above]
kind = "loft"
curves = ["still", "still_too"]
tension = 1

[films.below]
kind = "loft"
curves = ["follows", "of_that"]
tension = 1

[films.skin])");
}

TEST(CaseRates, AndValuesOfFixedCurvesAreThoseDrawnAnew) {
  const reader::CaseReading reading =
      reader::read_case_text(with_copies(), "case.toml");
  ASSERT_THAT(reading.problems, testing::IsEmpty());
  case_data::Case drawn = *reading.input;
  std::vector<std::string> fixed;
  for (case_data::CurveEntry& curve : drawn.curves) {
    if (curve.fixed) {
      fixed.push_back(curve.name);
    }
    curve.fixed = nullptr;
  }
  EXPECT_THAT(fixed, testing::ElementsAre("still", "still_too"));
  for (const double foot : {21.0, 25.0, 30.5}) {
    VectorX design = case_data::initial_design(drawn);
    design[0] = foot;
    const auto a = case_data::evaluate(*reading.input, design);
    const auto b = case_data::evaluate(drawn, design);
    EXPECT_TRUE(case_data::have_equal_shapes(a.film_system.curves,
                                             b.film_system.curves));
    for (int j = 0; j < 2; ++j) {
      EXPECT_TRUE(case_data::have_equal_shapes(
          case_data::rates(*reading.input, design, j).film_system.curves,
          case_data::rates(drawn, design, j).film_system.curves));
    }
  }
}

TEST(CaseRates, AreZeroForWhatStandsAsNumbers) {
  const reader::CaseReading reading =
      reader::read_case_text(strut(), "case.toml");
  const case_data::CaseRates rate = case_data::rates(
      *reading.input, case_data::initial_design(*reading.input), 0);
  EXPECT_EQ(std::get<curves::Circle>(rate.film_system.curves[0].shape).radius,
            1.0);
  EXPECT_EQ(std::get<curves::Circle>(rate.film_system.curves[0].shape).normal,
            Vec3(0, 0, 0));
  EXPECT_EQ(std::get<curves::Circle>(rate.film_system.curves[1].shape).radius,
            0.0);
  EXPECT_EQ(*rate.film_system.bodies[0].volume, 0.0);
  EXPECT_EQ(rate.load_cases[0].forces[0].total, Vec3(0, 0, 0));
  EXPECT_EQ(rate.materials[0].youngs_modulus, 0.0);
}

TEST(CaseRates, ExpressionsWithoutADerivativeAreNamed) {
  const reader::CaseReading reading = reader::read_case_text(
      changed(strut(), "volume = 9e4",
              "volume = \"9e4 + sqrt((foot - 25) ^ 2)\""),
      "case.toml");
  ASSERT_THAT(reading.problems, testing::IsEmpty());
  try {
    case_data::rates(*reading.input, case_data::initial_design(*reading.input),
                     0);
    FAIL() << "a square root of 0 has no derivative";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("bodies.part.volume"));
  }
}

/// The strut with a spine of three points that is `radius` thick.
std::string with_spine(const std::string& radius) {
  return strut() +
         "\n[spines.arm]\npoints = [[0, 0, 0], [\"foot / 2\", 0, "
         "\"20 + foot / 5\"], [0, 0, \"length\"]]\nradius = \"" +
         radius + "\"\n";
}

TEST(SpineRadii, FollowTheShareOfTheWayAndItsRate) {
  const reader::CaseReading reading =
      reader::read_case_text(with_spine("foot * (1 - 0.6 * s^2)"), "case.toml");
  ASSERT_THAT(reading.problems, testing::IsEmpty());
  const case_data::Case& input = *reading.input;
  const auto radii_at = [&](double foot) {
    return case_data::evaluate(input, VectorX::Constant(1, foot))
        .film_system.spines[0]
        .radii;
  };
  const std::vector<double> radii = radii_at(25.0);
  const double first = Vec3(12.5, 0, 25).norm();
  const double share = first / (first + Vec3(12.5, 0, 35).norm());
  ASSERT_EQ(radii.size(), 3U);
  EXPECT_DOUBLE_EQ(radii[0], 25.0);
  EXPECT_DOUBLE_EQ(radii[1], 25.0 * (1.0 - 0.6 * share * share));
  EXPECT_DOUBLE_EQ(radii[2], 10.0);
  const std::vector<double> rates =
      case_data::rates(input, VectorX::Constant(1, 25.0), 0)
          .film_system.spines[0]
          .radii;
  for (std::size_t k = 0; k < 3; ++k) {
    const double difference =
        (radii_at(25.0 + kStep)[k] - radii_at(25.0 - kStep)[k]) / (2 * kStep);
    EXPECT_NEAR(rates[k], difference, 1e-7) << k;
  }
}

TEST(SpineRadii, AreAboveZeroAllTheWay) {
  const reader::CaseReading reading =
      reader::read_case_text(with_spine("10 - 12 * s"), "case.toml");
  EXPECT_THAT(reading.problems,
              testing::ElementsAre(testing::HasSubstr(
                  "spines.arm.radius is -2 at s = 1 of the spine; it must")));
}

// A case that has the name keeps it, and lists know no way.
TEST(SpineRadii, OfACasesOwnSAreThat) {
  const std::string own =
      changed(with_spine("3 + s"), "[parameters]\n", "[parameters]\ns = 2.0\n");
  const reader::CaseReading reading = reader::read_case_text(own, "case.toml");
  ASSERT_THAT(reading.problems, testing::IsEmpty());
  EXPECT_FALSE(reading.input->spines[0].along);
  const reader::CaseReading list = reader::read_case_text(
      changed(with_spine("s"), "radius = \"s\"", "radius = [1, \"s\", 1]"),
      "case.toml");
  EXPECT_THAT(list.problems,
              testing::Contains(testing::HasSubstr("unknown name 's'")));
}

}  // namespace
}  // namespace meniscus::case_rates_test
