#include "fea/assembly.h"

#include <algorithm>
#include <numeric>
#include <omp.h>

#include <Eigen/Geometry>

#include "fea/tet_element.h"

namespace meniscus {

namespace {

/// Width of a padded row of the element's outer products: whole AVX vectors.
template <int Nodes>
constexpr int kPadded = (3 * Nodes + 3) / 4 * 4;

template <int Nodes>
void load_nodes(const ElementTable& table, const Points& x, int e,
                std::array<Vec3, Nodes>& corner) {
  const std::size_t first = static_cast<std::size_t>(e) * Nodes;
  for (int a = 0; a < Nodes; ++a) {
    corner[a] = x[table.pattern.element_nodes[first + table.slot[first + a]]];
  }
}

/// G = sum over points of V h h^T, h the gradients of all nodes in ascending
/// order, one after another.
template <int Nodes>
void outer_products(const TetGradients<Nodes>& g, const unsigned char* slot,
                    double (*G)[kPadded<Nodes>]) {
  constexpr int kPoints = kTetPoints<Nodes>;
  alignas(32) double h[kPoints][kPadded<Nodes>] = {};
  for (int q = 0; q < kPoints; ++q) {
    for (int a = 0; a < Nodes; ++a) {
      for (int k = 0; k < 3; ++k) {
        h[q][3L * slot[a] + k] = g.gradient[q][a][k];
      }
    }
  }
  for (int r = 0; r < 3 * Nodes; ++r) {
    double s[kPoints];
    for (int q = 0; q < kPoints; ++q) {
      s[q] = g.volume[q] * h[q][r];
    }
    for (int c = 0; c < kPadded<Nodes>; ++c) {
      double sum = s[0] * h[0][c];
      for (int q = 1; q < kPoints; ++q) {
        sum += s[q] * h[q][c];
      }
      G[r][c] = sum;
    }
  }
}

/// block += lambda G_ab + mu G_ab^T + mu tr(G_ab) I.
template <int Width>
void add_stiffness(const double (*G)[Width], int a, int b, const Lame& m,
                   double* block) {
  const double* g0 = G[3L * a] + 3L * b;
  const double* g1 = g0 + Width;
  const double* g2 = g1 + Width;
  const double d = m.mu * (g0[0] + g1[1] + g2[2]);
  const double both = m.lambda + m.mu;
  block[0] += both * g0[0] + d;
  block[1] += m.lambda * g0[1] + m.mu * g1[0];
  block[2] += m.lambda * g0[2] + m.mu * g2[0];
  block[3] += m.lambda * g1[0] + m.mu * g0[1];
  block[4] += both * g1[1] + d;
  block[5] += m.lambda * g1[2] + m.mu * g2[1];
  block[6] += m.lambda * g2[0] + m.mu * g0[2];
  block[7] += m.lambda * g2[1] + m.mu * g1[2];
  block[8] += both * g2[2] + d;
}

/// block += C : G_ab, see ElasticLaw::tensor.
template <int Width>
void add_stiffness(const double (*G)[Width], int a, int b, const ElasticLaw& m,
                   double* block) {
  double g[9];
  for (int j = 0; j < 3; ++j) {
    for (int l = 0; l < 3; ++l) {
      g[3 * j + l] = G[3L * a + j][3L * b + l];
    }
  }
  const double* row = m.tensor.data();
  for (int k = 0; k < 9; ++k, row += 9) {
    double sum = 0.0;
    for (int c = 0; c < 9; ++c) {
      sum += row[c] * g[c];
    }
    block[k] += sum;
  }
}

/// Adds the blocks of rows [low, high) of one element. Law: Lame or ElasticLaw.
template <int Nodes, class Law>
void add_element(const double (*G)[kPadded<Nodes>], const int* ids,
                 const int* block, const Law& law, int low, int high,
                 BlockMatrix<double>& matrix) {
  for (int a = 0; a < Nodes; ++a) {
    if (ids[a] >= low && ids[a] < high) {
      add_stiffness(G, a, a, law, matrix.diagonal.data() + 9L * ids[a]);
      for (int b = 0; b < a; ++b) {
        add_stiffness(G, a, b, law,
                      matrix.lower.data() + 9L * block[a * (a - 1) / 2 + b]);
      }
    }
  }
}

/// Adds the blocks of rows [low, high); returns the first bad element.
template <int Nodes>
int assemble_rows(const ElementTable& table, const Points& x,
                  const std::vector<ElasticLaw>& laws, int low, int high,
                  BlockMatrix<double>& matrix) {
  const BlockPattern& p = table.pattern;
  constexpr int kPairs = Nodes * (Nodes - 1) / 2;
  const int count = p.element_count();
  int bad = count;
  std::array<Vec3, Nodes> corner;
  TetGradients<Nodes> g;
  alignas(32) double G[3 * Nodes][kPadded<Nodes>];
  for (int e = 0; e < count; ++e) {
    const std::size_t first = static_cast<std::size_t>(e) * Nodes;
    const int* ids = p.element_nodes.data() + first;
    if (ids[Nodes - 1] < low || ids[0] >= high) {
      continue;
    }
    load_nodes<Nodes>(table, x, e, corner);
    if (!tet_gradients<Nodes>(corner, g)) {
      bad = std::min(bad, e);
    }
    outer_products<Nodes>(g, table.slot.data() + first, G);
    const ElasticLaw& law = laws[table.region[e]];
    const int* block =
        p.pair_block.data() + static_cast<std::size_t>(e) * kPairs;
    if (law.isotropic) {
      add_element<Nodes>(G, ids, block, law.lame, low, high, matrix);
    } else {
      add_element<Nodes>(G, ids, block, law, low, high, matrix);
    }
  }
  return bad;
}

template <int Nodes>
std::optional<int> assemble_all(const ElementTable& table, const Points& x,
                                const std::vector<ElasticLaw>& laws,
                                BlockMatrix<double>& matrix) {
  const BlockPattern& p = table.pattern;
  int bad = p.element_count();
  // Each thread owns a range of rows and visits the elements that touch it.
#pragma omp parallel reduction(min : bad)
  {
    const long threads = omp_get_num_threads();
    const long t = omp_get_thread_num();
    const long blocks = static_cast<long>(p.column.size());
    const auto row = [&](long part) {
      const long target = blocks * part / threads;
      return static_cast<int>(
          std::lower_bound(p.start.begin(), p.start.end() - 1, target) -
          p.start.begin());
    };
    const int low = t == 0 ? 0 : row(t);
    const int high = t + 1 == threads ? p.nodes : row(t + 1);
    std::fill(matrix.diagonal.begin() + 9L * low,
              matrix.diagonal.begin() + 9L * high, 0.0);
    std::fill(matrix.lower.begin() + 9L * p.start[low],
              matrix.lower.begin() + 9L * p.start[high], 0.0);
    bad = assemble_rows<Nodes>(table, x, laws, low, high, matrix);
  }
  return bad == p.element_count() ? std::nullopt : std::optional(bad);
}

template <int Nodes>
void add_internal_forces(const ElementTable& table, const Points& x,
                         const std::vector<ElasticLaw>& laws, const VectorX& u,
                         VectorX& f) {
  std::array<Vec3, Nodes> corner;
  TetGradients<Nodes> g;
  for (int e = 0; e < table.pattern.element_count(); ++e) {
    load_nodes<Nodes>(table, x, e, corner);
    tet_gradients<Nodes>(corner, g);
    const ElasticLaw& law = laws[table.region[e]];
    const std::size_t first = static_cast<std::size_t>(e) * Nodes;
    std::array<int, Nodes> ids;
    std::array<Vec3, Nodes> du;  // relative to one node: no rigid shift
    for (int a = 0; a < Nodes; ++a) {
      ids[a] = table.pattern.element_nodes[first + table.slot[first + a]];
      du[a] = u.segment<3>(3 * ids[a]) - u.segment<3>(3 * ids[0]);
    }
    for (int q = 0; q < kTetPoints<Nodes>; ++q) {
      Mat3 H = Mat3::Zero();
      for (int a = 1; a < Nodes; ++a) {
        H.noalias() += du[a] * g.gradient[q][a].transpose();
      }
      const Mat3 stress = g.volume[q] * law.stress(H);
      for (int a = 0; a < Nodes; ++a) {
        f.segment<3>(3 * ids[a]).noalias() += stress * g.gradient[q][a];
      }
    }
  }
}

}  // namespace

ElementTable make_element_table(int nodes, int nodes_per_element,
                                const std::vector<int>& elements,
                                std::vector<int> region) {
  ElementTable table;
  table.slot.resize(elements.size());
  std::vector<int> ascending(elements.size());
  std::array<int, 10> order;
  for (std::size_t first = 0; first < elements.size();
       first += nodes_per_element) {
    std::iota(order.begin(), order.begin() + nodes_per_element, 0);
    std::sort(order.begin(), order.begin() + nodes_per_element,
              [&](int a, int b) {
                return elements[first + a] < elements[first + b];
              });
    for (int s = 0; s < nodes_per_element; ++s) {
      ascending[first + s] = elements[first + order[s]];
      table.slot[first + order[s]] = static_cast<unsigned char>(s);
    }
  }
  table.region = std::move(region);
  table.pattern = make_pattern(nodes, nodes_per_element, std::move(ascending));
  return table;
}

std::optional<int> assemble(const ElementTable& table, const Points& x,
                            const std::vector<ElasticLaw>& laws,
                            BlockMatrix<double>& matrix) {
  matrix.diagonal.resize(9L * table.pattern.nodes);
  matrix.lower.resize(9L * table.pattern.column.size());
  return table.pattern.nodes_per_element == 4
             ? assemble_all<4>(table, x, laws, matrix)
             : assemble_all<10>(table, x, laws, matrix);
}

VectorX internal_forces(const ElementTable& table, const Points& x,
                        const std::vector<ElasticLaw>& laws, const VectorX& u) {
  VectorX f = VectorX::Zero(u.size());
  if (table.pattern.nodes_per_element == 4) {
    add_internal_forces<4>(table, x, laws, u, f);
  } else {
    add_internal_forces<10>(table, x, laws, u, f);
  }
  return f;
}

}  // namespace meniscus
