// Cases with rings, gaps and scans, from file to answer.
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "io/stl.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "pipeline/results/scan_curves.h"
#include "pipeline/study/scan_match.h"
#include "pipeline/study/study.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::scan_fit_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The strut as a tube: a hollow of its own rims inside, rings between.
std::string hollow_strut() {
  std::string text = changed(strut(), "[films.skin]", R"([curves.base_hole]
kind = "copy"
of = "base"
scale = 0.6

[curves.head_hole]
kind = "copy"
of = "head"
scale = 0.6
about = [0, 0, "length"]

[films.lining]
kind = "branch"
curves = ["base_hole", "head_hole"]

[solids.low_lid]
kind = "cap"
curve = "base_hole"

[solids.high_lid]
kind = "cap"
curve = "head_hole"

[bodies.hollow]
enclosed_by = ["lining", "low_lid", "high_lid"]
volume = 3e4
material = "void"

[films.skin])");
  text = changed(text, "kind = \"cap\"\ncurve = \"base\"\n",
                 "kind = \"ring\"\ncurve = \"base\"\ninner = \"base_hole\"\n");
  text = changed(text, "kind = \"cap\"\ncurve = \"head\"\n",
                 "kind = \"ring\"\ncurve = \"head\"\ninner = \"head_hole\"\n");
  text = changed(text, "[\"skin\", \"foot_pad\", \"head_pad\"]\nvolume = 9e4",
                 "[\"skin\", \"foot_pad\", \"head_pad\", \"lining\"]\n"
                 "volume = 6e4");
  return changed(text, "[responses.mass]", R"([responses.wall]
kind = "gap"
films = ["skin", "lining"]

[responses.mass])");
}

TEST(RingCase, IsATubeWithAGapWhoseGradientIsExact) {
  const reader::CaseReading reading =
      reader::read_case_text(hollow_strut(), "case.toml");
  ASSERT_THAT(reading.problems, IsEmpty());
  const forward::ForwardModel model(*reading.input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  forward::EvaluationFields fields;
  const forward::Evaluation found =
      model.evaluate(case_data::initial_design(*reading.input), &fields);
  ASSERT_FALSE(found.failure) << found.failure->message;
  double volume = 0.0;
  for (int e = 0; e < fields.mesh.element_count(); ++e) {
    volume += corner_volume(fields.mesh, e);
  }
  constexpr double kFlatFacets = 0.02;
  EXPECT_NEAR(volume / 6e4, 1.0, kFlatFacets);
  // At the rims the wall is 8 and 10 mm, between them a little more or less.
  EXPECT_GT(found.responses[1], 4.0);
  EXPECT_LT(found.responses[1], 8.0);
  EXPECT_TRUE(forward::check_case_gradient(
                  *reading.input, case_data::initial_design(*reading.input))
                  .report.passed);
}

TEST(RingCase, TellsWhatIsWrong) {
  EXPECT_THAT(
      problems_of(changed(hollow_strut(), "inner = \"base_hole\"\n", "")),
      Contains(HasSubstr("is a ring and has no 'inner'")));
  EXPECT_THAT(problems_of(changed(hollow_strut(), "inner = \"base_hole\"",
                                  "inner = \"base\"")),
              Contains(HasSubstr("has the curve 'base' on both sides")));
  EXPECT_THAT(problems_of(changed(strut(), "curve = \"base\"",
                                  "curve = \"base\"\ninner = \"head\"")),
              Contains(HasSubstr("does not belong to a cap")));
  EXPECT_THAT(problems_of(changed(hollow_strut(), "inner = \"head_hole\"",
                                  "inner = \"head_whole\"")),
              Contains(HasSubstr("did you mean 'head_hole'")));
  EXPECT_THAT(problems_of(changed(hollow_strut(), "[\"skin\", \"lining\"]",
                                  "[\"skin\"]")),
              Contains(HasSubstr("a gap is between two films")));
}

TEST(GapCase, OfFilmsThatCrossIsAFailureThatTellsThePlace) {
  // A skin of given pressure, and a hollow too large for it bulges through it.
  const reader::CaseReading reading = reader::read_case_text(
      changed(changed(hollow_strut(), "volume = 3e4", "volume = 1.2e5"),
              "volume = 6e4", "pressure = 0.045"),
      "case.toml");
  ASSERT_THAT(reading.problems, IsEmpty());
  const forward::ForwardModel model(*reading.input);
  ASSERT_TRUE(model.failure());
  EXPECT_THAT(model.failure()->message, HasSubstr("cross"));
  EXPECT_THAT(model.failure()->message, HasSubstr("lining"));
  EXPECT_THAT(model.failure()->message, HasSubstr("("));
}

/// The strut's film in place of a part: three numbers to find.
std::string scanned(const std::string& scan) {
  std::string text =
      changed(strut(), "[curves.base]",
              "[design.top]\ninitial = 20.0\nbounds = [16.0, 24.0]\n\n"
              "[design.fill]\ninitial = 9e4\nbounds = [7e4, 1.2e5]\n\n"
              "[curves.base]");
  text = changed(text, "radius = 20\n", "radius = \"top\"\n");
  text = changed(text, "volume = 9e4", "volume = \"fill\"");
  text = changed(text, "fea = 6.0\nfilm = 3.0", "fea = 8.0");
  text = text.substr(0, text.find("[study]"));
  for (const std::string measure : {"rms", "mean", "p95", "largest"}) {
    text += "[responses." + measure + "]\nkind = \"scan_distance\"\nscan = \"" +
            scan + "\"\nmeasure = \"" + measure + "\"\n\n";
  }
  return text +
         "[analysis]\nbuckling = 0\n\n[study]\nkind = \"match\"\n"
         "fit = \"rms\"\n";
}

constexpr double kNoise = 0.5;  // [mm]

/// What the film of these numbers would look like to a scanner.
void write_scan(const std::filesystem::path& file, double foot, double top,
                double fill, double noise) {
  std::string text =
      changed(strut(), "initial = 25.0", "initial = " + std::to_string(foot));
  text =
      changed(text, "radius = 20\n", "radius = " + std::to_string(top) + "\n");
  text = changed(text, "volume = 9e4", "volume = " + std::to_string(fill));
  const case_data::Case input =
      *reader::read_case_text(text, "case.toml").input;
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const frozen::FilmModel film =
      frozen::FilmModel::freeze(inputs.film_system, {.edge = 4.0});
  SurfaceMesh surface = film.boundary(film.reference().points);
  std::mt19937 random(3);
  std::normal_distribution<double> spread(0.0, noise);
  for (Vec3& point : surface.points) {
    point += Vec3(spread(random), spread(random), spread(random));
  }
  io::write_stl(file, surface);
}

reader::CaseReading read_scanned(const TempFolder& folder) {
  return reader::read_case_text(scanned("scan.stl"),
                                (folder / "case.toml").string());
}

TEST(ScanFit, RecoversTheNumbersOfANoisyScanWithinOnePercent) {
  const TempFolder folder;
  write_scan(folder / "scan.stl", 28.0, 18.0, 9.6e4, kNoise);
  const reader::CaseReading reading = read_scanned(folder);
  ASSERT_THAT(reading.problems, IsEmpty());
  const case_data::Case& input = *reading.input;
  store::StudyStore store = store::StudyStore::start(folder.path().string(),
                                                     {.case_hash = input.hash});
  const study::RunResult result =
      study::run_study(input, store, {.estimate_errors = false, .frames = 0});
  EXPECT_EQ(result.status, study::RunStatus::Converged) << result.message;
  ASSERT_TRUE(result.best);
  EXPECT_NEAR(result.best->design[0], 28.0, 0.28);
  EXPECT_NEAR(result.best->design[1], 18.0, 0.18);
  EXPECT_NEAR(result.best->design[2], 9.6e4, 9.6e2);
  // sway, mass, then rms, mean, p95, largest
  const VectorX& responses = result.best->responses;
  EXPECT_LT(responses[2], kNoise);
  EXPECT_LT(responses[3], responses[2]);
  EXPECT_GT(responses[4], responses[2]);
  EXPECT_GT(responses[5], responses[4]);
  EXPECT_GT(result.start->responses[2], 3.0 * responses[2]);
  EXPECT_LT(result.evaluations, 12);
}

TEST(ScanFit, HasAnExactGradientAndJacobian) {
  const TempFolder folder;
  write_scan(folder / "scan.stl", 28.0, 18.0, 9.6e4, 0.0);
  const reader::CaseReading reading = read_scanned(folder);
  ASSERT_THAT(reading.problems, IsEmpty());
  const case_data::Case& input = *reading.input;
  const forward::ForwardModel model(input);
  const VectorX at = case_data::initial_design(input);
  EXPECT_TRUE(forward::check_case_gradient(input, at).report.passed);
  study::ScanMatch match(input, model, 2);
  const Eigen::MatrixXd jacobian = match.jacobian(at).jacobian;
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    const double step = 1e-4 * at[j];
    VectorX up = at;
    VectorX down = at;
    up[j] += step;
    down[j] -= step;
    const VectorX difference =
        (match.residuals(up) - match.residuals(down)) / (2.0 * step);
    EXPECT_LT((difference - jacobian.col(j)).norm(),
              1e-2 * jacobian.col(j).norm());
  }
}

TEST(ScanFit, TellsWhatIsWrong) {
  const TempFolder folder;
  const std::string path = (folder / "case.toml").string();
  const auto problems = [&](const std::string& text) {
    return reader::read_case_text(text, path).problems;
  };
  EXPECT_THAT(problems(scanned("nowhere.stl")),
              Contains(HasSubstr("there is no file")));
  write_file(folder / "scan.ply", "ply");
  EXPECT_THAT(problems(scanned("scan.ply")),
              Contains(HasSubstr("ends in .stl or .obj")));
  write_scan(folder / "scan.stl", 28.0, 18.0, 9.6e4, 0.0);
  const std::string good = scanned("scan.stl");
  EXPECT_THAT(problems(good), IsEmpty());
  EXPECT_THAT(problems(changed(good, "fit = \"rms\"", "fit = \"mean\"")),
              Contains(HasSubstr("expected a response of kind")));
  EXPECT_THAT(problems(changed(good, "fit = \"rms\"", "")),
              Contains(HasSubstr("study.fit")));
  EXPECT_THAT(problems(changed(good, "fit = \"rms\"",
                               "fit = \"rms\"\nmethod = \"bobyqa\"")),
              Contains(HasSubstr("by method ceres")));
  EXPECT_THAT(problems(changed(good, "fit = \"rms\"",
                               "fit = \"rms\"\ntargets = { sway = 0.01 }")),
              Contains(HasSubstr("take one out")));
}

// Another scan is another case; its bytes are not kept with it.
TEST(ScanFit, ChangesTheCasesHashWithTheScan) {
  const TempFolder folder;
  write_scan(folder / "scan.stl", 28.0, 18.0, 9.6e4, 0.0);
  const case_data::Case first = *read_scanned(folder).input;
  write_scan(folder / "scan.stl", 28.0, 18.0, 9.6e4, 0.1);
  const case_data::Case second = *read_scanned(folder).input;
  EXPECT_NE(first.hash, second.hash);
  ASSERT_EQ(first.files.size(), 1U);
  EXPECT_LT(first.files[0].text.size(), 100U);
  EXPECT_THROW(responses::read_scans(first), InvalidInput);
}

TEST(ScanCurves, AreTheRimsThatTheFilmHangsOnAndMakeACase) {
  const TempFolder folder;
  write_scan(folder / "scan.stl", 28.0, 18.0, 9.6e4, 0.2);
  const scan::ScanRimReport report =
      results::rims_of_scan(folder / "scan.stl", {});
  ASSERT_EQ(report.rims.size(), 2U);
  EXPECT_NEAR(report.rims[0].radius, 28.0, 0.6);
  EXPECT_NEAR(report.rims[1].radius, 18.0, 0.6);
  const std::string curves = results::curves_text(report, "scan.stl");
  EXPECT_THAT(problems_of(changed(
                  changed(strut(), "[curves.base]", curves + "[curves.base]"),
                  "[\"base\", \"head\"]", "[\"base\", \"head\"]")),
              IsEmpty());
  EXPECT_THROW(results::rims_of_scan(folder / "scan.step", {}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::scan_fit_test
