#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdlib.h>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/find_program.h"
#include "fea/modes/buckling.h"
#include "tests/support/environment_variable.h"
#include "tests/support/not_here.h"
#include "tests/support/parts.h"
#include "tests/support/temp_folder.h"

namespace meniscus::distributed_test {
namespace {

constexpr double kSolvers = 1e-8;  // what two solvers may differ by
// Half, and what PETSc itself takes in every process (40 to 60 MB).
constexpr double kMemoryShare = 0.75;

equations::ElasticOptions over(int processes) {
  return {.solver = equations::SolverKind::Distributed, .processes = processes};
}

double difference(const VectorX& a, const VectorX& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

bool petsc_is_here() {
  return find_helper("meniscus-petsc", "MENISCUS_PETSC") &&
         find_program("mpirun");
}

#define NEED_PETSC()                                          \
  if (!petsc_is_here()) {                                     \
    MENISCUS_NOT_HERE(                                        \
        "meniscus-petsc or mpirun is not here: the packages " \
        "libpetsc-real-dev and openmpi-bin");                 \
  }

element::Material spruce() {
  element::Material m{"spruce", 0.0, 0.0, 4.5e-10, {}};
  m.orthotropic =
      element::Orthotropic{.youngs_moduli = {11000.0, 400.0, 700.0},
                           .poisson_ratios = {0.40, 0.35, 0.40},
                           .shear_moduli = {600.0, 650.0, 40.0},
                           .axes = {{1.0, 0.2, 0.0}, {0.1, 1.0, 0.3}}};
  return m;
}

struct Model {
  std::string name;
  TetMesh mesh;
  std::vector<element::Material> materials;
  std::vector<loads::LoadCase> load_cases;
};

/// Four nodes, one matrix for two load cases and another for the third, which
/// stands on springs.
Model four_nodes() {
  loads::LoadCase twist = parts::pulled({0.0, 20.0, 5.0});
  twist.name = "second";
  twist.pressures = {{"z1", 3.0}};
  loads::LoadCase bed = twist;
  bed.name = "bed";
  bed.supports = {{"x0", true, false, false}};
  bed.springs = {
      {.surface = "z0", .components = {200.0, 300.0, 0.0}, .normal = 900.0}};
  return {"four_nodes",
          parts::distorted_brick({3.0, 1.0, 1.0}, 7),
          {parts::steel()},
          {parts::pulled({1.0, 0.0, -10.0}), twist, bed}};
}

/// Curved ten-node elements, two materials, one of them orthotropic.
Model two_materials() {
  TetMesh tube = parts::quarter_tube(4, 0.5);
  for (int e = 0; e < tube.element_count(); e += 3) {
    tube.element_region[e] = 1;
  }
  loads::LoadCase heat = parts::tube_pressure(2.0);
  heat.name = "heat";
  heat.pressures = {{"x1", 1.0}};
  return {"two_materials",
          std::move(tube),
          {parts::steel(), spruce()},
          {parts::tube_pressure(2.0), heat}};
}

/// Held along oblique normals.
Model oblique() {
  const Mat3 turn(Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()));
  TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({3.0, 1.0, 1.0}, 9, 3, 3));
  for (Vec3& x : mesh.nodes) {
    x = turn * x;
  }
  loads::LoadCase load_case;
  load_case.name = "planes";
  for (const char* surface : {"x0", "y0", "z0"}) {
    load_case.supports.push_back(
        {.surface = surface, .kind = loads::SupportKind::Normal});
  }
  load_case.forces = {{"x1", {5.0, 2.0, -3.0}}};
  return {"oblique", std::move(mesh), {parts::steel()}, {load_case}};
}

class Distributed : public testing::TestWithParam<int> {};

TEST_P(Distributed, DisplacementsAreThoseOfOurSolver) {
  NEED_PETSC();
  for (const Model& part : {four_nodes(), two_materials(), oblique()}) {
    SCOPED_TRACE(part.name);
    const elastic::ElasticModel ours(part.mesh, part.materials,
                                     part.load_cases);
    const elastic::ElasticModel petsc(part.mesh, part.materials,
                                      part.load_cases, over(GetParam()));
    const TetMesh moved = shapes::sheared(part.mesh, 0.01);
    for (const auto& [a, b] :
         {std::pair(petsc.base_solution(), ours.base_solution()),
          std::pair(petsc.solve(moved), ours.solve(moved))}) {
      ASSERT_FALSE(a.failure) << a.failure->message;
      ASSERT_FALSE(b.failure) << b.failure->message;
      EXPECT_EQ(a.report.solver, "petsc");
      EXPECT_EQ(a.report.dofs, b.report.dofs);
      EXPECT_GT(a.report.iterations, 1);
      EXPECT_EQ(std::ssize(a.report.process_memory), GetParam());
      EXPECT_NEAR(a.report.strain_energy, b.report.strain_energy,
                  kSolvers * b.report.strain_energy);
      for (std::size_t c = 0; c < part.load_cases.size(); ++c) {
        EXPECT_LE(difference(a.displacements[c], b.displacements[c]), kSolvers);
        // A reaction is a difference of forces, each as wrong as the strain.
        EXPECT_LE(difference(a.reactions[c], b.reactions[c]), 100.0 * kSolvers);
      }
    }
  }
}

TEST_P(Distributed, ModelsOfOneDesignHaveTheSameBits) {
  NEED_PETSC();
  const Model part = four_nodes();
  const elastic::ElasticModel a(part.mesh, part.materials, part.load_cases,
                                over(GetParam()));
  const elastic::ElasticModel b(part.mesh, part.materials, part.load_cases,
                                over(GetParam()));
  const equations::ElasticSolution again = a.solve(part.mesh);
  for (std::size_t c = 0; c < part.load_cases.size(); ++c) {
    EXPECT_EQ(a.base_solution().displacements[c],
              b.base_solution().displacements[c]);
    EXPECT_LE(
        difference(again.displacements[c], a.base_solution().displacements[c]),
        kSolvers);
  }
  EXPECT_LE(again.report.iterations, 3);  // the start's own rounding
}

INSTANTIATE_TEST_SUITE_P(Processes, Distributed, testing::Values(1, 2));

TEST(DistributedMemory, OfAProcessFallsWithTheirNumber) {
  NEED_PETSC();
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 1.0, 1.0}, 26, 13, 13));
  std::vector<double> largest;
  for (const int processes : {1, 2}) {
    const elastic::ElasticModel model(mesh, {parts::steel()},
                                      {parts::pulled({1.0, 0.0, -10.0})},
                                      over(processes));
    const equations::ElasticSolution& solution = model.base_solution();
    ASSERT_FALSE(solution.failure) << solution.failure->message;
    const std::vector<double>& memory = solution.report.process_memory;
    largest.push_back(*std::max_element(memory.begin(), memory.end()));
  }
  RecordProperty("bytes of 1", std::to_string(largest[0]));
  RecordProperty("bytes of 2", std::to_string(largest[1]));
  EXPECT_LT(largest[1], kMemoryShare * largest[0]) << largest[0];
}

TEST(DistributedLimits, SmallPartsTakeFewerProcesses) {
  NEED_PETSC();
  const elastic::ElasticModel model(shapes::brick({2.0, 1.0, 1.0}, 4, 2, 2),
                                    {parts::steel()},
                                    {parts::pulled({0.0, 0.0, 1.0})}, over(16));
  ASSERT_FALSE(model.base_solution().failure);
  EXPECT_EQ(model.base_solution().report.process_memory.size(), 1u);
}

TEST(DistributedLimits, WhatDoesNotConvergeIsAFailure) {
  NEED_PETSC();
  equations::ElasticOptions options = over(2);
  options.max_iterations = 2;
  const Model part = oblique();
  const elastic::ElasticModel model(part.mesh, part.materials, part.load_cases,
                                    options);
  ASSERT_TRUE(model.base_solution().failure);
  EXPECT_THAT(model.base_solution().failure->message,
              testing::HasSubstr("no convergence in 2 iterations"));
}

TEST(DistributedLimits, EigenvaluesAndWrongNumbersAreRefused) {
  NEED_PETSC();
  const Model part = oblique();
  const elastic::ElasticModel model(part.mesh, part.materials, part.load_cases,
                                    over(1));
  EXPECT_THROW(modes::buckling_modes(model, part.mesh, part.load_cases, 0,
                                     model.base_solution().displacements[0],
                                     {.count = 1}),
               InvalidInput);
  for (const int processes : {0, -1, equations::kMostProcesses + 1}) {
    EXPECT_THROW(elastic::ElasticModel(part.mesh, part.materials,
                                       part.load_cases, over(processes)),
                 InvalidInput);
  }
}

TEST(DistributedLimits, SupportsTooWeakAndInvertedElementsAreKnownBefore) {
  NEED_PETSC();
  Model part = oblique();
  part.load_cases[0].supports.pop_back();
  EXPECT_THROW(elastic::ElasticModel(part.mesh, part.materials, part.load_cases,
                                     over(2)),
               SolverError);
  part = four_nodes();
  std::swap(part.mesh.elements[0], part.mesh.elements[1]);
  EXPECT_THROW(elastic::ElasticModel(part.mesh, part.materials, part.load_cases,
                                     over(2)),
               MeshError);
}

/// What a solve says with `script` in the helper's place.
class BadHelper : public testing::Test {
 protected:
  void SetUp() override {
    if (!find_program("mpirun")) {
      MENISCUS_NOT_HERE("mpirun is not here: the package openmpi-bin");
    }
  }

  std::string write(const std::string& script) {
    const std::string path = (folder_ / "helper").string();
    std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
  }

  static void solve(const equations::ElasticOptions& options) {
    const Model part = oblique();
    elastic::ElasticModel(part.mesh, part.materials, part.load_cases, options);
  }

  template <class Wanted>
  static std::string message(const equations::ElasticOptions& options) {
    try {
      solve(options);
    } catch (const Wanted& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
  }

  TempFolder folder_;
};

TEST_F(BadHelper, MissingOnesAreNamedWithTheirPackages) {
  {
    const EnvironmentVariable variable("MENISCUS_PETSC", "/nowhere/petsc");
    EXPECT_THAT(message<IoError>(over(2)),
                testing::HasSubstr("MENISCUS_PETSC says '/nowhere/petsc'"));
  }
  const EnvironmentVariable variable("MENISCUS_PETSC", write("true"));
  const EnvironmentVariable path("PATH", "/nowhere");
  EXPECT_THAT(message<IoError>(over(2)), testing::HasSubstr("openmpi-bin"));
}

TEST_F(BadHelper, OneThatDiesIsAnErrorWithWhatItSaid) {
  {
    const EnvironmentVariable variable("MENISCUS_PETSC",
                                       write("kill -KILL $$"));
    EXPECT_THAT(message<SolverError>(over(2)), testing::HasSubstr("signal 9"));
  }
  {
    const EnvironmentVariable variable("MENISCUS_PETSC",
                                       write("echo no luck today >&2; exit 3"));
    EXPECT_THAT(message<SolverError>(over(2)),
                testing::HasSubstr("no luck today"));
  }
  const EnvironmentVariable variable("MENISCUS_PETSC", write("true"));
  EXPECT_THAT(message<SolverError>(over(2)),
              testing::HasSubstr("result_0 is missing"));
}

TEST_F(BadHelper, OneThatHangsEndsAtItsLimitOrOnRequest) {
  const EnvironmentVariable variable("MENISCUS_PETSC", write("exec sleep 60"));
  equations::ElasticOptions options = over(2);
  options.time_limit = 1.5;
  EXPECT_THAT(message<SolverError>(options), testing::HasSubstr("time limit"));
  class Stopper : public Monitor {
   public:
    bool stop_requested() const override { return true; }
  } stopper;
  options.monitor = &stopper;
  EXPECT_THROW(solve(options), Interrupted);
}

}  // namespace
}  // namespace meniscus::distributed_test
