/// Matrices of small models in plain form, for the tests of modes and buckling.
#pragma once

#include <Eigen/SparseCore>

#include "fea/solver/nodal_matrix.h"
#include "tests/support/parts.h"

namespace meniscus::parts {

/// Numbers in (-1, 1) that repeat.
inline VectorX irregular(Eigen::Index size, double seed) {
  VectorX v(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const double s = std::sin(seed + 12.9898 * static_cast<double>(k)) * 437.5;
    v[k] = 2.0 * (s - std::floor(s)) - 1.0;
  }
  return v;
}

/// A u by the solver's product.
inline VectorX product(const solver::ElementTable& table,
                       const solver::NodalMatrix& A, const VectorX& u) {
  Eigen::Matrix4Xd x = Eigen::Matrix4Xd::Zero(4, table.pattern.nodes);
  x.topRows<3>() = u.reshaped(3, table.pattern.nodes);
  Eigen::Matrix4Xd y = x;
  solver::multiply<1>(table.pattern, A, x.data(), y.data());
  return Eigen::Matrix3Xd(y.topRows<3>()).reshaped();
}

/// The whole matrix without the unknowns marked in `held`, which may be empty.
/// at(node a, node b, i, j, value) is called by fill(entry).
template <class Fill>
Eigen::SparseMatrix<double> sparse(const solver::ElementTable& table,
                                   const std::vector<char>& held,
                                   const Fill& fill) {
  std::vector<int> number(3L * table.pattern.nodes, 0);
  int next = 0;
  for (std::size_t k = 0; k < number.size(); ++k) {
    number[k] = held.empty() || held[k] == 0 ? next++ : -1;
  }
  std::vector<Eigen::Triplet<double>> entries;
  fill([&](int row, int column, double value) {
    if (number[row] >= 0 && number[column] >= 0) {
      entries.emplace_back(number[row], number[column], value);
    }
  });
  Eigen::SparseMatrix<double> A(next, next);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

inline Eigen::SparseMatrix<double> sparse(const solver::ElementTable& table,
                                          const solver::NodalMatrix& A,
                                          const std::vector<char>& held = {}) {
  const solver::BlockPattern& p = table.pattern;
  return sparse(table, held, [&](const auto& entry) {
    for (int i = 0; i < p.nodes; ++i) {
      for (int c = 0; c < 3; ++c) {
        entry(3 * i + c, 3 * i + c, A.diagonal[i]);
        for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
          entry(3 * i + c, 3 * p.column[k] + c, A.lower[k]);
          entry(3 * p.column[k] + c, 3 * i + c, A.lower[k]);
        }
      }
    }
  });
}

inline Eigen::SparseMatrix<double> sparse(const solver::ElementTable& table,
                                          const solver::BlockMatrix<double>& A,
                                          const std::vector<char>& held = {}) {
  const solver::BlockPattern& p = table.pattern;
  return sparse(table, held, [&](const auto& entry) {
    for (int i = 0; i < p.nodes; ++i) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          entry(3 * i + r, 3 * i + c, A.diagonal[9L * i + 3 * r + c]);
          for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
            const double value = A.lower[9L * k + 3 * r + c];
            entry(3 * i + r, 3 * p.column[k] + c, value);
            entry(3 * p.column[k] + c, 3 * i + r, value);
          }
        }
      }
    }
  });
}

/// The table's element numbers: the mesh's own.
inline std::vector<int> own_elements(const TetMesh& mesh) {
  std::vector<int> element(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    element[e] = e;
  }
  return element;
}

/// Marks the unknowns of nodes where `where` holds.
template <class Where>
std::vector<char> held_unknowns(const TetMesh& mesh, const Where& where) {
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      held[3 * i + c] = where(mesh.nodes[i], static_cast<int>(c)) ? 1 : 0;
    }
  }
  return held;
}

}  // namespace meniscus::parts
