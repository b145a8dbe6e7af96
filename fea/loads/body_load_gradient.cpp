#include "fea/loads/body_load_gradient.h"

#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/loads/body_loads.h"
#include "fea/loads/load_checks.h"

namespace meniscus::loads {

namespace {

template <std::size_t Fields>
Vec3 field_at(const element::SweepPoint<Fields>& point, const VectorX& field) {
  Vec3 value = Vec3::Zero();
  for (std::size_t a = 0; a < point.shape.size(); ++a) {
    value += point.shape[a] * field.segment<3>(3L * point.nodes[a]);
  }
  return value;
}

/// v . density (gravity + rate^2 r).
void add_weight_by_nodes(const TetMesh& mesh,
                         const std::vector<element::Material>& materials,
                         const LoadCase& load_case, const VectorX& v,
                         VectorX& sum) {
  const bool spins = load_case.spin && load_case.spin->rate != 0.0;
  if (load_case.gravity.isZero(0.0) && !spins) {
    return;
  }
  // rate^2 (r - axis axis . r)
  Mat3 centrifugal = Mat3::Zero();
  Vec3 centre = Vec3::Zero();
  if (spins) {
    const Spin& spin = *load_case.spin;
    const Vec3 axis = spin.axis.normalized();
    centrifugal =
        spin.rate * spin.rate * (Mat3::Identity() - axis * axis.transpose());
    centre = spin.point;
  }
  const element::SweepTargets<0, 1> targets{.fields = {}, .outputs = {&sum}};
  element::sweep_stiffness_points(
      mesh, targets,
      [&](const element::SweepPoint<0>& point, element::SweepFlux<1>& flux) {
        Vec3 r = -centre;
        for (std::size_t a = 0; spins && a < point.shape.size(); ++a) {
          r += point.shape[a] * mesh.nodes[point.nodes[a]];
        }
        const Vec3 here = field_at(point, v);
        const double mass =
            point.volume *
            materials[mesh.element_region[point.element]].density;
        const Vec3 force = load_case.gravity + centrifugal * r;
        flux.by_gradient[0] = mass * force.dot(here) * Mat3::Identity();
        flux.by_shape[0] = mass * (centrifugal * here);
      });
}

/// (C expansion change) : gradient of v.
void add_expansion(const TetMesh& mesh,
                   const std::vector<element::Material>& materials,
                   const LoadCase& load_case, const VectorX& v, VectorX& sum,
                   VectorX& by_temperature) {
  const VectorX change = temperature_change(mesh, load_case);
  std::vector<Mat3> stress;
  stress.reserve(materials.size());
  for (const element::ElasticLaw& law : element::elastic_laws(materials)) {
    stress.push_back(element::stress_tensor(law.heat_stress));
  }
  const element::SweepTargets<1, 1> targets{
      .fields = {&v}, .outputs = {&sum}, .scalar = &by_temperature};
  element::sweep_stiffness_points(
      mesh, targets,
      [&](const element::SweepPoint<1>& point, element::SweepFlux<1>& flux) {
        double degrees = 0.0;
        for (std::size_t a = 0; a < point.shape.size(); ++a) {
          degrees += point.shape[a] * change[point.nodes[a]];
        }
        const Mat3& s = stress[mesh.element_region[point.element]];
        const Mat3& H = point.gradient[0];
        const double work = point.volume * s.cwiseProduct(H).sum();
        flux.by_gradient[0] = -point.volume * degrees * H.transpose() * s;
        flux.by_gradient[0].diagonal().array() += degrees * work;
        flux.by_scalar = work;
      });
}

}  // namespace

void require_temperature_slope(const LoadCase& load_case) {
  if (load_case.temperature && load_case.temperature->field) {
    require_slope(load_case.temperature->slope, load_case, "the temperature");
  }
}

void add_temperature_slope(const TetMesh& mesh, const LoadCase& load_case,
                           const VectorX& by_temperature, Points& gradient) {
  if (!load_case.temperature || !load_case.temperature->field) {
    return;
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    gradient[i] += by_temperature[static_cast<Eigen::Index>(i)] *
                   field_value(load_case.temperature->slope, mesh.nodes[i],
                               load_case, "the temperature's slope");
  }
}

void add_body_load_gradient(const TetMesh& mesh,
                            const std::vector<element::Material>& materials,
                            const LoadCase& load_case, const VectorX& v,
                            Points& gradient) {
  element::check_materials(mesh, materials);
  VectorX sum = element::nodal_zeros(mesh);
  add_weight_by_nodes(mesh, materials, load_case, v, sum);
  if (load_case.temperature) {
    require_temperature_slope(load_case);
    VectorX by_temperature =
        VectorX::Zero(static_cast<Eigen::Index>(mesh.nodes.size()));
    add_expansion(mesh, materials, load_case, v, sum, by_temperature);
    add_temperature_slope(mesh, load_case, by_temperature, gradient);
  }
  flat(gradient) += sum;
}

}  // namespace meniscus::loads
