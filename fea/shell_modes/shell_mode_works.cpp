#include "fea/shell_modes/shell_mode_works.h"

#include <array>
#include <cmath>
#include <numbers>

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
                     facet_resultants<T>({at.facet, at.loads, at.own, frame,
                                          strain, thickness}),
                     at.x);
}

struct FacetWork : FacetGradient {
  WholeVector by_whole = WholeVector::Zero();  // with the bubble's two numbers
};

/// By places and thicknesses, nodes' numbers and bubble held.
void add_by_places(const StressedFacet& at, Tape& tape, FacetWork& work) {
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

/// By the nodes' numbers and the bubble, which resultants are linear in.
void add_by_numbers(const StressedFacet& at, FacetWork& work) {
  const auto X = triples(at.facet);
  const auto axes = bubble_axes(X);
  const ShellLoads none;
  const FacetLoad unloaded;
  const Triple<double> still = {0.0, 0.0, 0.0};
  StressedFacet unit{
      at.facet, none, unloaded, FacetField::Zero(), Eigen::Vector2d::Zero(),
      at.x};
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, at.facet.direction);
    const double area = p.weight * frame.area;
    const double t = thickness_at(at.facet, p);
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
}

/// Twice the kinetic energy of unit frequency of one facet.
FacetGradient facet_inertia(const Facet& facet, const FacetField& x,
                            Tape& tape) {
  const TapedFacet taped(facet, tape);
  Taped sum(0.0);
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
      density = density + facet.law->plies[layer.ply].density * layer.weight *
                              thickness *
                              determinant(shifter(frame.curvature, zeta)) *
                              dot(motion, motion);
    }
    sum = sum + p.weight * frame.area * density;
  }
  return {sum.value, taped.transpose(sum)};
}

}  // namespace

ModeWork geometric_work(const ShellMesh& mesh,
                        const std::vector<Section>& sections,
                        const ShellLoads& loads, const VectorX& u,
                        const VectorX& x) {
  check_shell(mesh, sections);
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const std::vector<FacetLoad> own = facet_loads(mesh, loads);
  std::vector<FacetWork> parts(mesh.facets.size());
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
                           const modes::WeightedModes& modes) {
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
    // Of -x^T K x:
    add_gradient(-by_stiffness, residual_gradient(mesh, sections, {}, x, x),
                 result);
    add_gradient(by_geometric, geometric, result);
    result.by_displacement += by_geometric * geometric.by_displacement;
  }
  return result;
}

ModeWork frequency_functional(const ShellMesh& mesh,
                              const std::vector<Section>& sections,
                              const modes::WeightedModes& modes) {
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
    add_gradient(-by_stiffness, residual_gradient(mesh, sections, {}, x, x),
                 result);
    add_gradient(-std::pow(kTurn * frequency, 2) * by_stiffness, inertia,
                 result);
  }
  return result;
}

}  // namespace meniscus::shell
