/// A facet whose nodes and thicknesses are inputs of a tape: what is computed
/// from them has its derivatives by both.
#pragma once

#include <array>
#include <vector>

#include "core/math/taped.h"
#include "fea/shell/facet_matrices.h"
#include "fea/shell/shell_gradient.h"

namespace meniscus::shell {

inline constexpr int kShapeInputs = 3 * kNodes + 3;  // places, thicknesses
using ByShape = std::array<double, kShapeInputs>;

struct TapedFacet {
  /// Clears the tape, which is not owned.
  TapedFacet(const Facet& facet, Tape& tape);

  Taped thickness_at(const FacetPoint& p) const;
  /// A bubble's rotation by its two numbers.
  Triple<Taped> bubble(const Eigen::Vector2d& numbers) const;
  /// The result's derivatives by places and thicknesses.
  ByShape transpose(const Taped& result) const;

  std::array<Triple<Taped>, kNodes> X;
  std::array<Taped, 3> thickness;  // at the corners

 private:
  Tape* tape_;
  std::array<Triple<Taped>, 2> axes_;  // of the bubble
};

/// A facet's part of a value.
struct FacetGradient {
  double value = 0.0;
  ByShape by = {};
  std::vector<PlyGradient> by_ply;  // empty: 0
  ByLoads by_loads = ByLoads::Zero();
  ByMass by_mass = {};
};

/// With that by the nodes' numbers and the bubble's two.
struct WholeGradient : FacetGradient {
  WholeVector by_whole = WholeVector::Zero();
};

/// work(field of the nodes, bubble's rotation), which is linear in both, by
/// each of the numbers; `axes` are the bubble's.
template <class Work>
void add_linear_work(const std::array<Triple<double>, 2>& axes,
                     const Work& work, WholeVector& sum) {
  const Triple<double> still = {0.0, 0.0, 0.0};
  for (int n = 0; n < kUnknowns; ++n) {
    FacetField unit = FacetField::Zero();
    unit(n % 6, n / 6) = 1.0;
    sum[n] += work(unit, still);
  }
  for (int k = 0; k < 2; ++k) {
    sum[kUnknowns + k] += work(FacetField::Zero(), axes[k]);
  }
}

/// Of no value, with its vectors' lengths.
ShellGradient empty_gradient(const ShellMesh& mesh);

/// Adds that of facet f to its nodes' and corners'.
void add_facet(const ShellMesh& mesh, int f, const FacetGradient& part,
               ShellGradient& sum);

/// The sum of all facets, in their order.
ShellGradient gradient_of(const ShellMesh& mesh,
                          const std::vector<FacetGradient>& parts);

}  // namespace meniscus::shell
