#include <cstdlib>
#include <fstream>
#include <string>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "core/error.h"
#include "tests/support/parts.h"

namespace meniscus::hostile_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TetMesh block() { return shapes::brick({2.0, 1.0, 1.0}, 2, 2, 2); }

void build(const TetMesh& mesh, const element::Material& material,
           const loads::LoadCase& load_case,
           const equations::ElasticOptions& options = {}) {
  const elastic::ElasticModel model(mesh, {material}, {load_case}, options);
}

template <class E>
void expect_refused(const loads::LoadCase& load_case, const std::string& part,
                    const std::string& other = "") {
  EXPECT_THAT(
      [&] { build(block(), parts::steel(), load_case); },
      testing::ThrowsMessage<E>(AllOf(HasSubstr(part), HasSubstr(other))));
}

const Vec3 kForce(1.0, 2.0, 3.0);

TEST(WeakSupports, NothingHeldAlongAnAxis) {
  loads::LoadCase load_case = parts::pulled(kForce);
  load_case.supports = {{"x0", true, true, false}};
  expect_refused<SolverError>(load_case, "move along z", "main");
}

TEST(WeakSupports, OnePlaneOnItsNormal) {
  loads::LoadCase load_case = parts::pulled(kForce);
  load_case.supports = {{"z0", false, false, true}};
  expect_refused<SolverError>(load_case, "rotate about z");
}

TEST(WeakSupports, HingeAlongALineNamesItsAxisAndPoint) {
  loads::LoadCase load_case = parts::pulled(kForce);
  TetMesh mesh = block();
  // The label "hinge" on faces that are squeezed into the edge y = z = 0.
  mesh.labels.push_back("hinge");
  for (int k = 0; k < 3; ++k) {
    mesh.faces.push_back(k);  // nodes 0..2 lie on that edge
  }
  mesh.face_label.push_back(6);
  mesh.face_element.push_back(0);
  load_case.supports = {parts::hold("hinge")};
  EXPECT_THAT(
      [&] { build(mesh, parts::steel(), load_case); },
      testing::ThrowsMessage<SolverError>(AllOf(
          HasSubstr("rotate about x through"), HasSubstr("held are x at 3"))));
}

TEST(WeakSupports, APieceApartIsFree) {
  TetMesh mesh = block();
  const TetMesh other = block();
  const int shift = static_cast<int>(mesh.nodes.size());
  for (const Vec3& x : other.nodes) {
    mesh.nodes.emplace_back(x + Vec3(10.0, 0.0, 0.0));
  }
  for (const int node : other.elements) {
    mesh.elements.push_back(node + shift);
  }
  mesh.element_region.assign(mesh.element_count(), 0);
  EXPECT_THAT([&] { build(mesh, parts::steel(), parts::pulled(kForce)); },
              testing::ThrowsMessage<SolverError>(
                  AllOf(HasSubstr("nothing holds it"), HasSubstr("(11, "))));
}

TEST(WeakSupports, APieceOnOneNodeIsAMechanism) {
  TetMesh mesh = block();
  const int tip = static_cast<int>(mesh.nodes.size()) - 1;  // (2, 1, 1)
  const int first = tip + 1;
  for (const Vec3& x :
       {Vec3(3.0, 1.0, 1.0), Vec3(2.5, 2.0, 1.0), Vec3(2.5, 1.2, 2.0)}) {
    mesh.nodes.push_back(x);
  }
  mesh.elements.insert(mesh.elements.end(), {tip, first, first + 1, first + 2});
  mesh.element_region.push_back(0);
  EXPECT_THAT(
      [&] { build(mesh, parts::steel(), parts::pulled(kForce)); },
      testing::ThrowsMessage<SolverError>(HasSubstr("hangs on a single node")));
}

TEST(Hostile, NoSupportNoLoadUnknownSurface) {
  loads::LoadCase none = parts::pulled(kForce);
  none.supports.clear();
  expect_refused<InvalidInput>(none, "main", "no support");
  none.supports = {{"x0", false, false, false}};
  expect_refused<InvalidInput>(none, "no support");
  expect_refused<InvalidInput>(parts::pulled(Vec3::Zero()), "main", "no load");
  loads::LoadCase lost = parts::pulled(kForce);
  lost.supports = {parts::hold("bottom")};
  expect_refused<InvalidInput>(lost, "bottom", "x0, x1");
  lost = parts::pulled(kForce);
  lost.forces[0].surfaces = "";
  expect_refused<InvalidInput>(lost, "no surface ''");
}

TEST(Hostile, Materials) {
  const auto refused = [&](const element::Material& material,
                           const char* part) {
    EXPECT_THAT([&] { build(block(), material, parts::pulled(kForce)); },
                testing::ThrowsMessage<InvalidInput>(
                    AllOf(HasSubstr("steel"), HasSubstr(part))));
  };
  for (const double nu : {0.5, 0.7, -1.0, -2.0, double(NAN)}) {
    element::Material material = parts::steel();
    material.poisson_ratio = nu;
    refused(material, "Poisson");
  }
  for (const double E : {0.0, -1.0, double(INFINITY), double(NAN)}) {
    element::Material material = parts::steel();
    material.youngs_modulus = E;
    refused(material, "Young");
  }
  element::Material material = parts::steel();
  material.density = -1.0;
  refused(material, "density");
  TetMesh mesh = block();
  mesh.element_region[3] = 1;
  EXPECT_THAT([&] { build(mesh, parts::steel(), parts::pulled(kForce)); },
              testing::ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("element 3"), HasSubstr("region 1"))));
}

TEST(Hostile, Meshes) {
  TetMesh mesh = block();
  mesh.elements[5] = 1000;
  EXPECT_THROW(build(mesh, parts::steel(), parts::pulled(kForce)),
               InvalidInput);
  mesh = block();
  std::swap(mesh.elements[0], mesh.elements[1]);
  EXPECT_THROW(build(mesh, parts::steel(), parts::pulled(kForce)), MeshError);
  mesh = block();
  mesh.nodes[4].x() = NAN;
  EXPECT_THROW(build(mesh, parts::steel(), parts::pulled(kForce)), MeshError);
  EXPECT_THROW(build(TetMesh{}, parts::steel(), parts::pulled(kForce)),
               InvalidInput);
}

TEST(Hostile, NodesInNoElementStayAtRest) {
  TetMesh mesh = block();
  mesh.nodes.emplace_back(7.0, 7.0, 7.0);
  const elastic::ElasticModel model(mesh, {parts::steel()},
                                    {parts::pulled(kForce)});
  EXPECT_FALSE(model.base_solution().failure);
  EXPECT_EQ(model.base_solution().displacements[0].tail<3>(), Vec3::Zero());
}

TEST(Hostile, DesignsThatCannotBeSolvedAreFailures) {
  const TetMesh base = shapes::straight_quadratic(block());
  const elastic::ElasticModel model(
      base, {parts::steel()}, {parts::pulled(kForce)},
      {.solver = equations::SolverKind::Multigrid});
  TetMesh mesh = base;
  mesh.nodes[13] += Vec3(5.0, 0.0, 0.0);
  equations::ElasticSolution solution = model.solve(mesh);
  ASSERT_TRUE(solution.failure);
  EXPECT_EQ(solution.failure->kind, FailureKind::ElementsInverted);
  mesh = base;
  mesh.nodes[3].y() = NAN;
  solution = model.solve(mesh);
  ASSERT_TRUE(solution.failure);
  EXPECT_EQ(solution.failure->kind, FailureKind::NotANumber);
  mesh = base;
  mesh.elements.resize(40);
  EXPECT_THROW(model.solve(mesh), InvalidInput);
  loads::LoadCase other = parts::pulled(kForce);
  other.supports = {parts::hold("y0")};
  EXPECT_THROW(model.solve(base, {other}), InvalidInput);
}

TEST(Hostile, TooFewIterationsIsAFailureThatSaysSo) {
  const TetMesh base = shapes::straight_quadratic(block());
  const elastic::ElasticModel model(
      base, {parts::steel()}, {parts::pulled(kForce)},
      {.solver = equations::SolverKind::Multigrid, .max_iterations = 2});
  const auto& failure = model.base_solution().failure;
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::SolverFailed);
  EXPECT_THAT(failure->message,
              AllOf(HasSubstr("main"), HasSubstr("2 iterations")));
}

TEST(Hostile, AStopIsObeyed) {
  class Stopper : public Monitor {
   public:
    bool stop_requested() const override { return true; }
  } stopper;
  EXPECT_THROW(build(block(), parts::steel(), parts::pulled(kForce),
                     {.monitor = &stopper}),
               Interrupted);
}

// In a child process that may have `more` bytes than it has: exits with 0 when
// the model is refused for its memory, with `says` in the message.
void exit_when_refused(double more, const equations::ElasticOptions& options,
                       const std::string& says) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 1.0, 1.0}, 20, 14, 14));
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  const double now = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
  const rlimit limit{static_cast<rlim_t>(now + more), RLIM_INFINITY};
  setrlimit(RLIMIT_AS, &limit);
  try {
    build(mesh, parts::steel(), parts::pulled(kForce), options);
  } catch (const SolverError& error) {
    std::exit(std::string(error.what()).find(says) == std::string::npos ? 2
                                                                        : 0);
  }
  std::exit(1);
}

TEST(Memory, TooLittleIsForeseen) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(exit_when_refused(5e7, {}, "longer edges (resolution.fea)"),
              testing::ExitedWithCode(0), "");
  EXPECT_EXIT(
      exit_when_refused(4e8, {.solver = equations::SolverKind::Cholesky},
                        "a sparse factor of"),
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace meniscus::hostile_test
