/// From what a number changes by at the integration points (point_stress.h) to
/// nodes, displacement, temperatures and moduli.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/element/functional.h"
#include "fea/element/material.h"
#include "fea/loads/body_load_gradient.h"
#include "fea/loads/load_case.h"

namespace meniscus::functionals {

/// What a number changes by one point.
struct PointSlope {
  Mat3 stress = Mat3::Zero();    // symmetric: dJ = stress : d sigma
  Vec3 position = Vec3::Zero();  // by its place
  double volume = 0.0;           // by its volume
  bool is_zero = true;           // of points that do not count
};

/// A displacement and what it comes from, on loan.
struct StressState {
  const loads::LoadCase& load_case;  // for its temperature
  const VectorX& displacement;
};

/// Sets the derivatives of `result` but for its modulus: `slope`(element,
/// point) is asked side by side and must not throw. Throws InvalidInput where
/// a temperature has no slope.
template <class Slope>
void chain_points(const TetMesh& mesh,
                  const std::vector<element::Material>& materials,
                  const StressState& state, const Slope& slope,
                  element::Functional& result) {
  loads::require_temperature_slope(state.load_case);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  // One sweep gives nodes, displacements and temperatures their parts.
  VectorX by_x = element::nodal_zeros(mesh);
  result.by_displacement = element::nodal_zeros(mesh);
  const bool warm = state.load_case.temperature.has_value();
  if (warm) {
    result.by_temperature.setZero(static_cast<Eigen::Index>(mesh.nodes.size()));
  }
  const element::SweepTargets<1, 2> targets{
      .fields = {&state.displacement},
      .outputs = {&by_x, &result.by_displacement},
      .scalar = warm ? &result.by_temperature : nullptr};
  element::sweep_stiffness_points(
      mesh, targets,
      [&](const element::SweepPoint<1>& point, element::SweepFlux<2>& flux) {
        const PointSlope by = slope(point.element, point.point);
        if (by.is_zero) {
          return;
        }
        const element::ElasticLaw& law =
            laws[mesh.element_region[point.element]];
        // B = C A: a change of the displacement gradient H gives dJ = B : dH.
        const Mat3 B = law.stress(by.stress);
        // A move of the nodes with gradient D has dH = -H D and dV = V tr D.
        flux.by_gradient[0].noalias() = -point.gradient[0].transpose() * B;
        flux.by_gradient[0].diagonal().array() += point.volume * by.volume;
        flux.by_gradient[1] = B;
        flux.by_shape[0] = by.position;
        // Temperature takes C alpha dT out of the stress.
        flux.by_scalar = -element::stress_tensor(law.heat_stress)
                              .cwiseProduct(by.stress)
                              .sum();
      });
  // A temperature field moves with the nodes.
  result.by_nodes = element::as_points(by_x);
  loads::add_temperature_slope(mesh, state.load_case, result.by_temperature,
                               result.by_nodes);
}

}  // namespace meniscus::functionals
