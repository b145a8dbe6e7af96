/// The stiffness of a shell, facet by facet.
#pragma once

#include <map>
#include <vector>

#include "fea/shell/facet_matrices.h"
#include "fea/shell/shell_assembly.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

/// Mesh and sections are kept by reference.
class ShellStiffness {
 public:
  /// Throws MeshError and InvalidInput as check_shell() and laminate_law() do,
  /// InvalidInput for springs between nodes of no one facet.
  ShellStiffness(const ShellMesh& mesh, const std::vector<Section>& sections,
                 const FacetRule& rule = facet_rule(),
                 const std::vector<GroundSpring>& springs = {});

  /// Of one facet, without its bubble, and the springs that it is the first to
  /// have.
  FacetMatrix of(int facet) const;
  /// K u, 6 per node: what holds the shell in u. The same bits for any number
  /// of threads.
  VectorX times(const VectorX& u) const;

  /// One per section.
  const std::vector<LaminateLaw>& laws() const { return laws_; }

 private:
  const ShellMesh& mesh_;
  const std::vector<Section>& sections_;
  const FacetRule& rule_;
  std::vector<LaminateLaw> laws_;
  std::map<int, std::vector<GroundSpring>> springs_;  // by facet
};

/// What all facets' matrices make of `u`, 6 per node: the same bits for any
/// number of threads.
VectorX facets_times(const ShellMesh& mesh, const MatrixOfFacet& matrix,
                     const VectorX& u);

}  // namespace meniscus::shell
