#include "fea/shell/taped_facet.h"

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
  return plus(times(numbers[0], axes_[0]), numbers[1], axes_[1]);
}

ByShape TapedFacet::transpose(const Taped& result) const {
  ByShape by = {};
  ByShape by_rates = {};
  tape_->transpose(result, 1.0, 0.0, by, by_rates);
  return by;
}

void add_by_shape(const ShellMesh& mesh, int f, const ByShape& by,
                  ShellGradient& gradient) {
  for (int i = 0; i < kNodes; ++i) {
    gradient.by_nodes[mesh.facets[f][i]] +=
        Vec3(by[3 * i], by[3 * i + 1], by[3 * i + 2]);
  }
  constexpr int kFirst = 3 * kNodes;
  gradient.by_thickness[f] += Vec3(by[kFirst], by[kFirst + 1], by[kFirst + 2]);
}

}  // namespace meniscus::shell
