// The datafile language on small files of our own: what is read, what is
// refused and how.
#include <ctime>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/datafile/fe_complex.h"
#include "evolve/datafile/fe_write.h"
#include "tests/support/film_sums.h"

namespace meniscus::fe_reader_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kTriangle = R"(vertices
1 0 0 0 fixed
2 1 0 0 fixed
3 0 1 0
edges
1 1 2 fixed
2 2 3
3 3 1
faces
1 1 2 3
)";

std::string message_of_text(const std::string& text) {
  try {
    datafile::complex_of(datafile::read_fe(text, "a.fe"));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "no error";
}

// x of vertex 3 of the triangle, written as `formula`.
double value(const std::string& formula, const std::string& top = "") {
  std::string text = top + kTriangle;
  const std::string old = "3 0 1 0";
  text.replace(text.find(old), old.size(), "3 " + formula + " 1 0");
  return datafile::complex_of(datafile::read_fe(text, "a.fe"))
      .mesh.points[2]
      .x();
}

TEST(FeReader, FollowsEvolversPrecedence) {
  EXPECT_EQ(value("2^3^2"), 64.0);  // left to right
  EXPECT_EQ(value("2**3"), 8.0);
  EXPECT_EQ(value("-2^2"), -4.0);
  EXPECT_EQ(value("7/2*2"), 7.0);
  EXPECT_EQ(value("(3 = 5)"), -2.0);  // a minus that binds least
  EXPECT_EQ(value("!1 || 2 > 1 && 0"), 0.0);
  EXPECT_EQ(value("not 0 and 3 >= 3"), 1.0);
  EXPECT_EQ(value("1 < 2 ? 4 : 5"), 4.0);
  EXPECT_EQ(value("0 ? 4 : 1 ? 6 : 7"), 6.0);
  EXPECT_EQ(value("-3.5 idiv 2.1"), -1.0);
  EXPECT_EQ(value("-7 % 3"), 2.0);
  EXPECT_EQ(value("7 mod 3"), 1.0);
  EXPECT_EQ(value("-1 imod 3"), 2.0);
  EXPECT_EQ(value("maximum(2, minimum(9, 4))"), 4.0);
}

TEST(FeReader, ReadsEveryKindOfNumber) {
  EXPECT_EQ(value(".5"), 0.5);
  EXPECT_EQ(value("23."), 23.0);
  EXPECT_EQ(value("5e-3"), 5e-3);
  EXPECT_EQ(value("+0.7D2"), 70.0);
  EXPECT_EQ(value("0x1Af"), 431.0);
  EXPECT_EQ(value("1101b"), 13.0);
}

TEST(FeReader, SplitsExpressionsWhereASignLeans) {
  const std::string text =
      "parameter aa = 3\nvertices\n1 aa -aa (1 -1) fixed\n"
      "2 aa - aa, aa-2, 2 fixed\n3 5 + 1 -2 -aa\nedges\n1 1 2\n2 2 3\n3 3 1\n"
      "faces\n1 1 2 3\n";
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(text, "a.fe"));
  EXPECT_EQ(complex.mesh.points[0], Vec3(3, -3, 0));
  EXPECT_EQ(complex.mesh.points[1], Vec3(0, 1, 2));
  EXPECT_EQ(complex.mesh.points[2], Vec3(6, -2, -3));
}

TEST(FeReader, SkipsCommentsSplicesLinesAndExpandsMacros) {
  const std::string text =
      "// first\r\n/* second\n third */ #define ONE (1)\n#define TWO ONE+ONE\n"
      "VERTICES: /* here */\n1 0 0 \\\n 0 FIXED\n2 ONE 0 0 Fixed // x\n"
      "3 TWO -ONE TWO*2\nEdges\n1 1 2\n2 2 3\n3 3 1\nfaces\n1 1 2 3\n";
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(text, "a.fe"));
  EXPECT_EQ(complex.mesh.points[2], Vec3(2, -1, 3));  // text, not value
}

TEST(FeReader, TakesOtherParameterValues) {
  const std::string text =
      "PARAMETER Width = 2\nparameter half = width/2\n" + kTriangle;
  std::string wide = text;
  wide.replace(wide.find("3 0 1 0"), 7, "3 half 1 0");
  const datafile::FeFile file = datafile::read_fe(wide, "a.fe");
  EXPECT_EQ(datafile::complex_of(file).mesh.points[2].x(), 1.0);
  EXPECT_EQ(datafile::complex_of(file, {{"WIDTH", 8.0}}).mesh.points[2].x(),
            4.0);
  EXPECT_EQ(datafile::complex_of(file, {{"G", 8.0}}).gravity.z(), -8.0);
  EXPECT_THROW(datafile::complex_of(file, {{"widht", 8.0}}), InvalidInput);
}

TEST(FeReader, PutsVerticesOntoConstraints) {
  const std::string text =
      "constraint ball\nformula: x^2 + y^2 + z^2 = 4\nconstraint 7 "
      "nonnegative\n"
      "equation: z = 1\n" +
      kTriangle;
  std::string on = text;
  on.replace(on.find("3 0 1 0"), 7, "3 0 1 0 constraints ball, 7");
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(on, "a.fe"));
  constexpr double kRounding = 1e-14;
  EXPECT_NEAR(complex.mesh.points[2].z(), 1.0, kRounding);
  EXPECT_NEAR(complex.mesh.points[2].norm(), 2.0, kRounding);
  EXPECT_EQ(complex.vertices[2].constraints, 0);
  EXPECT_EQ(complex.constraint_sets[0], (std::vector<int>{0, 1}));
}

TEST(FeReader, CutsFacesAndGroupsFacetsIntoSurfaces) {
  const std::string text = R"(
vertices
1 0 0 0 fixed
2 1 0 0 fixed
3 1 1 0 fixed
4 0 1 0 fixed
5 0.5 0.5 1
edges
1 1 2 fixed no_refine
2 2 3 fixed
3 3 4 fixed
4 4 1 fixed
5 1 5
6 2 5
7 3 5
8 4 5
faces
1 1 2 3 4 density 0 fixed no_refine
2 1 6 -5 color red
3 2 7 -6 tension 2
4 3 8 -7
5 4 5 -8
bodies
3 -1 2 3 4 5 pressure 2 density 1.5
read
gogo := { g 5 }
)";
  const datafile::FeFile file = datafile::read_fe(text, "a.fe");
  EXPECT_EQ(file.commands_line, 25);
  EXPECT_THAT(file.commands, HasSubstr("gogo := { g 5 }"));
  const films::FilmComplex complex = datafile::complex_of(file);
  ASSERT_EQ(complex.mesh.facets.size(), 8);
  ASSERT_EQ(complex.surfaces.size(), 3);
  EXPECT_EQ(complex.mesh.labels,
            (std::vector<std::string>{"solid_1", "film_1", "film_2"}));
  EXPECT_FALSE(complex.surfaces[0].liquid);
  EXPECT_FALSE(complex.surfaces[0].refine);
  EXPECT_EQ(complex.surfaces[2].tension, 2.0);
  EXPECT_EQ(complex.mesh.points[5], Vec3(0.5, 0.5, 0.0));
  EXPECT_EQ(complex.vertices[5].kind, films::VertexKind::Fixed);
  EXPECT_EQ(complex.edges.size(), 4 + 4);  // fixed ones, and spokes
  ASSERT_EQ(complex.bodies.size(), 1);
  EXPECT_EQ(complex.bodies[0].name, "body_3");
  EXPECT_EQ(complex.bodies[0].sides.size(), 3);
  EXPECT_EQ(complex.bodies[0].pressure, 2.0);
  EXPECT_EQ(complex.bodies[0].density, 1.5);
  EXPECT_EQ(complex.gravity, Vec3(0, 0, -1));
  EXPECT_EQ(complex.volume_rule, films::VolumeRule::Column);
  constexpr double kRounding = 1e-15;
  EXPECT_NEAR(sums::volume(complex, 0), 1.0 / 3.0, kRounding);
}

TEST(FeReader, EvaluatesEdgeAttributesPerEdge) {
  std::string text =
      "define edge attribute angle real\n"
      "constraint 1\nformula: z = 0\nenergy: e1: angle e2: 0 e3: 0\n" +
      kTriangle;
  text.replace(text.find("2 2 3"), 5, "2 2 3 constraint 1 angle 3");
  text.replace(text.find("3 3 1"), 5, "3 3 1 constraint -1 angle 5");
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(text, "a.fe"));
  EXPECT_EQ(complex.integrals.size(), 2);
  constexpr double kRounding = 1e-14;
  // dx is -1 along edge 2 and 0 along edge 3; area 1/2.
  EXPECT_NEAR(sums::energy(complex), 0.5 - 3.0, kRounding);
}

TEST(FeReader, RecalculatesFormulasAlone) {
  const std::string text =
      "parameter rad = 2\nboundary 1 parameters 1\nx1: rad*cos(p1)\n"
      "x2: rad*sin(p1)\nx3: 0\nquantity qq info_only method "
      "facet_scalar_integral global scalar_integrand: rad\n" +
      kTriangle;
  const datafile::FeFile file = datafile::read_fe(text, "a.fe");
  films::FilmComplex complex = datafile::complex_of(file);
  datafile::recalculate(complex, file, {{"rad", 3.0}});
  constexpr double kRounding = 1e-15;
  EXPECT_NEAR(sums::quantity(complex, 0), 1.5, kRounding);
  EXPECT_EQ(complex.mesh.points[1], Vec3(1, 0, 0));
}

TEST(FeReader, WritesWhatItReads) {
  std::string text =
      "parameter hh = 0.25\nconstraint 1 nonpositive\n"
      "formula: (x < hh && !(y == 2)) ? z - 1 : exp(-x^2)*maximum(z, -1) - 2\n"
      "quantity qq energy modulus 2 method facet_vector_integral\n"
      "vector_integrand: q1: x**2 q2: atan2(y, 2) q3: -z/-3\n" +
      kTriangle;
  text.replace(text.find("3 0 1 0"), 7, "3 0 1 0.5 constraint 1");
  text.replace(text.find("1 1 2 3\n"), 8, "1 1 2 3 qq\n");
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(text, "a.fe"));
  const films::FilmComplex again = datafile::complex_of(
      datafile::read_fe(datafile::fe_text(complex), "b.fe"));
  EXPECT_EQ(again.mesh.points, complex.mesh.points);
  EXPECT_EQ(again.mesh.facets, complex.mesh.facets);
  constexpr double kRounding = 1e-15;
  EXPECT_NEAR(sums::energy(again), sums::energy(complex), kRounding);
  for (const double x : {-1.0, 0.5}) {
    const std::array<double, 3> at = {x, 0.3, 0.7};
    EXPECT_NEAR(again.level_sets[0].formula.evaluate(at),
                complex.level_sets[0].formula.evaluate(at), kRounding);
  }
}

struct Wrong {
  std::string find, replace, message;
};

TEST(FeReader, SaysWhatIsWrongAndWhere) {
  const std::vector<Wrong> cases = {
      {"2 2 3\n", "2 2 9\n", "a.fe:7:5: vertex 9 is not defined"},
      {"1 1 2 3", "1 1 3 2", "a.fe:10:1: face 1 does not close"},
      {"1 1 2 3", "1 1 2", "a.fe:10:1: face 1 has 2 edges"},
      {"1 1 2 3", "1 1 2 8", "a.fe:10:7: edge 8 is not defined"},
      {"2 1 0 0", "2 1 0", "a.fe:3:1: vertex 2 has 2 coordinates of 3"},
      {"2 1 0 0", "2 nan 0 0", "a.fe:3:3: 'nan' is not defined here"},
      {"2 1 0 0", "2 1/0 0 0", "a.fe:3:3: the expression's value is inf"},
      {"2 1 0 0", "2 1e999 0 0", "a.fe:3:3: '1e999' is no number"},
      {"2 1 0 0", "2 1.2.3 0 0", "a.fe:3:3: '1.2.3' is no number"},
      {"2 1 0 0", "-2 1 0 0", "a.fe:3:1: the section 'edges' is expected"},
      {"2 1 0 0", "2147483648 1 0 0", "a.fe:3:1: a vertex's number"},
      {"2 1 0 0", "1 1 0 0", "a.fe:3:1: vertex 1 is defined twice"},
      {"fixed\n3", "fixd\n3", "a.fe:3:9: this attribute of a vertex"},
      {"2 2 3\n", "2 2 3 tension 1\n", "a.fe:7:7: edge 2: edges with tension"},
      {"2 2 3\n", "2 1 2\n", "a.fe:10:1: face 1 does not close"},
      {"3 0 1 0", "3 0 1 0 constraint 4", "a.fe:4:20: constraint 4"},
      {"1 1 2 3", "1 1 2 3 fixed", "a.fe:10:1: face 1 is fixed but its"},
      {"faces", "faecs", "a.fe:9:1: the section 'faces' is expected"},
      {"vertices", "paramter aa = 1\nvertices",
       "a.fe:1:1: unknown keyword 'paramter'; is 'parameter' meant?"},
      {"vertices", "parameter aa = bb\nvertices",
       "a.fe:1:16: 'bb' is not defined here"},
      {"vertices", "string\nvertices", "a.fe:1:1: 'string': the string model"},
      {"vertices", "#include \"b\"\nvertices", "a.fe:1:1: '#include'"},
      {"vertices",
       "#define AA BB\n#define BB (AA)\nparameter cc = AA\nvertices",
       "a.fe:3:16: macro 'AA' contains itself"},
      {"vertices", "/* no end", "a.fe:1:1: the comment that starts here"},
      {"vertices", "constraint 1\nformula: x % 2\nvertices",
       "a.fe:2:12: remainders"},
      {"vertices", "space_dimension 4\nvertices", "a.fe:1:1: space_dimension"},
      {"vertices", "quantity qq energy method dirichlet global\nvertices",
       "a.fe:1:27: method 'dirichlet' is not supported"},
      {"vertices", "quantity qq energy method facet_area\nvertices",
       "a.fe:1:1: quantity 'qq' is neither global nor on any face"},
      {"vertices", "boundary 1 parameters 2\nvertices",
       "a.fe:1:23: only boundaries of one parameter"},
  };
  for (const Wrong& wrong : cases) {
    std::string text = kTriangle;
    text.replace(text.find(wrong.find), wrong.find.size(), wrong.replace);
    EXPECT_THAT(message_of_text(text), StartsWith(wrong.message)) << text;
  }
}

TEST(FeReader, SurvivesEveryTruncation) {
  const std::string text =
      "#define RR 2 /* r */\nparameter aa = RR*(1+1)\nconstraint 1\n"
      "formula: x^2 + y^2 = aa ? 1 : 2\nenergy: e1: -(y) e2: 0 e3: 0\n"
      "quantity qq fixed = 1 method facet_scalar_integral global\n"
      "scalar_integrand: x*y\n" +
      kTriangle + "bodies\n1 1 volume 1 density 2\nread\ngogo\n";
  int whole = 0;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const std::string message = message_of_text(text.substr(0, size));
    EXPECT_TRUE(message == "no error" || message.rfind("a.fe:", 0) == 0)
        << message;
    whole += message == "no error" ? 1 : 0;
  }
  EXPECT_GT(whole, 0);
}

TEST(FeReader, RefusesBottomlessNesting) {
  const std::string deep(1000000, '(');
  EXPECT_THAT(message_of_text("parameter aa = " + deep),
              HasSubstr("nested more"));
  EXPECT_THAT(message_of_text("parameter aa = 1" + std::string(1000000, '^')),
              StartsWith("a.fe:1:"));
  std::string signs;
  std::string powers;
  std::string choices;
  for (int k = 0; k < 100000; ++k) {
    signs += "- ";
    powers += "2^-";
    choices += "1 ? 2 : ";
  }
  EXPECT_THAT(message_of_text("parameter aa = " + signs + "1"),
              HasSubstr("nested more"));
  EXPECT_THAT(message_of_text("parameter aa = " + powers + "1"),
              HasSubstr("nested more"));
  EXPECT_THAT(message_of_text("parameter aa = " + choices + "1"),
              HasSubstr("nested more"));
  std::string sum = "parameter aa = 1";
  for (int k = 0; k < 100000; ++k) {
    sum += " + 1";
  }
  EXPECT_THAT(message_of_text(sum), HasSubstr("more than 4000 parts"));
}

TEST(FeReader, BoundsTheGrowthOfMacros) {
  std::string text = "#define M0 1\n";
  for (int k = 1; k < 60; ++k) {
    text += "#define M" + std::to_string(k) + " M" + std::to_string(k - 1) +
            " M" + std::to_string(k - 1) + "\n";
  }
  EXPECT_THAT(message_of_text(text + "view_matrix M59\n"),
              StartsWith("a.fe:61:"));
  std::string empty = "#define E0\n";
  for (int k = 1; k < 60; ++k) {
    empty += "#define E" + std::to_string(k) + " E" + std::to_string(k - 1) +
             " E" + std::to_string(k - 1) + "\n";
  }
  EXPECT_THAT(message_of_text(empty + "view_matrix E59\n"),
              HasSubstr("macros expand to more"));
}

TEST(FeReader, EndsOnLargeGarbageInBoundedTime) {
  constexpr std::size_t kSize = std::size_t{64} << 20U;
  constexpr double kSeconds = 5.0;  // 0.1 s is usual
  for (const char* pattern :
       {" ", "\n", "a", "1", "(", "\"", "/*", "//", "#define A A\n",
        "keep_macros ", "\\\n", "vertices 1 2 3\n", "- ", "\xff"}) {
    std::string text = pattern;
    while (text.size() < kSize) {
      text += text;
    }
    const std::clock_t start = std::clock();  // whatever else runs
    const std::string message = message_of_text(text);
    const double taken =
        static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_THAT(message, StartsWith("a.fe:")) << pattern;
    EXPECT_LT(message.size(), 1000) << pattern;
    EXPECT_LT(taken, kSeconds) << pattern;
  }
}

}  // namespace
}  // namespace meniscus::fe_reader_test
