#include "fea/functionals/energy_functionals.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/element/point_stress.h"
#include "fea/loads/body_load_gradient.h"
#include "fea/loads/body_loads.h"
#include "fea/loads/loads.h"

namespace meniscus::functionals {

namespace {

/// Stress of `degrees` of expansion held back, and the energy's derivative by
/// a degree.
struct Expansion {
  Mat3 stress = Mat3::Zero();  // C alpha
  Mat3 strain = Mat3::Zero();  // alpha
};

std::vector<Expansion> expansions(
    const std::vector<element::ElasticLaw>& laws) {
  std::vector<Expansion> result;
  result.reserve(laws.size());
  for (const element::ElasticLaw& law : laws) {
    element::Vec6 strain = law.expansion;
    strain.tail<3>() *= 0.5;
    result.push_back({element::stress_tensor(law.heat_stress),
                      element::stress_tensor(strain)});
  }
  return result;
}

/// 1/2 (e - change alpha) : C : (e - change alpha).
void add_energy_gradient(const TetMesh& mesh,
                         const std::vector<element::Material>& materials,
                         const VectorX& u, const VectorX& change, VectorX& by_x,
                         VectorX& by_u, VectorX& by_temperature) {
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  const std::vector<Expansion> expansion = expansions(laws);
  const element::SweepTargets<1, 2> targets{
      .fields = {&u},
      .outputs = {&by_x, &by_u},
      .scalar = change.size() != 0 ? &by_temperature : nullptr};
  element::sweep_stiffness_points(
      mesh, targets,
      [&](const element::SweepPoint<1>& point, element::SweepFlux<2>& flux) {
        const int region = mesh.element_region[point.element];
        const Mat3& H = point.gradient[0];
        Mat3 s = laws[region].stress(H);
        Mat3 elastic = H;
        if (change.size() != 0) {
          double degrees = 0.0;
          for (std::size_t a = 0; a < point.shape.size(); ++a) {
            degrees += point.shape[a] * change[point.nodes[a]];
          }
          s -= degrees * expansion[region].stress;
          elastic -= degrees * expansion[region].strain;
        }
        const double V = point.volume;
        flux.by_gradient[0].noalias() = -V * H.transpose() * s;
        flux.by_gradient[0].diagonal().array() +=
            0.5 * V * s.cwiseProduct(elastic).sum();
        flux.by_gradient[1] = V * s;
        flux.by_scalar = -V * s.cwiseProduct(expansion[region].strain).sum();
      });
}

/// The energy at a given strain is in proportion to Young's modulus.
std::vector<double> energy_by_modulus(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const VectorX& u, const VectorX& change) {
  const element::PointStress points =
      element::point_stress(mesh, materials, u, change);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  std::vector<double> result(materials.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int region = mesh.element_region[e];
    const element::Material& material = materials[region];
    for (int q = 0; !material.orthotropic && q < points.points_per_element;
         ++q) {
      const std::size_t at = points.index(e, q);
      const element::Stress& stress = points.stress[at];
      result[region] +=
          0.5 * points.volume[at] *
          element::complementary_product(stress, stress, laws[region]) /
          material.youngs_modulus;
    }
  }
  return result;
}

}  // namespace

element::Functional compliance_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& displacement,
    element::Derivatives derivatives) {
  VectorX f = loads::nodal_forces(mesh, load_case, materials);
  if (displacement.size() != f.size()) {
    throw InvalidInput(fmt::format(
        "compliance of load case '{}': {} displacements for {} nodes",
        load_case.name, displacement.size(), mesh.nodes.size()));
  }
  element::Functional result{.value = f.dot(displacement)};
  if (derivatives == element::Derivatives::All) {
    result.by_nodes =
        elastic::force_gradient(mesh, materials, load_case, displacement);
    result.by_displacement = std::move(f);
  }
  return result;
}

element::Functional strain_energy_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& displacement,
    element::Derivatives derivatives) {
  const VectorX change = loads::temperature_change(mesh, load_case);
  element::Functional result{
      .value = loads::strain_energy(mesh, materials, displacement, change)};
  if (derivatives == element::Derivatives::All) {
    loads::require_temperature_slope(load_case);
    VectorX by_x = element::nodal_zeros(mesh);
    result.by_displacement = element::nodal_zeros(mesh);
    if (load_case.temperature) {
      result.by_temperature.setZero(
          static_cast<Eigen::Index>(mesh.nodes.size()));
    }
    add_energy_gradient(mesh, materials, displacement, change, by_x,
                        result.by_displacement, result.by_temperature);
    result.by_nodes = element::as_points(by_x);
    loads::add_temperature_slope(mesh, load_case, result.by_temperature,
                                 result.by_nodes);
    result.by_modulus =
        energy_by_modulus(mesh, materials, displacement, change);
  }
  return result;
}

}  // namespace meniscus::functionals
