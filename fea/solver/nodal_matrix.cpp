#include "fea/solver/nodal_matrix.h"

#include "fea/element/elastic_law.h"
#include "fea/element/tet_shape.h"
#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

namespace {

template <int Nodes>
using ElementMatrix = Eigen::Matrix<double, Nodes, Nodes>;

template <int Nodes>
std::array<Vec3, Nodes> nodes_of(const ElementTable& table, const Points& x,
                                 int e) {
  const std::size_t first = static_cast<std::size_t>(e) * Nodes;
  std::array<Vec3, Nodes> place;
  for (int a = 0; a < Nodes; ++a) {
    place[a] = x[table.pattern.element_nodes[first + table.slot[first + a]]];
  }
  return place;
}

/// Adds element(e, nodes), symmetric and in TetMesh's order, over all elements.
template <int Nodes, class Element>
NodalMatrix assemble_nodal(const ElementTable& table, const Points& x,
                           const Element& element) {
  const BlockPattern& p = table.pattern;
  NodalMatrix A;
  A.diagonal.assign(p.nodes, 0.0);
  A.lower.assign(p.column.size(), 0.0);
  over_elements(table, [&](int e) {
    const ElementMatrix<Nodes> values =
        element(e, nodes_of<Nodes>(table, x, e));
    const std::size_t first = static_cast<std::size_t>(e) * Nodes;
    const int* pair = p.pair_block.data() +
                      static_cast<std::size_t>(e) * (Nodes * (Nodes - 1) / 2);
    for (int a = 0; a < Nodes; ++a) {
      const int high = table.slot[first + a];
      A.diagonal[p.element_nodes[first + high]] += values(a, a);
      for (int b = 0; b < Nodes; ++b) {
        const int low = table.slot[first + b];
        if (low < high) {
          A.lower[pair[high * (high - 1) / 2 + low]] += values(a, b);
        }
      }
    }
  });
  return A;
}

ElementMatrix<4> exact_mass(const std::array<Vec3, 4>& x) {
  element::TetGradients<4> g;
  element::tet_gradients<4>(x, g);
  ElementMatrix<4> m;
  m.setConstant(g.volume[0] / 20.0);
  m.diagonal() *= 2.0;
  return m;
}

ElementMatrix<10> exact_mass(const std::array<Vec3, 10>& x) {
  static const auto kShapes = [] {
    std::vector<Eigen::Matrix<double, 10, 1>> shapes;
    for (const element::TetRulePoint& point : element::fine_tet_rule()) {
      const std::array<double, 10> N = element::tet_shapes<10>(point.L);
      shapes.emplace_back(N.data());
    }
    return shapes;
  }();
  ElementMatrix<10> m = ElementMatrix<10>::Zero();
  std::size_t q = 0;
  for (const element::TetRulePoint& point : element::fine_tet_rule()) {
    const double volume = point.weight / 6.0 *
                          element::gradient_at<10>(x, x, point.L).determinant;
    m.noalias() += (volume * kShapes[q]) * kShapes[q].transpose();
    ++q;
  }
  return m;
}

template <int Nodes>
ElementMatrix<Nodes> mass_at_points(const std::array<Vec3, Nodes>& x) {
  element::TetGradients<Nodes> g;
  element::tet_gradients<Nodes>(x, g);
  ElementMatrix<Nodes> m = ElementMatrix<Nodes>::Zero();
  for (int q = 0; q < element::kTetPoints<Nodes>; ++q) {
    const std::array<double, Nodes> N =
        element::tet_shapes<Nodes>(element::rule_point<Nodes>(q));
    const Eigen::Map<const Eigen::Matrix<double, Nodes, 1>> shape(N.data());
    m.noalias() += (g.volume[q] * shape) * shape.transpose();
  }
  return m;
}

template <int Nodes>
ElementMatrix<Nodes> geometric_of(const std::array<Vec3, Nodes>& x,
                                  const element::Stress* stress) {
  element::TetGradients<Nodes> g;
  element::tet_gradients<Nodes>(x, g);
  ElementMatrix<Nodes> m = ElementMatrix<Nodes>::Zero();
  for (int q = 0; q < element::kTetPoints<Nodes>; ++q) {
    const element::Vec6 s = Eigen::Map<const element::Vec6>(stress[q].data());
    const Mat3 sigma = g.volume[q] * element::stress_tensor(s);
    Eigen::Matrix<double, 3, Nodes> gradient;
    for (int a = 0; a < Nodes; ++a) {
      gradient.col(a) = g.gradient[q][a];
    }
    m.noalias() += gradient.transpose() * (sigma * gradient).eval();
  }
  return m;
}

template <int Nodes>
NodalMatrix geometric(const ElementTable& table, const Points& x,
                      const std::vector<int>& element,
                      const element::PointStress& stress) {
  return assemble_nodal<Nodes>(
      table, x, [&](int e, const std::array<Vec3, Nodes>& nodes) {
        return geometric_of<Nodes>(nodes,
                                   &stress.stress[stress.index(element[e])]);
      });
}

template <int Nodes>
NodalMatrix mass(const ElementTable& table, const Points& x,
                 const std::vector<double>& density, MassRule rule) {
  return assemble_nodal<Nodes>(
      table, x, [&](int e, const std::array<Vec3, Nodes>& nodes) {
        const ElementMatrix<Nodes> m = rule == MassRule::Exact
                                           ? exact_mass(nodes)
                                           : mass_at_points<Nodes>(nodes);
        return ElementMatrix<Nodes>(density[table.region[e]] * m);
      });
}

}  // namespace

template <int K>
void multiply(const BlockPattern& pattern, const NodalMatrix& matrix,
              const double* x, double* y) {
  constexpr int kWidth = K * kLanes<3>;
  using Row = Eigen::Array<double, kWidth, 1>;
  over_chunks(pattern.chunks, RowOrder::Forward, [&](int chunk) {
    for (int i = pattern.chunks.first[chunk];
         i < pattern.chunks.first[chunk + 1]; ++i) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * kWidth;
      const Row xi = Eigen::Map<const Row>(x + at);
      Row sum = matrix.diagonal[i] * xi;
      for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
        const std::ptrdiff_t j =
            static_cast<std::ptrdiff_t>(pattern.column[k]) * kWidth;
        const double value = matrix.lower[k];
        sum += value * Eigen::Map<const Row>(x + j);
        Eigen::Map<Row>(y + j) += value * xi;
      }
      // Only rows after i add to y_i: it has not been written before.
      Eigen::Map<Row>(y + at) = sum;
    }
  });
}

template void multiply<1>(const BlockPattern&, const NodalMatrix&,
                          const double*, double*);
template void multiply<2>(const BlockPattern&, const NodalMatrix&,
                          const double*, double*);
template void multiply<3>(const BlockPattern&, const NodalMatrix&,
                          const double*, double*);
template void multiply<4>(const BlockPattern&, const NodalMatrix&,
                          const double*, double*);

void add_scaled(double factor, const NodalMatrix& A,
                BlockMatrix<double>& matrix) {
  const auto add = [factor](const std::vector<double>& values,
                            std::vector<double>& blocks) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        blocks[9 * k + 4 * c] += factor * values[k];
      }
    }
  };
  add(A.diagonal, matrix.diagonal);
  add(A.lower, matrix.lower);
}

NodalMatrix mass_matrix(const ElementTable& table, const Points& x,
                        const std::vector<double>& density, MassRule rule) {
  return table.pattern.nodes_per_element == 4
             ? mass<4>(table, x, density, rule)
             : mass<10>(table, x, density, rule);
}

NodalMatrix geometric_stiffness(const ElementTable& table, const Points& x,
                                const std::vector<int>& element,
                                const element::PointStress& stress) {
  return table.pattern.nodes_per_element == 4
             ? geometric<4>(table, x, element, stress)
             : geometric<10>(table, x, element, stress);
}

}  // namespace meniscus::solver
