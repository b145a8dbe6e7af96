// Surface Evolver's shipped samples, side by side with Surface Evolver itself:
// its own settled films are at rest here too, and from the raw files our own
// route ends at no higher energy.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/child_process.h"
#include "core/find_program.h"
#include "evolve/datafile/fe_complex.h"
#include "evolve/settle/find_equilibrium.h"
#include "pipeline/results/datafile.h"
#include "tests/support/not_here.h"
#include "tests/support/temp_folder.h"

namespace meniscus::evolver_samples_test {
namespace {

constexpr double kDumped = 1e-12;  // relative: dumps have 15 digits
constexpr double kSame = 1e-10;    // relative, of a film that is at rest
constexpr double kAbove = 1e-4;    // relative, of our own route
// The sixteenth digit of coordinates of size 1 alone leaves this residual,
// relative to tension x edge.
constexpr double kRounding = 1e-14;

std::string sample(const std::string& name) {
  std::ifstream file(std::filesystem::path("/usr/share/doc/evolver/examples") /
                     (name + ".fe"));
  std::ostringstream text;
  text << file.rdbuf();
  return file ? text.str() : std::string();
}

struct Ran {
  double energy = NAN;
  double volume = 0.0;  // of all bodies
  int facets = 0;
  std::string dump;
};

// What Surface Evolver makes of a datafile by `commands`.
Ran run_evolver(const std::string& text, const std::string& commands) {
  const TempFolder folder;
  const std::filesystem::path dump = folder / "film.dmp";
  std::ofstream(folder / "film.fe") << text;
  std::ofstream(folder / "script.cmd")
      << commands
      << "\nprintf \"MEASURED %.17g %.17g %d\\n\", total_energy, "
         "sum(body,volume), facet_count;\ndump \""
      << dump.string() << "\"\nq\nq\n";
  ChildOptions options;
  options.argv = {"evolver", "-x", "-f", (folder / "script.cmd").string(),
                  (folder / "film.fe").string()};
  options.environment = {{"LC_ALL", "C"}};
  options.time_limit = 60.0;
  const ChildResult result = run_child(options);
  Ran ran;
  const auto at = result.output.rfind("MEASURED ");
  if (at == std::string::npos) {
    ADD_FAILURE() << describe_end(result) << "\n" << result.output;
    return ran;
  }
  std::istringstream numbers(result.output.substr(at + 9));
  numbers >> ran.energy >> ran.volume >> ran.facets;
  std::ostringstream dumped;
  dumped << std::ifstream(dump).rdbuf();
  ran.dump = dumped.str();
  return ran;
}

/// Why the test cannot run; empty: it can.
std::string missing(const std::string& name) {
  if (!find_program("evolver")) {
    return "evolver (Debian package evolver) is not installed";
  }
  return sample(name).empty()
             ? "the samples of Debian's evolver-doc are not installed"
             : "";
}

double energy_of(const films::FilmComplex& complex) {
  return energy::FilmEnergy(complex).value(complex.mesh.points,
                                           energy::targets_of(complex));
}

struct Dumped {
  std::string name;
  std::string commands = "gogo; hessian_seek; hessian_seek;";
};

class EvolverDump : public ::testing::TestWithParam<Dumped> {};

TEST_P(EvolverDump, IsAtRest) {
  const Dumped& sampled = GetParam();
  if (const std::string why = missing(sampled.name); !why.empty()) {
    MENISCUS_NOT_HERE(why);
  }
  const Ran ran = run_evolver(sample(sampled.name), sampled.commands);
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(ran.dump, "film.dmp"));
  const energy::FilmEnergy energy(complex);
  const Points& points = complex.mesh.points;
  const films::FilmTargets targets = energy::targets_of(complex);
  EXPECT_EQ(ran.facets, complex.mesh.facets.size());
  EXPECT_NEAR(energy_of(complex), ran.energy, kDumped * ran.energy);
  EXPECT_NEAR(energy.volumes(points).head(energy.bodies()).sum(), ran.volume,
              kDumped * (1.0 + ran.volume));

  // No step at all: the residual along the normals that Evolver left.
  const settle::FilmState before =
      settle::settle_in_normals(energy, complex, targets, points,
                                {.residual_factor = 0.0, .max_iterations = 0});
  const settle::FilmState after =
      settle::settle_in_normals(energy, complex, targets, points, {});
  RecordProperty("energy", fmt::format("{:.15g}", ran.energy));
  RecordProperty("residual_before",
                 fmt::format("{:.2e}", before.report.residual));
  RecordProperty("residual_after",
                 fmt::format("{:.2e}", after.report.residual));
  RecordProperty("energy_moved",
                 fmt::format("{:.2e}", after.report.energy / ran.energy - 1.0));
  EXPECT_FALSE(after.failure) << after.report.verdict;
  EXPECT_NEAR(after.report.energy, ran.energy, kSame * ran.energy);
  const double size = energy.value(points, targets) / energy.area(points) *
                      energy.mean_edge(points);
  EXPECT_LE(after.report.residual,
            std::max(before.report.residual, kRounding * size));
}

// sphere.fe has no Hessian in Surface Evolver (gap energy): descent, to where
// no scale lowers the energy.
INSTANTIATE_TEST_SUITE_P(Samples, EvolverDump,
                         ::testing::Values(Dumped{"cat"}, Dumped{"catbody"},
                                           Dumped{"catman"}, Dumped{"column"},
                                           Dumped{"cube"}, Dumped{"mound"},
                                           Dumped{"qmound"}, Dumped{"octa"},
                                           Dumped{"quad"},
                                           Dumped{"sphere", "gogo; g 400;"}),
                         [](const auto& one) { return one.param.name; });

struct Raw {
  std::string name;
  std::string commands = "gogo; hessian_seek; hessian_seek;";
  int refinements = 2;       // as many as the commands do
  std::string prepare = {};  // commands for both
};

class RawSample : public ::testing::TestWithParam<Raw> {};

TEST_P(RawSample, EndsNoHigherThanEvolver) {
  const Raw& raw = GetParam();
  if (const std::string why = missing(raw.name); !why.empty()) {
    MENISCUS_NOT_HERE(why);
  }
  const std::string text =
      raw.prepare.empty() ? sample(raw.name)
                          : run_evolver(sample(raw.name), raw.prepare).dump;
  const Ran ran = run_evolver(text, raw.commands);
  const TempFolder folder;
  std::ofstream(folder / "raw.fe") << text;
  const results::DatafileResult found = results::evolve_datafile(
      folder / "raw.fe", {.refinements = raw.refinements});
  ASSERT_FALSE(found.failure) << found.report.verdict;
  EXPECT_EQ(ran.facets, found.complex.mesh.facets.size());
  EXPECT_LT(found.report.energy, (1.0 + kAbove) * ran.energy);
  RecordProperty("energy", fmt::format("{:.15g}", ran.energy));
  RecordProperty("above",
                 fmt::format("{:.2e}", found.report.energy / ran.energy - 1.0));
  EXPECT_EQ(found.report.index, 0);
}

// The macros of the mounds refine their rims first.
const char* const kMound =
    "g 5; r; g 5; r; g 5; hessian; hessian; hessian_seek; hessian_seek;";
INSTANTIATE_TEST_SUITE_P(
    Samples, RawSample,
    ::testing::Values(
        Raw{"catbody", "gogo; hessian_seek; hessian_seek;", 3},
        Raw{"catman", "gogo; hessian_seek; hessian_seek;", 1},
        Raw{"catman",
            "gogo; r; U; g 100; r; g 100; hessian_seek; hessian_seek;", 3},
        Raw{"column"}, Raw{"cube"}, Raw{"mound", kMound, 2, "re;"},
        Raw{"qmound", kMound, 2, "re;"},
        Raw{"quad", "gogo; hessian_seek; hessian_seek;", 3},
        Raw{"sphere", "gogo; g 400;", 3}),
    [](const auto& one) {
      return fmt::format("{}_{}", one.param.name, one.param.refinements);
    });

// cat.fe: the rings are too far apart for a catenoid. The film pinches, which
// is said; popped on request it ends as two flat polygons, whose area does not
// depend on their facets.
TEST(EvolverSamples, CatPopsIntoTwoPolygons) {
  if (const std::string why = missing("cat"); !why.empty()) {
    MENISCUS_NOT_HERE(why);
  }
  const Ran ran = run_evolver(
      sample("cat"),
      "r; u; r; g 400; t .05; o; g 20; hessian_seek; hessian_seek;");
  const TempFolder folder;
  std::ofstream(folder / "cat.fe") << sample("cat");
  const results::DatafileResult found =
      results::evolve_datafile(folder / "cat.fe", {.refinements = 2});
  ASSERT_TRUE(found.failure);
  EXPECT_EQ(found.failure->kind, FailureKind::FilmPinched);
  const results::DatafileResult disks = results::evolve_datafile(
      folder / "cat.fe", {.refinements = 2, .pop = true});
  EXPECT_FALSE(disks.failure) << disks.report.verdict;
  EXPECT_LT(disks.report.energy, (1.0 + kAbove) * ran.energy);
  constexpr double kRadius = 1.5088795;
  const double polygons =
      24.0 * kRadius * kRadius * std::sin(std::numbers::pi / 12.0);
  EXPECT_NEAR(disks.report.energy, polygons, kSame * polygons);
}

// octa.fe: the raw film is a saddle that must pop. At which of several films at
// rest that ends is a matter of history: Surface Evolver's macro is the record
// of a trial sequence. Here histories are searched.
TEST(EvolverSamples, OctaPopsToTheCentralPoint) {
  if (const std::string why = missing("octa"); !why.empty()) {
    MENISCUS_NOT_HERE(why);
  }
  const Ran ran =
      run_evolver(sample("octa"), "gogo; hessian_seek; hessian_seek;");
  const TempFolder folder;
  std::ofstream(folder / "octa.fe") << sample("octa");
  const results::DatafileResult found =
      results::evolve_datafile(folder / "octa.fe", {.pop = true});
  EXPECT_FALSE(found.failure) << found.report.verdict;
  // All films are flat: their area does not depend on their facets.
  constexpr double kFlat = 16.0 * std::numbers::sqrt2;
  EXPECT_NEAR(ran.energy, kFlat, kSame * kFlat);
  EXPECT_NEAR(found.report.energy, kFlat, kSame * kFlat);
}

// tankex.fe: contact angles of 45 degrees in a corner of 90 keep no film away
// from it, and no constraint keeps the film inside the tank. Surface Evolver's
// film thins at the corner for as long as it is let, and says nothing.
TEST(EvolverSamples, TankexRunsOutOfItsTank) {
  if (const std::string why = missing("tankex"); !why.empty()) {
    MENISCUS_NOT_HERE(why);
  }
  const Ran ran = run_evolver(sample("tankex"), "g 5; r; g 5; r; g 5;");
  const films::FilmComplex dumped =
      datafile::complex_of(datafile::read_fe(ran.dump, "tankex.dmp"));
  EXPECT_NEAR(energy_of(dumped), ran.energy, kDumped * ran.energy);
  EXPECT_NEAR(energy::FilmEnergy(dumped).volumes(dumped.mesh.points)[0],
              ran.volume, kDumped);
  const Ran later = run_evolver(ran.dump, "g 500;");
  EXPECT_LT(later.energy, 0.99 * ran.energy);
  films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(sample("tankex"), "tankex.fe"));
  const settle::FilmState found =
      settle::find_equilibrium(complex, {.refinements = 2});
  ASSERT_TRUE(found.failure);
  EXPECT_NE(found.failure->kind, FailureKind::FilmUnstable);
}

}  // namespace
}  // namespace meniscus::evolver_samples_test
