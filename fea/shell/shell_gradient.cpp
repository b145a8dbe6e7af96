#include "fea/shell/shell_gradient.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/taped.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_matrices.h"

namespace meniscus::shell {

namespace {

constexpr int kInputs = 3 * kNodes + 3;  // nodes' places, thicknesses

/// One of the two fields, with the bubble of least energy.
struct WholeField {
  FacetField nodes;
  Eigen::Vector2d bubble;
};

struct TapedWall {
  FacetFrame<Taped> frame;
  Taped thickness;
};

/// v H u per area of the surface.
Taped work(const Facet& facet, const TapedWall& wall,
           const FacetStrain<Taped>& v, const FacetStrain<Taped>& u) {
  const LaminateLaw& law = *facet.law;
  Taped sum(0.0);
  for (const LayerPoint& point : law.points) {
    const Taped zeta = (point.at + facet.offset) * wall.thickness;
    const Square<Taped> shift = shifter(wall.frame.curvature, zeta);
    const Square<Taped> back = inverse(shift);
    const LayerStrain<Taped> a = layer_strain(v, back, zeta);
    const LayerStrain<Taped> b = layer_strain(u, back, zeta);
    const PlyLaw& ply = law.plies[point.ply];
    Taped density(0.0);
    for (int i = 0; i < 3; ++i) {
      density = density + a.plane[i] * (ply.plane(i, 0) * b.plane[0] +
                                        ply.plane(i, 1) * b.plane[1] +
                                        ply.plane(i, 2) * b.plane[2]);
    }
    for (int i = 0; i < 2; ++i) {
      density = density + law.shear_correction * a.across[i] *
                              (ply.across(i, 0) * b.across[0] +
                               ply.across(i, 1) * b.across[1]);
    }
    sum = sum + point.weight * determinant(shift) * density;
  }
  const Taped skew =
      (v.stretch[0][1] - v.stretch[1][0]) * (u.stretch[0][1] - u.stretch[1][0]);
  return wall.thickness * (sum + kDrilling * law.mean_shear * skew);
}

struct FacetGradient {
  double value = 0.0;
  std::array<double, kInputs> by_input = {};
};

FacetGradient facet_gradient(const Facet& facet, const WholeField& v,
                             const WholeField& u, Tape& tape) {
  tape.clear();
  std::array<Triple<Taped>, kNodes> X;
  for (int i = 0; i < kNodes; ++i) {
    for (int c = 0; c < 3; ++c) {
      X[i][c] = tape.input(facet.nodes[i][c], 0.0);
    }
  }
  std::array<Taped, 3> t;
  for (int c = 0; c < 3; ++c) {
    t[c] = tape.input(facet.thickness[c], 0.0);
  }
  const auto axes = bubble_axes(X);
  const auto bubble = [&](const WholeField& field) {
    return plus(times(field.bubble[0], axes[0]), field.bubble[1], axes[1]);
  };
  const Triple<Taped> of_v = bubble(v);
  const Triple<Taped> of_u = bubble(u);
  Taped sum(0.0);
  for (const FacetPoint& p : facet_rule()) {
    const Vec3 share = corner_shares(p);
    const TapedWall wall = {
        facet_frame(X, p, facet.direction),
        share[0] * t[0] + share[1] * t[1] + share[2] * t[2]};
    sum = sum + p.weight * wall.frame.area *
                    work(facet, wall,
                         facet_strain(X, p, wall.frame, v.nodes, of_v),
                         facet_strain(X, p, wall.frame, u.nodes, of_u));
  }
  FacetGradient result;
  result.value = sum.value;
  std::array<double, kInputs> by_rates = {};
  tape.transpose(sum, 1.0, 0.0, result.by_input, by_rates);
  return result;
}

}  // namespace

ShellGradient stiffness_gradient(const ShellMesh& mesh,
                                 const std::vector<Section>& sections,
                                 const VectorX& v, const VectorX& u) {
  check_shell(mesh, sections);
  const auto length = static_cast<Eigen::Index>(6 * mesh.nodes.size());
  if (u.size() != length || v.size() != length) {
    throw InvalidInput(
        fmt::format("a shell of {} nodes has vectors of {} and {} numbers; six "
                    "a node are needed",
                    mesh.nodes.size(), v.size(), u.size()));
  }
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  std::vector<FacetGradient> parts(mesh.facets.size());
  parallel_for(static_cast<std::ptrdiff_t>(parts.size()),
               [&](std::ptrdiff_t k) {
                 static thread_local Tape tape;
                 const int f = static_cast<int>(k);
                 const Facet facet = facet_of(mesh, sections, laws, f);
                 const WholeMatrix K = whole_stiffness(facet);
                 const auto field = [&](const VectorX& nodal) -> WholeField {
                   const FacetVector own = numbers_of(mesh, f, nodal);
                   return {Eigen::Map<const FacetField>(own.data()),
                           bubble_rotation(K, WholeVector::Zero(), own)};
                 };
                 parts[k] = facet_gradient(facet, field(v), field(u), tape);
               });
  ShellGradient gradient;
  gradient.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
  for (std::size_t f = 0; f < parts.size(); ++f) {
    const auto& by = parts[f].by_input;
    gradient.value += parts[f].value;
    for (int i = 0; i < kNodes; ++i) {
      gradient.by_nodes[mesh.facets[f][i]] +=
          Vec3(by[3 * i], by[3 * i + 1], by[3 * i + 2]);
    }
    gradient.by_thickness.emplace_back(by[18], by[19], by[20]);
  }
  return gradient;
}

}  // namespace meniscus::shell
