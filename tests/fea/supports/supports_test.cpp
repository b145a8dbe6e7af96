#include "fea/supports/supports.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/element/surface_faces.h"
#include "fea/supports/springs.h"
#include "tests/support/parts.h"

namespace meniscus::supports_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kSolvers = 1e-8;  // what two solvers may differ by
// Iterations of problems alike: the number of cycles on the corner mesh is
// chosen from a random start, and one more or less shows.
constexpr double kAlike = 1.25;
constexpr double kBalance = 1e-9;  // reactions against loads
constexpr double kExact = 1e-9;    // fields that elements have exactly

/// Some rotation that leaves no axis alone.
Mat3 turn() {
  return Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized())
      .toRotationMatrix();
}

TetMesh turned(TetMesh mesh) {
  for (Vec3& x : mesh.nodes) {
    x = turn() * x;
  }
  return mesh;
}

TetMesh bar(int order) {
  const TetMesh mesh = shapes::brick({3.0, 1.0, 1.0}, 6, 3, 3);
  return order == 1 ? mesh : shapes::straight_quadratic(mesh);
}

loads::Support slide(const std::string& surface,
                     loads::SupportKind kind = loads::SupportKind::Normal) {
  return {.surface = surface, .kind = kind};
}

equations::ElasticSolution solve(
    const TetMesh& mesh, const loads::LoadCase& load_case,
    equations::SolverKind kind = equations::SolverKind::Automatic) {
  const elastic::ElasticModel model(mesh, {parts::steel()}, {load_case},
                                    {.solver = kind});
  const equations::ElasticSolution& solution = model.base_solution();
  EXPECT_FALSE(solution.failure) << solution.failure->message;
  EXPECT_LE(solution.report.reaction_imbalance, kBalance);
  return solution;
}

double difference(const VectorX& a, const VectorX& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

VectorX turned(const VectorX& u) {
  VectorX v(u.size());
  for (Eigen::Index d = 0; d < u.size(); d += 3) {
    v.segment<3>(d) = turn() * u.segment<3>(d);
  }
  return v;
}

/// Three planes held along their normals, a force on the end.
loads::LoadCase on_planes(bool oblique, loads::SupportKind kind) {
  loads::LoadCase load_case;
  load_case.name = "planes";
  if (oblique) {
    load_case.supports = {slide("x0", kind), slide("y0", kind),
                          slide("z0", kind)};
  } else {
    load_case.supports = {{"x0", true, false, false},
                          {"y0", false, true, false},
                          {"z0", false, false, true}};
  }
  const Vec3 force(5.0, 2.0, -3.0);
  load_case.forces = {{"x1", oblique ? Vec3(turn() * force) : force}};
  return load_case;
}

class Supports : public testing::TestWithParam<equations::SolverKind> {};

// Nodes of edges and of the corner are held along two and three normals.
TEST_P(Supports, PlanesHoldAlongTheirNormalsInAnyPosition) {
  const TetMesh mesh = bar(2);
  const equations::ElasticSolution straight =
      solve(mesh, on_planes(false, loads::SupportKind::Components), GetParam());
  for (const auto kind :
       {loads::SupportKind::Normal, loads::SupportKind::Symmetry}) {
    const equations::ElasticSolution oblique =
        solve(turned(mesh), on_planes(true, kind), GetParam());
    EXPECT_LE(
        difference(oblique.displacements[0], turned(straight.displacements[0])),
        kSolvers);
    EXPECT_LE(difference(oblique.reactions[0], turned(straight.reactions[0])),
              10.0 * kSolvers);
    EXPECT_EQ(oblique.report.dofs, straight.report.dofs);
    EXPECT_LE(oblique.report.iterations, straight.report.iterations + 2);
  }
}

TEST_P(Supports, LocalAxesTurnWithThePart) {
  loads::LoadCase straight = parts::pulled({5.0, 2.0, -3.0});
  straight.supports = {{"x0", true, false, true}, {"y0", false, true, false}};
  loads::LoadCase oblique = straight;
  for (loads::Support& support : oblique.supports) {
    support.axes =
        element::LocalAxes{turn().col(0), turn().col(1) + turn().col(0)};
  }
  oblique.forces[0].total = turn() * straight.forces[0].total;
  const TetMesh mesh = bar(2);
  const equations::ElasticSolution a = solve(mesh, straight, GetParam());
  const equations::ElasticSolution b = solve(turned(mesh), oblique, GetParam());
  EXPECT_LE(difference(b.displacements[0], turned(a.displacements[0])),
            kSolvers);
  EXPECT_LE(b.report.iterations, kAlike * a.report.iterations);
}

TEST_P(Supports, SpringsTurnWithThePart) {
  loads::LoadCase straight = parts::pulled({5.0, 2.0, -3.0});
  straight.supports.clear();
  straight.springs = {
      {.surface = "x0", .components = {1e4, 3e4, 2e5}},
      {.surface = "z0", .normal = 5e3, .measure = loads::SpringMeasure::Total}};
  loads::LoadCase oblique = straight;
  oblique.springs[0].axes = element::LocalAxes{turn().col(0), turn().col(1)};
  oblique.forces[0].total = turn() * straight.forces[0].total;
  const TetMesh mesh = bar(2);
  const equations::ElasticSolution a = solve(mesh, straight, GetParam());
  const equations::ElasticSolution b = solve(turned(mesh), oblique, GetParam());
  EXPECT_LE(difference(b.displacements[0], turned(a.displacements[0])),
            kSolvers);
  EXPECT_LE(difference(b.reactions[0], turned(a.reactions[0])),
            10.0 * kSolvers);
  EXPECT_LE(b.report.iterations, a.report.iterations + 2);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Supports,
                         testing::Values(equations::SolverKind::Cholesky,
                                         equations::SolverKind::Multigrid));

// Without Poisson's effect a block on springs sinks by p / k and shortens by
// p z / E: linear, so both orders have it exactly.
TEST(Springs, BlockSinksAndShortens) {
  for (const int order : {1, 2}) {
    TetMesh mesh = parts::distorted_brick({2.0, 3.0, 1.5}, 3);
    if (order == 2) {
      mesh = shapes::straight_quadratic(mesh);
    }
    element::Material material = parts::steel();
    material.poisson_ratio = 0.0;
    loads::LoadCase load_case;
    load_case.name = "sink";
    load_case.supports = {slide("x0"), slide("y0")};
    load_case.springs = {{.surface = "z0",
                          .normal = 6.0 * 4e4,
                          .measure = loads::SpringMeasure::Total}};
    load_case.pressures = {{"z1", 7.0}};
    const elastic::ElasticModel model(mesh, {material}, {load_case},
                                      {.tolerance = 1e-13});
    const equations::ElasticSolution& solution = model.base_solution();
    ASSERT_FALSE(solution.failure) << solution.failure->message;
    EXPECT_LE(solution.report.reaction_imbalance, kBalance);
    double ground = 0.0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      const double exact =
          -7.0 / 4e4 - 7.0 * mesh.nodes[i].z() / material.youngs_modulus;
      EXPECT_NEAR(solution.displacements[0][at + 2], exact, -kExact * exact);
      ground += solution.reactions[0][at + 2];
    }
    EXPECT_NEAR(ground, 42.0, 42.0 * kExact);
  }
}

// The stiffer, the closer to a fixed surface, and never a wrong answer.
TEST(Springs, OneByOneAreTheirBed) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = turned(bar(order));
    loads::LoadCase load_case{.name = "beds"};
    load_case.springs = {
        {"x0", {2.0, 0.0, 3.0}, 5.0},
        {.surface = "y1",
         .components = {7.0, 1.0, 0.0},
         .measure = loads::SpringMeasure::Total,
         .axes = element::LocalAxes{{1.0, 1.0, 0.0}, Vec3::UnitZ()}}};
    const std::vector<supports::SpringSet> sets =
        supports::spring_sets(mesh, load_case);
    EXPECT_EQ(sets.size(), 5U);
    const VectorX u = VectorX::Random(3 * static_cast<int>(mesh.nodes.size()));
    VectorX f = VectorX::Zero(u.size());
    for (const supports::SpringSet& set : sets) {
      for (const supports::SpringSet::Spring& spring : set.springs) {
        double e = 0.0;
        for (std::size_t a = 0; a < spring.nodes.size(); ++a) {
          e += spring.coefficients[a].dot(u.segment<3>(3 * spring.nodes[a]));
        }
        for (std::size_t a = 0; a < spring.nodes.size(); ++a) {
          f.segment<3>(3 * spring.nodes[a]) +=
              set.stiffness * e * spring.coefficients[a];
        }
      }
    }
    const VectorX bed = supports::spring_forces(
        supports::spring_blocks(mesh, load_case, order), u);
    EXPECT_LT((f - bed).norm(), 1e-13 * bed.norm());
  }
}

TEST(Springs, StiffOnesActAsAFixedSurface) {
  const TetMesh mesh = turned(bar(2));
  loads::LoadCase fixed = parts::pulled({5.0, 2.0, -3.0});
  loads::LoadCase sprung = fixed;
  sprung.supports.clear();
  for (const auto kind :
       {equations::SolverKind::Cholesky, equations::SolverKind::Multigrid}) {
    const VectorX exact = solve(mesh, fixed, kind).displacements[0];
    for (const double stiffness : {1e9, 1e12}) {
      sprung.springs = {
          {.surface = "x0", .components = Vec3::Constant(stiffness)}};
      EXPECT_LE(difference(solve(mesh, sprung, kind).displacements[0], exact),
                1e7 / stiffness);
    }
  }
}

/// Lame: bore held along its normals, pressure p outside, plane strain:
/// u = A (r - 1 / r) with stress_r(2) = -p.
double held_bore(double r, double pressure) {
  const element::Material m = parts::steel();
  const element::Lame l = element::lame(m);
  const double slope =
      (l.lambda + 2.0 * l.mu) * (1.0 + 0.25) + l.lambda * (1.0 - 0.25);
  return -pressure / slope * (r - 1.0 / r);
}

loads::LoadCase squeezed_tube() {
  loads::LoadCase load_case;
  load_case.name = "squeeze";
  load_case.supports = {slide("x0"),
                        slide("y0", loads::SupportKind::Symmetry),
                        slide("y1", loads::SupportKind::Symmetry),
                        {"z0", false, false, true},
                        {"z1", false, false, true}};
  load_case.pressures = {{"x1", 5.0}};
  return load_case;
}

// The normals of quadratic facets are of second order, and so is the answer.
TEST(CurvedSupports, HoldABoreAlongItsNormalsToSecondOrder) {
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const TetMesh mesh = parts::quarter_tube(level == 0 ? 3 : 6, 0.3);
    const VectorX u = solve(mesh, squeezed_tube()).displacements[0];
    error[level] = 0.0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      Vec3 radial = mesh.nodes[i];
      radial.z() = 0.0;
      const double r = radial.norm();
      error[level] = std::max(error[level],
                              (u.segment<3>(static_cast<Eigen::Index>(3 * i)) -
                               held_bore(r, 5.0) * radial / r)
                                      .norm() /
                                  std::abs(held_bore(2.0, 5.0)));
    }
  }
  EXPECT_LT(error[1], 1e-3);
  EXPECT_GT(error[0] / error[1], 3.3) << error[0] << " " << error[1];
}

TEST(CurvedSupports, MultigridConvergesAsFastAsWithFixedComponents) {
  const TetMesh mesh = parts::quarter_tube(6, 0.5);
  const equations::ElasticSolution held =
      solve(mesh, squeezed_tube(), equations::SolverKind::Multigrid);
  const equations::ElasticSolution direct =
      solve(mesh, squeezed_tube(), equations::SolverKind::Cholesky);
  const equations::ElasticSolution fixed =
      solve(mesh, parts::tube_pressure(5.0), equations::SolverKind::Multigrid);
  EXPECT_LE(difference(held.displacements[0], direct.displacements[0]),
            kSolvers);
  EXPECT_LE(held.report.iterations, kAlike * fixed.report.iterations);
}

TEST(CurvedSupports, NextDesignTurnsItsNormals) {
  const TetMesh base = parts::quarter_tube(4, 0.5);
  TetMesh moved = base;
  for (Vec3& x : moved.nodes) {
    x.x() *= 1.0 + 0.05 * x.y();
  }
  loads::LoadCase load_case = squeezed_tube();
  load_case.supports.back() = {"x1", true, true, true};
  load_case.supports[2].kind = loads::SupportKind::Normal;
  load_case.pressures = {{"z1", 5.0}};
  for (const auto kind :
       {equations::SolverKind::Cholesky, equations::SolverKind::Multigrid}) {
    const elastic::ElasticModel model(base, {parts::steel()}, {load_case},
                                      {.solver = kind});
    const equations::ElasticSolution next = model.solve(moved);
    ASSERT_FALSE(next.failure) << next.failure->message;
    const elastic::ElasticModel fresh(moved, {parts::steel()}, {load_case},
                                      {.solver = kind});
    EXPECT_LE(difference(next.displacements[0],
                         fresh.base_solution().displacements[0]),
              kSolvers);
    const equations::ElasticSolution back = model.solve(base);
    EXPECT_LE(difference(back.displacements[0],
                         model.base_solution().displacements[0]),
              kSolvers);
  }
}

TEST(SupportGroups, CasesHeldDifferentlyAreSolvedAsAlone) {
  const TetMesh mesh = turned(bar(2));
  loads::LoadCase sprung = parts::pulled({1.0, 0.0, 0.0});
  sprung.name = "sprung";
  sprung.supports = {slide("x0")};
  sprung.springs = {{.surface = "y0", .components = {1e3, 2e3, 5e2}}};
  const std::vector<loads::LoadCase> cases = {
      on_planes(true, loads::SupportKind::Normal),
      parts::pulled({0.0, 1.0, 0.0}), sprung,
      on_planes(true, loads::SupportKind::Normal)};
  for (const auto kind :
       {equations::SolverKind::Cholesky, equations::SolverKind::Multigrid}) {
    const elastic::ElasticModel together(mesh, {parts::steel()}, cases,
                                         {.solver = kind});
    ASSERT_FALSE(together.base_solution().failure);
    for (std::size_t c = 0; c < cases.size(); ++c) {
      EXPECT_LE(difference(together.base_solution().displacements[c],
                           solve(mesh, cases[c], kind).displacements[0]),
                kSolvers);
    }
  }
}

template <class Error>
void expect_refused(const TetMesh& mesh, const loads::LoadCase& load_case,
                    const char* part) {
  EXPECT_THAT(
      [&] { elastic::ElasticModel(mesh, {parts::steel()}, {load_case}); },
      testing::ThrowsMessage<Error>(
          AllOf(HasSubstr(load_case.name), HasSubstr(part))));
}

TEST(SupportChecks, ABushTurnsInItsBore) {
  const TetMesh mesh = parts::quarter_tube(3, 0.5);
  loads::LoadCase load_case;
  load_case.name = "bush";
  load_case.supports = {slide("x0"), {"z0", false, false, true}};
  load_case.pressures = {{"x1", 1.0}};
  expect_refused<SolverError>(mesh, load_case, "rotate about z");
  load_case.springs = {{.surface = "x1", .normal = 100.0}};
  expect_refused<SolverError>(mesh, load_case, "rotate about z");
  load_case.springs[0].components.x() = 1.0;
  solve(mesh, load_case);
}

TEST(SupportChecks, SymmetryNeedsAPlane) {
  const TetMesh mesh = parts::quarter_tube(2, 0.5);
  loads::LoadCase load_case = squeezed_tube();
  load_case.name = "surface 'x0'";
  load_case.supports[0].kind = loads::SupportKind::Symmetry;
  expect_refused<InvalidInput>(mesh, load_case, "is no plane");
}

TEST(SupportChecks, AxesSpringsAndNames) {
  const TetMesh mesh = bar(1);
  loads::LoadCase load_case = parts::pulled({1.0, 0.0, 0.0});
  load_case.supports[0].axes =
      element::LocalAxes{Vec3::UnitX(), -2.0 * Vec3::UnitX()};
  expect_refused<InvalidInput>(mesh, load_case, "parallel");
  load_case = parts::pulled({1.0, 0.0, 0.0});
  load_case.springs = {{.surface = "y0"}};
  expect_refused<InvalidInput>(mesh, load_case, "no stiffness");
  for (const double bad : {-1.0, double(NAN), double(INFINITY)}) {
    load_case.springs[0].normal = bad;
    expect_refused<InvalidInput>(mesh, load_case, "0 or above");
  }
  load_case.springs = {{.surface = "lid", .normal = 1.0}};
  EXPECT_THROW(elastic::ElasticModel(mesh, {parts::steel()}, {load_case}),
               InvalidInput);
  load_case = parts::pulled({1.0, 0.0, 0.0});
  load_case.supports = {slide("lid")};
  EXPECT_THROW(elastic::ElasticModel(mesh, {parts::steel()}, {load_case}),
               InvalidInput);
  load_case.supports = {slide("x0")};
  expect_refused<SolverError>(mesh, load_case, "rotate about x");
  load_case.supports.clear();
  load_case.springs = {{.surface = "x0", .components = {1.0, 0.0, 0.0}}};
  expect_refused<SolverError>(mesh, load_case, "move along");
}

// Facets of one smooth surface that two names share do not lock each other.
TEST(NodeFreedom, NormalsOfOneSmoothSurfaceUnderTwoNamesCountOnce) {
  TetMesh mesh = parts::quarter_tube(3, 0.5);
  mesh.labels.push_back("upper");
  for (int f = 0; f < mesh.face_count(); ++f) {
    const Vec3& x = mesh.nodes[mesh.face(f)[0]];
    if (mesh.face_label[f] == mesh.label_of("x0") && x.y() > x.x() - 1e-9) {
      mesh.face_label[f] = mesh.label_of("upper");
    }
  }
  loads::LoadCase load_case;
  load_case.supports = {slide("x0"), slide("upper")};
  const solver::NodeFreedom freedom =
      supports::node_freedom(mesh, supports::held_directions(mesh, load_case));
  for (const Mat3& P : freedom.projector) {
    EXPECT_NEAR(P.trace(), 2.0, 1e-12);
    EXPECT_LE((P * P - P).norm(), 1e-12);
  }
}

/// Every node of a surface held along three directions.
std::vector<loads::HeldNode> held_nodes_of(const TetMesh& mesh,
                                           const std::string& surface,
                                           const Mat3& directions) {
  std::vector<loads::HeldNode> held;
  const int label = element::surface_label(mesh, surface);
  for (const int node : element::surface_nodes(mesh, label)) {
    for (int k = 0; k < 3; ++k) {
      held.push_back({node, 2.5 * directions.col(k)});
    }
  }
  return held;
}

TEST(HeldNodes, OfASurfaceAreItsSupport) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = turned(bar(order));
    loads::LoadCase by_surface = parts::pulled({5.0, 2.0, -3.0});
    by_surface.supports.push_back(
        {.surface = "y0",
         .fix_y = true,
         .axes = element::LocalAxes{turn().col(0), turn().col(1)}});
    loads::LoadCase by_node = by_surface;
    by_node.supports.clear();
    by_node.held_nodes = held_nodes_of(mesh, "x0", turn());
    for (const loads::HeldNode& node :
         held_nodes_of(mesh, "y0", turn().col(1).replicate<1, 3>())) {
      by_node.held_nodes.push_back(node);
    }
    EXPECT_LE(difference(solve(mesh, by_node).displacements[0],
                         solve(mesh, by_surface).displacements[0]),
              kSolvers);
  }
}

// Six components at three nodes within the part hold it and nothing more: a
// bar under end pressures strains evenly.
TEST(HeldNodes, InsideThePartLeaveItFreeToStrain) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = bar(order);
    const auto node_at = [&](const Vec3& x) {
      return static_cast<int>(
          std::min_element(mesh.nodes.begin(), mesh.nodes.end(),
                           [&](const Vec3& a, const Vec3& b) {
                             return (a - x).norm() < (b - x).norm();
                           }) -
          mesh.nodes.begin());
    };
    const int a = node_at({1.0, 1.0 / 3.0, 1.0 / 3.0});
    const int b = node_at({2.0, 1.0 / 3.0, 1.0 / 3.0});
    const int c = node_at({1.0, 2.0 / 3.0, 1.0 / 3.0});
    loads::LoadCase load_case{.name = "inside"};
    load_case.held_nodes = {{a, Vec3::UnitX()}, {a, Vec3::UnitY()},
                            {a, Vec3::UnitZ()}, {b, Vec3::UnitY()},
                            {b, Vec3::UnitZ()}, {c, Vec3::UnitZ()}};
    load_case.pressures = {{"x0", 21.0}, {"x1", 21.0}};
    const equations::ElasticSolution solution = solve(mesh, load_case);
    const double strain = 21.0 / 210000.0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Vec3 d = mesh.nodes[i] - mesh.nodes[a];
      const Vec3 exact = strain * Vec3(-d.x(), 0.3 * d.y(), 0.3 * d.z());
      EXPECT_LE((solution.displacements[0].segment<3>(3L * i) - exact).norm(),
                kExact * strain * 3.0);
    }
    EXPECT_LE(solution.reactions[0].lpNorm<Eigen::Infinity>(), 21.0 * kExact);
    load_case.held_nodes.pop_back();
    expect_refused<SolverError>(mesh, load_case, "rotate about x");
    load_case.held_nodes.push_back({-1, Vec3::UnitZ()});
    expect_refused<InvalidInput>(mesh, load_case, "a node of the mesh");
    load_case.held_nodes.back() = {c, Vec3::Zero()};
    expect_refused<InvalidInput>(mesh, load_case, "with a length");
  }
}

TEST(NodeSprings, OneByOneAreTheirBed) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = turned(bar(order));
    loads::LoadCase bed = parts::pulled({5.0, 2.0, -3.0});
    bed.supports.clear();
    bed.springs = {{"x0", {2000.0, 0.0, 3000.0}, 5000.0}, {"y0", {}, 100.0}};
    loads::LoadCase single = bed;
    single.springs.clear();
    for (const supports::SpringSet& set : supports::spring_sets(mesh, bed)) {
      for (const supports::SpringSet::Spring& spring : set.springs) {
        single.node_springs.push_back(
            {set.stiffness, spring.nodes, spring.coefficients});
      }
    }
    for (const auto kind :
         {equations::SolverKind::Cholesky, equations::SolverKind::Multigrid}) {
      const equations::ElasticSolution expected = solve(mesh, bed, kind);
      const equations::ElasticSolution found = solve(mesh, single, kind);
      EXPECT_LE(difference(found.displacements[0], expected.displacements[0]),
                kSolvers);
      EXPECT_LE(found.report.iterations,
                kAlike * expected.report.iterations + 1);
    }
  }
}

TEST(NodeSprings, MustBeOfOneElement) {
  const TetMesh mesh = bar(2);
  loads::LoadCase load_case = parts::pulled({1.0, 0.0, 0.0});
  const int last = mesh.corner_count - 1;
  load_case.node_springs = {{1.0, {0, last}, {Vec3::UnitX(), Vec3::UnitX()}}};
  expect_refused<InvalidInput>(mesh, load_case, "no element that has them all");
  load_case.node_springs = {{0.0, {0}, {Vec3::UnitX()}}};
  expect_refused<InvalidInput>(mesh, load_case, "stiffness above 0");
}

}  // namespace
}  // namespace meniscus::supports_test
