#include "fea/shell_modes/shell_mode_works.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"
#include "fea/shell/facet_second_work.h"
#include "fea/shell/shell_assembly.h"
#include "fea/shell/shell_supports.h"
#include "fea/shell/taped_facet.h"

namespace meniscus::shell {

namespace {

/// One facet with its solution and the mode.
struct StressedFacet {
  Facet facet;
  const ShellLoads& loads;
  const FacetLoad& own;
  FacetField u;
  Eigen::Vector2d bubble;
  FacetField x;
};

/// At one point, per area of the surface: the work of what strains `u` and
/// `bubble`, and the loads, make of resultants.
template <class T>
T work_at(const StressedFacet& at, const std::array<Triple<T>, kNodes>& X,
          const FacetPoint& p, const FacetFrame<T>& frame,
          const Triple<T>& bubble, const T& thickness) {
  const FacetStrain<T> strain = facet_strain(X, p, frame, at.u, bubble);
  return second_work(p, frame,
                     facet_resultants<T>({at.facet, at.loads, at.own, p, frame,
                                          strain, thickness}),
                     at.x);
}

/// By places and thicknesses, nodes' numbers and bubble held.
void add_by_places(const StressedFacet& at, Tape& tape, WholeGradient& work) {
  const TapedFacet taped(at.facet, tape);
  const Triple<Taped> bubble = taped.bubble(at.bubble);
  Taped sum(0.0);
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<Taped> frame = facet_frame(taped.X, p, at.facet.direction);
    sum =
        sum + p.weight * frame.area *
                  work_at(at, taped.X, p, frame, bubble, taped.thickness_at(p));
  }
  work.value = sum.value;
  work.by = taped.transpose(sum);
}

/// What one point's work is by each resultant, which it is linear in.
FacetResultants<double> by_resultants(const FacetPoint& p,
                                      const FacetFrame<double>& frame,
                                      const FacetField& x) {
  FacetResultants<double> unit{};
  FacetResultants<double> by{};
  const auto find = [&](double& one, double& of) {
    one = 1.0;
    of = second_work(p, frame, unit, x);
    one = 0.0;
  };
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      for (int k = 0; k < 3; ++k) {
        find(unit.stress[k][a][b], by.stress[k][a][b]);
      }
    }
    find(unit.shear[a], by.shear[a]);
  }
  find(unit.drilling, by.drilling);
  for (int c = 0; c < 3; ++c) {
    find(unit.lever[c], by.lever[c]);
  }
  return by;
}

/// By the law and the loads, at one point of which the area is `area`:
/// facet_resultants() transposed.
void add_by_law(const StressedFacet& at, const FacetPoint& p,
                const FacetFrame<double>& frame,
                const FacetStrain<double>& strain, double thickness,
                const FacetResultants<double>& by, double area,
                LawGradient& sum, FacetGradient& loads) {
  const LaminateLaw& law = *at.facet.law;
  const WallState state = wall_states(at.loads, at.own).at(p);
  StateGradient by_state;
  for (const LayerPoint& layer : law.points) {
    const PlyLaw& ply = law.plies[layer.ply];
    PlyLaw& own = sum.by[layer.ply];
    const double zeta = (layer.at + at.facet.offset) * thickness;
    const Square<double> shift = shifter(frame.curvature, zeta);
    const Square<double> back = inverse(shift);
    const double weight = area * layer.weight * thickness * determinant(shift);
    const LayerStrain<double> e = layer_strain(strain, back, zeta);
    Vec3 on_stress = Vec3::Zero();
    Eigen::Vector2d on_shear = Eigen::Vector2d::Zero();
    for (int a = 0; a < 2; ++a) {
      for (int i = 0; i < 2; ++i) {
        on_shear[i] += weight * by.shear[a] * back[i][a];
      }
      for (int b = 0; b < 2; ++b) {
        const double here =
            weight * (by.stress[0][a][b] + zeta * by.stress[1][a][b] +
                      zeta * zeta * by.stress[2][a][b]);
        on_stress +=
            here * Vec3(back[0][a] * back[0][b], back[1][a] * back[1][b],
                        back[0][a] * back[1][b] + back[1][a] * back[0][b]);
      }
    }
    own.plane +=
        on_stress *
        (as_vector(e.plane) - state.free_strain(ply, layer.at)).transpose();
    const Vec3 on_free = -ply.plane.transpose() * on_stress;
    by_state.add_free_strain(state, ply, layer.at, on_free, own);
    sum.by_across += on_shear * Eigen::RowVector2d(e.across[0], e.across[1]);
    const Vec3 lever = weight * zeta * as_vector(by.lever);
    own.density += lever.dot(at.loads.gravity);
    loads.by_mass.gravity += ply.density * lever;
  }
  sum.by_mean_shear += area * by.drilling * kDrilling * thickness *
                       (strain.stretch[0][1] - strain.stretch[1][0]);
  by_state.add_to(p, loads.by_loads);
  const double lever = area * as_vector(by.lever).dot(as_vector(frame.axes[2]));
  const auto push = [&](double place) {
    const double zeta = (place + at.facet.offset) * thickness;
    return lever * zeta * determinant(shifter(frame.curvature, zeta));
  };
  add_by_loads(p, {0.0, push(-0.5), push(0.5)}, loads.by_loads);
}

/// By the nodes' numbers and the bubble, which resultants are linear in, and by
/// the law.
void add_by_numbers(const StressedFacet& at, WholeGradient& work) {
  const auto X = triples(at.facet);
  const auto axes = bubble_axes(X);
  const ShellLoads none;
  const FacetLoad unloaded;
  const Triple<double> still = {0.0, 0.0, 0.0};
  StressedFacet unit{
      at.facet, none, unloaded, FacetField::Zero(), Eigen::Vector2d::Zero(),
      at.x};
  LawGradient by_law(*at.facet.law);
  const Triple<double> turned = bubble_turn(axes, at.bubble);
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, at.facet.direction);
    const double area = p.weight * frame.area;
    const double t = thickness_at(at.facet, p);
    add_by_law(at, p, frame, facet_strain(X, p, frame, at.u, turned), t,
               by_resultants(p, frame, at.x), area, by_law, work);
    for (int n = 0; n < kUnknowns; ++n) {
      unit.u(n % 6, n / 6) = 1.0;
      work.by_whole[n] += area * work_at(unit, X, p, frame, still, t);
      unit.u(n % 6, n / 6) = 0.0;
    }
    for (int k = 0; k < 2; ++k) {
      work.by_whole[kUnknowns + k] +=
          area * work_at(unit, X, p, frame, axes[k], t);
    }
  }
  work.by_ply = by_law.by_ply();
  add_field_slopes(at.facet, at.own, work.by_loads, work.by.data());
}

FacetField field_of(const ShellMesh& mesh, int facet, const VectorX& nodal) {
  const FacetVector own = numbers_of(mesh, facet, nodal);
  return Eigen::Map<const FacetField>(own.data());
}

void add_gradient(double factor, const ShellGradient& more,
                  ShellGradient& sum) {
  for (std::size_t i = 0; i < more.by_nodes.size(); ++i) {
    sum.by_nodes[i] += factor * more.by_nodes[i];
  }
  for (std::size_t f = 0; f < more.by_thickness.size(); ++f) {
    sum.by_thickness[f] += factor * more.by_thickness[f];
  }
  add_plies(factor, more.by_ply, sum.by_ply);
  sum.by_actions.add(factor, more.by_actions);
}

void add_work(double factor, const ModeWork& more, ModeWork& sum) {
  add_gradient(factor, more, sum);
  sum.by_points.resize(more.by_points.size(), Vec3::Zero());
  for (std::size_t r = 0; r < more.by_points.size(); ++r) {
    sum.by_points[r] += factor * more.by_points[r];
  }
}

/// -x . K x, which no loads change, of a mode.
ModeWork minus_stiffness_work(const ShellMesh& mesh,
                              const std::vector<Section>& sections,
                              const AddHeldWork& held, std::size_t mode,
                              const VectorX& x) {
  ModeWork work{residual_gradient(mesh, sections, {}, x, x), {}};
  work.by_actions = {};
  if (held) {
    held(mode, x, work);
  }
  return work;
}

/// Twice the kinetic energy of unit frequency of one facet.
FacetGradient facet_inertia(const Facet& facet, const FacetField& x,
                            Tape& tape) {
  const TapedFacet taped(facet, tape);
  Taped sum(0.0);
  std::vector<PlyGradient> by_ply(facet.law->plies.size());
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<Taped> frame = facet_frame(taped.X, p, facet.direction);
    const Taped thickness = taped.thickness_at(p);
    Six at = Six::Zero();
    for (int i = 0; i < kNodes; ++i) {
      at += p.shape[i] * x.col(i);
    }
    const Triple<double> u = {at[0], at[1], at[2]};
    const Triple<double> theta = {at[3], at[4], at[5]};
    const Triple<Taped> arm = cross(theta, frame.axes[2]);
    Taped density(0.0);
    for (const LayerPoint& layer : facet.law->points) {
      const Taped zeta = (layer.at + facet.offset) * thickness;
      const Triple<Taped> motion = plus(times(zeta, arm), 1.0, u);
      const Taped of_unit = layer.weight * thickness *
                            determinant(shifter(frame.curvature, zeta)) *
                            dot(motion, motion);
      density = density + facet.law->plies[layer.ply].density * of_unit;
      by_ply[layer.ply].density += p.weight * frame.area.value * of_unit.value;
    }
    sum = sum + p.weight * frame.area * density;
  }
  return {
      sum.value, taped.transpose(sum), std::move(by_ply), ByLoads::Zero(), {}};
}

}  // namespace

ModeWork geometric_work(const ShellMesh& mesh,
                        const std::vector<Section>& sections,
                        const ShellLoads& loads, const VectorX& u,
                        const VectorX& x) {
  check_shell(mesh, sections);
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const std::vector<FacetLoad> own = facet_loads(mesh, loads);
  std::vector<WholeGradient> parts(mesh.facets.size());
  std::vector<Eigen::Vector2d> on_bubbles(mesh.facets.size());
  parallel_for(static_cast<std::ptrdiff_t>(parts.size()),
               [&](std::ptrdiff_t k) {
                 static thread_local Tape tape;
                 const int f = static_cast<int>(k);
                 const Facet facet = facet_of(mesh, sections, laws, f);
                 const WholeMatrix K = whole_stiffness(facet);
                 const StressedFacet at{
                     facet,
                     loads,
                     own[k],
                     field_of(mesh, f, u),
                     bubble_rotation(K, facet_forces(facet, loads, own[k]),
                                     numbers_of(mesh, f, u)),
                     field_of(mesh, f, x)};
                 add_by_places(at, tape, parts[k]);
                 add_by_numbers(at, parts[k]);
                 // The bubble follows the nodes: condensed as forces are.
                 on_bubbles[k] = parts[k].by_whole.tail<2>();
                 condensed(K, &parts[k].by_whole);
               });
  // And places and thicknesses: its equilibrium, to which its derivatives are
  // the adjoint's forces.
  const VectorX none = VectorX::Zero(u.size());
  ModeWork work{residual_gradient(mesh, sections, loads, none, u, &on_bubbles),
                none};
  work.value = 0.0;
  for (std::size_t f = 0; f < parts.size(); ++f) {
    add_facet(mesh, static_cast<int>(f), parts[f], work);
    for (int i = 0; i < kNodes; ++i) {
      work.by_displacement.segment<6>(6L * mesh.facets[f][i]) +=
          parts[f].by_whole.segment<6>(6L * i);
    }
  }
  return work;
}

ShellGradient inertia_work(const ShellMesh& mesh,
                           const std::vector<Section>& sections,
                           const VectorX& x) {
  check_shell(mesh, sections);
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  std::vector<FacetGradient> parts(mesh.facets.size());
  parallel_for(static_cast<std::ptrdiff_t>(parts.size()),
               [&](std::ptrdiff_t k) {
                 static thread_local Tape tape;
                 const int f = static_cast<int>(k);
                 parts[k] = facet_inertia(facet_of(mesh, sections, laws, f),
                                          field_of(mesh, f, x), tape);
               });
  return gradient_of(mesh, parts);
}

SparseMatrix nodal_mass(const ShellMesh& mesh,
                        const std::vector<Section>& sections) {
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const ShellFreedom free(static_cast<int>(mesh.nodes.size()), {});
  return ShellAssembly(mesh, free).sum([&](int f) {
    return facet_mass(facet_of(mesh, sections, laws, f));
  });
}

ModeWork factor_functional(const ShellMesh& mesh,
                           const std::vector<Section>& sections,
                           const ShellLoads& loads, const VectorX& u,
                           const modes::WeightedModes& modes,
                           const AddHeldWork& held) {
  ModeWork result{empty_gradient(mesh), VectorX::Zero(u.size())};
  for (std::size_t k = 0; k < modes.values.size(); ++k) {
    const double weight = modes.weights[static_cast<Eigen::Index>(k)];
    if (weight == 0.0) {
      continue;
    }
    const VectorX& x = modes.shapes[k];
    const ModeWork geometric = geometric_work(mesh, sections, loads, u, x);
    const double by_stiffness = -weight / geometric.value;
    const double by_geometric = modes.values[k] * by_stiffness;
    result.value += weight * modes.values[k];
    add_work(-by_stiffness, minus_stiffness_work(mesh, sections, held, k, x),
             result);
    add_gradient(by_geometric, geometric, result);
    result.by_displacement += by_geometric * geometric.by_displacement;
  }
  return result;
}

ModeWork frequency_functional(const ShellMesh& mesh,
                              const std::vector<Section>& sections,
                              const modes::WeightedModes& modes,
                              const AddHeldWork& held) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  ModeWork result{empty_gradient(mesh), {}};
  for (std::size_t k = 0; k < modes.values.size(); ++k) {
    const double weight = modes.weights[static_cast<Eigen::Index>(k)];
    if (weight == 0.0) {
      continue;
    }
    const double frequency = modes.values[k];
    const VectorX& x = modes.shapes[k];
    const ShellGradient inertia = inertia_work(mesh, sections, x);
    // df = d omega^2 / (2 (2 pi)^2 f).
    const double by_stiffness =
        weight / (2.0 * kTurn * kTurn * frequency * inertia.value);
    result.value += weight * frequency;
    add_work(-by_stiffness, minus_stiffness_work(mesh, sections, held, k, x),
             result);
    add_gradient(-std::pow(kTurn * frequency, 2) * by_stiffness, inertia,
                 result);
  }
  return result;
}

}  // namespace meniscus::shell
