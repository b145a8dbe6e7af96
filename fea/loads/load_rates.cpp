#include "fea/loads/load_rates.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"
#include "fea/loads/bearing_load.h"
#include "fea/loads/load_checks.h"
#include "fea/loads/loads.h"
#include "fea/loads/remote_gradient.h"

namespace meniscus::loads {

namespace {

Vec3 mean_over(const TetMesh& mesh, const Surfaces& surfaces,
               const VectorX& v) {
  const SurfaceWeights w = surface_weights(mesh, surfaces);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    sum +=
        w.weights[static_cast<Eigen::Index>(k)] * v.segment<3>(3L * w.nodes[k]);
  }
  return sum / w.weights.sum();
}

void add_surface_loads(const TetMesh& mesh, const LoadCase& load_case,
                       const VectorX& v, LoadGradient& out) {
  // Derivatives of v . f by the numbers of each load, at fixed v and mesh.
  // A total force F: f . v = F . (mean of v over the surface).
  for (const SurfaceForce& load : load_case.forces) {
    out.by_number.forces.push_back(
        {load.surfaces, mean_over(mesh, load.surfaces, v)});
  }
  // A pressure: -int N . v by its value; a field keeps weights and places of
  // the points, so that any rate of it is a sum.
  for (const SurfacePressure& load : load_case.pressures) {
    SurfacePressure by{.surface = load.surface};
    LoadGradient::NumberField field;
    element::over_face_points(
        mesh, element::surface_label(mesh, load.surface),
        load.field ? element::FaceRule::Seven : element::FaceRule::Three,
        [&](int f, const element::FacePoint& point) {
          const double weight =
              -point.normal.dot(element::value_at(mesh, f, point, v));
          by.pressure += weight;
          if (load.field) {
            field.places.push_back(point.position);
            field.weights.push_back(weight);
          }
        });
    out.by_number.pressures.push_back(by);
    out.pressures.push_back(std::move(field));
  }
  // A force per area: int v dA by its components.
  for (const SurfaceTraction& load : load_case.tractions) {
    SurfaceTraction by{.surface = load.surface};
    LoadGradient::VectorField field;
    element::over_face_points(
        mesh, element::surface_label(mesh, load.surface),
        load.field ? element::FaceRule::Seven : element::FaceRule::Three,
        [&](int f, const element::FacePoint& point) {
          const Vec3 weight =
              point.normal.norm() * element::value_at(mesh, f, point, v);
          by.traction += weight;
          if (load.field) {
            field.places.push_back(point.position);
            field.weights.push_back(weight);
          }
        });
    out.by_number.tractions.push_back(by);
    out.tractions.push_back(std::move(field));
  }
  // A remote load: its place counts too, through the moment arm.
  for (const RemoteLoad& load : load_case.remote_loads) {
    const RemoteGradient by = remote_gradient(mesh, load, v, nullptr);
    out.by_number.remote_loads.push_back(
        {load.surfaces, by.by_point, by.by_force, by.by_moment});
  }
  for (const BearingLoad& load : load_case.bearings) {
    const BearingGradient by = bearing_gradient(mesh, load, v, nullptr);
    out.by_number.bearings.push_back(
        {load.surfaces, by.by_force, by.by_point, by.by_axis});
  }
}

/// sum of mass v and mass x v^T over the solid.
struct MassMoments {
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

MassMoments mass_moments(const TetMesh& mesh,
                         const std::vector<element::Material>& materials,
                         const VectorX& v) {
  std::vector<MassMoments> part(static_cast<std::size_t>(mesh.element_count()));
  element::sweep_stiffness_points(
      mesh, element::SweepTargets<0, 0>{},
      [&](const element::SweepPoint<0>& point, element::SweepFlux<0>&) {
        Vec3 x = Vec3::Zero();
        Vec3 here = Vec3::Zero();
        for (std::size_t a = 0; a < point.shape.size(); ++a) {
          x += point.shape[a] * mesh.nodes[point.nodes[a]];
          here += point.shape[a] * v.segment<3>(3L * point.nodes[a]);
        }
        const double mass =
            point.volume *
            materials[mesh.element_region[point.element]].density;
        part[point.element].first += mass * here;
        part[point.element].second += mass * x * here.transpose();
      });
  MassMoments sum;
  for (const MassMoments& p : part) {
    sum.first += p.first;
    sum.second += p.second;
  }
  return sum;
}

/// With T = sum mass r v^T, r from the axis' point, and the unit axis a:
/// v . f = gravity . sum mass v + rate^2 (tr T - a . T a).
void add_weight_rates(const TetMesh& mesh,
                      const std::vector<element::Material>& materials,
                      const LoadCase& load_case, const VectorX& v,
                      LoadGradient& out) {
  const MassMoments moments = mass_moments(mesh, materials, v);
  out.by_number.gravity = moments.first;
  if (!load_case.spin) {
    return;
  }
  const Spin& spin = *load_case.spin;
  const Vec3 a = spin.axis.normalized();
  const Mat3 T = moments.second - spin.point * moments.first.transpose();
  const double square = spin.rate * spin.rate;
  const Vec3 by_unit = -square * (T + T.transpose()) * a;
  out.by_number.spin =
      Spin{.point = -square * (moments.first - a.dot(moments.first) * a),
           .axis = (by_unit - a.dot(by_unit) * a) / spin.axis.norm(),
           .rate = 2.0 * spin.rate * (T.trace() - a.dot(T * a))};
}

void add_temperature(const TetMesh& mesh,
                     const std::vector<element::Material>& materials,
                     const LoadCase& load_case, const VectorX& v,
                     LoadGradient& out) {
  std::vector<Mat3> stress;
  stress.reserve(materials.size());
  for (const element::ElasticLaw& law : element::elastic_laws(materials)) {
    stress.push_back(element::stress_tensor(law.heat_stress));
  }
  VectorX unused = element::nodal_zeros(mesh);
  VectorX by_node = VectorX::Zero(static_cast<Eigen::Index>(mesh.nodes.size()));
  const element::SweepTargets<1, 1> targets{
      .fields = {&v}, .outputs = {&unused}, .scalar = &by_node};
  element::sweep_stiffness_points(
      mesh, targets,
      [&](const element::SweepPoint<1>& point, element::SweepFlux<1>& flux) {
        flux.by_scalar =
            point.volume * stress[mesh.element_region[point.element]]
                               .cwiseProduct(point.gradient[0])
                               .sum();
      });
  add_temperature_gradient(mesh, load_case, by_node, out);
}

double number_at(const NumberOfPlace& field, double number, const Vec3& x,
                 const LoadCase& rates) {
  return field ? field_value(field, x, rates, "a field's rate") : number;
}

void check_rates(const LoadCase& by, const LoadCase& rates) {
  if (by.forces.size() != rates.forces.size() ||
      by.pressures.size() != rates.pressures.size() ||
      by.tractions.size() != rates.tractions.size() ||
      by.remote_loads.size() != rates.remote_loads.size() ||
      by.bearings.size() != rates.bearings.size() ||
      (!by.supports.empty() && by.supports.size() != rates.supports.size()) ||
      (!by.pins.empty() && by.pins.size() != rates.pins.size()) ||
      (rates.nodal.size() != 0 && by.nodal.size() != rates.nodal.size())) {
    throw InvalidInput(fmt::format(
        "load case '{}': the rates of its loads differ from them in number",
        by.name));
  }
}

void refuse_field(bool field, const LoadCase& by, const char* what) {
  if (field) {
    throw InvalidInput(
        fmt::format("load case '{}': a {} is a number, but its rate is a field",
                    by.name, what));
  }
}

double pressure_rate(const LoadGradient& gradient, const LoadCase& rates) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rates.pressures.size(); ++k) {
    const SurfacePressure& rate = rates.pressures[k];
    const LoadGradient::NumberField& field = gradient.pressures[k];
    if (field.places.empty()) {
      refuse_field(static_cast<bool>(rate.field), gradient.by_number,
                   "pressure");
      sum += gradient.by_number.pressures[k].pressure * rate.pressure;
    }
    for (std::size_t i = 0; i < field.places.size(); ++i) {
      sum += field.weights[i] *
             number_at(rate.field, rate.pressure, field.places[i], rates);
    }
  }
  return sum;
}

double traction_rate(const LoadGradient& gradient, const LoadCase& rates) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rates.tractions.size(); ++k) {
    const SurfaceTraction& rate = rates.tractions[k];
    const LoadGradient::VectorField& field = gradient.tractions[k];
    if (field.places.empty()) {
      refuse_field(static_cast<bool>(rate.field), gradient.by_number,
                   "traction");
      sum += gradient.by_number.tractions[k].traction.dot(rate.traction);
    }
    for (std::size_t i = 0; i < field.places.size(); ++i) {
      sum += field.weights[i].dot(rate.field
                                      ? field_value(rate.field, field.places[i],
                                                    rates, "a field's rate")
                                      : rate.traction);
    }
  }
  return sum;
}

double temperature_rate(const LoadGradient& gradient, const LoadCase& rates) {
  const auto& by = gradient.by_number.temperature;
  if (!by || !rates.temperature) {
    return 0.0;
  }
  const Temperature& rate = *rates.temperature;
  double sum = by->reference * rate.reference;
  const LoadGradient::NumberField& field = gradient.temperature;
  if (field.places.empty()) {
    refuse_field(static_cast<bool>(rate.field), gradient.by_number,
                 "temperature");
    sum += by->value * rate.value;
  }
  for (std::size_t i = 0; i < field.places.size(); ++i) {
    sum += field.weights[i] *
           number_at(rate.field, rate.value, field.places[i], rates);
  }
  return sum;
}

double enforced_rate(const LoadCase& by, const LoadCase& rates) {
  double sum = 0.0;
  for (std::size_t k = 0; k < by.supports.size(); ++k) {
    sum += value_of(by.supports[k].displacement)
               .dot(value_of(rates.supports[k].displacement));
  }
  for (std::size_t k = 0; k < by.pins.size(); ++k) {
    const RigidPin& d = by.pins[k];
    const RigidPin& rate = rates.pins[k];
    sum += d.point.dot(rate.point) +
           value_of(d.displacement).dot(value_of(rate.displacement)) +
           value_of(d.rotation).dot(value_of(rate.rotation));
  }
  return sum;
}

}  // namespace

LoadGradient load_gradient(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const LoadCase& load_case, const VectorX& v) {
  element::check_materials(mesh, materials);
  if (v.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("load case '{}': a vector of {} numbers for {} nodes",
                    load_case.name, v.size(), mesh.nodes.size()));
  }
  LoadGradient result;
  result.by_number.name = load_case.name;
  if (load_case.nodal.size() != 0) {
    result.by_number.nodal = v;
  }
  add_surface_loads(mesh, load_case, v, result);
  add_weight_rates(mesh, materials, load_case, v, result);
  if (load_case.temperature) {
    add_temperature(mesh, materials, load_case, v, result);
  }
  return result;
}

void add_temperature_gradient(const TetMesh& mesh, const LoadCase& load_case,
                              const VectorX& by_temperature,
                              LoadGradient& gradient) {
  if (by_temperature.size() == 0 || !load_case.temperature) {
    return;
  }
  auto& by = gradient.by_number.temperature;
  if (!by) {
    by = Temperature{};
  }
  const double sum = by_temperature.sum();
  by->value += sum;
  by->reference -= sum;
  if (load_case.temperature->field) {
    LoadGradient::NumberField& field = gradient.temperature;
    field.places = mesh.nodes;
    field.weights.resize(mesh.nodes.size(), 0.0);
    for (std::size_t i = 0; i < field.weights.size(); ++i) {
      field.weights[i] += by_temperature[static_cast<Eigen::Index>(i)];
    }
  }
}

bool changes(const LoadCase& rates) {
  const Vec3 none = Vec3::Zero();
  const auto any = [](const auto& items, const auto& moves) {
    return std::any_of(items.begin(), items.end(), moves);
  };
  const auto& heat = rates.temperature;
  const auto& spin = rates.spin;
  return rates.nodal.size() != 0 || rates.gravity != none ||
         any(rates.forces,
             [&](const SurfaceForce& f) { return f.total != none; }) ||
         any(rates.pressures,
             [](const SurfacePressure& p) {
               return p.field || p.pressure != 0.0;
             }) ||
         any(rates.tractions,
             [&](const SurfaceTraction& t) {
               return t.field || t.traction != none;
             }) ||
         any(rates.rim_tensions,
             [](const RimTension& t) { return t.tension != 0.0; }) ||
         any(rates.remote_loads,
             [&](const RemoteLoad& r) {
               return r.point != none || r.force != none || r.moment != none;
             }) ||
         any(rates.bearings,
             [&](const BearingLoad& b) {
               return b.force != none || value_of(b.point) != none ||
                      value_of(b.axis) != none;
             }) ||
         (spin &&
          (spin->point != none || spin->axis != none || spin->rate != 0.0)) ||
         (heat && (heat->field || heat->nodal.size() != 0 ||
                   heat->value != 0.0 || heat->reference != 0.0));
}

double load_rate(const LoadGradient& gradient, const LoadCase& rates) {
  const LoadCase& by = gradient.by_number;
  check_rates(by, rates);
  double sum = by.gravity.dot(rates.gravity) + enforced_rate(by, rates);
  if (rates.nodal.size() != 0) {
    sum += by.nodal.dot(rates.nodal);
  }
  for (std::size_t k = 0; k < by.forces.size(); ++k) {
    sum += by.forces[k].total.dot(rates.forces[k].total);
  }
  sum += pressure_rate(gradient, rates) + traction_rate(gradient, rates) +
         temperature_rate(gradient, rates);
  for (std::size_t k = 0; k < by.remote_loads.size(); ++k) {
    const RemoteLoad& d = by.remote_loads[k];
    const RemoteLoad& rate = rates.remote_loads[k];
    sum += d.point.dot(rate.point) + d.force.dot(rate.force) +
           d.moment.dot(rate.moment);
  }
  for (std::size_t k = 0; k < by.bearings.size(); ++k) {
    const BearingLoad& d = by.bearings[k];
    const BearingLoad& rate = rates.bearings[k];
    sum += d.force.dot(rate.force) +
           value_of(d.point).dot(value_of(rate.point)) +
           value_of(d.axis).dot(value_of(rate.axis));
  }
  if (by.spin && rates.spin) {
    sum += by.spin->point.dot(rates.spin->point) +
           by.spin->axis.dot(rates.spin->axis) +
           by.spin->rate * rates.spin->rate;
  }
  return sum;
}

}  // namespace meniscus::loads
