#include "fea/equations/elastic_base.h"

#include <algorithm>

#include <fmt/format.h>

#include "fea/equations/elastic_checks.h"
#include "fea/equations/elastic_operator.h"
#include "fea/equations/equilibrium_check.h"

namespace meniscus::equations {

namespace {

std::string cause(solver::CgEnd end, const solver::CgColumn& column, int most) {
  switch (end) {
    case solver::CgEnd::TooManyIterations:
      return fmt::format(
          "no convergence in {} iterations (relative error {:.2e}): the "
          "design is too far from the base design, the material too nearly "
          "incompressible, or elements are badly shaped",
          most, column.error);
    case solver::CgEnd::NotPositive:
      return "the stiffness matrix is not positive definite: the supports are "
             "too weak or an element is inverted";
    default:
      return "the solution is not finite: check loads, material and node "
             "positions";
  }
}

/// What a design may not change.
std::vector<loads::Support> without_numbers(
    std::vector<loads::Support> supports) {
  for (loads::Support& support : supports) {
    support.displacement.reset();
  }
  return supports;
}

std::vector<loads::RigidPin> without_numbers(
    std::vector<loads::RigidPin> pins) {
  for (loads::RigidPin& pin : pins) {
    pin.point.setZero();
    pin.displacement.reset();
    pin.rotation.reset();
  }
  return pins;
}

loads::LoadCase only_holds(const loads::LoadCase& load_case) {
  loads::LoadCase held;
  held.supports = without_numbers(load_case.supports);
  held.held_nodes = load_case.held_nodes;
  for (loads::HeldNode& node : held.held_nodes) {
    node.displacement = 0.0;
  }
  held.springs = load_case.springs;
  held.node_springs = load_case.node_springs;
  held.pins = without_numbers(load_case.pins);
  return held;
}

bool held_alike(const loads::LoadCase& a, const loads::LoadCase& b) {
  return a.supports == b.supports && a.held_nodes == b.held_nodes &&
         a.springs == b.springs && a.node_springs == b.node_springs &&
         a.pins == b.pins;
}

}  // namespace

ElasticBase::ElasticBase(const TetMesh& mesh,
                         const std::vector<element::Material>& given,
                         const std::vector<loads::LoadCase>& load_cases,
                         const ElasticOptions& chosen)
    : options(chosen), elements(mesh.elements), faces(mesh.faces) {
  check_arrays(mesh);
  check_memory(mesh, options.solver);
  element::check_materials(mesh, given);
  if (load_cases.empty()) {
    throw InvalidInput("elasticity: no load case is given");
  }
  if (!(options.tolerance > 0.0) || options.max_iterations < 1) {
    throw InvalidInput(fmt::format(
        "elasticity: tolerance is {} and max_iterations {}; both must be above "
        "0",
        options.tolerance, options.max_iterations));
  }
  regions = {given, element::elastic_laws(given)};
  if (!std::all_of(mesh.nodes.begin(), mesh.nodes.end(),
                   [](const Vec3& x) { return x.allFinite(); })) {
    throw MeshError("elasticity: a node position of the mesh is not finite");
  }
  for (const loads::LoadCase& load_case : load_cases) {
    held.push_back(only_holds(load_case));
    checked_forces(mesh, load_case, given);
  }
}

void ElasticBase::check_same(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases) const {
  if (mesh.elements != elements || mesh.faces != faces ||
      mesh.nodes.size() != order.to_mesh.size()) {
    throw InvalidInput(fmt::format(
        "elasticity: the mesh ({} nodes, {} elements) is not a moved copy of "
        "the base mesh ({} nodes)",
        mesh.nodes.size(), mesh.element_count(), order.to_mesh.size()));
  }
  if (load_cases.size() != held.size()) {
    throw InvalidInput(
        fmt::format("elasticity: {} load cases, but the base design has {}",
                    load_cases.size(), held.size()));
  }
  for (std::size_t c = 0; c < load_cases.size(); ++c) {
    if (!held_alike(only_holds(load_cases[c]), held[c])) {
      throw InvalidInput(fmt::format(
          "load case '{}': its supports differ from the base design's; build "
          "a new model for them",
          load_cases[c].name));
    }
  }
}

Points ElasticBase::solver_points(const TetMesh& mesh) const {
  Points x;
  x.reserve(mesh.nodes.size());
  for (const int node : order.to_mesh) {
    x.push_back(mesh.nodes[node]);
  }
  return x;
}

std::vector<VectorX> ElasticBase::solver_forces(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    const std::vector<element::Material>& materials) const {
  std::vector<VectorX> f;
  f.reserve(load_cases.size());
  for (const loads::LoadCase& load_case : load_cases) {
    f.push_back(to_solver(order, checked_forces(mesh, load_case, materials)));
  }
  return f;
}

RegionMaterials ElasticBase::of_design(
    const TetMesh& mesh,
    const std::vector<element::Material>& materials) const {
  element::check_materials(mesh, materials);
  if (materials.size() != regions.materials.size()) {
    throw InvalidInput(
        fmt::format("elasticity: {} materials, but the base design has {}",
                    materials.size(), regions.materials.size()));
  }
  return {materials, element::elastic_laws(materials)};
}

std::vector<int> ElasticBase::solver_elements(const TetMesh& mesh) const {
  std::vector<int> result;
  result.reserve(mesh.elements.size());
  for (const int e : order.element) {
    for (const int node : mesh.element(e)) {
      result.push_back(order.to_solver[node]);
    }
  }
  return result;
}

std::vector<int> ElasticBase::solver_regions(const TetMesh& mesh) const {
  std::vector<int> result;
  result.reserve(mesh.element_region.size());
  for (const int e : order.element) {
    result.push_back(mesh.element_region[e]);
  }
  return result;
}

std::optional<Failure> ElasticBase::bad_node(const TetMesh& mesh) const {
  const auto place = std::find_if(mesh.nodes.begin(), mesh.nodes.end(),
                                  [](const Vec3& p) { return !p.allFinite(); });
  if (place == mesh.nodes.end()) {
    return std::nullopt;
  }
  return Failure{FailureKind::NotANumber,
                 fmt::format("node {} of the mesh is not finite",
                             place - mesh.nodes.begin())};
}

Failure ElasticBase::inverted(const TetMesh& mesh, int element) const {
  const int e = order.element[element];
  const Vec3& at = mesh.nodes[mesh.element(e)[0]];
  return {
      FailureKind::ElementsInverted,
      fmt::format("element {} at ({:.4g}, {:.4g}, {:.4g}) is inverted or flat: "
                  "its Jacobian determinant is not positive",
                  e, at.x(), at.y(), at.z())};
}

Failure ElasticBase::turned(const loads::LoadCase& load_case) {
  return {FailureKind::SolverFailed,
          fmt::format("load case '{}': the directions in which its supports "
                      "hold the nodes are no longer the base design's: the "
                      "surfaces have turned against each other",
                      load_case.name)};
}

std::vector<HeldCases> group_alike(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    const solver::NodeOrder& order) {
  std::vector<HeldCases> groups;
  for (std::size_t c = 0; c < load_cases.size(); ++c) {
    supports::check_restraints(mesh, load_cases[c]);
    supports::Restraints restraints =
        supports::make_restraints(mesh, load_cases[c], order);
    const auto found = std::find_if(
        groups.begin(), groups.end(),
        [&](const HeldCases& g) { return g.restraints == restraints; });
    if (found != groups.end()) {
      found->cases.push_back(static_cast<int>(c));
    } else {
      groups.push_back({{static_cast<int>(c)}, std::move(restraints)});
    }
  }
  return groups;
}

void finish_solution(const ElasticBase& base, const solver::ElementTable& table,
                     const SolvedCase& solved, ElasticSolution& result) {
  const int c = solved.load_case;
  const ElasticOptions& options = base.options;
  const VectorX internal =
      solver::internal_forces(table, solved.x, solved.laws, solved.u);
  const Equilibrium equilibrium = check_equilibrium(
      {solved.x, solved.f, internal,
       supports::spring_forces(solved.restraints.springs, solved.u), solved.u,
       solved.restraints, solved.diagonal, solved.enforced});
  result.displacements[c] = to_mesh(base.order, solved.u);
  result.reactions[c] = to_mesh(base.order, equilibrium.reactions);
  ElasticReport& report = result.report;
  report.iterations = solved.column.iterations;
  report.residual = std::max(report.residual, equilibrium.residual);
  report.reaction_imbalance =
      std::max(report.reaction_imbalance, equilibrium.imbalance);
  if (c == 0) {
    report.strain_energy = equilibrium.energy;
  }
  if (result.failure) {
    return;
  }
  if (solved.column.end != solver::CgEnd::Converged) {
    result.failure = Failure{FailureKind::SolverFailed,
                             fmt::format("load case '{}': {}", solved.name,
                                         cause(solved.column.end, solved.column,
                                               options.max_iterations))};
  } else {
    result.failure =
        check_residual(equilibrium, options.tolerance, solved.name);
  }
}

}  // namespace meniscus::equations
