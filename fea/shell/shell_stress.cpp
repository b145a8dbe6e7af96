#include "fea/shell/shell_stress.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/facet_matrices.h"

namespace meniscus::shell {

namespace {

using element::Stress;

Stress global_stress(const FacetFrame<double>& frame, const Vec3& plane,
                     const Eigen::Vector2d& across, double normal) {
  Mat3 own;
  own << plane[0], plane[2], across[0],  //
      plane[2], plane[1], across[1],     //
      across[0], across[1], normal;
  Mat3 axes;
  axes << as_vector(frame.axes[0]), as_vector(frame.axes[1]),
      as_vector(frame.axes[2]);
  const Mat3 s = axes * own * axes.transpose();
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
}

/// The ply at a height between the faces, the lower of two.
int ply_at(const LaminateLaw& law, double at) {
  int ply = 0;
  while (ply + 1 < static_cast<int>(law.plies.size()) && law.to[ply] < at) {
    ++ply;
  }
  return ply;
}

struct WallPoint {
  const Facet& facet;
  const FacetFrame<double>& frame;
  const FacetStrain<double>& strain;
  double thickness;
  const WallState& state;
};

Stress stress_at(const WallPoint& point, double at, double transverse) {
  const LaminateLaw& law = *point.facet.law;
  const PlyLaw& ply = law.plies[ply_at(law, at)];
  const double zeta = (at + point.facet.offset) * point.thickness;
  const LayerStrain<double> e = layer_strain(
      point.strain, inverse(shifter(point.frame.curvature, zeta)), zeta);
  const Vec3 strain = as_vector(e.plane) - point.state.free_strain(ply, at);
  const Eigen::Vector2d across = transverse * law.shear_correction *
                                 ply.across *
                                 Eigen::Vector2d(e.across[0], e.across[1]);
  return global_stress(point.frame, ply.plane * strain, across,
                       point.state.stress(at));
}

/// Points (1/6, 1/6), (2/3, 1/6), (1/6, 2/3).
const std::array<FacetPoint, 3>& inner_points() {
  static const std::array<FacetPoint, 3> points = {
      facet_point(1.0 / 6.0, 1.0 / 6.0), facet_point(2.0 / 3.0, 1.0 / 6.0),
      facet_point(1.0 / 6.0, 2.0 / 3.0)};
  return points;
}

/// Linear functions through the inner points, at the nodes.
constexpr double kOut[kNodes][3] = {
    {5.0 / 3.0, -1.0 / 3.0, -1.0 / 3.0}, {-1.0 / 3.0, 5.0 / 3.0, -1.0 / 3.0},
    {-1.0 / 3.0, -1.0 / 3.0, 5.0 / 3.0}, {2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0},
    {-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0},  {2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0}};

void add(WallStress& sum, double weight, const WallStress& stress) {
  for (int c = 0; c < 6; ++c) {
    sum.negative[c] += weight * stress.negative[c];
    sum.middle[c] += weight * stress.middle[c];
    sum.positive[c] += weight * stress.positive[c];
  }
}

FacetStress facet_stress(const Facet& facet, const ShellLoads& loads,
                         const FacetLoad& own, const FacetVector& u) {
  const auto X = triples(facet);
  const Eigen::Vector2d b = bubble_rotation(whole_stiffness(facet),
                                            facet_forces(facet, loads, own), u);
  const WallState state = wall_state(loads, own);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble = bubble_turn(axes, b);
  const FacetField field = Eigen::Map<const FacetField>(u.data());
  FacetStress result{};
  for (int q = 0; q < 3; ++q) {
    const FacetPoint& p = inner_points()[q];
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> strain = facet_strain(X, p, frame, field, bubble);
    const WallPoint point{facet, frame, strain, thickness_at(facet, p), state};
    const WallStress wall = {stress_at(point, -0.5, 0.0),
                             stress_at(point, 0.0, 1.5),
                             stress_at(point, 0.5, 0.0)};
    for (int i = 0; i < kNodes; ++i) {
      add(result[i], kOut[i][q], wall);
    }
  }
  return result;
}

}  // namespace

std::vector<FacetStress> shell_stress(const ShellMesh& mesh,
                                      const std::vector<Section>& sections,
                                      const ShellLoads& loads,
                                      const VectorX& displacement) {
  check_shell(mesh, sections);
  if (displacement.size() != static_cast<Eigen::Index>(6 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("a shell of {} nodes has a displacement of {} numbers; "
                    "six a node are needed",
                    mesh.nodes.size(), displacement.size()));
  }
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const std::vector<FacetLoad> own = facet_loads(mesh, loads);
  std::vector<FacetStress> stress(mesh.facets.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(stress.size()), [&](std::ptrdiff_t k) {
        const int f = static_cast<int>(k);
        stress[k] = facet_stress(facet_of(mesh, sections, laws, f), loads,
                                 own[k], numbers_of(mesh, f, displacement));
      });
  return stress;
}

std::vector<FacetStress> averaged_stress(const ShellMesh& mesh,
                                         const std::vector<FacetStress>& stress,
                                         double fold) {
  struct Use {
    int facet;
    int place;
    Vec3 normal;
  };
  std::vector<std::vector<Use>> uses(mesh.nodes.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto& c = mesh.facets[f];
    const Vec3& o = mesh.nodes[c[0]];
    const Vec3 n =
        (mesh.nodes[c[1]] - o).cross(mesh.nodes[c[2]] - o).normalized();
    for (int i = 0; i < kNodes; ++i) {
      uses[c[i]].push_back({static_cast<int>(f), i, n});
    }
  }
  const double least = std::cos(fold);
  std::vector<FacetStress> mean(stress.size());
  for (const auto& at : uses) {
    for (const Use& own : at) {
      WallStress sum{};
      double count = 0.0;
      for (const Use& other : at) {
        if (own.normal.dot(other.normal) >= least) {
          add(sum, 1.0, stress[other.facet][other.place]);
          count += 1.0;
        }
      }
      add(mean[own.facet][own.place], 1.0 / count, sum);
    }
  }
  return mean;
}

}  // namespace meniscus::shell
