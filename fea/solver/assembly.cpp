#include "fea/solver/assembly.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include <Eigen/Geometry>

#include "core/operation_count.h"
#include "fea/element/element_stiffness.h"
#include "fea/element/tet_element.h"
#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

namespace {

template <int Nodes>
void load_nodes(const ElementTable& table, const Points& x, int e,
                std::array<Vec3, Nodes>& corner) {
  const std::size_t first = static_cast<std::size_t>(e) * Nodes;
  for (int a = 0; a < Nodes; ++a) {
    corner[a] = x[table.pattern.element_nodes[first + table.slot[first + a]]];
  }
}

/// Adds the blocks of one element; false when it is bad.
template <int Nodes>
bool add_element(const ElementTable& table, const Points& x,
                 const std::vector<element::ElasticLaw>& laws, int e,
                 BlockMatrix<double>& matrix) {
  const BlockPattern& p = table.pattern;
  constexpr int kPairs = Nodes * (Nodes - 1) / 2;
  std::array<Vec3, Nodes> corner;
  load_nodes<Nodes>(table, x, e, corner);
  const std::size_t first = static_cast<std::size_t>(e) * Nodes;
  const int* ids = p.element_nodes.data() + first;
  const int* block = p.pair_block.data() + static_cast<std::size_t>(e) * kPairs;
  return element::add_element_stiffness<Nodes>(
      corner, table.slot.data() + first, laws[table.region[e]],
      [&](int a, int b) {
        return a == b ? matrix.diagonal.data() + 9L * ids[a]
                      : matrix.lower.data() + 9L * block[a * (a - 1) / 2 + b];
      });
}

template <int Nodes>
std::optional<int> first_bad(const ElementTable& table, const Points& x) {
  std::array<Vec3, Nodes> corner;
  element::TetGradients<Nodes> g;
  for (int e = 0; e < table.pattern.element_count(); ++e) {
    load_nodes<Nodes>(table, x, e, corner);
    if (!element::tet_gradients<Nodes>(corner, g)) {
      return e;
    }
  }
  return std::nullopt;
}

/// The outer products of all elements and their blocks; gradients of the shape
/// functions, a tenth of it, are not counted.
template <int Nodes>
double element_work(const ElementTable& table,
                    const std::vector<element::ElasticLaw>& laws) {
  constexpr double kRows = 3.0 * Nodes;
  constexpr double kPoints = element::kTetPoints<Nodes>;
  constexpr double kBlocks = Nodes * (Nodes + 1) / 2.0;
  constexpr double kIsotropic = 37.0;
  constexpr double kTensor = 9.0 * (2 * 9 + 1);
  constexpr double kProducts = kRows * (kPoints + kRows * (2 * kPoints - 1));
  double work = 0.0;
  for (const int region : table.region) {
    work +=
        kProducts + kBlocks * (laws[static_cast<std::size_t>(region)].isotropic
                                   ? kIsotropic
                                   : kTensor);
  }
  return work;
}

template <int Nodes>
std::optional<int> assemble_all(const ElementTable& table, const Points& x,
                                const std::vector<element::ElasticLaw>& laws,
                                BlockMatrix<double>& matrix) {
  const BlockPattern& p = table.pattern;
  count_operations(element_work<Nodes>(table, laws));
  over_chunks(p.chunks, RowOrder::Forward, [&](int chunk) {
    const int low = p.chunks.first[chunk];
    const int high = p.chunks.first[chunk + 1];
    std::fill(matrix.diagonal.begin() + 9L * low,
              matrix.diagonal.begin() + 9L * high, 0.0);
    std::fill(matrix.lower.begin() + 9L * p.start[low],
              matrix.lower.begin() + 9L * p.start[high], 0.0);
  });
  std::atomic<int> bad = p.element_count();
  over_elements(table, [&](int e) {
    if (!add_element<Nodes>(table, x, laws, e, matrix)) {
      int least = bad;
      while (e < least && !bad.compare_exchange_weak(least, e)) {
      }
    }
  });
  return bad == p.element_count() ? std::nullopt : std::optional<int>(bad);
}

template <int Nodes>
void add_internal_forces(const ElementTable& table, const Points& x,
                         const std::vector<element::ElasticLaw>& laws,
                         const VectorX& u, VectorX& f) {
  over_elements(table, [&](int e) {
    std::array<Vec3, Nodes> corner;
    load_nodes<Nodes>(table, x, e, corner);
    element::TetGradients<Nodes> g;
    element::tet_gradients<Nodes>(corner, g);
    const element::ElasticLaw& law = laws[table.region[e]];
    const std::size_t first = static_cast<std::size_t>(e) * Nodes;
    std::array<int, Nodes> ids;
    std::array<Vec3, Nodes> du;  // relative to one node: no rigid shift
    for (int a = 0; a < Nodes; ++a) {
      ids[a] = table.pattern.element_nodes[first + table.slot[first + a]];
      du[a] = u.segment<3>(3 * ids[a]) - u.segment<3>(3 * ids[0]);
    }
    for (int q = 0; q < element::kTetPoints<Nodes>; ++q) {
      Mat3 H = Mat3::Zero();
      for (int a = 1; a < Nodes; ++a) {
        H.noalias() += du[a] * g.gradient[q][a].transpose();
      }
      const Mat3 stress = g.volume[q] * law.stress(H);
      for (int a = 0; a < Nodes; ++a) {
        f.segment<3>(3 * ids[a]).noalias() += stress * g.gradient[q][a];
      }
    }
  });
}

}  // namespace

ElementTable make_element_list(RowChunks chunks, int nodes_per_element,
                               const std::vector<int>& elements,
                               std::vector<int> region) {
  ElementTable table;
  table.slot.resize(elements.size());
  std::vector<int>& ascending = table.pattern.element_nodes;
  ascending.resize(elements.size());
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
  const int count = static_cast<int>(elements.size()) / nodes_per_element;
  int e = 0;
  for (const int row : chunks.first) {
    while (e < count &&
           ascending[static_cast<std::size_t>(e) * nodes_per_element] < row) {
      ++e;
    }
    table.chunk_first.push_back(e);
  }
  table.pattern.nodes = chunks.first.back();
  table.pattern.chunks = std::move(chunks);
  table.pattern.nodes_per_element = nodes_per_element;
  return table;
}

ElementTable make_element_table(RowChunks chunks, int nodes_per_element,
                                const std::vector<int>& elements,
                                std::vector<int> region) {
  ElementTable table = make_element_list(std::move(chunks), nodes_per_element,
                                         elements, std::move(region));
  table.pattern =
      make_pattern(std::move(table.pattern.chunks), nodes_per_element,
                   std::move(table.pattern.element_nodes));
  return table;
}

std::optional<int> first_bad_element(const ElementTable& table,
                                     const Points& x) {
  return table.pattern.nodes_per_element == 4 ? first_bad<4>(table, x)
                                              : first_bad<10>(table, x);
}

std::optional<int> assemble(const ElementTable& table, const Points& x,
                            const std::vector<element::ElasticLaw>& laws,
                            BlockMatrix<double>& matrix) {
  matrix.diagonal.resize(9L * table.pattern.nodes + kBlockPadding);
  matrix.lower.resize(9L * table.pattern.column.size() + kBlockPadding);
  return table.pattern.nodes_per_element == 4
             ? assemble_all<4>(table, x, laws, matrix)
             : assemble_all<10>(table, x, laws, matrix);
}

VectorX internal_forces(const ElementTable& table, const Points& x,
                        const std::vector<element::ElasticLaw>& laws,
                        const VectorX& u) {
  VectorX f = VectorX::Zero(u.size());
  if (table.pattern.nodes_per_element == 4) {
    add_internal_forces<4>(table, x, laws, u, f);
  } else {
    add_internal_forces<10>(table, x, laws, u, f);
  }
  return f;
}

}  // namespace meniscus::solver
