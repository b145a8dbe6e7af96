#include "fea/shell/shell_stiffness.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"

namespace meniscus::shell {

namespace {

std::vector<LaminateLaw> checked_laws(const ShellMesh& mesh,
                                      const std::vector<Section>& sections) {
  check_shell(mesh, sections);
  return laminate_laws(sections);
}

int facet_of_both(const ShellMesh& mesh, const NodeFacets& facets,
                  const GroundSpring& spring) {
  const auto nodes = static_cast<int>(mesh.nodes.size());
  if (spring.at >= 0 && spring.at < nodes) {
    for (int k = facets.start[spring.at]; k < facets.start[spring.at + 1];
         ++k) {
      const auto& own = mesh.facets[facets.facet[k]];
      if (std::count(own.begin(), own.end(), spring.from) > 0) {
        return facets.facet[k];
      }
    }
  }
  throw InvalidInput(
      fmt::format("a spring to the ground is between the nodes {} and {}, "
                  "which no facet of {} nodes has",
                  spring.at, spring.from, nodes));
}

void add_spring(const std::array<int, 6>& nodes, const GroundSpring& spring,
                FacetMatrix& K) {
  const auto place = [&](int node) {
    return 6 * (std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  const auto at = place(spring.at);
  const auto from = place(spring.from);
  K.block<3, 3>(at, from) += spring.block;
  if (at != from) {
    K.block<3, 3>(from, at) += spring.block.transpose();
  }
}

}  // namespace

ShellStiffness::ShellStiffness(const ShellMesh& mesh,
                               const std::vector<Section>& sections,
                               const FacetRule& rule,
                               const std::vector<GroundSpring>& springs)
    : mesh_(mesh),
      sections_(sections),
      rule_(rule),
      laws_(checked_laws(mesh, sections)) {
  if (!springs.empty()) {
    const NodeFacets facets = node_facets(mesh);
    for (const GroundSpring& spring : springs) {
      springs_[facet_of_both(mesh, facets, spring)].push_back(spring);
    }
  }
}

FacetMatrix ShellStiffness::of(int facet) const {
  FacetMatrix K = condensed(
      whole_stiffness(facet_of(mesh_, sections_, laws_, facet), rule_));
  if (const auto own = springs_.find(facet); own != springs_.end()) {
    for (const GroundSpring& spring : own->second) {
      add_spring(mesh_.facets[facet], spring, K);
    }
  }
  return K;
}

VectorX ShellStiffness::times(const VectorX& u) const {
  return facets_times(
      mesh_, [this](int facet) { return of(facet); }, u);
}

VectorX facets_times(const ShellMesh& mesh, const MatrixOfFacet& matrix,
                     const VectorX& u) {
  std::vector<FacetVector> forces(mesh.facets.size());
  parallel_for(static_cast<std::ptrdiff_t>(forces.size()),
               [&](std::ptrdiff_t k) {
                 const auto facet = static_cast<int>(k);
                 forces[k] = matrix(facet) * numbers_of(mesh, facet, u);
               });
  VectorX f = VectorX::Zero(u.size());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    for (int i = 0; i < kNodes; ++i) {
      f.segment<6>(6L * mesh.facets[k][i]) += forces[k].segment<6>(6 * i);
    }
  }
  return f;
}

}  // namespace meniscus::shell
