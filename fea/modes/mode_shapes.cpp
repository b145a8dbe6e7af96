#include "fea/modes/mode_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/element/point_stress.h"
#include "fea/loads/body_loads.h"

namespace meniscus::modes {

namespace {

/// What pushes a mode on, per point of the stiffness rule, >= 0.
std::vector<double> pushing_work(const TetMesh& mesh,
                                 const element::PointStress& points,
                                 const VectorX& x) {
  std::vector<double> work(points.stress.size(), 0.0);
  element::sweep_stiffness_points(
      mesh, element::SweepTargets<1, 0>{.fields = {&x}, .outputs = {}},
      [&](const element::SweepPoint<1>& point, element::SweepFlux<0>&) {
        const std::size_t at = points.index(point.element, point.point);
        const Mat3& H = point.gradient[0];
        const Mat3 stress = element::stress_tensor(
            Eigen::Map<const element::Vec6>(points.stress[at].data()));
        work[at] = std::max(
            0.0, -point.volume * stress.cwiseProduct(H.transpose() * H).sum());
      });
  return work;
}

double strain_norm(const element::Stress& stress,
                   const element::ElasticLaw& law) {
  const element::Strain strain = element::strain_of(stress, law);
  double square = 0.0;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    square += (k < 3 ? 1.0 : 2.0) * strain[k] * strain[k];
  }
  return std::sqrt(square);
}

}  // namespace

std::optional<std::size_t> same_mode(const TetMesh& mesh,
                                     const std::vector<double>& density,
                                     const std::vector<VectorX>& shapes,
                                     const VectorX& reference) {
  return same_mode(
      [&](const VectorX& x) { return mass_times(mesh, density, x); }, shapes,
      reference);
}

std::optional<std::size_t> same_mode(
    const std::function<VectorX(const VectorX& x)>& mass_times,
    const std::vector<VectorX>& shapes, const VectorX& reference) {
  const VectorX momentum = mass_times(reference);
  const double own = reference.dot(momentum);
  std::optional<std::size_t> most;
  double share = 0.5;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const VectorX& x = shapes[k];
    const double here =
        std::pow(x.dot(momentum), 2) / (x.dot(mass_times(x)) * own);
    if (here > share) {
      share = here;
      most = k;
    }
  }
  return most;
}

ModeStress mode_stress(const TetMesh& mesh,
                       const std::vector<element::Material>& materials,
                       const loads::LoadCase& load_case, const VectorX& u,
                       const VectorX& x) {
  const element::PointStress points = element::point_stress(
      mesh, materials, u, loads::temperature_change(mesh, load_case));
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  const std::vector<double> work = pushing_work(mesh, points, x);
  ModeStress mean;
  double total = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto region = static_cast<std::size_t>(mesh.element_region[e]);
    const double yield = materials[region].yield_strength.value_or(
        std::numeric_limits<double>::quiet_NaN());
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      if (work[at] == 0.0) {
        continue;
      }
      const double von_mises = element::von_mises(points.stress[at]);
      total += work[at];
      mean.von_mises += work[at] * von_mises;
      mean.of_yield += work[at] * von_mises / yield;
      mean.strain += work[at] * strain_norm(points.stress[at], laws[region]);
      mean.position += work[at] * points.position[at];
    }
  }
  if (total > 0.0) {
    mean.von_mises /= total;
    mean.of_yield /= total;
    mean.strain /= total;
    mean.position /= total;
  }
  return mean;
}

}  // namespace meniscus::modes
