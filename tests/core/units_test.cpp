#include "core/units.h"

#include <clocale>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/not_here.h"

namespace meniscus::units_test {
namespace {

using testing::HasSubstr;

const UnitSystem kMm = *unit_system("mm-N-MPa");
const UnitSystem kM = *unit_system("m-N-Pa");
const UnitSystem kInch = *unit_system("in-lbf-psi");

std::string error_of(const std::string& text,
                     std::optional<Dimension> dimension) {
  try {
    parse_quantity(text, dimension, kMm);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "no error";
}

TEST(UnitSystem, HasThreeNames) {
  EXPECT_FALSE(unit_system("mm").has_value());
  EXPECT_FALSE(unit_system("").has_value());
  EXPECT_EQ(kMm.unit_of(Dimension::Density), "t/mm3");
  EXPECT_EQ(kM.unit_of(Dimension::Pressure), "Pa");
  EXPECT_EQ(kInch.unit_of(Dimension::Tension), "lbf/in");
  EXPECT_EQ(kMm.unit_of(Dimension::Energy), "N mm");
  EXPECT_EQ(kMm.unit_of(Dimension::None), "");
}

TEST(Quantity, IsNumberSpaceUnit) {
  for (const char* text : {"20 ft", "71.7 GPa", "-1e3 mm", "+2 m", "50 %",
                           "3  in", "60 \xC2\xB0", "1 kg/m3", "2 mm "}) {
    EXPECT_TRUE(looks_like_quantity(text)) << text;
  }
  for (const char* text : {"20ft", "20", "a mm", "2 * a", "2 + 3", "", " ",
                           "20 ", "- mm", "2 (mm)", "1 2 mm"}) {
    EXPECT_FALSE(looks_like_quantity(text)) << text;
  }
}

TEST(Quantity, ConvertsDecimalUnitsExactly) {
  EXPECT_EQ(parse_quantity("71.7 GPa", Dimension::Pressure, kMm), 71700.0);
  EXPECT_EQ(parse_quantity("71.7 GPa", Dimension::Pressure, kM), 71.7e9);
  EXPECT_EQ(parse_quantity("2800 kg/m3", Dimension::Density, kMm), 2.8e-9);
  EXPECT_EQ(parse_quantity("20 ft", Dimension::Length, kMm), 6096.0);
  EXPECT_EQ(parse_quantity("0.1 in", Dimension::Length, kMm), 2.54);
  EXPECT_EQ(parse_quantity("1 cm", Dimension::Length, kMm), 10.0);
  EXPECT_EQ(parse_quantity("40 kN", Dimension::Force, kMm), 40000.0);
  EXPECT_EQ(parse_quantity("1.7 l", Dimension::Volume, kMm), 1.7e6);
  EXPECT_EQ(parse_quantity("1 t", Dimension::Mass, kMm), 1.0);
  EXPECT_EQ(parse_quantity("0.03 N/m", Dimension::Tension, kMm), 3e-5);
  EXPECT_EQ(parse_quantity("1 J", Dimension::Energy, kMm), 1000.0);
  EXPECT_EQ(parse_quantity("0.5 mm", Dimension::Length, kMm), 0.5);
}

TEST(Quantity, KnowsInchesAndPounds) {
  constexpr double kDigits = 1e-12;  // 15 digits kept
  EXPECT_EQ(parse_quantity("2 ft", Dimension::Length, kInch), 24.0);
  EXPECT_EQ(parse_quantity("10 lbf", Dimension::Force, kInch), 10.0);
  EXPECT_EQ(parse_quantity("30 psi", Dimension::Pressure, kInch), 30.0);
  EXPECT_NEAR(parse_quantity("71.7 GPa", Dimension::Pressure, kInch),
              71.7e9 / 6894.757293168361, 1e7 * kDigits);
  // 1 lbf s2/in is 386.0886 lb.
  EXPECT_NEAR(parse_quantity("386.08858267716535 lb", Dimension::Mass, kInch),
              1.0, kDigits);
}

TEST(Quantity, AnglesAreRadians) {
  EXPECT_NEAR(parse_quantity("180 deg", Dimension::Angle, kMm),
              3.14159265358979, 1e-14);
  EXPECT_NEAR(parse_quantity("60 deg", std::nullopt, kMm), 1.0471975511966,
              1e-13);
  EXPECT_EQ(parse_quantity("50 %", Dimension::None, kMm), 0.5);
}

TEST(Quantity, TakesAnyDimensionWhenNoneIsAsked) {
  EXPECT_EQ(parse_quantity("40 kN", std::nullopt, kMm), 40000.0);
  EXPECT_EQ(parse_quantity("2 GPa", std::nullopt, kMm), 2000.0);
  EXPECT_EQ(parse_quantity("3 m", std::nullopt, kMm), 3000.0);
  EXPECT_EQ(parse_quantity("3 kN/m2/s", std::nullopt, kMm), 0.003);
  for (const char* other : {"3 volt", "20 degC", "3 K", "50 Hz"}) {
    EXPECT_THAT(
        error_of(other, std::nullopt),
        HasSubstr(std::string("'") + other + "' is no quantity of a case"));
  }
}

TEST(Quantity, KnowsItsPowers) {
  const auto powers = [](const char* text) { return quantity_powers(text); };
  EXPECT_EQ(powers("3 kg"), powers_of(Dimension::Mass));
  EXPECT_EQ(powers("3 lbf"), powers_of(Dimension::Force));
  EXPECT_EQ(powers("3 ksi"), powers_of(Dimension::Pressure));
  EXPECT_EQ(powers("3 g/cm3"), powers_of(Dimension::Density));
  EXPECT_EQ(powers("9.81 m/s2"), powers_of(Dimension::Acceleration));
  EXPECT_EQ(powers("3000 rpm"), powers_of(Dimension::Rate));
  EXPECT_EQ(powers("60 deg"), UnitPowers{});
  EXPECT_EQ(powers("50 %"), UnitPowers{});
  EXPECT_EQ(described(powers("2 m2")), "an area");
  EXPECT_EQ(described(powers("2 N/s")), "a quantity of force time^-1");
  EXPECT_NEAR(parse_quantity("3000 rpm", Dimension::Rate, kMm),
              314.159265358979, 1e-9);
  // Turns or radians? It does not say.
  EXPECT_THAT(error_of("50 Hz", Dimension::Rate), HasSubstr("is no rate"));
}

// The powers say of each unit what UDUNITS says of it.
TEST(Quantity, PowersAgreeWithEveryDimension) {
  for (int d = 0; d <= static_cast<int>(Dimension::Foundation); ++d) {
    const auto dimension = static_cast<Dimension>(d);
    for (const UnitSystem& system : {kMm, kM, kInch}) {
      const std::string unit = system.unit_of(dimension);
      if (unit.empty() || unit.starts_with("lbf s2")) {
        continue;
      }
      if (dimension != Dimension::Frequency) {  // else "Hz" may count radians
        EXPECT_EQ(quantity_powers("2 " + unit), powers_of(dimension)) << unit;
      }
      EXPECT_EQ(parse_quantity("2 " + unit, dimension, system), 2.0) << unit;
    }
  }
}

TEST(Quantity, HertzCountTurnsWhereThatIsAsked) {
  EXPECT_EQ(parse_quantity("50 Hz", Dimension::Frequency, kMm), 50.0);
  EXPECT_EQ(parse_quantity("2 kHz", Dimension::Frequency, kMm), 2000.0);
  EXPECT_THROW(parse_quantity("50 rad/s", Dimension::Frequency, kMm),
               InvalidInput);
  EXPECT_THROW(parse_quantity("50 Hz", Dimension::Rate, kMm), InvalidInput);
}

TEST(Quantity, RefusesWrongUnitsByName) {
  EXPECT_EQ(error_of("20 furlongs_per", Dimension::Length),
            "unknown unit 'furlongs_per' in '20 furlongs_per'; try a value in "
            "mm");
  EXPECT_EQ(
      error_of("0.4 N/mm / ring^2", Dimension::Pressure),
      "unknown unit 'N/mm / ring^2' in '0.4 N/mm / ring^2'; an expression "
      "holds no units: give the quantity a name in [parameters] and write "
      "that here");
  EXPECT_EQ(error_of("20 N", Dimension::Length),
            "'20 N' is no length but a force; try a value in mm");
  EXPECT_EQ(error_of("20 mm", Dimension::None),
            "'20 mm' is no number but a length; try a value in plain numbers");
  EXPECT_THAT(error_of("inf mm", Dimension::Length), HasSubstr("no finite"));
  EXPECT_THAT(error_of("1e308 km", Dimension::Length), HasSubstr("too large"));
  EXPECT_THAT(error_of("1 " + std::string(1000000, 'm'), Dimension::Length),
              HasSubstr("at most 64 characters"));
  EXPECT_THAT(error_of("1 m((((((((((((", Dimension::Length),
              HasSubstr("unknown unit"));
  EXPECT_THAT(error_of("12", Dimension::Length), HasSubstr("not a number, a"));
}

TEST(Quantity, ReadsAlikeInACommaLocale) {
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) {
    MENISCUS_NOT_HERE("no locale with a decimal comma on this machine");
  }
  EXPECT_EQ(parse_quantity("0.1 in", Dimension::Length, kMm), 2.54);
  EXPECT_EQ(parse_quantity("1.5 kN", Dimension::Force, kMm), 1500.0);
  EXPECT_EQ(kMm.unit_of(Dimension::Density), "t/mm3");
  EXPECT_STREQ(std::setlocale(LC_ALL, nullptr), "de_DE.UTF-8");
  std::setlocale(LC_ALL, "C");
}

TEST(Quantity, ReadsFromSeveralThreads) {
  std::vector<std::thread> threads;
  std::array<double, 4> found{};
  for (std::size_t t = 0; t < found.size(); ++t) {
    threads.emplace_back([&found, t] {
      for (int k = 0; k < 200; ++k) {
        found[t] += parse_quantity("1 ft", Dimension::Length, kMm) / 200;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const double sum : found) {
    EXPECT_NEAR(sum, 304.8, 1e-10);  // 200 rounded additions
  }
}

}  // namespace
}  // namespace meniscus::units_test
