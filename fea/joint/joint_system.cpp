#include "fea/joint/joint_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/equations/elastic_checks.h"
#include "fea/joint/joint_held.h"
#include "fea/supports/supports.h"

namespace meniscus::joint {

namespace {

/// Facets whose matrices are held at once.
constexpr int kBatch = 1024;

using Triplet = Eigen::Triplet<double, int>;

std::vector<int> row_numbers(const std::vector<TieRow>& rows,
                             std::size_t nodes) {
  std::vector<int> numbers(nodes, -1);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    numbers[rows[k].node] = static_cast<int>(k);
  }
  return numbers;
}

/// Those at tied nodes make way for the tie, which leaves one turn free.
std::vector<shell::NodeSupport> with_tied(
    const std::vector<shell::NodeSupport>& supports, const EdgeTie& tie,
    const std::vector<int>& row_of) {
  std::vector<shell::NodeSupport> result;
  for (const shell::NodeSupport& support : supports) {
    if (row_of.at(support.node) < 0) {
      result.push_back(support);
    }
  }
  for (const TiedNode& node : tie.nodes) {
    result.push_back(
        {.node = node.node,
         .held = {true, true, true, true, true, false},
         .axes = element::LocalAxes{node.axes.col(0), node.axes.col(1)}});
  }
  return result;
}

}  // namespace

/// One unknown of a node's six numbers.
struct JointSystem::Column {
  int unknown = 0;
  shell::Six by;
};

JointSystem::JointSystem(const TetMesh& solid,
                         const std::vector<element::Material>& materials,
                         const loads::LoadCase& held,
                         const shell::ShellMesh& mesh,
                         const std::vector<shell::Section>& sections,
                         const std::vector<shell::NodeSupport>& supports,
                         const EdgeTie& tie)
    : solid_(solid),
      mesh_(mesh),
      laws_(element::elastic_laws(materials)),
      stiffness_(mesh, sections),
      rows_(tie_rows(tie, solid.nodes, mesh.nodes)),
      row_of_(row_numbers(rows_, mesh.nodes.size())),
      order_(solver::chunked_order(solid)),
      restraints_(supports::make_restraints(solid, held, order_)),
      free_(solver::free_unknowns(restraints_.freedom,
                                  static_cast<int>(solid.nodes.size()))),
      shell_(static_cast<int>(mesh.nodes.size()),
             with_tied(supports, tie, row_of_)),
      start_(free_.start.back()) {
  equations::check_memory(solid, equations::SolverKind::Cholesky);
  std::vector<supports::HeldDirection> directions =
      supports::held_directions(solid, held);
  const std::vector<supports::HeldDirection> sprung =
      supports::sprung_directions(solid, held);
  directions.insert(directions.end(), sprung.begin(), sprung.end());
  check_held(solid, directions, mesh, shell_, rows_);
  assemble_solid();
}

void JointSystem::assemble_solid() {
  std::vector<int> elements;
  std::vector<int> regions;
  for (const int e : order_.element) {
    for (const int node : solid_.element(e)) {
      elements.push_back(order_.to_solver[node]);
    }
    regions.push_back(solid_.element_region[e]);
  }
  table_ = solver::make_element_table(order_.chunks, solid_.nodes_per_element(),
                                      elements, std::move(regions));
  for (const int node : order_.to_mesh) {
    x_.push_back(solid_.nodes[node]);
  }
  solver::BlockMatrix<double> K;
  if (const auto bad = solver::assemble(table_, x_, laws_, K)) {
    const int e = order_.element[*bad];
    const Vec3& at = solid_.nodes[solid_.element(e)[0]];
    throw MeshError(fmt::format(
        "element {} at ({:.4g}, {:.4g}, {:.4g}) is inverted or flat: its "
        "Jacobian determinant is not positive",
        e, at.x(), at.y(), at.z()));
  }
  supports::add_springs(table_.pattern, restraints_.springs, K);
  SparseMatrix A = solver::free_matrix(table_.pattern, K, free_);
  K = {};
  A.conservativeResize(unknowns(), unknowns());
  A += shell_matrix();
  factor_.emplace(A, FactorKind::Cholesky);
  if (!factor_->factorize(A)) {
    throw SolverError(fmt::format(
        "the stiffness matrix of solids and shells, of {} unknowns, is not "
        "positive definite: a piece of the part hangs on a single node or edge "
        "and can turn, or elements are nearly flat",
        unknowns()));
  }
}

std::vector<JointSystem::Column> JointSystem::columns_of(int shell_node) const {
  std::vector<Column> columns;
  const int first = start_ + shell_.first_unknown(shell_node);
  if (row_of_[shell_node] < 0) {
    const auto basis = shell_.basis(shell_node);
    for (int k = 0; k < basis.cols(); ++k) {
      columns.push_back({first + k, basis.col(k)});
    }
    return columns;
  }
  const TieRow& row = rows_[row_of_[shell_node]];
  for (std::size_t n = 0; n < row.solid.size(); ++n) {
    const int node = order_.to_solver[row.solid[n]];
    for (int k = 0; k < free_.start[node + 1] - free_.start[node]; ++k) {
      columns.push_back({free_.start[node] + k,
                         row.by_solid[n] * free_.bases[node].axes.col(k)});
    }
  }
  columns.push_back({first, row.by_turn});
  return columns;
}

SparseMatrix JointSystem::shell_matrix() const {
  std::vector<Triplet> triplets;
  const auto facets = static_cast<int>(mesh_.facets.size());
  std::vector<shell::FacetMatrix> batch(std::min(kBatch, facets));
  for (int begin = 0; begin < facets; begin += kBatch) {
    const int count = std::min(kBatch, facets - begin);
    parallel_for(count, [&](std::ptrdiff_t k) {
      batch[k] = stiffness_.of(begin + static_cast<int>(k));
    });
    for (int k = 0; k < count; ++k) {
      std::vector<Column> columns;
      std::vector<int> of_node;  // per column
      for (int i = 0; i < shell::kNodes; ++i) {
        for (Column& column : columns_of(mesh_.facets[begin + k][i])) {
          columns.push_back(column);
          of_node.push_back(i);
        }
      }
      const auto n = static_cast<Eigen::Index>(columns.size());
      using Columns = Eigen::Matrix<double, shell::kUnknowns, Eigen::Dynamic>;
      Columns P = Columns::Zero(shell::kUnknowns, n);
      for (Eigen::Index c = 0; c < n; ++c) {
        P.block<6, 1>(6 * of_node[c], c) = columns[c].by;
      }
      const Columns KP = batch[k] * P;
      const Eigen::MatrixXd A = P.transpose().lazyProduct(KP);
      for (Eigen::Index c = 0; c < n; ++c) {
        for (Eigen::Index r = 0; r < n; ++r) {
          if (columns[r].unknown >= columns[c].unknown) {
            triplets.emplace_back(columns[r].unknown, columns[c].unknown,
                                  A(r, c));
          }
        }
      }
    }
  }
  SparseMatrix sum(unknowns(), unknowns());
  sum.setFromTriplets(triplets.begin(), triplets.end());
  return sum;
}

VectorX JointSystem::to_solid(const VectorX& shell_forces) const {
  VectorX forces =
      VectorX::Zero(3L * static_cast<Eigen::Index>(solid_.nodes.size()));
  for (const TieRow& row : rows_) {
    const shell::Six own = shell_forces.segment<6>(6L * row.node);
    for (std::size_t n = 0; n < row.solid.size(); ++n) {
      forces.segment<3>(3L * row.solid[n]) += row.by_solid[n].transpose() * own;
    }
  }
  return forces;
}

/// T^T of both.
VectorX JointSystem::restrict(const VectorX& both) const {
  const auto size = 3L * static_cast<Eigen::Index>(solid_.nodes.size());
  const VectorX shell_forces = both.tail(both.size() - size);
  const VectorX on_solid = both.head(size) + to_solid(shell_forces);
  VectorX right(unknowns());
  for (std::size_t i = 0; i < order_.to_mesh.size(); ++i) {
    for (int k = free_.start[i]; k < free_.start[i + 1]; ++k) {
      right[k] = free_.bases[i]
                     .axes.col(k - free_.start[i])
                     .dot(on_solid.segment<3>(3L * order_.to_mesh[i]));
    }
  }
  VectorX own = shell_.restrict(shell_forces);
  for (const TieRow& row : rows_) {
    own[shell_.first_unknown(row.node)] =
        row.by_turn.dot(shell_forces.segment<6>(6L * row.node));
  }
  right.tail(own.size()) = own;
  return right;
}

VectorX JointSystem::solve(const VectorX& forces) const {
  const VectorX q = factor_->solve(restrict(forces));
  VectorX u = VectorX::Zero(forces.size());
  const auto size = 3L * static_cast<Eigen::Index>(solid_.nodes.size());
  for (std::size_t i = 0; i < order_.to_mesh.size(); ++i) {
    for (int k = free_.start[i]; k < free_.start[i + 1]; ++k) {
      u.segment<3>(3L * order_.to_mesh[i]) +=
          q[k] * free_.bases[i].axes.col(k - free_.start[i]);
    }
  }
  u.tail(u.size() - size) = shell_.expand(q.tail(q.size() - start_));
  for (const TieRow& row : rows_) {
    shell::Six own = row.by_turn * q[start_ + shell_.first_unknown(row.node)];
    for (std::size_t n = 0; n < row.solid.size(); ++n) {
      own += row.by_solid[n] * u.segment<3>(3L * row.solid[n]);
    }
    u.segment<6>(size + 6L * row.node) = own;
  }
  return u;
}

VectorX JointSystem::residual(const VectorX& u, const VectorX& forces) const {
  const auto size = 3L * static_cast<Eigen::Index>(solid_.nodes.size());
  VectorX left = -forces;
  left.tail(u.size() - size) += stiffness_.times(u.tail(u.size() - size));
  VectorX in_order(size);
  for (std::size_t i = 0; i < order_.to_mesh.size(); ++i) {
    in_order.segment<3>(3L * static_cast<Eigen::Index>(i)) =
        u.segment<3>(3L * order_.to_mesh[i]);
  }
  const VectorX inner = solver::internal_forces(table_, x_, laws_, in_order) +
                        supports::spring_forces(restraints_.springs, in_order);
  for (std::size_t i = 0; i < order_.to_mesh.size(); ++i) {
    left.segment<3>(3L * order_.to_mesh[i]) +=
        inner.segment<3>(3L * static_cast<Eigen::Index>(i));
  }
  left.head(size) += to_solid(left.tail(u.size() - size));
  return left;
}

VectorX JointSystem::reactions(const VectorX& residual) const {
  VectorX result =
      VectorX::Zero(3L * static_cast<Eigen::Index>(solid_.nodes.size()));
  const solver::NodeFreedom& freedom = restraints_.freedom;
  for (std::size_t h = 0; h < freedom.held.size(); ++h) {
    const int node = order_.to_mesh[freedom.held[h]];
    result.segment<3>(3L * node) = (Mat3::Identity() - freedom.projector[h]) *
                                   residual.segment<3>(3L * node);
  }
  return result;
}

double JointSystem::imbalance(const VectorX& residual,
                              const VectorX& forces) const {
  // Tied nodes' forces are in the solid's already, but what their turns do.
  VectorX both = residual;
  const auto size = 3L * static_cast<Eigen::Index>(solid_.nodes.size());
  both.head(size) -= to_solid(residual.tail(residual.size() - size));
  const double left = restrict(both).norm();
  const double all = forces.norm();
  return all > 0.0 ? left / all : left;
}

}  // namespace meniscus::joint
