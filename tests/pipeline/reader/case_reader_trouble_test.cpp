// Every kind of mistake in a case file: what is said, and of which line.
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/reader/case_reader.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::case_reader_trouble_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Trouble {
  const char* name;
  const char* from;  // in strut()
  const char* to;
  const char* message;  // must appear in the first problem, after "case.toml:"
};

class MistakeTest : public testing::TestWithParam<Trouble> {};

TEST_P(MistakeTest, IsToldWithItsLine) {
  const Trouble& mistake = GetParam();
  const std::vector<std::string> problems =
      problems_of(changed(strut(), mistake.from, mistake.to));
  ASSERT_EQ(problems.size(), 1U) << testing::PrintToString(problems);
  EXPECT_THAT(problems[0],
              HasSubstr(std::string("case.toml:") + mistake.message));
}

const Trouble kMistakes[] = {
    {"MissingTitle", "title = \"A strut\"", "",
     "1: the file has no 'title' (one line for people); add it"},
    {"UnknownUnits", "mm-N-MPa", "mm-N",
     "2: units is the text 'mm-N'; expected one of mm-N-MPa, m-N-Pa, "
     "in-lbf-psi"},
    {"UnknownTable", "[resolution]", "[resolutions]\nfea = 1\n[resolution]",
     "41: unknown table 'resolutions'; did you mean 'resolution'?"},
    {"LaterTable", "[resolution]", "[regions.web]\ntension = 3\n[resolution]",
     "41: [regions] is not available in this version"},
    {"MissingKey", "radius = 20\n", "",
     "18: curves.head is a circle and has no 'radius'; add it"},
    {"MisspeltKey", "volume = 9e4", "volme = 9e4",
     "38: unknown key 'volme' in bodies.part; did you mean 'volume'?"},
    {"StrangeKey", "volume = 9e4", "colour = 3",
     "38: unknown key 'colour' in bodies.part; there are enclosed_by, volume, "
     "pressure, material"},
    {"WrongType", "radius = 20", "radius = [20]",
     "22: curves.head.radius is an array of 1; expected a number, an "
     "expression in quotes or a value with a unit"},
    {"BooleanForNumber", "radius = 20", "radius = true",
     "22: curves.head.radius is true; expected a number"},
    {"NotANumber", "radius = 20", "radius = nan",
     "22: curves.head.radius is nan; expected a number"},
    {"Infinite", "length = 60.0", "length = inf",
     "6: parameters.length is inf; expected a number"},
    {"ShortVector", "center = [0, 0, 0]", "center = [0, 0]",
     "14: curves.base.center is an array of 2; expected [x, y, z]"},
    {"NumberForName", "curve = \"head\"", "curve = 3",
     "34: solids.head_pad.curve is 3; expected text in quotes"},
    {"NameForNames", "curves = [\"base\", \"head\"]", "curves = \"base\"",
     "26: films.skin.curves is the text 'base'; expected names"},
    {"UnknownKind", "kind = \"branch\"", "kind = \"brunch\"",
     "25: films.skin.kind is the text 'brunch'; did you mean 'branch'?"},
    {"EmptyKind", "kind = \"branch\"", "kind = \"\"",
     "25: films.skin.kind is the text ''; expected one of branch, loft, disk"},
    {"LaterKind", "kind = \"circle\"", "kind = \"arc\"",
     "13: curves.base.kind 'arc' is not available in this version; expected "
     "one of circle, ellipse"},
    {"UnknownName", "\"foot\"", "\"fot\"",
     "16: curves.base.radius: unknown name 'fot' (did you mean 'foot'?) in "
     "'fot' at character 1"},
    {"BrokenExpression", "\"foot\"", "\"2 * (foot + 1\"",
     "16: curves.base.radius: ')' is missing before 'end' in '2 * (foot + 1' "
     "at character 14"},
    {"ExpressionInVector", "\"length\"]", "\"lenght\"]",
     "20: curves.head.center[z]: unknown name 'lenght' (did you mean"},
    {"WrongUnit", "radius = 20", "radius = \"20 N\"",
     "22: curves.head.radius: '20 N' is no length but a force; try a value in "
     "mm"},
    {"UnknownUnit", "radius = 20", "radius = \"20 furlong_ish\"",
     "22: curves.head.radius: unknown unit 'furlong_ish'"},
    {"ZeroRadius", "radius = 20", "radius = 0",
     "18: curve 'head': radius is 0, must be above 0"},
    {"ZeroRadiusAtABound", "bounds = [20.0, 32.0]", "bounds = [0.0, 32.0]",
     "12: curve 'base': radius is 0, must be above 0 where foot = 0"},
    {"DivisionByZeroAtABound", "\"foot\"", "\"foot / (32 - foot)\"",
     "16: curves.base.radius: division of 32 by zero in 'foot / (32 - foot)' "
     "where foot = 32"},
    {"ZeroNormal", "normal = [0, 0, -1]", "normal = [0, 0, 0]",
     "12: curve 'base': normal"},
    {"BoundsUpsideDown", "bounds = [20.0, 32.0]", "bounds = [32.0, 20.0]",
     "10: design.foot.bounds are [32, 20]; the first must not be above the "
     "second"},
    {"ThreeBounds", "bounds = [20.0, 32.0]", "bounds = [1, 2, 3]",
     "10: design.foot.bounds is an array of 3; expected two numbers"},
    {"InitialOutside", "initial = 25.0", "initial = 33.0",
     "9: design.foot.initial is 33, outside its bounds [20, 32]"},
    {"ClashOfNames", "length = 60.0", "length = 60.0\nfoot = 1",
     "7: 'foot' is both a parameter and a design variable (line 9)"},
    {"ReservedName", "length = 60.0", "length = 60.0\npi = 3",
     "7: 'pi' is a name that expressions know already; choose another"},
    {"BadName", "length = 60.0", "length = 60.0\n\"my load\" = 3",
     "7: parameters.my load: 'my load' is no name; expected letters, digits"},
    {"TensionBelowZero", "curves = [\"base\", \"head\"]",
     "curves = [\"base\", \"head\"]\ntension = \"z - length/2\"",
     "27: films.skin.tension is -30 at (9.615, -23.08, 0) on curve 'base' "
     "where length "
     "= 60; it must be above 0 on the whole film"},
    {"TensionWithoutValue", "curves = [\"base\", \"head\"]",
     "curves = [\"base\", \"head\"]\ntension = \"log(z)\"",
     "27: films.skin.tension has no value (log(0) is not a finite number in "
     "'log(z)' at (9.6154, -23.077, 0)) on curve 'base'"},
    {"PlaceWhereNoneIs", "radius = 20", "radius = \"x\"",
     "22: curves.head.radius: unknown name 'x'"},
    {"IdleSolid", "[resolution]",
     "[curves.lid]\nkind = \"circle\"\ncenter = [0, 0, 90]\n"
     "normal = [0, 0, 1]\nradius = 9\n"
     "[solids.lid]\nkind = \"cap\"\ncurve = \"lid\"\n[resolution]",
     "46: solid 'lid' encloses no body; add it to a body's enclosed_by"},
    {"WallWithoutThickness", "[resolution]",
     "[walls.web]\nfilms = [\"skin\"]\n[resolution]",
     "41: walls.web has no 'thickness' (above 0; the film takes it"},
    {"ProcessOfNothing", "[resolution]",
     "[process]\nsmallest_feature = 0\n[resolution]",
     "42: process.smallest_feature is 0; it is a length above 0"},
    {"ProcessWithoutAFeature", "[resolution]",
     "[process]\nname = \"casting\"\n[resolution]",
     "41: process has no 'smallest_feature'"},
    {"WallOfASolid", "[resolution]",
     "[walls.web]\nfilms = [\"foot_pad\"]\nthickness = 1\n[resolution]",
     "42: there is no film 'foot_pad'"},
    {"WallOfTwoFilms", "[resolution]",
     "[walls.web]\nfilms = [\"skin\"]\nthickness = 1\n[walls.shell]\nfilms = "
     "[\"skin\"]\nthickness = 1\n[resolution]",
     "45: walls.shell.films names 'skin', of which 'web' is made already"},
    {"WallSide", "[resolution]",
     "[walls.web]\nfilms = [\"skin\"]\nthickness = 1\nside = "
     "\"in\"\n[resolution]",
     "44: walls.web.side is the text 'in'"},
    {"WallThickness", "[resolution]",
     "[walls.web]\nfilms = [\"skin\"]\nthickness = \"z - 1\"\n[resolution]",
     "43: walls.web.thickness is -1 at (9.615, -23.08, 0) on curve 'base'; it "
     "must be above 0 on the whole film"},
    {"FieldWithoutCore", "[resolution]",
     "[fields.pull]\nkind = \"point\"\nat = [0, 0, 30]\nstrength = 0.2\nfilms "
     "= [\"skin\"]\n[resolution]",
     "41: fields.pull is a point and has no 'core'; add it"},
    {"FieldOnNothing", "[resolution]",
     "[fields.pull]\nkind = \"point\"\nat = [0, 0, 30]\nstrength = 0.2\ncore = "
     "3\n[resolution]",
     "41: fields.pull has neither films nor a body; expected films"},
    {"FieldOnFilmAndBody", "[resolution]",
     "[fields.pull]\nkind = \"point\"\nat = [0, 0, 30]\nstrength = 0.2\ncore = "
     "3\nfilms = [\"skin\"]\nbody = \"part\"\n[resolution]",
     "41: fields.pull has both films and a body"},
    {"FieldOnUnknownBody", "[resolution]",
     "[fields.pull]\nkind = \"point\"\nat = [0, 0, 30]\nstrength = 0.2\ncore = "
     "3\nbody = \"port\"\n[resolution]",
     "46: there is no body 'port'; did you mean 'part'?"},
    {"FieldTooStrong", "[resolution]",
     "[fields.pull]\nkind = \"point\"\nat = [0, 0, 30]\nstrength = 2\ncore = "
     "3\nfilms = [\"skin\"]\n[resolution]",
     "44: fields.pull.strength is 2, and film 'skin' has a tension of 1; it "
     "would crumple on the pole"},
    {"FieldOfZeroCore", "[resolution]",
     "[fields.pull]\nkind = \"point\"\nat = [0, 0, 30]\nstrength = 0.2\ncore = "
     "0\nfilms = [\"skin\"]\n[resolution]",
     "45: fields.pull.core is 0; it must be above 0"},
    {"PressureOfAPole", "[resolution]",
     "[fields.pull]\nkind = \"point\"\nat = [0, 0, 30]\nstrength = 0.2\ncore = "
     "3\nfilms = [\"skin\"]\npressure = 1\n[resolution]",
     "47: fields.pull.pressure does not belong to a point; it has at, "
     "strength, core"},
    {"UnknownCurve", "curves = [\"base\", \"head\"]",
     "curves = [\"base\", \"heat\"]",
     "26: there is no curve 'heat'; did you mean 'head'?"},
    {"CopyWithoutRepeat", "curves = [\"base\", \"head\"]",
     "curves = [\"base\", \"head_{i}\"]",
     "26: there is no curve 'head_{i}'; braces count copies: give this table "
     "repeat = N, or write a copy's name, as 'base'"},
    {"CurveTwice", "curves = [\"base\", \"head\"]",
     "curves = [\"base\", \"head\", \"base\"]",
     "26: films.skin names curve 'base' twice"},
    {"OpenBody", "[\"skin\", \"foot_pad\", \"head_pad\"]",
     "[\"skin\", \"foot_pad\"]",
     "37: body 'part' is not closed at curve 'head': 1 of its surfaces meets "
     "there (skin), two must; add 'head_pad' to enclosed_by"},
    {"UnknownSurface", "\"foot_pad\", \"head_pad\"]",
     "\"foot_pad\", \"head_pid\"]",
     "37: there is no film or solid 'head_pid'; did you mean 'head_pad'?"},
    {"SurfaceTwice", "\"foot_pad\", \"head_pad\"]",
     "\"foot_pad\", \"head_pad\", \"skin\"]",
     "37: bodies.part.enclosed_by names 'skin' twice"},
    {"VolumeAndPressure", "volume = 9e4", "volume = 9e4\npressure = 1",
     "39: bodies.part has both a volume and a pressure; keep one"},
    {"NegativeVolume", "volume = 9e4", "volume = \"-load\"",
     "38: bodies.part.volume is -1000 where load = 1000; it must be above 0"},
    {"UnknownMaterial", "material = \"aluminium\"", "material = \"aluminum\"",
     "39: there is no material 'aluminum'; did you mean 'aluminium'?"},
    {"Poisson", "poisson_ratio = 0.33", "poisson_ratio = 0.5",
     "47: materials.aluminium.poisson_ratio is 0.5; it must be above -1 and "
     "below 0.5"},
    {"Modulus", "youngs_modulus = 71700.0", "youngs_modulus = 0",
     "46: materials.aluminium.youngs_modulus is 0; it must be above 0"},
    {"PoissonByDesign", "poisson_ratio = 0.33",
     "poisson_ratio = \"foot / 100\"",
     "47: materials.aluminium.poisson_ratio depends on a design variable"},
    {"YieldByDesign", "density = 2.8e-9\n",
     "density = 2.8e-9\nyield_strength = \"4 * foot\"\n"
     "[responses.ks]\nkind = \"von_mises_ks\"\n",
     "49: materials.aluminium.yield_strength depends on a design variable, and "
     "a von_mises_ks without a 'scale' or a stress_ratio without an "
     "'allowable' is measured by it"},
    {"Density", "density = 2.8e-9", "density = -1",
     "48: materials.aluminium.density is -1; it must be 0 or above"},
    {"Resolution", "fea = 6.0", "fea = 0",
     "42: resolution.fea is 0; an edge length is above 0"},
    {"NoSupport", "supports = [{ on = \"foot_pad\", fix = \"xyz\" }]\n", "",
     "50: load_cases.service has no 'supports' (at least one); add it"},
    {"EmptySupports", "[{ on = \"foot_pad\", fix = \"xyz\" }]", "[]",
     "51: load_cases.service.supports is an array of 0; expected tables"},
    {"NothingFixed", "fix = \"xyz\"", "fix = \"\"",
     "51: load_cases.service.supports.fix is ''; expected some of \"xyz\""},
    {"FixedWhere", "fix = \"xyz\"", "fix = \"xyw\"",
     "51: load_cases.service.supports.fix is 'xyw'; expected some of"},
    {"NoLoad", "loads = [{ on = \"head_pad\", force = [\"load\", 0, 0] }]\n",
     "", "50: load case 'service' has no load that is not 0"},
    {"ZeroLoad", "force = [\"load\", 0, 0]", "force = [0, \"load - load\", 0]",
     "50: load case 'service' has no load that is not 0"},
    {"LoadWithoutForce", ", force = [\"load\", 0, 0]", "",
     "52: load_cases.service.loads on 'head_pad' has no load; expected one of "
     "force, moment"},
    {"UnknownKeyOfLoad", "force = [\"load\"", "torque = 1, force = [\"load\"",
     "52: unknown key 'torque' in load_cases.service.loads"},
    {"LoadOnNothing", "loads = [{ on = \"head_pad\"",
     "loads = [{ on = \"head_lid\"",
     "52: there is no surface 'head_lid'; did you mean 'head_pad'?"},
    {"LoadOnAnIdleSurface", "loads = [{ on = \"head_pad\"",
     "loads = [{ on = \"idle\"", "52: there is no surface 'idle'"},
    {"ZeroDirection", "direction = [1, 0, 0]", "direction = [0, 0, 0]",
     "57: responses.sway.direction has length 0; expected any other"},
    {"DirectionOfMass", "kind = \"mass\"",
     "kind = \"mass\"\ndirection = [1, 0, 0]",
     "61: responses.mass.direction does not belong to a mass"},
    {"UnknownLoadCase", "kind = \"mass\"",
     "kind = \"compliance\"\nload_case = \"servce\"",
     "61: there is no load case 'servce'; did you mean 'service'?"},
    {"PowerOfADisplacementNorm", "kind = \"mean_displacement\"",
     "kind = \"displacement_norm\"\npower = 1.5",
     "56: responses.sway.power is 1.5; it must be 2 or above; 8 when left out"},
    {"PowerOfAStressNorm", "kind = \"mass\"",
     "kind = \"von_mises_norm\"\npower = 1",
     "61: responses.mass.power is 1; it must be above 1; 8 when left out"},
    {"SmoothPeakWithoutScale", "kind = \"mass\"", "kind = \"von_mises_ks\"",
     "59: responses.mass has no 'scale', and no body's material a "
     "yield_strength to take in its place; add scale = STRESS here"},
    {"DistanceToNothing", "kind = \"mass\"", "kind = \"distance\"",
     "59: responses.mass has none of keep_out and keep_in; expected one"},
    {"DistanceToBoth", "kind = \"mass\"",
     "kind = \"distance\"\nkeep_in = \"x\"\nkeep_out = \"y\"",
     "59: responses.mass has both of keep_out and keep_in; expected one"},
    {"DistanceWithoutAName", "kind = \"mass\"",
     "kind = \"distance\"\nkeep_in = \"w - x\"",
     "61: responses.mass.keep_in: unknown name 'w'"},
    {"Smoothing", "kind = \"mass\"", "kind = \"thickness\"\nsmoothing = 0",
     "61: responses.mass.smoothing is 0; it must be above 0"},
    {"CoarseStageThatIsFiner", "kind = \"match\"",
     "kind = \"match\"\ncoarse_first = 0.5",
     "64: study.coarse_first is 0.5; it must be above 1 and at most 8, 2 is "
     "usual"},
    {"KeyOfAnotherKind", "kind = \"mass\"",
     "kind = \"mass\"\nload_case = \"service\"",
     "61: responses.mass.load_case does not belong to a mass; it has no keys "
     "of its own"},
    {"UnknownResponse", "sway = 0.01", "swag = 0.01",
     "64: there is no response 'swag'; did you mean 'sway'?"},
    {"NoTarget", "targets = { sway = 0.01 }", "",
     "62: a match needs study.equal"},
    {"EqualOfOne", "targets = { sway = 0.01 }", "equal = [\"sway\"]",
     "64: study.equal names one response; two or more can be made equal"},
    {"EqualOfUnlike", "targets = { sway = 0.01 }",
     "equal = [\"sway\", \"mass\"]",
     "64: study.equal names responses of different dimensions"},
    {"Tolerance", "targets = { sway = 0.01 }",
     "targets = { sway = 0.01 }\ntolerance = 0",
     "65: study.tolerance is 0; it must be above 0"},
    {"Method", "targets = { sway = 0.01 }",
     "targets = { sway = 0.01 }\nmethod = \"bobica\"",
     "65: there is no method 'bobica'; did you mean 'bobyqa'?"},
    {"MaxEvaluations", "targets = { sway = 0.01 }",
     "targets = { sway = 0.01 }\nmax_evaluations = 2.5",
     "65: study.max_evaluations is 2.5; expected a whole number above 0"},
    {"NotToml", "radius = 20", "radius = = 20", "22: this is not TOML"},
    {"KeyTwice", "radius = 20", "radius = 20\nradius = 21",
     "23: this is not TOML"},
    {"Unquoted", "radius = \"foot\"", "radius = 2 * foot",
     "16: this is not TOML"},
    {"Unclosed", "radius = \"foot\"", "radius = \"foot",
     "16: this is not TOML: Error while parsing string: unescaped control "
     "characters other than TAB (U+0009) are explicitly prohibited (column "
     "15); "
     "is a closing quote missing?"},
    {"DecimalComma", "radius = \"foot\"", "radius = \"70,5 mm\"",
     "16: curves.base.radius: unexpected ',' (decimals follow a point) in "
     "'70,5 mm'"},
};

INSTANTIATE_TEST_SUITE_P(CaseReader, MistakeTest, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) {
                           return std::string(mistake.param.name);
                         });

TEST(CaseTrouble, IsAllToldAtOnce) {
  std::string text = strut();
  text = changed(text, "radius = 20", "raduis = 20");
  text = changed(text, "\"foot\"", "\"fot\"");
  text = changed(text, "volume = 9e4", "volume = \"9e4 mm\"");
  text = changed(text, "[\"skin\", \"foot_pad\", \"head_pad\"]",
                 "[\"skin\", \"foot_pad\"]");
  text = changed(text, "sway = 0.01", "swag = 0.01");
  EXPECT_THAT(
      problems_of(text),
      ElementsAre(HasSubstr(":16: curves.base.radius: unknown name 'fot'"),
                  HasSubstr(":18: curves.head is a circle and has no 'radius'"),
                  HasSubstr(":22: unknown key 'raduis' in curves.head; did "
                            "you mean 'radius'?"),
                  HasSubstr(":37: body 'part' is not closed"),
                  HasSubstr(":38: bodies.part.volume: '9e4 mm' is no volume"),
                  HasSubstr(":64: there is no response 'swag'")));
}

TEST(CaseTrouble, IsToldUpToTwentyTimes) {
  std::string text = strut();
  for (int k = 0; k < 30; ++k) {
    text += "[materials.m" + std::to_string(k) + "]\n";
  }
  const std::vector<std::string> problems = problems_of(text);
  ASSERT_EQ(problems.size(), 21U);
  EXPECT_EQ(problems.back(), "... and 70 more problems");
}

// What else is wrong with a cap of that name is told too.
TEST(CaseTrouble, FilmsAndSolidsHaveNamesOfTheirOwn) {
  EXPECT_THAT(
      problems_of(changed(strut(), "[solids.head_pad]\n",
                          "[solids.skin]\nkind = \"cap\"\n"
                          "curve = \"head\"\n[solids.head_pad]\n")),
      ElementsAre(HasSubstr("32: 'skin' is both a film and a solid"),
                  HasSubstr("'skin' and 'head_pad' lie on each other")));
}

TEST(CaseTrouble, MissingTablesAreNamed) {
  const std::vector<std::string> problems = problems_of("title = \"x\"\n");
  for (const char* table :
       {"units", "[bodies.NAME]", "[resolution]", "[materials.NAME]",
        "[load_cases.NAME]", "[responses.NAME]"}) {
    EXPECT_THAT(problems, Contains(HasSubstr(table)));
  }
}

TEST(CaseTrouble, TablesOfTheWrongShape) {
  EXPECT_THAT(problems_of("curves = 3\n" + strut()),
              Contains(HasSubstr("not TOML")));  // defined twice
  for (const char* table :
       {"curves", "films", "design", "parameters", "resolution", "study"}) {
    EXPECT_THAT(problems_of(std::string(table) + " = 3\n"),
                Contains(AllOf(HasSubstr("case.toml:1: "), HasSubstr(table),
                               HasSubstr("is 3; expected"))));
  }
  EXPECT_THAT(problems_of("[curves]\nring = 3\n"),
              Contains(HasSubstr(
                  "2: curves.ring is 3; expected a table [curves.ring]")));
}

TEST(CaseTrouble, ASurfaceWithoutABodyBearsNothing) {
  const std::string text =
      changed(strut(), "loads = [{ on = \"head_pad\"",
              "loads = [{ on = \"flap\"") +
      "[films.flap]\nkind = \"disk\"\ncurves = [\"head\"]\n";
  EXPECT_THAT(problems_of(text),
              ElementsAre(HasSubstr("52: surface 'flap' encloses no body, so "
                                    "nothing can act on it")));
}

TEST(CaseTrouble, ASurfaceHasTwoSides) {
  std::string text = strut();
  for (const char* name : {"b", "c"}) {
    text += std::string("[bodies.") + name +
            "]\nenclosed_by = [\"skin\", \"foot_pad\", \"head_pad\"]\n"
            "material = \"aluminium\"\n";
  }
  EXPECT_THAT(problems_of(text),
              Contains(HasSubstr("'skin' encloses 3 bodies (part, b, c); it "
                                 "has two sides")));
}

TEST(CaseTrouble, FilesThatAreNone) {
  const TempFolder folder;
  EXPECT_THAT(
      reader::read_case_file(folder.path().string() + "/no.toml").problems,
      ElementsAre(folder.path().string() + "/no.toml: there is no such file"));
  EXPECT_THAT(reader::read_case_file(folder.path().string()).problems,
              ElementsAre(HasSubstr("this is a folder; name the case file")));
  EXPECT_THAT(reader::read_case_file("").problems,
              ElementsAre(HasSubstr("there is no such file")));
  EXPECT_THAT(problems_of(""), ElementsAre(HasSubstr("the file is empty")));
  EXPECT_THAT(problems_of(" \r\n\t\n"),
              ElementsAre(HasSubstr("the file is empty")));
  const std::string large = folder.path().string() + "/large.toml";
  std::ofstream(large) << std::string(10U << 20U, 'x');
  EXPECT_THAT(reader::read_case_file(large).problems,
              ElementsAre(HasSubstr("larger than 4 MB: not a case file")));
  EXPECT_THROW(reader::read_case(large), InvalidInput);
}

TEST(CaseTrouble, WindowsFilesAreRead) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : strut()) {
    text += c == '\n' ? "\r\n" : std::string(1, c);
  }
  EXPECT_THAT(problems_of(text), IsEmpty());
  EXPECT_THAT(problems_of(changed(text, "radius = 20", "radius = 0")),
              ElementsAre(HasSubstr("case.toml:18:")));
}

TEST(CaseTrouble, HostileTextEndsInAMessage) {
  std::string deep = "a";
  for (int k = 0; k < 1000000; ++k) {
    deep += ".a";
  }
  EXPECT_THAT(problems_of("\n" + deep + " = 1\n"),
              ElementsAre(HasSubstr("case.toml:2: a key of more than 30")));
  EXPECT_THAT(problems_of("[" + deep + "]\n"),
              ElementsAre(HasSubstr("case.toml:1: a key of more than 30")));
  // A string that hides the key from a careless scan.
  EXPECT_THAT(problems_of("x = { k = \"\"\"\n\"\"\"\", " + deep + " = \"z\" }"),
              ElementsAre(HasSubstr("case.toml:2: a key of more than 30")));
  EXPECT_THAT(problems_of("x = " + std::string(1000000, '[')),
              ElementsAre(HasSubstr("not TOML")));
  EXPECT_THAT(problems_of(strut() + std::string(1, '\0')),
              ElementsAre(HasSubstr("not TOML")));
  EXPECT_THAT(problems_of("a = \"\xFF\xFE\"\n"),
              ElementsAre(HasSubstr("not TOML")));
  EXPECT_THAT(problems_of(changed(strut(), "\"foot\"",
                                  "\"" + std::string(2000000, '(') + "\"")),
              ElementsAre(HasSubstr("at most 10000 are read")));
  EXPECT_THAT(problems_of(changed(strut(), "radius = 20",
                                  "radius = 99999999999999999999")),
              ElementsAre(HasSubstr("not TOML")));
}

TEST(CaseTrouble, DotsInTextAreNoKeys) {
  const std::string dots(200, '.');
  EXPECT_THAT(problems_of(changed(strut(), "A strut", dots)), IsEmpty());
  EXPECT_THAT(problems_of("# " + dots + "\n" + strut()), IsEmpty());
  EXPECT_THAT(
      problems_of(changed(strut(), "\"A strut\"", "'''\n" + dots + "'''")),
      IsEmpty());
}

TEST(CaseTrouble, ALoftNeedsTwoCurves) {
  const std::string text =
      changed(strut(), "kind = \"branch\"\ncurves = [\"base\", \"head\"]",
              "kind = \"loft\"\ncurves = [\"base\"]");
  EXPECT_EQ(problems_of(text).front(),
            "case.toml:26: films.skin names 1 curve; a loft needs two");
}

TEST(CaseTrouble, RandomDamageEndsInAMessage) {
  // No crash, no hang: a case or problems, whatever is changed.
  std::mt19937 generator(5);
  const std::string base = strut();
  const std::string bytes = "=[]{}\"'.,#\n 0-eE+\\xyz_\xC3";
  for (int round = 0; round < 3000; ++round) {
    std::string text = base;
    const std::size_t count = 1 + generator() % 4;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = generator() % text.size();
      switch (generator() % 3) {
        case 0:
          text[at] = bytes[generator() % bytes.size()];
          break;
        case 1:
          text.erase(at, 1 + generator() % 40);
          break;
        default:
          text.insert(at, 1, bytes[generator() % bytes.size()]);
          break;
      }
    }
    const reader::CaseReading reading =
        reader::read_case_text(text, "case.toml");
    EXPECT_NE(reading.input.has_value(), !reading.problems.empty());
  }
}

}  // namespace
}  // namespace meniscus::case_reader_trouble_test
