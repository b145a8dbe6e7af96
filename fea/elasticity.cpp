#include "fea/elasticity.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/elastic_system.h"

namespace meniscus {

struct ElasticModel::Impl {
  ElasticSystem system;
  std::vector<LoadCase> load_cases;
  ElasticSolution base;
};

ElasticModel::ElasticModel(const TetMesh& base,
                           const std::vector<Material>& materials,
                           std::vector<LoadCase> load_cases,
                           const ElasticOptions& options) {
  const Timer timer;
  BlockMatrix<double> matrix;
  ElasticSystem system(base, materials, load_cases, options, matrix);
  impl_.reset(new Impl{std::move(system), std::move(load_cases), {}});
  const double seconds = timer.seconds();
  impl_->base = impl_->system.solve(base, impl_->load_cases, matrix, nullptr);
  impl_->base.report.setup_seconds += seconds;
}

ElasticModel::~ElasticModel() = default;
ElasticModel::ElasticModel(ElasticModel&&) noexcept = default;
ElasticModel& ElasticModel::operator=(ElasticModel&&) noexcept = default;

const ElasticSolution& ElasticModel::base_solution() const {
  return impl_->base;
}

ElasticSolution ElasticModel::solve(const TetMesh& mesh) const {
  return solve(mesh, impl_->load_cases);
}

ElasticSolution ElasticModel::solve(
    const TetMesh& mesh, const std::vector<LoadCase>& load_cases) const {
  return solve(mesh, load_cases, nullptr);
}

ElasticSolution ElasticModel::solve(const TetMesh& mesh,
                                    const std::vector<LoadCase>& load_cases,
                                    ElasticState* keep) const {
  const Timer timer;
  if (keep != nullptr) {
    keep->kept_.reset();
  }
  impl_->system.check_same(mesh, load_cases);
  BlockMatrix<double> matrix;
  ElasticSolution result;
  if (auto failure = impl_->system.assemble(mesh, matrix)) {
    result.report = impl_->base.report;
    result.failure = std::move(failure);
    return result;
  }
  const double seconds = timer.seconds();
  result = impl_->system.solve(mesh, load_cases, matrix, &impl_->base);
  result.report.setup_seconds += seconds;
  if (keep != nullptr && !result.failure) {
    keep->kept_ = std::make_unique<KeptState>(
        impl_->system.keep(mesh, load_cases, std::move(matrix)));
  }
  return result;
}

AdjointSolution ElasticModel::solve_adjoint(
    const ElasticState& state, int load_case,
    const std::vector<VectorX>& right_hand_sides) const {
  if (state.empty()) {
    throw InvalidInput(
        "adjoint of elasticity: the state is empty; keep that of a solve that "
        "did not fail");
  }
  return meniscus::solve_adjoint(*state.kept_, load_case, right_hand_sides);
}

ElasticOperator ElasticModel::operator_at(
    const TetMesh& mesh, const std::vector<LoadCase>& load_cases,
    int load_case) const {
  impl_->system.check_same(mesh, load_cases);
  return impl_->system.operator_at(mesh, load_cases, load_case);
}

}  // namespace meniscus
