#include "fea/shell/taped_facet.h"

#include <algorithm>

namespace meniscus::shell {

TapedFacet::TapedFacet(const Facet& facet, Tape& tape) : tape_(&tape) {
  tape.clear();
  for (int i = 0; i < kNodes; ++i) {
    for (int c = 0; c < 3; ++c) {
      X[i][c] = tape.input(facet.nodes[i][c], 0.0);
    }
  }
  for (int c = 0; c < 3; ++c) {
    thickness[c] = tape.input(facet.thickness[c], 0.0);
  }
  axes_ = bubble_axes(X);
}

Taped TapedFacet::thickness_at(const FacetPoint& p) const {
  const Vec3 share = corner_shares(p);
  return share[0] * thickness[0] + share[1] * thickness[1] +
         share[2] * thickness[2];
}

Triple<Taped> TapedFacet::bubble(const Eigen::Vector2d& numbers) const {
  return bubble_turn(axes_, numbers);
}

ByShape TapedFacet::transpose(const Taped& result) const {
  ByShape by = {};
  ByShape by_rates = {};
  tape_->transpose(result, 1.0, 0.0, by, by_rates);
  return by;
}

ShellGradient empty_gradient(const ShellMesh& mesh) {
  ShellGradient gradient;
  gradient.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
  gradient.by_thickness.assign(mesh.facets.size(), Vec3::Zero());
  gradient.by_actions.facets.assign(mesh.facets.size(), ByLoads::Zero());
  return gradient;
}

void add_facet(const ShellMesh& mesh, int f, const FacetGradient& part,
               ShellGradient& sum) {
  sum.value += part.value;
  for (int i = 0; i < kNodes; ++i) {
    sum.by_nodes[mesh.facets[f][i]] +=
        Vec3(part.by[3 * i], part.by[3 * i + 1], part.by[3 * i + 2]);
  }
  constexpr int kFirst = 3 * kNodes;
  sum.by_thickness[f] +=
      Vec3(part.by[kFirst], part.by[kFirst + 1], part.by[kFirst + 2]);
  sum.by_actions.facets[f] += part.by_loads;
  sum.by_actions.mass.add(1.0, part.by_mass);
  const auto section = static_cast<std::size_t>(mesh.section[f]);
  sum.by_ply.resize(std::max(sum.by_ply.size(), section + 1));
  std::vector<PlyGradient>& plies = sum.by_ply[section];
  plies.resize(std::max(plies.size(), part.by_ply.size()));
  for (std::size_t p = 0; p < part.by_ply.size(); ++p) {
    plies[p].modulus += part.by_ply[p].modulus;
    plies[p].density += part.by_ply[p].density;
    plies[p].angle += part.by_ply[p].angle;
  }
}

ShellGradient gradient_of(const ShellMesh& mesh,
                          const std::vector<FacetGradient>& parts) {
  ShellGradient sum = empty_gradient(mesh);
  for (std::size_t f = 0; f < parts.size(); ++f) {
    add_facet(mesh, static_cast<int>(f), parts[f], sum);
  }
  return sum;
}

}  // namespace meniscus::shell
