/// Stiffness matrices and internal forces of linear elasticity.
#pragma once

#include <optional>
#include <vector>

#include "fea/element/elastic_law.h"
#include "fea/solver/block_matrix.h"

namespace meniscus::solver {

/// What the assembler knows of a mesh's elements, in the solver's order.
struct ElementTable {
  BlockPattern pattern;
  std::vector<unsigned char> slot;  // per element and node in TetMesh's order:
                                    // its place among the ascending nodes
  std::vector<int> region;          // per element
  std::vector<int> chunk_first;     // elements of each chunk of rows: those
                                    // whose lowest node is in it; chunks + 1
};

/// work(e) for every element. Chunks of one colour side by side: elements that
/// share a node are never visited at the same time, nor in another order.
template <class Work>
void over_elements(const ElementTable& table, const Work& work) {
  over_chunks(table.pattern.chunks, RowOrder::Forward, [&](int chunk) {
    for (int e = table.chunk_first[chunk]; e < table.chunk_first[chunk + 1];
         ++e) {
      work(e);
    }
  });
}

/// `elements`: node ids (solver's) in TetMesh's order, nodes_per_element each;
/// elements ascend by their lowest node.
ElementTable make_element_table(RowChunks chunks, int nodes_per_element,
                                const std::vector<int>& elements,
                                std::vector<int> region);

/// The same without the places of blocks (start, column and pair_block of the
/// pattern): a tenth of the memory, enough for internal_forces().
ElementTable make_element_list(RowChunks chunks, int nodes_per_element,
                               const std::vector<int>& elements,
                               std::vector<int> region);

/// The first element (solver's) whose Jacobian determinant is not positive at
/// a point of the stiffness rule.
std::optional<int> first_bad_element(const ElementTable& table,
                                     const Points& x);

/// Fills `matrix` with K_ab = sum over points of V (lambda g_a g_b^T +
/// mu g_b g_a^T + mu g_a . g_b I), or C g_a g_b^T where a material is not
/// isotropic. Each block adds its elements in one order, whatever the number of
/// threads. `x`: the solver's nodes; `laws`: one per region. Returns the first
/// element (solver's) whose Jacobian determinant is not positive at a point;
/// the matrix is then of no use.
std::optional<int> assemble(const ElementTable& table, const Points& x,
                            const std::vector<element::ElasticLaw>& laws,
                            BlockMatrix<double>& matrix);

/// Nodal forces that hold the body in displacement u: f = K u, computed from
/// displacement gradients, so that rigid motions give none [force].
VectorX internal_forces(const ElementTable& table, const Points& x,
                        const std::vector<element::ElasticLaw>& laws,
                        const VectorX& u);

}  // namespace meniscus::solver
