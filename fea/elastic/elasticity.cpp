#include "fea/elastic/elasticity.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/distributed/distributed_system.h"
#include "fea/equations/elastic_system.h"
#include "fea/solver/preconditioner.h"

namespace meniscus::elastic {

struct ElasticModel::Impl {
  std::optional<equations::ElasticSystem> system;  // one of the two
  std::optional<distributed::DistributedSystem> distributed;
  std::vector<loads::LoadCase> load_cases;
  equations::ElasticSolution base;

  const equations::ElasticBase& input() const {
    return system ? system->base() : distributed->base();
  }
};

ElasticModel::ElasticModel(const TetMesh& base,
                           const std::vector<element::Material>& materials,
                           std::vector<loads::LoadCase> load_cases,
                           const equations::ElasticOptions& options)
    : impl_(std::make_unique<Impl>()) {
  const Timer timer;
  impl_->load_cases = std::move(load_cases);
  const std::vector<loads::LoadCase>& cases = impl_->load_cases;
  double seconds = 0.0;
  if (options.solver == equations::SolverKind::Distributed) {
    impl_->distributed.emplace(base, materials, cases, options);
    seconds = timer.seconds();
    impl_->base = impl_->distributed->solve(
        base, cases, impl_->distributed->base().regions, nullptr);
  } else {
    const auto solve_by = [&](const equations::ElasticOptions& chosen) {
      solver::BlockMatrix<double> matrix;
      impl_->system.emplace(base, materials, cases, chosen, matrix);
      seconds = timer.seconds();
      impl_->base = impl_->system->solve(
          base, cases, impl_->system->base().regions, matrix, nullptr);
    };
    solve_by(options);
    // Multigrid comes to a halt, or is slow, where walls are thin, material is
    // nearly incompressible, or springs hardly hold: the model goes on with a
    // factor, which serves the designs to come as well.
    if ((impl_->base.failure ||
         impl_->base.report.solver == "cholmod after multigrid") &&
        impl_->base.report.solver != "cholmod" &&
        options.solver == equations::SolverKind::Automatic &&
        impl_->base.report.dofs <= solver::kSecondChance) {
      equations::ElasticOptions factor = options;
      factor.solver = equations::SolverKind::Cholesky;
      solve_by(factor);
    }
  }
  impl_->base.report.setup_seconds += seconds;
}

ElasticModel::~ElasticModel() = default;
ElasticModel::ElasticModel(ElasticModel&&) noexcept = default;
ElasticModel& ElasticModel::operator=(ElasticModel&&) noexcept = default;

const equations::ElasticSolution& ElasticModel::base_solution() const {
  return impl_->base;
}

equations::ElasticSolution ElasticModel::solve(const TetMesh& mesh) const {
  return solve(mesh, impl_->load_cases);
}

equations::ElasticSolution ElasticModel::solve(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases) const {
  return solve(mesh, load_cases, nullptr);
}

equations::ElasticSolution ElasticModel::solve(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    equations::ElasticState* keep) const {
  return solve(mesh, load_cases, impl_->input().regions.materials, keep);
}

equations::ElasticSolution ElasticModel::solve(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    const std::vector<element::Material>& materials,
    equations::ElasticState* keep) const {
  const Timer timer;
  if (keep != nullptr) {
    keep->kept_.reset();
  }
  impl_->input().check_same(mesh, load_cases);
  equations::RegionMaterials regions =
      impl_->input().of_design(mesh, materials);
  if (impl_->distributed) {
    if (keep != nullptr) {
      throw InvalidInput(
          "elasticity: the solver petsc keeps its matrix in other processes; "
          "exact gradients need another solver");
    }
    return impl_->distributed->solve(mesh, load_cases, regions, &impl_->base);
  }
  const equations::ElasticSystem& system = *impl_->system;
  solver::BlockMatrix<double> matrix;
  equations::ElasticSolution result;
  if (auto failure = system.assemble(mesh, regions.laws, matrix)) {
    result.report = impl_->base.report;
    result.failure = std::move(failure);
    return result;
  }
  const double seconds = timer.seconds();
  std::vector<equations::SolvedGroup> solved;
  result =
      system.solve(mesh, load_cases, regions, matrix, &impl_->base, &solved);
  result.report.setup_seconds += seconds;
  if (keep != nullptr && !result.failure) {
    keep->kept_ = std::make_unique<equations::KeptState>(
        system.keep(mesh, load_cases, std::move(regions.laws),
                    std::move(matrix), std::move(solved)));
  }
  return result;
}

equations::AdjointSolution ElasticModel::solve_adjoint(
    const equations::ElasticState& state, int load_case,
    const std::vector<VectorX>& right_hand_sides) const {
  return solve_adjoints(state,
                        std::vector<int>(right_hand_sides.size(), load_case),
                        right_hand_sides);
}

equations::AdjointSolution ElasticModel::solve_adjoints(
    const equations::ElasticState& state, const std::vector<int>& load_cases,
    const std::vector<VectorX>& right_hand_sides) const {
  if (state.empty()) {
    throw InvalidInput(
        "adjoint of elasticity: the state is empty; keep that of a solve that "
        "did not fail");
  }
  return meniscus::equations::solve_adjoints(*state.kept_, load_cases,
                                             right_hand_sides);
}

equations::ElasticOperator ElasticModel::operator_at(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    int load_case, const std::vector<element::Material>* materials) const {
  impl_->input().check_same(mesh, load_cases);
  if (impl_->distributed) {
    throw InvalidInput(
        "elasticity: the solver petsc keeps its matrix in other processes; "
        "natural frequencies and buckling factors need another solver");
  }
  return impl_->system->operator_at(mesh, load_cases, load_case, materials);
}

}  // namespace meniscus::elastic
