#include "fea/distributed/petsc_matrix.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "fea/element/element_stiffness.h"

namespace meniscus::distributed::petsc {

namespace {

using ConstBlock = Eigen::Map<const RowMat3>;

/// Blocks of each own node's row: those in own columns, and the others.
struct RowCounts {
  std::vector<PetscInt> own, other;
};

RowCounts count_blocks(const Piece& piece) {
  const auto own = static_cast<std::size_t>(piece.header.own);
  const auto width = static_cast<std::size_t>(piece.header.nodes_per_element);
  std::vector<std::size_t> start(own + 1, 0);
  for (const int node : piece.elements) {
    if (node < piece.header.own) {
      ++start[node + 1];
    }
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> around(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::size_t k = 0; k < piece.elements.size(); ++k) {
    if (piece.elements[k] < piece.header.own) {
      around[next[piece.elements[k]]++] = static_cast<int>(k / width);
    }
  }
  RowCounts counts;
  counts.own.resize(own);
  counts.other.resize(own);
  std::vector<int> seen(piece.local_nodes(), -1);
  for (std::size_t i = 0; i < own; ++i) {
    counts.own[i] = 1;  // nodes in no element have a diagonal, too
    seen[i] = static_cast<int>(i);
    for (std::size_t k = start[i]; k < start[i + 1]; ++k) {
      for (std::size_t a = 0; a < width; ++a) {
        const int node = piece.elements[around[k] * width + a];
        if (seen[node] != static_cast<int>(i)) {
          seen[node] = static_cast<int>(i);
          ++(node < piece.header.own ? counts.own : counts.other)[i];
        }
      }
    }
  }
  return counts;
}

void set_option(Mat matrix, MatOption option) {
  check(MatSetOption(matrix, option, PETSC_TRUE));
}

}  // namespace

void check(PetscErrorCode error) {
  if (error != 0) {
    throw std::runtime_error("PETSc's error " + std::to_string(error));
  }
}

StiffnessMatrix::StiffnessMatrix(const Piece& piece) : piece_(piece) {
  id_.reserve(piece.local_nodes());
  for (int i = 0; i < piece.local_nodes(); ++i) {
    id_.push_back(static_cast<PetscInt>(piece.id(i)));
  }
  const RowCounts counts = count_blocks(piece);
  const auto rows = static_cast<PetscInt>(3 * piece.header.own);
  check(MatCreate(PETSC_COMM_WORLD, &matrix_));
  check(MatSetSizes(matrix_, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetBlockSize(matrix_, 3));
  check(MatSetType(matrix_, MATAIJ));
  check(MatXAIJSetPreallocation(matrix_, 3, counts.own.data(),
                                counts.other.data(), nullptr, nullptr));
  set_option(matrix_, MAT_NO_OFF_PROC_ENTRIES);
  set_option(matrix_, MAT_SPD);
}

StiffnessMatrix::~StiffnessMatrix() { static_cast<void>(MatDestroy(&matrix_)); }

void StiffnessMatrix::assemble(const PieceGroup& group) {
  held_.assign(piece_.local_nodes(), -1);
  for (std::size_t h = 0; h < group.held.size(); ++h) {
    held_[group.held[h]] = static_cast<int>(h);
  }
  projector_ = group.projector.data();
  own_stiffness_.assign(group.held.size(), 0.0);
  check(MatZeroEntries(matrix_));
  if (piece_.header.nodes_per_element == 4) {
    add_elements<4>();
  } else {
    add_elements<10>();
  }
  add_springs(group);
  add_held(group);
  check(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
}

template <int Nodes>
void StiffnessMatrix::add_elements() {
  constexpr int kWidth = 3 * Nodes;
  std::array<unsigned char, Nodes> slot;
  std::iota(slot.begin(), slot.end(), static_cast<unsigned char>(0));
  Eigen::Matrix<double, kWidth, kWidth, Eigen::RowMajor> full;
  std::array<double, 9L * Nodes*(Nodes + 1) / 2> lower;
  std::array<Vec3, Nodes> x;
  std::array<PetscInt, Nodes> row;  // negative ones are left out
  std::array<PetscInt, Nodes> column;
  for (std::size_t e = 0; e < piece_.region.size(); ++e) {
    const int* ids = piece_.elements.data() + e * Nodes;
    // Only rows of own nodes are added: every element that touches them is
    // here, so that no process sends entries to another.
    for (int a = 0; a < Nodes; ++a) {
      x[a] = Eigen::Map<const Vec3>(piece_.x.data() + 3L * ids[a]);
      column[a] = id_[ids[a]];
      row[a] = ids[a] < piece_.header.own ? column[a] : -1;
    }
    // Element stiffness int B^T C B dV, blocks on and below the diagonal.
    lower.fill(0.0);
    const auto place = [&](int a, int b) {
      return lower.data() + 9L * (a * (a + 1) / 2 + b);
    };
    element::add_element_stiffness<Nodes>(x, slot.data(),
                                          piece_.law[piece_.region[e]], place);
    // Blocks of held nodes become P_a K_ab P_b; the mean of their diagonal is
    // kept for the directions that are taken out.
    for (int a = 0; a < Nodes; ++a) {
      const int p = held_[ids[a]];
      for (int b = 0; b <= a; ++b) {
        RowMat3 block = ConstBlock(place(a, b));
        if (a == b && p >= 0) {
          own_stiffness_[p] += block.trace() / 3.0;
        }
        if (p >= 0) {
          block = ConstBlock(projector_ + 9L * p) * block;
        }
        if (const int q = held_[ids[b]]; q >= 0) {
          block = block * ConstBlock(projector_ + 9L * q);
        }
        full.template block<3, 3>(3 * a, 3 * b) = block;
        full.template block<3, 3>(3 * b, 3 * a) = block.transpose();
      }
    }
    check(MatSetValuesBlocked(matrix_, Nodes, row.data(), Nodes, column.data(),
                              full.data(), ADD_VALUES));
  }
}

void StiffnessMatrix::add_springs(const PieceGroup& group) {
  const auto projected = [&](RowMat3 block, int a, int b) {
    if (held_[a] >= 0) {
      block = ConstBlock(projector_ + 9L * held_[a]) * block;
    }
    if (held_[b] >= 0) {
      block = block * ConstBlock(projector_ + 9L * held_[b]);
    }
    return block;
  };
  for (std::size_t k = 0; k < group.spring.size() / 9; ++k) {
    const ConstBlock spring(group.spring.data() + 9 * k);
    std::array<int, 2> at = {group.spring_at[2 * k],
                             group.spring_at[2 * k + 1]};
    for (int side = 0; side < (at[0] == at[1] ? 1 : 2); ++side) {
      if (at[0] < piece_.header.own) {
        const RowMat3 block = projected(spring, at[0], at[1]);
        check(MatSetValuesBlocked(matrix_, 1, &id_[at[0]], 1, &id_[at[1]],
                                  block.data(), ADD_VALUES));
      }
      std::swap(at[0], at[1]);
    }
  }
}

void StiffnessMatrix::add_held(const PieceGroup& group) {
  for (std::size_t h = 0; h < group.held.size(); ++h) {
    const int node = group.held[h];
    if (node >= piece_.header.own) {
      continue;
    }
    // Nodes in no element have no stiffness of their own.
    const double scale = own_stiffness_[h] > 0.0 ? own_stiffness_[h] : 1.0;
    const RowMat3 block =
        scale * (RowMat3::Identity() - ConstBlock(projector_ + 9 * h));
    check(MatSetValuesBlocked(matrix_, 1, &id_[node], 1, &id_[node],
                              block.data(), ADD_VALUES));
  }
}

}  // namespace meniscus::distributed::petsc
