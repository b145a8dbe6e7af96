#include "fea/modes/shifted_system.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/equations/elastic_checks.h"
#include "fea/solver/nodal_matrix.h"
#include "fea/stress/stress.h"
#include "fea/supports/held_check.h"

namespace meniscus {

namespace {

/// The shift in units of (speed of sound / size of the part)^2: of the order of
/// the lowest frequencies of a part that is not slender.
constexpr double kShift = 0.1;

double shift_of(const TetMesh& mesh, const std::vector<Material>& materials,
                const std::vector<ElasticLaw>& laws) {
  const double mass = mesh_mass(mesh, materials);
  double stiffest = 0.0;
  for (const ElasticLaw& law : laws) {
    stiffest = std::max(stiffest, law.stiffness.diagonal().maxCoeff());
  }
  Vec3 low = mesh.nodes[mesh.elements[0]];
  Vec3 high = low;
  for (const int node : mesh.elements) {
    low = low.cwiseMin(mesh.nodes[node]);
    high = high.cwiseMax(mesh.nodes[node]);
  }
  return kShift * stiffest * mesh_volume(mesh) /
         (mass * (high - low).squaredNorm());
}

}  // namespace

ShiftedSystem::ShiftedSystem(const TetMesh& mesh,
                             const std::vector<Material>& materials,
                             const LoadCase& held)
    : materials_(materials) {
  check_arrays(mesh);
  check_materials(mesh, materials);
  for (const Material& material : materials) {
    density_.push_back(material.density);
  }
  order_ = chunked_order(mesh);
  std::vector<int> elements;
  std::vector<int> region;
  for (const int e : order_.element) {
    for (const int node : mesh.element(e)) {
      elements.push_back(order_.to_solver[node]);
    }
    region.push_back(mesh.element_region[e]);
  }
  table_ = make_element_table(order_.chunks, mesh.nodes_per_element(), elements,
                              std::move(region));
  holding_ = make_holding(mesh, held, order_);
  std::vector<HeldDirection> directions = held_directions(mesh, held);
  motions_ = meniscus::free_motions(mesh, directions);
  const std::vector<HeldDirection> sprung = sprung_directions(mesh, held);
  directions.insert(directions.end(), sprung.begin(), sprung.end());
  unsprung_ = static_cast<int>(meniscus::free_motions(mesh, directions).cols());
  for (auto motion : motions_.colwise()) {
    motion = to_solver(order_, motion);
  }
  assemble_shifted(mesh, held);
  build_preconditioner(mesh, held);
}

void ShiftedSystem::assemble_shifted(const TetMesh& mesh,
                                     const LoadCase& held) {
  operator_ = {.table = &table_,
               .order = &order_,
               .preconditioner = nullptr,
               .materials = materials_,
               .K = {},
               .freedom = holding_.freedom,
               .x = {}};
  for (const int node : order_.to_mesh) {
    operator_.x.push_back(mesh.nodes[node]);
  }
  const std::vector<ElasticLaw> laws = elastic_laws(materials_);
  if (const auto bad = assemble(table_, operator_.x, laws, operator_.K)) {
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
    add_scaled(shift_, mass_matrix(table_, operator_.x, density_), operator_.K);
  }
  add_springs(table_.pattern, holding_.springs, operator_.K);
}

void ShiftedSystem::build_preconditioner(const TetMesh& mesh,
                                         const LoadCase& held) {
  if (free_unknowns(holding_) <= kFactorUnknowns) {
    preconditioner_ =
        make_direct(table_.pattern, operator_.K, holding_.freedom);
    operator_.preconditioner = preconditioner_.get();
    return;
  }
  smoother_ = make_smoother_matrix(operator_.K);
  MultigridInput input{
      .nodal = {&table_.pattern, &operator_.K, &smoother_, &operator_.x},
      .freedom = &holding_.freedom};
  BlockMatrix<double> coarse;
  if (mesh.order == 2) {
    corners_ = make_corner_mesh(mesh, order_);
    if (assemble(corners_.table, corners_.x, elastic_laws(materials_),
                 coarse)) {
      throw MeshError(
          "the straight-sided corners of an element enclose no "
          "positive volume; improve the mesh");
    }
    add_scaled(shift_, mass_matrix(corners_.table, corners_.x, density_),
               coarse);
    add_springs(corners_.table.pattern,
                corner_springs(mesh, held, order_, corners_.map), coarse);
    corner_smoother_ = make_smoother_matrix(coarse);
    input.fine_pattern = &table_.pattern;
    input.fine_matrix = &operator_.K;
    input.fine_smoother = &smoother_;
    input.map = &corners_.map;
    input.nodal = {&corners_.table.pattern, &coarse, &corner_smoother_,
                   &corners_.x};
  }
  preconditioner_ = make_multigrid(input);
  operator_.preconditioner = preconditioner_.get();
}

}  // namespace meniscus
