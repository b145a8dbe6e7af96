// Datafiles written here, loaded by Surface Evolver itself: counts, energy,
// area and volumes must be the same.
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/child_process.h"
#include "core/find_program.h"
#include "evolve/curves/curve.h"
#include "evolve/datafile/fe_complex.h"
#include "evolve/datafile/fe_write.h"
#include "evolve/frozen/film_model.h"
#include "evolve/start/wetted_faces.h"
#include "tests/support/film_shapes.h"
#include "tests/support/film_sums.h"
#include "tests/support/not_here.h"
#include "tests/support/temp_folder.h"

namespace meniscus::evolver_fe_test {
namespace {

constexpr double kTwelveDigits = 1e-12;  // of size 1; both sum in doubles

struct Measured {
  int vertices = 0, edges = 0, facets = 0, bodies = 0;
  double energy = 0.0, area = 0.0, volume = 0.0;  // of all bodies
};

void expect_near(double value, double expected, const char* what) {
  EXPECT_NEAR(value, expected, kTwelveDigits * (1.0 + std::abs(expected)))
      << what;
}

class EvolverFe : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!find_program("evolver")) {
      MENISCUS_NOT_HERE("Surface Evolver is not installed");
    }
  }

  // What Evolver finds in `text` as loaded, or once `commands` ran.
  Measured measure(const std::string& text, const std::string& commands = "") {
    std::ofstream(folder_ / "film.fe") << text;
    std::ofstream(folder_ / "script.cmd")
        << commands
        << "\nprintf \"MEASURED %d %d %d %d %.17g %.17g %.17g\\n\","
           "vertex_count,edge_count,facet_count,body_count,total_energy,"
           "total_area,sum(body,volume)\nq\nq\n";
    ChildOptions options;
    options.argv = {"evolver", "-x", "-f", (folder_ / "script.cmd").string(),
                    (folder_ / "film.fe").string()};
    options.environment = {{"LC_ALL", "C"}};
    options.time_limit = 60.0;
    const ChildResult result = run_child(options);
    Measured made;
    const auto at = result.output.rfind("MEASURED ");
    if (at == std::string::npos) {
      ADD_FAILURE() << describe_end(result) << "\n" << result.output << text;
      return made;
    }
    std::istringstream numbers(result.output.substr(at + 9));
    numbers >> made.vertices >> made.edges >> made.facets >> made.bodies >>
        made.energy >> made.area >> made.volume;
    EXPECT_TRUE(numbers) << result.output.substr(at);
    return made;
  }

  void expect_same(const films::FilmComplex& complex) {
    const std::string text = datafile::fe_text(complex);
    const Measured measured = measure(text);
    EXPECT_EQ(measured.vertices, complex.mesh.points.size());
    EXPECT_EQ(measured.edges, sums::edges(complex));
    EXPECT_EQ(measured.facets, complex.mesh.facets.size());
    EXPECT_EQ(measured.bodies, complex.bodies.size());
    double volume = 0.0;
    for (std::size_t b = 0; b < complex.bodies.size(); ++b) {
      volume += sums::volume(complex, static_cast<int>(b));
    }
    expect_near(measured.energy, sums::energy(complex), "energy");
    expect_near(measured.area, sums::area(complex), "area");
    expect_near(measured.volume, volume, "volume");
    const films::FilmComplex again =
        datafile::complex_of(datafile::read_fe(text, "again.fe"));
    expect_near(sums::energy(again), sums::energy(complex), "read again");
  }

  TempFolder folder_;
};

// A square frame of four free edges over a table, all features on one film.
const char* const kRich = R"(
parameter wet = 0.3
gravity_constant 1.7
gap_constant 0.8
constraint 1 convex
formula: x^2 + y^2/4 + (z - 1)/10 = 1
energy:
e1: wet*sin(y)
e2: wet*exp(z)*x
e3: y
content:
c1: -0.2*y
c2: z*x/(1 + y^2)
c3: 0
constraint 2 nonnegative
formula: z
boundary 1 parameters 1
x1: cos(p1)
x2: 2*sin(p1)
x3: p1/10
energy:
e1: z
e2: x^3
e3: 1
content:
c1: 0
c2: x*z
c3: y
quantity side energy modulus 0.7 method facet_vector_integral
vector_integrand:
q1: y > 0 ? x*z : -x
q2: maximum(x, y)
q3: 1
quantity heft energy method facet_scalar_integral global
scalar_integrand: x^2 + z
vertices
1 0.0 boundary 1 fixed
2 pi/2 boundary 1 fixed
3 -0.9 0.3 1 constraint 1
4 0 -1.9 1 constraint 1
5 0 0.1 0.5 constraint 2
edges
1 1 2 boundary 1 fixed
2 2 3
3 3 4 constraint -1
4 4 1
5 1 5
6 2 5
7 3 5
8 4 5
faces
1 1 6 -5 tension 1.3 side
2 2 7 -6
3 3 8 -7 side
4 4 5 -8 density 0.4
bodies
1 1 2 3 4 volume 1 density 0.6 volconst 0.125
)";

TEST_F(EvolverFe, AgreesOnAFileWithEverything) {
  const Measured measured = measure(kRich);
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(kRich, "rich.fe"));
  expect_near(sums::energy(complex), measured.energy, "energy");
  expect_near(sums::volume(complex, 0), measured.volume, "volume");
  expect_same(complex);
}

TEST_F(EvolverFe, AgreesOnSymmetricContent) {
  const std::string text = std::string("symmetric_content\n") + kRich;
  const Measured measured = measure(text);
  const films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(text, "rich.fe"));
  expect_near(sums::energy(complex), measured.energy, "energy");
  expect_near(sums::volume(complex, 0), measured.volume, "volume");
  expect_same(complex);
}

TEST_F(EvolverFe, AgreesOnExpressionsInEveryForm) {
  for (const char* formula : {"2^3^2",
                              "-x^2",
                              "x ** 2 ^ 0.5",
                              "x - -y",
                              "1 - 2 - x",
                              "8/4/x",
                              "x > 1 && y > 1 || !(z == 3)",
                              "not x > 2",
                              "x ? 1 ? 2 : 3 : 4",
                              "x = y = 1",
                              "sqr(x) + sqrt(y) + abs(-z)",
                              "asinh(x) + acosh(1 + y)",
                              "atanh(x/9) + tanh(y)",
                              "atan2(x, y) + pow(x, 1.5)",
                              "5 % 3 + x",
                              "7 idiv 2 + x",
                              "-7 imod 3 + x",
                              "ceil(2.5) + floor(-2.5) + x",
                              "minimum(x, 2)*maximum(y, 2)",
                              "x*(y + 2)*-1",
                              "2e-1*x + 0x1F + 11b",
                              "(x -1)",
                              "-x - 1 + (2 -1)",
                              "x/y*z",
                              "x/(y*z)"}) {
    const std::string text = fmt::format(
        "constraint 1\nformula: 0*z\nenergy:\ne1: {}\ne2: 0\ne3: 0\n"
        "vertices\n1 1.1 0.7 0.3\n2 2.3 1.9 2.7\n3 0 1 0\nedges\n"
        "1 1 2 constraint 1\n2 2 3\n3 3 1\nfaces\n1 1 2 3\n",
        formula);
    SCOPED_TRACE(formula);
    const films::FilmComplex complex =
        datafile::complex_of(datafile::read_fe(text, "formula.fe"));
    expect_near(sums::energy(complex), measure(text).energy, "energy");
    expect_same(complex);
  }
}

// The shipped samples after their own macros, refined and settled.
TEST_F(EvolverFe, AgreesOnItsOwnDumps) {
  const std::filesystem::path samples = "/usr/share/doc/evolver/examples";
  for (const char* name : {"cat", "catbody", "catman", "column", "cube",
                           "mound", "qmound", "octa", "quad", "sphere"}) {
    std::ifstream file(samples / (std::string(name) + ".fe"));
    if (!file) {
      MENISCUS_NOT_HERE(
          "the samples of Debian's evolver-doc are not installed");
    }
    SCOPED_TRACE(name);
    std::ostringstream text;
    text << file.rdbuf();
    const std::filesystem::path dump = folder_ / "film.dmp";
    const Measured measured =
        measure(text.str(), fmt::format("gogo\ndump \"{}\"", dump.string()));
    std::ostringstream dumped;
    dumped << std::ifstream(dump).rdbuf();
    const films::FilmComplex complex =
        datafile::complex_of(datafile::read_fe(dumped.str(), "film.dmp"));
    EXPECT_EQ(measured.facets, complex.mesh.facets.size());
    // Dumps have 15 digits.
    constexpr double kDumped = 1e-11;
    EXPECT_NEAR(sums::energy(complex), measured.energy,
                kDumped * measured.energy);
    EXPECT_NEAR(sums::area(complex), measured.area, kDumped * measured.area);
  }
}

// Facets beside curves of every shape; nothing slides.
TEST_F(EvolverFe, AgreesOnCurvesAndTensionFields) {
  films::FilmComplex complex;
  curves::Circle circle;
  circle.normal = Vec3(1, 2, 2);
  circle.radius = 1.5;
  curves::Ellipse ellipse;
  ellipse.center = Vec3(0, 0, 3);
  ellipse.radius_2 = 0.4;
  complex.curves = {{"ring", circle}, {"oval", ellipse}};
  constexpr int kAround = 8;
  for (int c = 0; c < 2; ++c) {
    for (int k = 0; k < kAround; ++k) {
      const double t = static_cast<double>(k) / kAround;
      complex.vertices.push_back({films::VertexKind::OnCurve, c, t, -1});
      complex.mesh.points.push_back(
          curves::point_at(complex.curves[c].shape, t));
    }
  }
  complex.mesh.labels = {"skin", "thick"};
  complex.surfaces.resize(2);
  complex.surfaces[0].name = "skin";
  complex.surfaces[0].tension = 2.5;
  complex.surfaces[1].name = "thick";
  complex.surfaces[1].tension_field = Expression::parse(
      "if(x > 0, 1 + x^2, 1) + 0.5*cos(pi*y) + macaulay(y - 0.2, 1, 0.1) + "
      "macaulay(x, 0, 0.3) + macaulay(-x, 2, 0) + 0.1*macaulay(z - 0.5, 0, 0)",
      {"x", "y", "z"});
  for (int k = 0; k < kAround; ++k) {
    const int next = (k + 1) % kAround;
    complex.mesh.facets.push_back({k, next, kAround + k});
    complex.mesh.facets.push_back({next, kAround + next, kAround + k});
    complex.mesh.facet_label.push_back(0);
    complex.mesh.facet_label.push_back(1);
    complex.edges.push_back({k, next, films::VertexKind::OnCurve, 0});
    complex.edges.push_back(
        {kAround + next, kAround + k, films::VertexKind::OnCurve, 1});
  }
  complex.bodies.resize(1);
  complex.bodies[0].sides = {{0, 1}, {1, 1}};
  complex.bodies[0].pressure = 0.25;
  // Evolver counts -pV of a given pressure as energy.
  const Measured measured = measure(datafile::fe_text(complex));
  expect_near(measured.area, sums::area(complex), "area");
  complex.bodies[0].pressure.reset();
  expect_same(complex);
}

// A tension that turns with its film is an integral of its normal.
TEST_F(EvolverFe, AgreesOnATensionThatTurnsWithItsFilm) {
  films::FilmComplex complex = shapes::drop(shapes::sphere(1.0, 2), 3.0);
  complex.surfaces[0].tension = 1.7;
  complex.surfaces[0].drop_shape = {{Vec3(1, 2, -0.5), 1.3, 0.2},
                                    {Vec3(0, -1, 2), 0.4, 1.1}};
  complex.bodies[0].volume.reset();
  const Measured measured = measure(datafile::fe_text(complex));
  expect_near(measured.energy, sums::energy(complex), "energy");
  expect_near(measured.area, sums::area(complex), "area");
}

// A drop on a slanting plane: its wetted face is an integral along its rim.
TEST_F(EvolverFe, AgreesOnAFilmThatSlides) {
  films::FilmSystem system;
  const Vec3 at(0.3, 0.1, 0.2);
  const Vec3 normal(0.3, -0.2, 1.0);
  system.curves = {{"begin", curves::Circle{at, normal, 1.0}}};
  system.films = {{"dome", films::FilmKind::Disk, {"begin"}, 2.0}};
  system.caps = {{"floor", "begin"}};
  system.caps[0].wall = films::FilmWall{at, normal, -0.8};
  system.bodies = {{"drop", {"floor", "dome"}, 2.0, {}}};
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = 0.3});
  ASSERT_FALSE(model.reference().failure);
  const Measured measured = measure(datafile::fe_text(
      start::open_wetted_faces(model.complex_at(model.reference(), system))));
  expect_near(measured.energy, model.reference().report.energy, "energy");
  expect_near(measured.area, model.reference().report.area, "area");
  expect_near(measured.volume, 2.0, "volume");
}

// Upon a ball, in a funnel: what is bent is an integral along the rim, too,
// which the frozen film has by its facets. They differ as chords of it do.
TEST_F(EvolverFe, AgreesOnFilmsThatSlideOnBentWalls) {
  constexpr double kChords = 2e-3;
  for (const films::WallKind kind :
       {films::WallKind::Sphere, films::WallKind::Cone}) {
    const bool ball = kind == films::WallKind::Sphere;
    films::FilmSystem system;
    const Vec3 at(0.3, 0.1, 0.2);
    const Vec3 normal(0.3, -0.2, 1.0);
    const Vec3 n = normal.normalized();
    system.curves = {
        {"begin", curves::Circle{at + (ball ? 1.6 : 0.8) * n, normal,
                                 ball ? 1.2 : 0.8 * std::tan(0.7)}}};
    system.films = {{"dome", films::FilmKind::Disk, {"begin"}, 2.0}};
    system.caps = {{"floor", "begin"}};
    system.caps[0].wall = films::FilmWall{.at = at,
                                          .normal = normal,
                                          .tension = -0.3,
                                          .kind = kind,
                                          .radius = 2.0,
                                          .half_angle = 0.7};
    system.bodies = {{"drop", {"floor", "dome"}, ball ? 2.0 : 0.9, {}}};
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(system, {.edge = 0.1});
    ASSERT_FALSE(model.reference().failure);
    const Measured measured = measure(datafile::fe_text(
        start::open_wetted_faces(model.complex_at(model.reference(), system))));
    expect_near(measured.area, model.reference().report.area, "area");
    EXPECT_NEAR(measured.energy / model.reference().report.energy, 1.0,
                kChords);
    EXPECT_NEAR(measured.volume / *system.bodies[0].volume, 1.0, kChords);
  }
}

}  // namespace
}  // namespace meniscus::evolver_fe_test
