#include "fea/modes/shifted_system.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/equations/elastic_checks.h"
#include "fea/solver/nodal_matrix.h"
#include "fea/stress/stress.h"
#include "fea/supports/held_check.h"

namespace meniscus::modes {

namespace {

/// The shift in units of (speed of sound / size of the part)^2: of the order of
/// the lowest frequencies of a part that is not slender.
constexpr double kShift = 0.1;

double shift_of(const TetMesh& mesh,
                const std::vector<element::Material>& materials,
                const std::vector<element::ElasticLaw>& laws) {
  const double mass = stress::mesh_mass(mesh, materials);
  double stiffest = 0.0;
  for (const element::ElasticLaw& law : laws) {
    stiffest = std::max(stiffest, law.stiffness.diagonal().maxCoeff());
  }
  Vec3 low = mesh.nodes[mesh.elements[0]];
  Vec3 high = low;
  for (const int node : mesh.elements) {
    low = low.cwiseMin(mesh.nodes[node]);
    high = high.cwiseMax(mesh.nodes[node]);
  }
  return kShift * stiffest * stress::mesh_volume(mesh) /
         (mass * (high - low).squaredNorm());
}

}  // namespace

ShiftedSystem::ShiftedSystem(const TetMesh& mesh,
                             const std::vector<element::Material>& materials,
                             const loads::LoadCase& held)
    : materials_(materials) {
  equations::check_arrays(mesh);
  element::check_materials(mesh, materials);
  for (const element::Material& material : materials) {
    density_.push_back(material.density);
  }
  order_ = solver::chunked_order(mesh);
  std::vector<int> elements;
  std::vector<int> region;
  for (const int e : order_.element) {
    for (const int node : mesh.element(e)) {
      elements.push_back(order_.to_solver[node]);
    }
    region.push_back(mesh.element_region[e]);
  }
  table_ = solver::make_element_table(order_.chunks, mesh.nodes_per_element(),
                                      elements, std::move(region));
  restraints_ = supports::make_restraints(mesh, held, order_);
  std::vector<supports::HeldDirection> directions =
      supports::held_directions(mesh, held);
  motions_ = meniscus::supports::free_motions(mesh, directions);
  const std::vector<supports::HeldDirection> sprung =
      supports::sprung_directions(mesh, held);
  directions.insert(directions.end(), sprung.begin(), sprung.end());
  unsprung_ = static_cast<int>(
      meniscus::supports::free_motions(mesh, directions).cols());
  for (auto motion : motions_.colwise()) {
    motion = equations::to_solver(order_, motion);
  }
  assemble_shifted(mesh, held);
  build_preconditioner(mesh, held);
}

void ShiftedSystem::assemble_shifted(const TetMesh& mesh,
                                     const loads::LoadCase& held) {
  operator_ = {.table = &table_,
               .order = &order_,
               .preconditioner = nullptr,
               .materials = materials_,
               .K = {},
               .freedom = restraints_.freedom,
               .x = {}};
  for (const int node : order_.to_mesh) {
    operator_.x.push_back(mesh.nodes[node]);
  }
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials_);
  if (const auto bad =
          solver::assemble(table_, operator_.x, laws, operator_.K)) {
    throw MeshError(
        fmt::format("element {} is inverted or flat: its Jacobian determinant "
                    "is not positive",
                    order_.element[*bad]));
  }
  if (motions_.cols() > 0) {
    shift_ = shift_of(mesh, materials_, laws);
    if (!std::isfinite(shift_)) {
      throw InvalidInput(
          fmt::format("load case '{}': natural frequencies need a density; "
                      "give one to every material",
                      held.name));
    }
    solver::add_scaled(shift_,
                       solver::mass_matrix(table_, operator_.x, density_),
                       operator_.K);
  }
  supports::add_springs(table_.pattern, restraints_.springs, operator_.K);
}

void ShiftedSystem::build_preconditioner(const TetMesh& mesh,
                                         const loads::LoadCase& held) {
  if (supports::free_unknowns(restraints_) <= solver::kFactorUnknowns) {
    preconditioner_ =
        solver::make_direct(table_.pattern, operator_.K, restraints_.freedom);
    operator_.preconditioner = preconditioner_.get();
    return;
  }
  smoother_ = solver::make_smoother_matrix(operator_.K);
  solver::MultigridInput input{
      .nodal = {&table_.pattern, &operator_.K, &smoother_, &operator_.x},
      .freedom = &restraints_.freedom};
  solver::BlockMatrix<double> coarse;
  if (mesh.order == 2) {
    corners_ = solver::make_corner_mesh(mesh, order_);
    if (solver::assemble(corners_.table, corners_.x,
                         element::elastic_laws(materials_), coarse)) {
      throw MeshError(
          "the straight-sided corners of an element enclose no "
          "positive volume; improve the mesh");
    }
    solver::add_scaled(
        shift_, solver::mass_matrix(corners_.table, corners_.x, density_),
        coarse);
    supports::add_springs(
        corners_.table.pattern,
        supports::corner_springs(mesh, held, order_, corners_.map), coarse);
    corner_smoother_ = solver::make_smoother_matrix(coarse);
    input.fine_pattern = &table_.pattern;
    input.fine_matrix = &operator_.K;
    input.fine_smoother = &smoother_;
    input.map = &corners_.map;
    input.nodal = {&corners_.table.pattern, &coarse, &corner_smoother_,
                   &corners_.x};
  }
  preconditioner_ = solver::make_multigrid(input);
  operator_.preconditioner = preconditioner_.get();
}

}  // namespace meniscus::modes
