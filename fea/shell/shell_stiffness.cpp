#include "fea/shell/shell_stiffness.h"

#include "core/parallel_for.h"

namespace meniscus::shell {

namespace {

std::vector<LaminateLaw> checked_laws(const ShellMesh& mesh,
                                      const std::vector<Section>& sections) {
  check_shell(mesh, sections);
  return laminate_laws(sections);
}

}  // namespace

ShellStiffness::ShellStiffness(const ShellMesh& mesh,
                               const std::vector<Section>& sections,
                               const FacetRule& rule)
    : mesh_(mesh),
      sections_(sections),
      rule_(rule),
      laws_(checked_laws(mesh, sections)) {}

FacetMatrix ShellStiffness::of(int facet) const {
  return condensed(
      whole_stiffness(facet_of(mesh_, sections_, laws_, facet), rule_));
}

VectorX ShellStiffness::times(const VectorX& u) const {
  std::vector<FacetVector> forces(mesh_.facets.size());
  parallel_for(static_cast<std::ptrdiff_t>(forces.size()),
               [&](std::ptrdiff_t k) {
                 const auto facet = static_cast<int>(k);
                 forces[k] = of(facet) * numbers_of(mesh_, facet, u);
               });
  VectorX f = VectorX::Zero(u.size());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    for (int i = 0; i < kNodes; ++i) {
      f.segment<6>(6L * mesh_.facets[k][i]) += forces[k].segment<6>(6 * i);
    }
  }
  return f;
}

}  // namespace meniscus::shell
