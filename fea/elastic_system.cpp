#include "fea/elastic_system.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/body_loads.h"
#include "fea/conjugate_gradients.h"
#include "fea/corner_mesh.h"
#include "fea/elastic_checks.h"
#include "fea/equilibrium_check.h"

namespace meniscus {

namespace {

std::string cause(CgEnd end, const CgColumn& column, int most) {
  switch (end) {
    case CgEnd::TooManyIterations:
      return fmt::format(
          "no convergence in {} iterations (relative error {:.2e}): the "
          "design is too far from the base design, the material too nearly "
          "incompressible, or elements are badly shaped",
          most, column.error);
    case CgEnd::NotPositive:
      return "the stiffness matrix is not positive definite: the supports are "
             "too weak or an element is inverted";
    default:
      return "the solution is not finite: check loads, material and node "
             "positions";
  }
}

}  // namespace

ElasticSystem::ElasticSystem(const TetMesh& base,
                             const std::vector<Material>& materials,
                             const std::vector<LoadCase>& load_cases,
                             const ElasticOptions& options,
                             BlockMatrix<double>& matrix)
    : options_(options),
      elements_(base.elements),
      faces_(base.faces),
      shared_(std::make_unique<Shared>()) {
  check_arrays(base);
  check_memory(base);
  check_materials(base, materials);
  if (load_cases.empty()) {
    throw InvalidInput("elasticity: no load case is given");
  }
  if (!(options.tolerance > 0.0) || options.max_iterations < 1) {
    throw InvalidInput(fmt::format(
        "elasticity: tolerance is {} and max_iterations {}; both must be above "
        "0",
        options.tolerance, options.max_iterations));
  }
  materials_ = materials;
  laws_ = elastic_laws(materials);
  if (!std::all_of(base.nodes.begin(), base.nodes.end(),
                   [](const Vec3& x) { return x.allFinite(); })) {
    throw MeshError("elasticity: a node position of the mesh is not finite");
  }
  for (const LoadCase& load_case : load_cases) {
    supports_.push_back(load_case.supports);
    springs_.push_back(load_case.springs);
    checked_forces(base, load_case, materials);
  }
  order_mesh(base);
  group_supports(base, load_cases);
  if (const auto failure = assemble(base, matrix)) {
    throw MeshError(failure->message);
  }
  build_preconditioners(base, load_cases, matrix);
}

void ElasticSystem::order_mesh(const TetMesh& base) {
  order_ = chunked_order(base);
  std::vector<int> elements;
  std::vector<int> region;
  elements.reserve(base.elements.size());
  region.reserve(base.element_region.size());
  for (const int e : order_.element) {
    for (const int node : base.element(e)) {
      elements.push_back(order_.to_solver[node]);
    }
    region.push_back(base.element_region[e]);
  }
  shared_->table = make_element_table(order_.chunks, base.nodes_per_element(),
                                      elements, std::move(region));
}

void ElasticSystem::group_supports(const TetMesh& base,
                                   const std::vector<LoadCase>& load_cases) {
  for (std::size_t c = 0; c < load_cases.size(); ++c) {
    check_holding(base, load_cases[c]);
    Holding holding = make_holding(base, load_cases[c], order_);
    const auto found =
        std::find_if(groups_.begin(), groups_.end(),
                     [&](const Group& g) { return g.holding == holding; });
    if (found != groups_.end()) {
      found->cases.push_back(static_cast<int>(c));
    } else {
      groups_.push_back(
          {.cases = {static_cast<int>(c)}, .holding = std::move(holding)});
    }
  }
}

void ElasticSystem::build_preconditioners(
    const TetMesh& base, const std::vector<LoadCase>& load_cases,
    const BlockMatrix<double>& matrix) {
  multigrid_ = options_.solver == SolverKind::Multigrid ||
               (options_.solver == SolverKind::Automatic &&
                free_unknowns(groups_.front().holding) > kFactorUnknowns);
  if (multigrid_) {
    return build_multigrid(base, load_cases, matrix);
  }
  const BlockPattern& pattern = shared_->table.pattern;
  for (Group& group : groups_) {
    const Holding& holding = group.holding;
    group.preconditioner =
        holding.springs.at.empty()
            ? make_direct(pattern, matrix, holding.freedom)
            : make_direct(pattern,
                          sprung_matrix(pattern, matrix, holding.springs),
                          holding.freedom);
  }
}

CornerMesh ElasticSystem::build_corners(const TetMesh& base,
                                        BlockMatrix<double>& matrix) {
  CornerMesh corners = make_corner_mesh(base, order_);
  if (const auto bad =
          meniscus::assemble(corners.table, corners.x, laws_, matrix)) {
    throw MeshError(fmt::format(
        "element {}: its straight-sided corners enclose no positive volume; "
        "improve the mesh or choose the Cholesky solver",
        corners.element[*bad]));
  }
  shared_->map = std::move(corners.map);
  shared_->corner_pattern = corners.table.pattern;
  shared_->corner_smoother = make_smoother_matrix(matrix);
  return corners;
}

void ElasticSystem::build_multigrid(const TetMesh& base,
                                    const std::vector<LoadCase>& load_cases,
                                    const BlockMatrix<double>& matrix) {
  const bool ten_nodes = base.order == 2;
  shared_->smoother = make_smoother_matrix(matrix);
  BlockMatrix<double> coarse;
  const Points x =
      ten_nodes ? build_corners(base, coarse).x : solver_points(base);
  const BlockPattern& pattern = shared_->table.pattern;
  for (Group& group : groups_) {
    const SpringBlocks& springs = group.holding.springs;
    const BlockMatrix<double>* fine = &matrix;
    const BlockMatrix<double>* corner = &coarse;
    BlockMatrix<double> sprung;
    BlockMatrix<double> sprung_corner;
    if (!springs.at.empty()) {
      sprung = sprung_matrix(pattern, matrix, springs);
      fine = &sprung;
      group.smoother =
          std::make_unique<SmootherMatrix>(make_smoother_matrix(sprung));
    }
    if (!springs.at.empty() && ten_nodes) {
      sprung_corner =
          sprung_matrix(shared_->corner_pattern, coarse,
                        corner_springs(base, load_cases[group.cases.front()],
                                       order_, shared_->map));
      corner = &sprung_corner;
      group.corner_smoother =
          std::make_unique<SmootherMatrix>(make_smoother_matrix(sprung_corner));
    }
    const SmootherMatrix* smoother =
        group.smoother ? group.smoother.get() : &shared_->smoother;
    const SmootherMatrix* corner_smoother = group.corner_smoother
                                                ? group.corner_smoother.get()
                                                : &shared_->corner_smoother;
    MultigridInput input{.nodal = {&pattern, fine, smoother, &x},
                         .freedom = &group.holding.freedom};
    if (ten_nodes) {
      input.nodal = {&shared_->corner_pattern, corner, corner_smoother, &x};
      input.fine_pattern = &pattern;
      input.fine_matrix = fine;
      input.fine_smoother = smoother;
      input.map = &shared_->map;
    }
    group.preconditioner = make_multigrid(input);
  }
}

void ElasticSystem::check_same(const TetMesh& mesh,
                               const std::vector<LoadCase>& load_cases) const {
  if (mesh.elements != elements_ || mesh.faces != faces_ ||
      mesh.nodes.size() != order_.to_mesh.size()) {
    throw InvalidInput(fmt::format(
        "elasticity: the mesh ({} nodes, {} elements) is not a moved copy of "
        "the base mesh ({} nodes)",
        mesh.nodes.size(), mesh.element_count(), order_.to_mesh.size()));
  }
  if (load_cases.size() != supports_.size()) {
    throw InvalidInput(
        fmt::format("elasticity: {} load cases, but the base design has {}",
                    load_cases.size(), supports_.size()));
  }
  for (std::size_t c = 0; c < load_cases.size(); ++c) {
    if (load_cases[c].supports != supports_[c] ||
        load_cases[c].springs != springs_[c]) {
      throw InvalidInput(fmt::format(
          "load case '{}': its supports differ from the base design's; build "
          "a new model for them",
          load_cases[c].name));
    }
  }
}

Points ElasticSystem::solver_points(const TetMesh& mesh) const {
  Points x;
  x.reserve(mesh.nodes.size());
  for (const int node : order_.to_mesh) {
    x.push_back(mesh.nodes[node]);
  }
  return x;
}

VectorX ElasticSystem::to_solver(const VectorX& v) const {
  return meniscus::to_solver(order_, v);
}

VectorX ElasticSystem::to_mesh(const VectorX& v) const {
  return meniscus::to_mesh(order_, v);
}

std::optional<Failure> ElasticSystem::assemble(
    const TetMesh& mesh, BlockMatrix<double>& matrix) const {
  const Points x = solver_points(mesh);
  const auto place = std::find_if(x.begin(), x.end(),
                                  [](const Vec3& p) { return !p.allFinite(); });
  if (place != x.end()) {
    return Failure{FailureKind::NotANumber,
                   fmt::format("node {} of the mesh is not finite",
                               order_.to_mesh[place - x.begin()])};
  }
  const auto bad = meniscus::assemble(shared_->table, x, laws_, matrix);
  if (!bad) {
    return std::nullopt;
  }
  const int e = order_.element[*bad];
  const Vec3& at = mesh.nodes[mesh.element(e)[0]];
  return Failure{
      FailureKind::ElementsInverted,
      fmt::format("element {} at ({:.4g}, {:.4g}, {:.4g}) is inverted or flat: "
                  "its Jacobian determinant is not positive",
                  e, at.x(), at.y(), at.z())};
}

ElasticSolution ElasticSystem::solve(const TetMesh& mesh,
                                     const std::vector<LoadCase>& load_cases,
                                     const BlockMatrix<double>& matrix,
                                     const ElasticSolution* start) const {
  const Timer timer;
  ElasticSolution result;
  result.displacements.resize(load_cases.size());
  result.reactions.resize(load_cases.size());
  result.report.solver = !multigrid_       ? "cholmod"
                         : mesh.order == 1 ? "multigrid"
                                           : "p-multigrid";
  result.report.dofs = free_unknowns(groups_.front().holding);
  std::vector<VectorX> f;
  f.reserve(load_cases.size());
  for (const LoadCase& load_case : load_cases) {
    f.push_back(to_solver(checked_forces(mesh, load_case, materials_)));
  }
  const Points x = solver_points(mesh);
  for (const Group& group : groups_) {
    const Holding holding =
        start == nullptr
            ? group.holding
            : make_holding(mesh, load_cases[group.cases.front()], order_);
    if (!alike(holding, group.holding)) {
      result.failure = Failure{
          FailureKind::SolverFailed,
          fmt::format("load case '{}': the directions in which its supports "
                      "hold the nodes are no longer the base design's: the "
                      "surfaces have turned against each other",
                      load_cases[group.cases.front()].name)};
      return result;
    }
    const bool plain = holding.springs.at.empty();
    const BlockMatrix<double> sprung =
        plain ? BlockMatrix<double>{}
              : sprung_matrix(shared_->table.pattern, matrix, holding.springs);
    for (std::size_t first = 0; first < group.cases.size();
         first += kMostColumns) {
      const std::size_t last =
          std::min(first + kMostColumns, group.cases.size());
      solve_columns(group, holding,
                    {group.cases.begin() + static_cast<std::ptrdiff_t>(first),
                     group.cases.begin() + static_cast<std::ptrdiff_t>(last)},
                    x, f, load_cases, plain ? matrix : sprung, start, result);
    }
  }
  if (!result.failure && load_cases[0].temperature) {
    result.report.strain_energy =
        strain_energy(mesh, materials_, result.displacements[0],
                      temperature_change(mesh, load_cases[0]));
  }
  result.report.solve_seconds = timer.seconds();
  return result;
}

void ElasticSystem::solve_columns(
    const Group& group, const Holding& holding, const std::vector<int>& cases,
    const Points& x, const std::vector<VectorX>& f,
    const std::vector<LoadCase>& load_cases, const BlockMatrix<double>& matrix,
    const ElasticSolution* start, ElasticSolution& result) const {
  Monitor& monitor =
      options_.monitor != nullptr ? *options_.monitor : silent_monitor();
  std::vector<VectorX> right;
  std::vector<VectorX> u;
  for (const int c : cases) {
    right.push_back(f[c]);
    u.push_back(start != nullptr && !start->failure
                    ? to_solver(start->displacements[c])
                    : VectorX(VectorX::Zero(f[c].size())));
  }
  const auto solve_with = [&](const Preconditioner& preconditioner) {
    return conjugate_gradients({.pattern = shared_->table.pattern,
                                .matrix = matrix,
                                .preconditioner = preconditioner,
                                .freedom = holding.freedom,
                                .tolerance = options_.tolerance,
                                .max_iterations = options_.max_iterations,
                                .monitor = monitor},
                               right, u);
  };
  std::vector<CgColumn> columns = solve_with(*group.preconditioner);
  const bool lost = std::any_of(
      columns.begin(), columns.end(),
      [](const CgColumn& column) { return column.end == CgEnd::NotPositive; });
  if (lost && multigrid_ && free_unknowns(holding) <= kSecondChance) {
    // Single precision is lost on supports that hardly hold.
    for (VectorX& v : u) {
      v.setZero();
    }
    columns = solve_with(
        *make_direct(shared_->table.pattern, matrix, holding.freedom));
    result.report.solver = "cholmod after multigrid";
  }
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const int c = cases[k];
    const VectorX internal = internal_forces(shared_->table, x, laws_, u[k]);
    const Equilibrium equilibrium = check_equilibrium(
        {x, f[c], internal, spring_forces(holding.springs, u[k]), u[k],
         holding.freedom, matrix});
    result.displacements[c] = to_mesh(u[k]);
    result.reactions[c] = to_mesh(equilibrium.reactions);
    ElasticReport& report = result.report;
    report.iterations = columns[k].iterations;
    report.residual = std::max(report.residual, equilibrium.residual);
    report.reaction_imbalance =
        std::max(report.reaction_imbalance, equilibrium.imbalance);
    if (c == 0) {
      report.strain_energy = equilibrium.energy;
    }
    if (result.failure) {
      continue;
    }
    if (columns[k].end != CgEnd::Converged) {
      result.failure = Failure{
          FailureKind::SolverFailed,
          fmt::format(
              "load case '{}': {}", load_cases[c].name,
              cause(columns[k].end, columns[k], options_.max_iterations))};
    } else {
      result.failure =
          judge(equilibrium, options_.tolerance, load_cases[c].name);
    }
  }
}

}  // namespace meniscus
