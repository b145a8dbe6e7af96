#include "fea/shell/shell_gradient.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/taped_facet.h"

namespace meniscus::shell {

namespace {

/// One of the two fields, with its bubble.
struct WholeField {
  FacetField nodes;
  Eigen::Vector2d bubble;
};

struct TapedWall {
  FacetFrame<Taped> frame;
  Taped thickness;
};

/// All that one point of a facet needs.
struct TapedPoint {
  const Facet& facet;
  const FacetPoint& point;
  const std::array<Triple<Taped>, kNodes>& X;
  TapedWall wall;
};

TapedPoint taped_point(const Facet& facet, const TapedFacet& taped,
                       const FacetPoint& p) {
  return {facet,
          p,
          taped.X,
          {facet_frame(taped.X, p, facet.direction), taped.thickness_at(p)}};
}

/// visit(zeta, weight, inverse of the shifter, layer) through the thickness,
/// the weight per area of the surface.
template <class Visit>
void for_each_taped_layer(const TapedPoint& at, const Visit& visit) {
  for (const LayerPoint& layer : at.facet.law->points) {
    const Taped zeta = (layer.at + at.facet.offset) * at.wall.thickness;
    const Square<Taped> shift = shifter(at.wall.frame.curvature, zeta);
    visit(zeta, layer.weight * at.wall.thickness * determinant(shift),
          inverse(shift), layer);
  }
}

/// a . Q b.
template <class B>
Taped product(const Triple<Taped>& a, const Mat3& Q, const B& b) {
  Taped sum(0.0);
  for (int i = 0; i < 3; ++i) {
    sum = sum + a[i] * (Q(i, 0) * b[0] + Q(i, 1) * b[1] + Q(i, 2) * b[2]);
  }
  return sum;
}

/// v (H u - free stresses) per area of the surface.
Taped inner_work(const TapedPoint& at, const WallState& state,
                 const FacetStrain<Taped>& v, const FacetStrain<Taped>& u) {
  const LaminateLaw& law = *at.facet.law;
  Taped sum(0.0);
  for_each_taped_layer(
      at, [&](const Taped& zeta, const Taped& weight, const Square<Taped>& back,
              const LayerPoint& layer) {
        const LayerStrain<Taped> a = layer_strain(v, back, zeta);
        const LayerStrain<Taped> b = layer_strain(u, back, zeta);
        const PlyLaw& ply = law.plies[layer.ply];
        const Vec3 free = state.free_strain(ply, layer.at);
        Taped density =
            product(a.plane, ply.plane,
                    Triple<Taped>{b.plane[0] - free[0], b.plane[1] - free[1],
                                  b.plane[2] - free[2]});
        for (int i = 0; i < 2; ++i) {
          density = density + a.across[i] * (law.across(i, 0) * b.across[0] +
                                             law.across(i, 1) * b.across[1]);
        }
        sum = sum + weight * density;
      });
  const Taped skew =
      (v.stretch[0][1] - v.stretch[1][0]) * (u.stretch[0][1] - u.stretch[1][0]);
  return sum + kDrilling * law.mean_shear * at.wall.thickness * skew;
}

/// Force per mass at a place.
Triple<Taped> taped_acceleration(const ShellLoads& loads,
                                 const Triple<Taped>& x) {
  const Vec3& g = loads.gravity;
  Triple<Taped> a = {Taped(g[0]), Taped(g[1]), Taped(g[2])};
  if (loads.spin) {
    const Vec3 unit = loads.spin->axis.normalized();
    const Vec3& o = loads.spin->point;
    const Triple<double> axis = {unit[0], unit[1], unit[2]};
    const Triple<Taped> arm = {x[0] - o[0], x[1] - o[1], x[2] - o[2]};
    const Triple<Taped> out = plus(arm, -dot(arm, axis), axis);
    a = plus(a, loads.spin->rate * loads.spin->rate, out);
  }
  if (loads.mass_force) {
    const MassForce& force = *loads.mass_force;
    for (int i = 0; i < 3; ++i) {
      a[i] = a[i] + force.at_origin[i] + force.slope(i, 0) * x[0] +
             force.slope(i, 1) * x[1] + force.slope(i, 2) * x[2];
    }
  }
  return a;
}

/// What pressures, weight and spin do on v, per area of the surface.
Taped outer_work(const TapedPoint& at, const ShellLoads& loads,
                 const FacetLoad& own, const WholeField& v,
                 const Triple<Taped>& bubble) {
  Vec3 moved = Vec3::Zero();
  Vec3 turned = Vec3::Zero();
  Triple<Taped> x{};
  for (int i = 0; i < kNodes; ++i) {
    moved += at.point.shape[i] * v.nodes.col(i).head<3>();
    turned += at.point.shape[i] * v.nodes.col(i).tail<3>();
    x = plus(x, at.point.shape[i], at.X[i]);
  }
  const Triple<double> u = {moved[0], moved[1], moved[2]};
  const Triple<double> nodal = {turned[0], turned[1], turned[2]};
  const Triple<Taped> theta =
      plus(times(at.point.shape[kNodes], bubble), 1.0, nodal);
  const Triple<Taped>& n = at.wall.frame.axes[2];
  const FacePressures acting = pressures_at(own, at.point);
  const auto push = [&](double p, double place) {
    const Taped zeta = (place + at.facet.offset) * at.wall.thickness;
    return p * determinant(shifter(at.wall.frame.curvature, zeta));
  };
  Taped sum = (push(acting.negative, -0.5) + push(acting.middle, 0.0) +
               push(acting.positive, 0.5)) *
              dot(n, u);
  if (has_mass_loads(loads)) {
    const Triple<Taped> arm = cross(theta, n);
    for_each_taped_layer(
        at, [&](const Taped& zeta, const Taped& weight, const Square<Taped>&,
                const LayerPoint& layer) {
          const double density = at.facet.law->plies[layer.ply].density;
          const Triple<Taped> there = plus(x, zeta, n);
          const Triple<Taped> motion = plus(times(zeta, arm), 1.0, u);
          sum = sum + density * weight *
                          dot(motion, taped_acceleration(loads, there));
        });
  }
  return sum;
}

/// What acts along the facet's edges does on v.
Taped edge_work(const Facet& facet, const TapedFacet& taped,
                const FacetLoad& own, const WholeField& v) {
  Taped sum(0.0);
  for (int e = 0; e < 3; ++e) {
    const EdgeForces& forces = own.edges[e];
    if (!forces.acts()) {
      continue;
    }
    const Vec3& q = forces.traction;
    for (const EdgePoint& p : edge_rules()[e]) {
      Vec3 moved = Vec3::Zero();
      Vec3 turned = Vec3::Zero();
      for (int i = 0; i < kNodes; ++i) {
        moved += p.at.shape[i] * v.nodes.col(i).head<3>();
        turned += p.at.shape[i] * v.nodes.col(i).tail<3>();
      }
      const Triple<double> u = {moved[0], moved[1], moved[2]};
      const Triple<double> theta = {turned[0], turned[1], turned[2]};
      const EdgeFrame<Taped> frame = edge_frame(taped.X, p);
      const Taped t = taped.thickness_at(p.at);
      const Taped length = sqrt(dot(frame.conormal, frame.conormal));
      const Triple<Taped> middle =
          plus(times(facet.offset * t, cross(theta, frame.normal)), 1.0, u);
      sum = sum +
            p.weight *
                (forces.pull * dot(frame.conormal, u) +
                 t * (length * dot(middle, Triple<double>{q[0], q[1], q[2]}) -
                      forces.pressure * dot(frame.conormal, middle)));
    }
  }
  return sum;
}

/// The state equation's data and the two fields of one facet.
struct FacetResidual {
  const Facet& facet;
  const ShellLoads& loads;
  const FacetLoad& own;
  WholeField v, u;
};

/// By the law and the loads, at one point of which the area is `area`.
void add_by_law(const FacetResidual& residual, const FacetPoint& p,
                const std::array<Triple<double>, kNodes>& X, double area,
                LawGradient& sum, FacetGradient& loads) {
  const Facet& facet = residual.facet;
  const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
  const auto axes = bubble_axes(X);
  const Triple<double> of_v = bubble_turn(axes, residual.v.bubble);
  const FacetStrain<double> v =
      facet_strain(X, p, frame, residual.v.nodes, of_v);
  const FacetStrain<double> u = facet_strain(
      X, p, frame, residual.u.nodes, bubble_turn(axes, residual.u.bubble));
  const WallState state = wall_states(residual.loads, residual.own).at(p);
  const double t = thickness_at(facet, p);
  const Vec3 n = as_vector(frame.axes[2]);
  Vec3 x = Vec3::Zero();
  Vec3 moved = Vec3::Zero();
  Vec3 turned = p.shape[kNodes] * as_vector(of_v);
  for (int i = 0; i < kNodes; ++i) {
    x += p.shape[i] * facet.nodes[i];
    moved += p.shape[i] * residual.v.nodes.col(i).head<3>();
    turned += p.shape[i] * residual.v.nodes.col(i).tail<3>();
  }
  StateGradient by_state;
  for (const LayerPoint& layer : facet.law->points) {
    const double zeta = (layer.at + facet.offset) * t;
    const Square<double> shift = shifter(frame.curvature, zeta);
    const double weight = area * layer.weight * t * determinant(shift);
    const LayerStrain<double> a = layer_strain(v, inverse(shift), zeta);
    const LayerStrain<double> b = layer_strain(u, inverse(shift), zeta);
    const PlyLaw& ply = facet.law->plies[layer.ply];
    PlyLaw& by = sum.by[layer.ply];
    const Vec3 elastic = as_vector(b.plane) - state.free_strain(ply, layer.at);
    by.plane -= weight * as_vector(a.plane) * elastic.transpose();
    sum.by_across -= weight * Eigen::Vector2d(a.across[0], a.across[1]) *
                     Eigen::RowVector2d(b.across[0], b.across[1]);
    const Vec3 held = weight * ply.plane.transpose() * as_vector(a.plane);
    by_state.add_free_strain(state, ply, layer.at, held, by);
    const Vec3 there = x + zeta * n;
    const Vec3 motion = weight * (moved + zeta * turned.cross(n));
    by.density += motion.dot(acceleration(residual.loads, there));
    loads.by_mass.add(ply.density * motion, there);
  }
  sum.by_mean_shear -= area * kDrilling * t *
                       (v.stretch[0][1] - v.stretch[1][0]) *
                       (u.stretch[0][1] - u.stretch[1][0]);
  by_state.add_to(p, loads.by_loads);
  const auto push = [&](double place) {
    const double zeta = (place + facet.offset) * t;
    return area * determinant(shifter(frame.curvature, zeta)) * n.dot(moved);
  };
  add_by_loads(p, {0.0, push(-0.5), push(0.5)}, loads.by_loads);
}

FacetGradient facet_gradient(const FacetResidual& residual, Tape& tape) {
  const Facet& facet = residual.facet;
  const TapedFacet taped(facet, tape);
  const Triple<Taped> of_v = taped.bubble(residual.v.bubble);
  const Triple<Taped> of_u = taped.bubble(residual.u.bubble);
  const WallStates states = wall_states(residual.loads, residual.own);
  FacetGradient gradient;
  const auto X = triples(facet);
  LawGradient by_law(*facet.law);
  Taped sum = edge_work(facet, taped, residual.own, residual.v);
  for (const FacetPoint& p : facet_rule()) {
    const TapedPoint at = taped_point(facet, taped, p);
    const FacetFrame<Taped>& frame = at.wall.frame;
    const Taped inner =
        inner_work(at, states.at(p),
                   facet_strain(taped.X, p, frame, residual.v.nodes, of_v),
                   facet_strain(taped.X, p, frame, residual.u.nodes, of_u));
    const Taped outer =
        outer_work(at, residual.loads, residual.own, residual.v, of_v);
    sum = sum + p.weight * frame.area * (outer - inner);
    add_by_law(residual, p, X, p.weight * frame.area.value, by_law, gradient);
  }
  gradient.value = sum.value;
  gradient.by = taped.transpose(sum);
  gradient.by_ply = by_law.by_ply();
  add_field_slopes(facet, residual.own, gradient.by_loads, gradient.by.data());
  return gradient;
}

void add_edge_gradient(const ShellMesh& mesh, const EdgeLoad& load,
                       const VectorX& v, ShellGradient& gradient) {
  for (const LinePoint& p : line_points(mesh, load.nodes)) {
    double work = 0.0;  // per length
    for (int k = 0; k < 3; ++k) {
      const auto at = 6L * load.nodes[k];
      work += p.shape[k] * (v.segment<3>(at).dot(load.force) +
                            v.segment<3>(at + 3).dot(load.moment));
    }
    gradient.value += p.weight * p.tangent.norm() * work;
    for (int k = 0; k < 3; ++k) {
      gradient.by_nodes[load.nodes[k]] +=
          p.weight * work * p.slope[k] * p.tangent.normalized();
    }
  }
}

}  // namespace

ShellGradient residual_gradient(
    const ShellMesh& mesh, const std::vector<Section>& sections,
    const ShellLoads& loads, const VectorX& v, const VectorX& u,
    const std::vector<Eigen::Vector2d>* on_bubbles) {
  check_shell(mesh, sections);
  check_loads(mesh, loads);
  const auto length = static_cast<Eigen::Index>(6 * mesh.nodes.size());
  if (u.size() != length || v.size() != length) {
    throw InvalidInput(
        fmt::format("a shell of {} nodes has vectors of {} and {} numbers; six "
                    "a node are needed",
                    mesh.nodes.size(), v.size(), u.size()));
  }
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const std::vector<FacetLoad> acting = facet_loads(mesh, loads);
  std::vector<FacetGradient> parts(mesh.facets.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(parts.size()), [&](std::ptrdiff_t k) {
        static thread_local Tape tape;
        const int f = static_cast<int>(k);
        const Facet facet = facet_of(mesh, sections, laws, f);
        const WholeMatrix K = whole_stiffness(facet);
        // Bubbles in equilibrium, where the residual is stationary in them.
        const auto field = [&](const VectorX& nodal,
                               const WholeVector& forces) -> WholeField {
          const FacetVector own = numbers_of(mesh, f, nodal);
          return {Eigen::Map<const FacetField>(own.data()),
                  bubble_rotation(K, forces, own)};
        };
        WholeVector on_v = WholeVector::Zero();
        if (on_bubbles != nullptr) {
          on_v.tail<2>() = (*on_bubbles)[k];
        }
        parts[k] =
            facet_gradient({facet, loads, acting[k], field(v, on_v),
                            field(u, facet_forces(facet, loads, acting[k]))},
                           tape);
      });
  ShellGradient gradient = gradient_of(mesh, parts);
  for (const EdgeLoad& load : loads.edges) {
    add_edge_gradient(mesh, load, v, gradient);
  }
  if (loads.nodal.size() > 0) {
    gradient.value += v.dot(loads.nodal);
  }
  return gradient;
}

double action_rate(const ShellMesh& mesh, const ActionGradient& by,
                   const ShellLoads& rates) {
  check_loads(mesh, rates);
  const std::vector<FacetLoad> own = facet_loads(mesh, rates);
  const double heat = rates.temperature ? rates.temperature->mean : 0.0;
  double sum = by.mass.gravity.dot(rates.gravity);
  if (const auto& force = rates.mass_force) {
    sum += by.mass.at_origin.dot(force->at_origin) +
           by.mass.slope.cwiseProduct(force->slope).sum();
  }
  for (std::size_t f = 0; f < own.size(); ++f) {
    const Vec3 all = by.facets[f].rowwise().sum();
    sum += all.dot(Vec3(heat, own[f].negative, own[f].positive));
    if (const FacetFields* fields = own[f].fields.get()) {
      for (int i = 0; i < kNodes; ++i) {
        sum += by.facets[f].col(i).dot(Vec3(fields->temperature.value[i],
                                            fields->negative.value[i],
                                            fields->positive.value[i]));
      }
    }
  }
  return sum;
}

}  // namespace meniscus::shell
