// The kernels' formulas for their work against textbook algorithms in numbers
// that count what is done with them.
#include "core/operation_count.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/math/linear_solve.h"
#include "fea/element/tet_element.h"
#include "fea/solver/block_sweeps.h"
#include "fea/solver/conjugate_gradients.h"
#include "fea/solver/node_freedom.h"
#include "tests/support/counted.h"
#include "tests/support/parts.h"

namespace meniscus::operation_count_test {
namespace {

struct Stiffness {
  TetMesh mesh =
      shapes::straight_quadratic(parts::distorted_brick({3, 2, 1}, 2));
  solver::ElementTable table = parts::table_of(mesh);
  solver::BlockMatrix<double> matrix;
  VectorX x;

  Stiffness() {
    EXPECT_FALSE(solver::assemble(table, mesh.nodes,
                                  {element::lame(parts::steel())}, matrix));
    x = VectorX::LinSpaced(3 * table.pattern.nodes, -1.0, 2.0).array().sin();
  }
  Counted diagonal(int i, int r, int c) const {
    return {matrix.diagonal[9L * i + 3 * r + c]};
  }
  Counted lower(int k, int r, int c) const {
    return {matrix.lower[9L * k + 3 * r + c]};
  }
};

using Numbers = std::vector<Counted>;

Numbers numbers_of(const VectorX& x) {
  Numbers numbers;
  for (const double value : x) {
    numbers.push_back({value});
  }
  return numbers;
}

Numbers textbook_product(const Stiffness& k, const Numbers& x) {
  const solver::BlockPattern& p = k.table.pattern;
  Numbers y(x.size());
  for (int i = 0; i < p.nodes; ++i) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        y[3 * i + r] += k.diagonal(i, r, c) * x[3 * i + c];
        for (int b = p.start[i]; b < p.start[i + 1]; ++b) {
          y[3 * i + r] += k.lower(b, r, c) * x[3 * p.column[b] + c];
          y[3 * p.column[b] + c] += k.lower(b, r, c) * x[3 * i + r];
        }
      }
    }
  }
  return y;
}

TEST(OperationCount, AProductCountsEachStoredBlockTwice) {
  const Stiffness k;
  VectorX y;
  const double account =
      accounted([&] { y = parts::product(k.table, k.matrix, k.x); });
  Numbers expected;
  EXPECT_EQ(account,
            counted([&] { expected = textbook_product(k, numbers_of(k.x)); }));
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    EXPECT_NEAR(y[i], expected[static_cast<std::size_t>(i)].value,
                1e-12 * y.norm());
  }
}

/// x_i = D_i (r_i - sum L x), its `upper` scattered at once; D: any blocks.
void textbook_sweep(const Stiffness& k, const Numbers& r, Numbers& x,
                    Numbers& upper) {
  const solver::BlockPattern& p = k.table.pattern;
  for (int i = 0; i < p.nodes; ++i) {
    for (int row = 0; row < 3; ++row) {
      Counted sum;
      for (int b = p.start[i]; b < p.start[i + 1]; ++b) {
        for (int c = 0; c < 3; ++c) {
          sum += k.lower(b, row, c) * x[3 * p.column[b] + c];
        }
      }
      const Counted left = r[3 * i + row] - sum;
      for (int c = 0; c < 3; ++c) {
        x[3 * i + c] += k.diagonal(i, c, row) * left;
      }
    }
    for (int b = p.start[i]; b < p.start[i + 1]; ++b) {
      for (int row = 0; row < 3; ++row) {
        for (int c = 0; c < 3; ++c) {
          upper[3 * p.column[b] + c] += k.lower(b, row, c) * x[3 * i + row];
        }
      }
    }
  }
}

TEST(OperationCount, ASweepGathersAndScatters) {
  const Stiffness k;
  const auto size = static_cast<std::size_t>(4 * k.table.pattern.nodes);
  const std::vector<float> lower(k.matrix.lower.begin(), k.matrix.lower.end());
  const std::vector<float> inverse(3 * size, 1e-6F);
  const std::vector<float> right(size, 1.0F);
  std::vector<float> x(size, 0.0F);
  std::vector<float> upper(size, 0.0F);
  const solver::SweepMatrix matrix{&k.table.pattern, lower.data(),
                                   inverse.data()};
  const double account = accounted([&] {
    solver::sweep_forward<3, 1>(matrix, right.data(), x.data(), upper.data());
  });
  Numbers r = numbers_of(k.x);
  Numbers found(r.size());
  Numbers above(r.size());
  EXPECT_EQ(account, counted([&] { textbook_sweep(k, r, found, above); }));
  // Backward each row takes `upper` off too.
  EXPECT_EQ(accounted([&] {
              solver::sweep_backward<3, 1>(matrix, right.data(), x.data(),
                                           upper.data());
            }),
            account + 3.0 * k.table.pattern.nodes);
}

/// Outer products and blocks of one isotropic ten-node element.
void textbook_element(const std::array<Vec3, 10>& x) {
  element::TetGradients<10> g;
  ASSERT_TRUE(element::tet_gradients<10>(x, g));
  const Counted lambda{2.0};
  const Counted mu{1.0};
  std::vector<Numbers> G(30, Numbers(30));
  const auto h = [&](int q, int row) {
    return Counted{g.gradient[q][row / 3][row % 3]};
  };
  for (int row = 0; row < 30; ++row) {
    Numbers s;
    for (int q = 0; q < 4; ++q) {
      s.push_back(Counted{g.volume[q]} * h(q, row));
    }
    for (int c = 0; c < 30; ++c) {
      G[row][c] = s[0] * h(0, c);
      for (int q = 1; q < 4; ++q) {
        G[row][c] += s[q] * h(q, c);
      }
    }
  }
  for (int a = 0; a < 10; ++a) {
    for (int b = 0; b <= a; ++b) {
      Numbers block(9);
      const auto at = [&](int r, int c) { return G[3 * a + r][3 * b + c]; };
      const Counted trace = mu * (at(0, 0) + at(1, 1) + at(2, 2));
      const Counted both = lambda + mu;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          block[3 * r + c] += r == c ? both * at(r, c) + trace
                                     : lambda * at(r, c) + mu * at(c, r);
        }
      }
    }
  }
}

TEST(OperationCount, AssemblyCountsItsElements) {
  Stiffness k;
  const double account = accounted([&] {
    solver::assemble(k.table, k.mesh.nodes, {element::lame(parts::steel())},
                     k.matrix);
  });
  std::array<Vec3, 10> x;
  for (int a = 0; a < 10; ++a) {
    x[a] = k.mesh.nodes[k.mesh.element(0)[a]];
  }
  EXPECT_EQ(account,
            k.mesh.element_count() * counted([&] { textbook_element(x); }));
}

/// The Laplacian of an n x n grid, shifted; its lower half.
SparseMatrix grid_matrix(int n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n * n; ++i) {
    entries.emplace_back(i, i, 4.5);
    if (i % n > 0) {
      entries.emplace_back(i, i - 1, -1.0);
    }
    if (i >= n) {
      entries.emplace_back(i, i - n, -1.0);
    }
  }
  SparseMatrix a(n * n, n * n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

/// Column by column, only where L has entries; then both triangles.
struct TextbookFactor {
  std::vector<Numbers> l;  // by columns
  std::vector<std::vector<char>> there;

  explicit TextbookFactor(const SparseMatrix& a) {
    const auto n = static_cast<std::size_t>(a.cols());
    l.assign(n, Numbers(n));
    there.assign(n, std::vector<char>(n, 0));
    for (int c = 0; c < a.outerSize(); ++c) {
      for (SparseMatrix::InnerIterator it(a, c); it; ++it) {
        l[c][it.row()] = {it.value()};
        there[c][it.row()] = 1;
      }
    }
    for (std::size_t c = 0; c < n; ++c) {
      l[c][c] = root(l[c][c]);
      for (std::size_t i = c + 1; i < n; ++i) {
        if (there[c][i] != 0) {
          l[c][i] = l[c][i] / l[c][c];
        }
      }
      for (std::size_t j = c + 1; j < n; ++j) {
        for (std::size_t i = j; i < n && there[c][j] != 0; ++i) {
          if (there[c][i] != 0) {
            there[j][i] = 1;
            l[j][i] -= l[c][i] * l[c][j];
          }
        }
      }
    }
  }

  Numbers solve(Numbers x) const {
    const std::size_t n = l.size();
    for (std::size_t c = 0; c < n; ++c) {
      x[c] = x[c] / l[c][c];
      for (std::size_t i = c + 1; i < n; ++i) {
        if (there[c][i] != 0) {
          x[i] -= l[c][i] * x[c];
        }
      }
    }
    for (std::size_t c = n; c-- > 0;) {
      for (std::size_t i = c + 1; i < n; ++i) {
        if (there[c][i] != 0) {
          x[c] -= l[c][i] * x[i];
        }
      }
      x[c] = x[c] / l[c][c];
    }
    return x;
  }
};

TEST(OperationCount, AFactorCountsTheSquaresOfItsColumns) {
  const SparseMatrix a = grid_matrix(7);
  std::vector<int> natural(static_cast<std::size_t>(a.cols()));
  for (std::size_t i = 0; i < natural.size(); ++i) {
    natural[i] = static_cast<int>(i);
  }
  SymmetricFactor factor(a, FactorKind::Cholesky, natural);
  const double factorised =
      accounted([&] { ASSERT_TRUE(factor.factorize(a)); });
  std::optional<TextbookFactor> textbook;
  EXPECT_EQ(factorised, counted([&] { textbook.emplace(a); }));
  const VectorX right = VectorX::LinSpaced(a.cols(), 0.0, 1.0);
  VectorX x;
  const double solved = accounted([&] { x = factor.solve(right); });
  Numbers expected;
  EXPECT_EQ(solved,
            counted([&] { expected = textbook->solve(numbers_of(right)); }));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(x[i], expected[static_cast<std::size_t>(i)].value, 1e-12);
  }
}

/// No preconditioner at all.
struct Identity final : solver::Preconditioner {
  void apply(const std::vector<double>& r, std::vector<double>& z,
             int /*K*/) const override {
    z = r;
  }
};

TEST(OperationCount, AStepOfConjugateGradientsIsAProductAndFiveVectors) {
  const Stiffness k;
  solver::NodeFreedom freedom;
  const auto steps = [&](int most) {
    std::vector<VectorX> u = {VectorX::Zero(k.x.size())};
    return accounted([&] {
      solver::conjugate_gradients({.pattern = k.table.pattern,
                                   .matrix = k.matrix,
                                   .preconditioner = Identity(),
                                   .freedom = freedom,
                                   .tolerance = 1e-300,
                                   .max_iterations = most,
                                   .monitor = silent_monitor()},
                                  {k.x}, u);
    });
  };
  const double product =
      accounted([&] { parts::product(k.table, k.matrix, k.x); });
  // r.z and p.q, and the steps of p, u and r.
  const double vectors = counted([&] {
    Numbers p = numbers_of(k.x);
    Numbers q = p;
    Numbers u = p;
    Counted rz;
    Counted pq;
    for (std::size_t i = 0; i < p.size(); ++i) {
      rz += p[i] * q[i];
      p[i] = q[i] + Counted{0.5} * p[i];
      pq += p[i] * q[i];
      u[i] += Counted{0.1} * p[i];
      q[i] -= Counted{0.1} * u[i];
    }
  });
  EXPECT_EQ(steps(5) - steps(3), 2.0 * (product + vectors));
}

}  // namespace
}  // namespace meniscus::operation_count_test
