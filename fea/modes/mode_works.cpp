#include "fea/modes/mode_works.h"

#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/loads/body_load_gradient.h"
#include "fea/loads/body_loads.h"
#include "fea/loads/material_rates.h"
#include "fea/supports/enforced.h"
#include "fea/supports/springs.h"

namespace meniscus::modes {

namespace {

void check_vector(const TetMesh& mesh, const char* what, const VectorX& v) {
  if (v.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("work of a mode: {} of {} numbers for {} "
                    "nodes",
                    what, v.size(), mesh.nodes.size()));
  }
}

/// Stresses of a load case, expansion taken out.
class CaseStress {
 public:
  CaseStress(const TetMesh& mesh,
             const std::vector<element::Material>& materials,
             const loads::LoadCase& load_case)
      : mesh_(mesh),
        laws_(element::elastic_laws(materials)),
        change_(loads::temperature_change(mesh, load_case)) {}

  const element::ElasticLaw& law(int element) const {
    return laws_[mesh_.element_region[element]];
  }
  bool has_change() const { return change_.size() != 0; }

  /// `H`: the displacement's gradient at the point.
  template <class Point>
  Mat3 at(const Point& point, const Mat3& H) const {
    const element::ElasticLaw& own = law(point.element);
    Mat3 stress = own.stress(H);
    if (has_change()) {
      double degrees = 0.0;
      for (std::size_t a = 0; a < point.shape.size(); ++a) {
        degrees += point.shape[a] * change_[point.nodes[a]];
      }
      stress -= degrees * element::stress_tensor(own.heat_stress);
    }
    return stress;
  }

 private:
  const TetMesh& mesh_;
  std::vector<element::ElasticLaw> laws_;
  VectorX change_;
};

std::vector<double> element_zeros(const TetMesh& mesh) {
  return std::vector<double>(static_cast<std::size_t>(mesh.element_count()),
                             0.0);
}

double sum_of(const std::vector<double>& parts) {
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

/// Over each region's elements, in their order.
std::vector<double> region_sums(const TetMesh& mesh, std::size_t regions,
                                const std::vector<double>& parts) {
  std::vector<double> sums(regions, 0.0);
  for (std::size_t e = 0; e < parts.size(); ++e) {
    sums[mesh.element_region[e]] += parts[e];
  }
  return sums;
}

/// sigma : B with B = H^T H of the mode: with dx_i/dx_j = D of a change, dH =
/// -H D of both fields and dV = V tr D.
void add_geometric_gradient(const TetMesh& mesh, const CaseStress& stress,
                            const VectorX& u, const VectorX& x,
                            VectorX& by_nodes, element::Functional& result) {
  const element::SweepTargets<2, 2> targets{
      .fields = {&u, &x},
      .outputs = {&by_nodes, &result.by_displacement},
      .scalar = stress.has_change() ? &result.by_temperature : nullptr};
  element::sweep_stiffness_points(
      mesh, targets,
      [&](const element::SweepPoint<2>& point, element::SweepFlux<2>& flux) {
        const element::ElasticLaw& law = stress.law(point.element);
        const auto& [H_u, H] = point.gradient;
        const Mat3 s = stress.at(point, H_u);
        const Mat3 B = H.transpose() * H;
        const Mat3 s_B = law.stress(B);
        Mat3& M = flux.by_gradient[0];
        M.noalias() = -H_u.transpose() * s_B;
        M.noalias() -= 2.0 * B * s;
        M.diagonal().array() += s.cwiseProduct(B).sum();
        M *= point.volume;
        flux.by_gradient[1] = point.volume * s_B;
        if (stress.has_change()) {
          flux.by_scalar =
              -point.volume *
              element::stress_tensor(law.heat_stress).cwiseProduct(B).sum();
        }
      });
}

template <class Visit>
auto with_mass_rule(const TetMesh& mesh, const Visit& visit) {
  return mesh.order == 1 ? visit(element::mass_rule<4>())
                         : visit(element::mass_rule<10>());
}

/// The mode at a point of a sweep.
template <class Point>
Vec3 mode_at(const Point& point, const VectorX& x) {
  Vec3 here = Vec3::Zero();
  for (std::size_t a = 0; a < point.shape.size(); ++a) {
    here += point.shape[a] * x.segment<3>(3L * point.nodes[a]);
  }
  return here;
}

/// Supports and springs of a load case without its loads.
loads::LoadCase without_loads(const loads::LoadCase& held) {
  loads::LoadCase bare;
  bare.name = held.name;
  bare.supports = held.supports;
  bare.springs = held.springs;
  bare.pins = held.pins;
  return bare;
}

}  // namespace

element::Functional geometric_work(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& u, const VectorX& x,
    element::Derivatives derivatives) {
  element::check_materials(mesh, materials);
  check_vector(mesh, "a displacement", u);
  check_vector(mesh, "a mode", x);
  const CaseStress stress(mesh, materials, load_case);
  std::vector<double> parts = element_zeros(mesh);
  element::sweep_stiffness_points(
      mesh, element::SweepTargets<2, 0>{.fields = {&u, &x}, .outputs = {}},
      [&](const element::SweepPoint<2>& point, element::SweepFlux<0>&) {
        const auto& [H_u, H] = point.gradient;
        parts[point.element] +=
            point.volume *
            stress.at(point, H_u).cwiseProduct(H.transpose() * H).sum();
      });
  element::Functional result{.value = sum_of(parts)};
  if (derivatives == element::Derivatives::None) {
    return result;
  }
  loads::require_temperature_slope(load_case);
  VectorX by_nodes = element::nodal_zeros(mesh);
  result.by_displacement = element::nodal_zeros(mesh);
  if (load_case.temperature) {
    result.by_temperature.setZero(static_cast<Eigen::Index>(mesh.nodes.size()));
  }
  add_geometric_gradient(mesh, stress, u, x, by_nodes, result);
  result.by_nodes = element::as_points(by_nodes);
  loads::add_temperature_slope(mesh, load_case, result.by_temperature,
                               result.by_nodes);
  // At given strains stress is in proportion to Young's modulus.
  result.by_modulus = region_sums(mesh, materials.size(), parts);
  for (std::size_t r = 0; r < materials.size(); ++r) {
    result.by_modulus[r] =
        materials[r].orthotropic
            ? 0.0
            : result.by_modulus[r] / materials[r].youngs_modulus;
  }
  return result;
}

ModeFunctional inertia_work(const TetMesh& mesh,
                            const std::vector<element::Material>& materials,
                            const VectorX& x,
                            element::Derivatives derivatives) {
  element::check_materials(mesh, materials);
  check_vector(mesh, "a mode", x);
  std::vector<double> parts = element_zeros(mesh);
  VectorX by_nodes = element::nodal_zeros(mesh);
  const element::SweepTargets<0, 1> targets{.fields = {},
                                            .outputs = {&by_nodes}};
  with_mass_rule(mesh, [&](const auto& rule) {
    element::sweep_elements(
        mesh, rule, targets,
        [&](const element::SweepPoint<0>& point, element::SweepFlux<1>& flux) {
          const double square = point.volume * mode_at(point, x).squaredNorm();
          parts[point.element] += square;
          flux.by_gradient[0] =
              materials[mesh.element_region[point.element]].density * square *
              Mat3::Identity();
        });
  });
  ModeFunctional result;
  std::vector<double> by_density = region_sums(mesh, materials.size(), parts);
  for (std::size_t r = 0; r < materials.size(); ++r) {
    result.value += materials[r].density * by_density[r];
  }
  if (derivatives == element::Derivatives::All) {
    result.by_nodes = element::as_points(by_nodes);
    result.by_density = std::move(by_density);
  }
  return result;
}

ModeFunctional stiffness_work(const TetMesh& mesh,
                              const std::vector<element::Material>& materials,
                              const loads::LoadCase& held, const VectorX& x,
                              const VectorX& reactions,
                              element::Derivatives derivatives) {
  ModeFunctional result;
  result.value = x.dot(stiffness_times(mesh, materials, held, x));
  if (derivatives == element::Derivatives::None) {
    return result;
  }
  const loads::LoadCase bare = without_loads(held);
  const loads::AdjointPair pair{x, reactions, x, reactions};
  result.by_nodes = elastic::residual_gradient(mesh, materials, bare, pair);
  for (Vec3& by_node : result.by_nodes) {
    by_node = -by_node;  // it is that of -x^T K x
  }
  loads::LoadCase by_number;
  supports::add_enforced_gradient(mesh, bare, pair, by_number);
  for (const loads::RigidPin& pin : by_number.pins) {
    result.by_pin_point.emplace_back(-pin.point);
  }
  const loads::MaterialGradient by =
      loads::material_gradient(mesh, materials, bare, x, x);
  for (std::size_t r = 0; r < materials.size(); ++r) {
    result.by_modulus.push_back(
        materials[r].orthotropic ? 0.0 : -by.youngs_modulus[r]);
  }
  return result;
}

VectorX stiffness_times(const TetMesh& mesh,
                        const std::vector<element::Material>& materials,
                        const loads::LoadCase& held, const VectorX& x) {
  return vibration_reactions(mesh, materials, 0.0, x) +
         supports::spring_forces(
             supports::spring_blocks(mesh, held, mesh.order), x);
}

VectorX buckling_reactions(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const loads::LoadCase& load_case, const VectorX& u,
                           double factor, const VectorX& x) {
  element::check_materials(mesh, materials);
  check_vector(mesh, "a displacement", u);
  check_vector(mesh, "a mode", x);
  const CaseStress stress(mesh, materials, load_case);
  VectorX forces = element::nodal_zeros(mesh);
  element::sweep_stiffness_points(
      mesh,
      element::SweepTargets<2, 1>{.fields = {&u, &x}, .outputs = {&forces}},
      [&](const element::SweepPoint<2>& point, element::SweepFlux<1>& flux) {
        const auto& [H_u, H] = point.gradient;
        flux.by_gradient[0] =
            point.volume * (stress.law(point.element).stress(H) +
                            factor * H * stress.at(point, H_u));
      });
  return forces;
}

VectorX vibration_reactions(const TetMesh& mesh,
                            const std::vector<element::Material>& materials,
                            double square, const VectorX& x) {
  element::check_materials(mesh, materials);
  check_vector(mesh, "a mode", x);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  VectorX forces = element::nodal_zeros(mesh);
  element::sweep_stiffness_points(
      mesh, element::SweepTargets<1, 1>{.fields = {&x}, .outputs = {&forces}},
      [&](const element::SweepPoint<1>& point, element::SweepFlux<1>& flux) {
        flux.by_gradient[0] =
            point.volume *
            laws[mesh.element_region[point.element]].stress(point.gradient[0]);
      });
  if (square != 0.0) {
    std::vector<double> density;
    density.reserve(materials.size());
    for (const element::Material& material : materials) {
      density.push_back(material.density);
    }
    forces -= square * mass_times(mesh, density, x);
  }
  return forces;
}

VectorX mass_times(const TetMesh& mesh, const std::vector<double>& density,
                   const VectorX& x) {
  check_vector(mesh, "a mode", x);
  VectorX momentum = element::nodal_zeros(mesh);
  with_mass_rule(mesh, [&](const auto& rule) {
    element::sweep_elements(
        mesh, rule,
        element::SweepTargets<0, 1>{.fields = {}, .outputs = {&momentum}},
        [&](const element::SweepPoint<0>& point, element::SweepFlux<1>& flux) {
          flux.by_shape[0] = density[mesh.element_region[point.element]] *
                             point.volume * mode_at(point, x);
        });
  });
  return momentum;
}

}  // namespace meniscus::modes
