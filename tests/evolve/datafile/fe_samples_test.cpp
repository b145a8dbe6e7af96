// Surface Evolver's own samples, as loaded: counts, area and energy are those
// that it prints.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/datafile/fe_script.h"
#include "evolve/energy/energy.h"
#include "tests/support/film_sums.h"
#include "tests/support/not_here.h"

namespace meniscus::fe_samples_test {
namespace {

constexpr double kTwelveDigits = 1e-12;  // Evolver prints 14; sums round

std::string sample(const std::string& name) {
  const std::filesystem::path path =
      std::filesystem::path("/usr/share/doc/evolver/examples") / (name + ".fe");
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return file ? text.str() : std::string();
}

struct Loaded {
  std::string name;
  int vertices, edges, facets, bodies;
  double area, energy;
};

void PrintTo(const Loaded& loaded, std::ostream* out) { *out << loaded.name; }

class FeSamples : public ::testing::TestWithParam<Loaded> {};

TEST_P(FeSamples, LoadWithEvolversCountsAreaAndEnergy) {
  const Loaded& expected = GetParam();
  const std::string text = sample(expected.name);
  if (text.empty()) {
    MENISCUS_NOT_HERE("the samples of Debian's evolver-doc are not installed");
  }
  // As the program loads them: commands outside macros are run.
  const films::FilmComplex complex =
      datafile::run_fe_script(datafile::read_fe(text, expected.name + ".fe"),
                              {}, {})
          .complex;
  EXPECT_EQ(complex.mesh.points.size(), expected.vertices);
  EXPECT_EQ(sums::edges(complex), expected.edges);
  EXPECT_EQ(complex.mesh.facets.size(), expected.facets);
  EXPECT_EQ(complex.bodies.size(), expected.bodies);
  const energy::FilmEnergy energy(complex);
  const Points& points = complex.mesh.points;
  EXPECT_NEAR(sums::area(complex), expected.area,
              kTwelveDigits * expected.area);
  EXPECT_NEAR(energy.value(points, energy::targets_of(complex)),
              expected.energy, kTwelveDigits * expected.energy);
}

INSTANTIATE_TEST_SUITE_P(
    Evolver, FeSamples,
    ::testing::Values(
        Loaded{"cat", 18, 42, 24, 0, 18.106554, 18.106554},
        Loaded{"catbody", 18, 42, 24, 1, 6.6, 6.6},
        Loaded{"catman", 18, 42, 24, 0, 6.6, 6.6},
        Loaded{"column", 18, 42, 24, 1, 0.024575662047822, 11.325173459495},
        Loaded{"cube", 14, 36, 24, 1, 6.0, 6.0},
        Loaded{"mound", 18, 40, 24, 1, 14.0, 5.0},
        Loaded{"qmound", 18, 40, 24, 1, 14.0, 5.5},
        Loaded{"octa", 7, 18, 12, 0, 24.0, 24.0},
        Loaded{"quad", 5, 8, 4, 0, 4.4721359549996, 4.4721359549996},
        Loaded{"sphere", 10, 16, 8, 1, 5.4641016151378, 2.9428090415821},
        Loaded{"tankex", 8, 16, 8, 1, 2.8284271247462, 2.3572361663283}),
    [](const auto& loaded) { return loaded.param.name; });

struct Refused {
  std::string name;
  std::string message;
};

void PrintTo(const Refused& refused, std::ostream* out) {
  *out << refused.name;
}

class FeRefusedSamples : public ::testing::TestWithParam<Refused> {};

TEST_P(FeRefusedSamples, NameWhatIsNotSupportedAndWhere) {
  const std::string text = sample(GetParam().name);
  if (text.empty()) {
    MENISCUS_NOT_HERE("the samples of Debian's evolver-doc are not installed");
  }
  try {
    datafile::run_fe_script(datafile::read_fe(text, GetParam().name + ".fe"),
                            {}, {});
    FAIL() << "it was read";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Evolver, FeRefusedSamples,
    ::testing::Values(
        Refused{"knotty", "knotty.fe:"}, Refused{"metric", "metric.fe:"},
        Refused{"mylarcube", "mylarcube.fe:"}, Refused{"popstr", "popstr.fe:"},
        Refused{"quadm", "quadm.fe:"}, Refused{"relaxed", "relaxed.fe:"},
        Refused{"simplex3", "simplex3.fe:"},
        Refused{"slidestr", "slidestr.fe:"}, Refused{"crystal", "crystal.fe:"},
        Refused{"100grain", "100grain.fe:"}, Refused{"symtest", "symtest.fe:"},
        Refused{"twointor", "twointor.fe:5:"},
        Refused{"phelanc", "phelanc.fe:"},
        Refused{"addload_example", "addload_example.fe:82:"}),
    [](const auto& refused) { return "sample_" + refused.param.name; });

}  // namespace
}  // namespace meniscus::fe_samples_test
