// Evolution macros: the language, run on small films.
#include "evolve/datafile/fe_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/energy/energy.h"

namespace meniscus::fe_script_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// The unit cube around volume 1; its macros begin on line 35.
const char* const kCube = R"(parameter side = 1
parameter wet = 2
vertices
1 0 0 0
2 side 0 0
3 side side 0
4 0 side 0
5 0 0 side
6 side 0 side
7 side side side
8 0 side side
edges
1 1 2
2 2 3
3 3 4
4 4 1
5 5 6
6 6 7
7 7 8
8 8 5
9 1 5
10 2 6
11 3 7
12 4 8
faces
1 1 10 -5 -9
2 2 11 -6 -10
3 3 12 -7 -11
4 4 9 -8 -12
5 5 6 7 8
6 -4 -3 -2 -1
bodies
1 1 2 3 4 5 6 volume 1
read
)";

datafile::FeScriptResult run(const std::string& commands,
                             const datafile::FeScriptOptions& options = {
                                 .macro = "gogo"}) {
  static std::vector<std::unique_ptr<datafile::FeFile>> keep;
  keep.push_back(std::make_unique<datafile::FeFile>(
      datafile::read_fe(kCube + commands, "a.fe")));
  return datafile::run_fe_script(*keep.back(), {}, options);
}

std::string output_of(const std::string& body) {
  return run("gogo := { " + body + " }").output;
}

std::string message_of_script(const std::string& commands,
                              const datafile::FeScriptOptions& options = {
                                  .macro = "gogo"}) {
  try {
    run(commands, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "no error";
}

TEST(FeScript, RunsLoopsConditionsAndAssignments) {
  EXPECT_EQ(output_of("nn := 0; for (ii := 1; ii <= 5; ii += 1) { if ii == 3 "
                      "then continue; nn += ii; }; printf \"%d\\n\", nn"),
            "12\n");
  EXPECT_EQ(output_of("nn := 1; while nn < 100 do { nn *= 3; if nn > 20 then "
                      "break }; print nn"),
            "27\n");
  EXPECT_EQ(output_of("nn := 10; do { nn -= 4 } while nn > 0; print nn"),
            "-2\n");
  EXPECT_EQ(output_of("nn := 0; { nn ++ } 4; print nn"), "4\n");
  EXPECT_EQ(output_of("if 0 then print 1 else print 2"), "2\n");
}

TEST(FeScript, PrintsAsPrintfDoes) {
  EXPECT_EQ(output_of(R"(printf "%8.3f|%-5d|%g%%\n", 3.14159, 7, 1e-7)"),
            "   3.142|7    |1e-07%\n");
  EXPECT_THAT(message_of_script("gogo := {\nprintf \"%s\", 1 }"),
              StartsWith("a.fe:36:1: this format"));
  EXPECT_THAT(message_of_script("gogo := { printf \"%g %g\", 1 }"),
              HasSubstr("this format"));
}

TEST(FeScript, ReadsAndSetsElements) {
  EXPECT_EQ(output_of("print vertex_count; print facet_count; print "
                      "body[1].volume; print total_area"),
            "14\n24\n1\n6\n");
  EXPECT_EQ(output_of("set vertex z z + 1 where z > 0.75; print max(vertex, z)"
                      "; print count(vertex where z > 1.5)"),
            "2\n5\n");
  EXPECT_EQ(output_of("set facet tension 2 where id <= 12; print total_energy"),
            "9\n");
  EXPECT_EQ(output_of("nn := 0; foreach facet ff where ff.area > 0.1 do nn += "
                      "ff.area; print nn"),
            "6\n");
  EXPECT_EQ(output_of("body[1].target := 1.5; print body[1].target"), "1.5\n");
}

TEST(FeScript, RefinesChosenEdges) {
  // Each of the cube's 12 edges cuts two facets.
  const datafile::FeScriptResult result =
      run("gogo := { refine edges where length > 0.9 }");
  EXPECT_EQ(result.complex.mesh.points.size(), 14 + 12);
  EXPECT_EQ(result.complex.mesh.facets.size(), 24 + 24);
}

TEST(FeScript, EvolvesTowardsTheSphere) {
  const datafile::FeScriptResult result =
      run("gogo := { g 5; r; g 5; hessian; r; g 5; hessian; hessian }");
  EXPECT_EQ(result.complex.mesh.facets.size(), 384);
  const double area =
      energy::FilmEnergy(result.complex).area(result.complex.mesh.points);
  // Surface Evolver's own macro ends at 4.85446.
  EXPECT_NEAR(area, 4.85446, 2e-4);
  EXPECT_GT(result.iterations, 15);
}

TEST(FeScript, ConjugateGradientsComeLower) {
  const auto area = [](const datafile::FeScriptResult& r) {
    return energy::FilmEnergy(r.complex).area(r.complex.mesh.points);
  };
  const double plain = area(run("gogo := { r 2; g 30 }"));
  const double conjugate = area(run("gogo := { r 2; U; g 30 }"));
  EXPECT_LT(conjugate, plain);
}

TEST(FeScript, RunsTheMacroAskedFor) {
  EXPECT_EQ(run("two := { print 2 }; gogo := { two; two }").output, "2\n2\n");
  datafile::FeScriptOptions options;
  options.macro = "two";
  EXPECT_EQ(run("two := { print 2 }", options).output, "2\n");
  EXPECT_THAT(message_of_script("two := { g }"),
              HasSubstr("there is no macro 'gogo'; it has: two"));
}

TEST(FeScript, RefusesByNameAndLine) {
  EXPECT_THAT(message_of_script("gogo := {\n g; lagrange 2 }"),
              StartsWith("a.fe:36:5: 'lagrange' is not supported"));
  EXPECT_THAT(message_of_script("gogo := { autopop on }"),
              HasSubstr("'autopop' is not supported"));
  EXPECT_THAT(message_of_script("gogo := { print nix }"),
              HasSubstr("'nix' has no value"));
  EXPECT_THAT(message_of_script("gogo := { print vertex[99].x }"),
              HasSubstr("there is no vertex[99]"));
  EXPECT_THAT(message_of_script("gogo := { body[1].colour := 3 }"),
              HasSubstr("'colour' cannot be set"));
  EXPECT_THAT(message_of_script("gogo := { xx := 1/0 }"), HasSubstr("inf"));
  EXPECT_THAT(message_of_script("gogo := { m 0.5 }"),
              HasSubstr("the command 'm' is not supported"));
}

TEST(FeScript, EndlessMacrosAreStopped) {
  datafile::FeScriptOptions few{.macro = "gogo"};
  few.most_steps = 1000;
  EXPECT_THAT(message_of_script("gogo := { while 1 do nn := 1 }", few),
              HasSubstr("does not end within 1000 commands"));
  datafile::FeScriptOptions little{.macro = "gogo"};
  little.most_work = 1e5;
  EXPECT_THAT(message_of_script("gogo := { r 3; { nn := 1 } 100000 }", little),
              HasSubstr("more than 1e+05 facets times steps"));
  EXPECT_THAT(message_of_script("gogo := { gogo }"), HasSubstr("without end"));
  EXPECT_THAT(message_of_script("gogo := { r 40 }"), HasSubstr("facets"));
}

}  // namespace
}  // namespace meniscus::fe_script_test
