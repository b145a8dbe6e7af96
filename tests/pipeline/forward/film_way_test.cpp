// Films that begin where those of an earlier run stood.
#include "pipeline/case_films/film_way.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/case_films/film_start.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::film_way_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const char* const kRun = R"({
  "units": {"system": "mm-N-MPa"},
  "parameters": {"foot": 27.0, "length": 66.0, "load": 7.0},
  "start": {"parameters": {"foot": 22.0}, "responses": {}},
  "refrozen": [{"evaluation": 3, "parameters": {"foot": 24.0}}]
})";

/// The strut beside a run, at a foot of 25 and a length of 60.
class FilmWay : public testing::Test {
 protected:
  FilmWay() {
    std::filesystem::create_directory(folder_ / "easy");
    write(kRun);
  }
  void write(const std::string& text) {
    std::ofstream(folder_ / "easy" / "result.json") << text;
  }
  reader::CaseReading read(const std::string& text = strut()) {
    return reader::read_case_text("start = \"easy\"\n" + text,
                                  (folder_ / "case.toml").string(), {}, held_);
  }
  std::string problem(const std::string& text = strut()) {
    const reader::CaseReading reading = read(text);
    EXPECT_THAT(reading.problems, SizeIs(1));
    return reading.problems.empty() ? "" : reading.problems.front();
  }

  TempFolder folder_;
  std::vector<case_data::CaseFile> held_;
};

std::vector<case_films::Waypoint> way_of(const case_data::Case& input) {
  return case_films::film_way(
      input, case_data::evaluate(input, case_data::initial_design(input)));
}

// Design variables where each model was frozen, parameters as at the answer.
TEST_F(FilmWay, LeadsThroughTheRunsModelsToTheCasesOwn) {
  const reader::CaseReading reading = read();
  ASSERT_THAT(reading.problems, IsEmpty());
  const case_data::Case& input = *reading.input;
  const std::vector<case_films::Waypoint> way = way_of(input);
  std::vector<double> feet;
  std::vector<double> heights;
  for (const case_films::Waypoint& point : way) {
    feet.push_back(
        std::get<curves::Circle>(point.system.curves[0].shape).radius);
    heights.push_back(
        std::get<curves::Circle>(point.system.curves[1].shape).center.z());
  }
  EXPECT_THAT(feet, ElementsAre(22.0, 24.0, 27.0, 25.0));
  EXPECT_THAT(heights, ElementsAre(66.0, 66.0, 66.0, 60.0));
  const case_films::Waypoint middle =
      case_films::waypoint_between(input, way[2], way[3]);
  EXPECT_EQ(std::get<curves::Circle>(middle.system.curves[0].shape).radius,
            26.0);
  EXPECT_EQ(std::get<curves::Circle>(middle.system.curves[1].shape).center.z(),
            63.0);
  // Of the run the case keeps these numbers and no more.
  ASSERT_THAT(input.files, SizeIs(1));
  EXPECT_THAT(input.files[0].text, testing::Not(HasSubstr("responses")));
}

// A parameter that a design variable moves stays what it is.
TEST_F(FilmWay, KeepsParametersThatFollowTheDesign) {
  const reader::CaseReading reading =
      read(changed(strut(), "length = 60.0", "length = \"foot + 35\""));
  ASSERT_THAT(reading.problems, IsEmpty());
  const auto way = way_of(*reading.input);
  EXPECT_EQ(std::get<curves::Circle>(way[0].system.curves[1].shape).center.z(),
            57.0);
}

TEST_F(FilmWay, IsInTheCaseWhenTheFolderIsGone) {
  const case_data::Case first = *read().input;
  held_ = first.files;
  std::filesystem::remove_all(folder_ / "easy");
  const reader::CaseReading again = read();
  ASSERT_THAT(again.problems, IsEmpty());
  EXPECT_EQ(again.input->way, first.way);
  EXPECT_EQ(again.input->hash, first.hash);
  held_.clear();
  EXPECT_THAT(problem(), HasSubstr(":1: start = \"easy\": there is no "
                                   "result.json in this folder"));
}

TEST_F(FilmWay, RefusesWhatIsNoRunOfSuchACase) {
  write("{");
  problem();
  write("{}");
  EXPECT_THAT(problem(), HasSubstr("no result.json of a run"));
  write(R"({"units": {"system": "mm-N-MPa"}})");
  EXPECT_THAT(problem(), HasSubstr("has no answer"));
  write(R"({"units": {"system": "mm-N-MPa"}, "parameters": {"f": 1.0},
            "start": {"parameters": {}}})");
  EXPECT_THAT(problem(), HasSubstr("no design variable and no parameter of "));
  write(changed(kRun, "mm-N-MPa", "m-N-Pa"));
  EXPECT_THAT(problem(),
              HasSubstr("in m-N-Pa, those of this case in mm-N-MPa"));
  const reader::CaseReading number =
      reader::read_case_text("start = 3\n" + strut(), "case.toml");
  EXPECT_THAT(number.problems, ElementsAre(HasSubstr("start is 3; expected")));
}

// Values by name: what the table has not is the case's own.
TEST(FilmWayTable, HasValuesByName) {
  const std::string vector = changed(
      strut(), "[design.foot]\n",
      "[design.waist]\nshape = [2, 2]\ninitial = 1.0\nbounds = [0.0, 9.0]\n\n"
      "[design.foot]\n");
  const reader::CaseReading reading = reader::read_case_text(
      "start = { length = \"6.6 cm\", waist = [[1, 2], [3, \"2 * 2\"]] }\n" +
          vector,
      "case.toml");
  ASSERT_THAT(reading.problems, IsEmpty());
  const case_data::Case& input = *reading.input;
  ASSERT_THAT(input.way, SizeIs(1));
  const VectorX& values = input.way[0];
  EXPECT_THAT(std::vector<double>(values.begin(), values.end()),
              ElementsAre(1.0, 2.0, 3.0, 4.0, 25.0, testing::IsNan(), 66.0));
  EXPECT_THAT(input.files, IsEmpty());
  const auto way = way_of(input);
  ASSERT_THAT(way, SizeIs(2));
  EXPECT_EQ(std::get<curves::Circle>(way[0].system.curves[1].shape).center.z(),
            66.0);
  EXPECT_EQ(std::get<curves::Circle>(way[1].system.curves[1].shape).center.z(),
            60.0);
}

TEST(FilmWayTable, RefusesWhatHasNoSuchValue) {
  const auto problems = [](const std::string& table,
                           const std::string& text = strut()) {
    return reader::read_case_text("start = " + table + "\n" + text, "case.toml")
        .problems;
  };
  EXPECT_THAT(problems("{}"),
              ElementsAre(HasSubstr("case.toml:1: start is empty; expected")));
  EXPECT_THAT(problems("{ lenght = 6 }"),
              ElementsAre(HasSubstr("start has 'lenght', which is no design "
                                    "variable and no parameter; did you mean "
                                    "'length'")));
  EXPECT_THAT(problems("{ foot = [2, 3] }"),
              ElementsAre(HasSubstr("start.foot")));
  EXPECT_THAT(problems("{ load = \"foot\" }"),
              ElementsAre(HasSubstr("start.load")));
  EXPECT_THAT(
      problems("{ length = \"2 kg\" }",
               changed(strut(), "length = 60.0", "length = \"60 mm\"")),
      ElementsAre(HasSubstr("start.length is a mass, and 'length' a length")));
  EXPECT_THAT(
      problems("{ length = 50 }",
               changed(strut(), "length = 60.0", "length = \"foot + 35\"")),
      ElementsAre(HasSubstr("start.length: design variables move this")));
}

/// Hears warnings.
struct Listener : Monitor {
  void log(Severity severity, const std::string& message) override {
    if (severity == Severity::Warning) {
      warnings.push_back(message);
    }
  }
  std::vector<std::string> warnings;
};

/// A tube that is bent by `angle` [degrees].
case_data::Case elbow(double angle) {
  std::string text =
      changed(strut(), "length = 60.0", "angle = " + std::to_string(angle));
  text = changed(text, "center = [0, 0, \"length\"]\nnormal = [0, 0, 1]",
                 "center = [\"60 * (1 - cos(angle * deg))\", 0, "
                 "\"20 + 60 * sin(angle * deg)\"]\n"
                 "normal = [\"sin(angle * deg)\", 0, \"cos(angle * deg)\"]");
  text = changed(text, "initial = 25.0", "initial = 20.0");
  text = changed(text, "volume = 9e4",
                 "volume = \"1193 * (20 + 60 * angle * "
                 "deg)\"");
  const reader::CaseReading reading = reader::read_case_text(text, "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  return *reading.input;
}

/// An elbow whose film begins from that of a run at another angle.
struct Start {
  Start(double angle, double of_run) : input(elbow(angle)) {
    input.way = {Eigen::Vector3d(20.0, 1000.0, of_run)};
    inputs = case_data::evaluate(input, case_data::initial_design(input));
    options = {.edge = 8.0, .refinements = 0, .monitor = &listener};
  }

  case_data::Case input;
  case_data::EvaluatedCase inputs;
  Listener listener;
  frozen::FilmModelOptions options;
};

// The film cannot turn from 5 to 120 degrees at once, and is led there.
TEST(FilmStart, FollowsAlongStepsThatAreHalved) {
  const Start start(120.0, 5.0);
  const auto& [input, inputs, listener, options] = start;
  const frozen::FilmModel raw =
      frozen::FilmModel::freeze(inputs.film_system, options);
  ASSERT_FALSE(raw.reference().failure);

  const frozen::FilmModel easy =
      frozen::FilmModel::freeze(way_of(input).front().system, options);
  ASSERT_FALSE(easy.reference().failure);
  EXPECT_TRUE(easy.settle(inputs.film_system, {}).failure);

  const frozen::FilmModel led =
      case_films::freeze_films(input, inputs, options);
  EXPECT_THAT(listener.warnings, IsEmpty());
  ASSERT_FALSE(led.reference().failure);
  EXPECT_NE(led.reference().points.size(), raw.reference().points.size());
  EXPECT_NEAR(led.reference().report.area, raw.reference().report.area,
              5e-3 * raw.reference().report.area);
}

// Where it is not, it starts from first facets, and the user hears it.
TEST(FilmStart, SaysWhereAFilmDoesNotFollow) {
  const Start start(60.0, 175.0);  // which pinches
  const auto& [input, inputs, listener, options] = start;
  const frozen::FilmModel found =
      case_films::freeze_films(input, inputs, options);
  EXPECT_FALSE(found.reference().failure);
  EXPECT_THAT(listener.warnings,
              ElementsAre(HasSubstr("does not follow from where 'start'")));
}

}  // namespace
}  // namespace meniscus::film_way_test
