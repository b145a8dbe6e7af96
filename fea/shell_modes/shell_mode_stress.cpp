#include "fea/shell_modes/shell_mode_stress.h"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/parallel_for.h"
#include "fea/element/stress_measures.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

namespace {

/// Derivatives along the frame's axes of a mode's motion: of the surface, and
/// per height over it.
struct ModeSlopes {
  std::array<Vec3, 2> moved;
  std::array<Vec3, 2> turned;
};

ModeSlopes mode_slopes(const FacetField& x, const FacetPoint& p,
                       const FacetFrame<double>& frame) {
  const Vec3 n = as_vector(frame.axes[2]);
  Vec3 theta = Vec3::Zero();
  for (int i = 0; i < kNodes; ++i) {
    theta += p.shape[i] * x.col(i).tail<3>();
  }
  ModeSlopes slopes;
  for (int a = 0; a < 2; ++a) {
    const auto& g = frame.by_axis[a];
    Six slope = Six::Zero();
    for (int i = 0; i < kNodes; ++i) {
      slope += (g[0] * p.slope(i, 0) + g[1] * p.slope(i, 1)) * x.col(i);
    }
    const Vec3 turning = frame.curvature[a][0] * as_vector(frame.axes[0]) +
                         frame.curvature[a][1] * as_vector(frame.axes[1]);
    slopes.moved[a] = slope.head<3>();
    slopes.turned[a] = slope.tail<3>().cross(n) + theta.cross(turning);
  }
  return slopes;
}

/// Sums over places, each times the work done there.
struct WorkedSums {
  double work = 0.0;
  modes::ModeStress sums;

  void add(double factor, double more, const modes::ModeStress& from) {
    work += more;
    sums.von_mises += factor * from.von_mises;
    sums.strain += factor * from.strain;
    sums.of_yield += factor * from.of_yield;
    sums.position += factor * from.position;
  }
};

/// Of the stress in the surface, 11 22 12, and across it.
double strain_size(const PlyLaw& ply, const Vec3& elastic, const Vec3& plane) {
  const double across = ply.squeeze.dot(plane);
  return std::sqrt(elastic[0] * elastic[0] + elastic[1] * elastic[1] +
                   0.5 * elastic[2] * elastic[2] + across * across);
}

/// One facet with the two fields.
struct ModeFacet {
  const Facet& facet;
  const Section& section;
  WallStates states;
  FacetField u;
  Triple<double> bubble;
  FacetField x;
};

struct ModePoint {
  const ModeFacet& at;
  FacetFrame<double> frame;
  FacetStrain<double> strain;
  WallState state;
  ModeSlopes slopes;
  double area = 0.0;
  double thickness = 0.0;
  Vec3 position = Vec3::Zero();
};

void add_layer(const ModePoint& point, const LayerPoint& layer,
               WorkedSums& sums) {
  const ModeFacet& at = point.at;
  const PlyLaw& ply = at.facet.law->plies[layer.ply];
  const double zeta = (layer.at + at.facet.offset) * point.thickness;
  const Square<double> shift = shifter(point.frame.curvature, zeta);
  const Square<double> back = inverse(shift);
  const Vec3 elastic = as_vector(layer_strain(point.strain, back, zeta).plane) -
                       point.state.free_strain(ply, layer.at);
  const Vec3 s = ply.plane * elastic;
  std::array<Vec3, 2> U;
  for (int i = 0; i < 2; ++i) {
    U[i] =
        back[i][0] * (point.slopes.moved[0] + zeta * point.slopes.turned[0]) +
        back[i][1] * (point.slopes.moved[1] + zeta * point.slopes.turned[1]);
  }
  const double pushed =
      -(s[0] * U[0].squaredNorm() + s[1] * U[1].squaredNorm() +
        2.0 * s[2] * U[0].dot(U[1]));
  if (pushed > 0.0) {
    const double von_mises = element::von_mises(
        {s[0], s[1], point.state.stress(layer.at), s[2], 0.0, 0.0});
    const double yield =
        at.section.laminate.plies[layer.ply].material.yield_strength.value_or(
            std::numeric_limits<double>::quiet_NaN());
    const double work = pushed * point.area * layer.weight * point.thickness *
                        determinant(shift);
    sums.add(work, work,
             {von_mises, strain_size(ply, elastic, s), von_mises / yield,
              point.position});
  }
}

WorkedSums facet_sums(const ModeFacet& at) {
  const auto X = triples(at.facet);
  WorkedSums sums;
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, at.facet.direction);
    ModePoint point{at,
                    frame,
                    facet_strain(X, p, frame, at.u, at.bubble),
                    at.states.at(p),
                    mode_slopes(at.x, p, frame),
                    p.weight * frame.area,
                    thickness_at(at.facet, p)};
    for (int i = 0; i < kNodes; ++i) {
      point.position += p.shape[i] * at.facet.nodes[i];
    }
    for (const LayerPoint& layer : at.facet.law->points) {
      add_layer(point, layer, sums);
    }
  }
  return sums;
}

}  // namespace

modes::ModeStress mode_stress(const ShellMesh& mesh,
                              const std::vector<Section>& sections,
                              const ShellLoads& loads, const VectorX& u,
                              const VectorX& x) {
  check_shell(mesh, sections);
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const std::vector<FacetLoad> own = facet_loads(mesh, loads);
  std::vector<WorkedSums> parts(mesh.facets.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(parts.size()), [&](std::ptrdiff_t k) {
        const int f = static_cast<int>(k);
        const Facet facet = facet_of(mesh, sections, laws, f);
        const FacetVector of_u = numbers_of(mesh, f, u);
        const FacetVector of_x = numbers_of(mesh, f, x);
        const Eigen::Vector2d b = bubble_rotation(
            whole_stiffness(facet), facet_forces(facet, loads, own[k]), of_u);
        const auto axes = bubble_axes(triples(facet));
        parts[k] = facet_sums(
            {facet, sections[mesh.section[f]], wall_states(loads, own[k]),
             Eigen::Map<const FacetField>(of_u.data()), bubble_turn(axes, b),
             Eigen::Map<const FacetField>(of_x.data())});
      });
  WorkedSums all;
  for (const WorkedSums& part : parts) {
    all.add(1.0, part.work, part.sums);
  }
  if (!(all.work > 0.0)) {
    return {};
  }
  WorkedSums mean;
  mean.add(1.0 / all.work, 1.0, all.sums);
  return mean.sums;
}

}  // namespace meniscus::shell
