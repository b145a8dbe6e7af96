/// Stiffness matrices and internal forces of linear elasticity.
#pragma once

#include <optional>
#include <vector>

#include "fea/block_matrix.h"
#include "fea/elastic_law.h"

namespace meniscus {

/// What the assembler knows of a mesh's elements, in the solver's order.
struct ElementTable {
  BlockPattern pattern;
  std::vector<unsigned char> slot;  // per element and node in TetMesh's order:
                                    // its place among the ascending nodes
  std::vector<int> region;          // per element
};

/// `elements`: node ids (solver's) in TetMesh's order, nodes_per_element each.
ElementTable make_element_table(int nodes, int nodes_per_element,
                                const std::vector<int>& elements,
                                std::vector<int> region);

/// Fills `matrix` with K_ab = sum over points of V (lambda g_a g_b^T +
/// mu g_b g_a^T + mu g_a . g_b I), or C g_a g_b^T where a material is not
/// isotropic. Each block adds its elements in their
/// order, whatever the number of threads. `x`: the solver's nodes; `laws`:
/// one per region. Returns the first element (solver's) whose Jacobian
/// determinant is not positive at a point; the matrix is then of no use.
std::optional<int> assemble(const ElementTable& table, const Points& x,
                            const std::vector<ElasticLaw>& laws,
                            BlockMatrix<double>& matrix);

/// Nodal forces that hold the body in displacement u: f = K u, computed from
/// displacement gradients, so that rigid motions give none [force].
VectorX internal_forces(const ElementTable& table, const Points& x,
                        const std::vector<ElasticLaw>& laws, const VectorX& u);

}  // namespace meniscus
