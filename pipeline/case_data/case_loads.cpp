#include "pipeline/case_data/case_loads.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::case_data {

namespace {

loads::SurfaceTraction traction_of(const LoadEntry& load,
                                   const CaseValues& values) {
  loads::SurfaceTraction result;
  const auto& t = load.traction;
  if (!t[0].of_place && !t[1].of_place && !t[2].of_place) {
    result.traction = {values.at(t[0].quantity), values.at(t[1].quantity),
                       values.at(t[2].quantity)};
    return result;
  }
  const std::array<loads::NumberOfPlace, 3> components = {
      values.field(t[0]), values.field(t[1]), values.field(t[2])};
  result.field = [components](const Vec3& x) {
    return Vec3(components[0](x), components[1](x), components[2](x));
  };
  if (!values.are_rates()) {
    const std::array<loads::VectorOfPlace, 3> rows = {
        values.slope(t[0]), values.slope(t[1]), values.slope(t[2])};
    result.slope = [rows](const Vec3& x) {
      Mat3 slope;
      slope << rows[0](x).transpose(), rows[1](x).transpose(),
          rows[2](x).transpose();
      return slope;
    };
  }
  return result;
}

void add_load(const LoadEntry& load, const CaseValues& values,
              loads::LoadCase& result) {
  switch (load.kind) {
    case LoadKind::Force:
      result.forces.push_back({load.surfaces, values.at(load.vector)});
      break;
    case LoadKind::Remote:
      result.remote_loads.push_back({load.surfaces, values.at(load.at),
                                     values.at(load.vector),
                                     values.at(load.moment)});
      break;
    case LoadKind::Pressure: {
      loads::SurfacePressure pressure;
      if (load.place.of_place) {
        pressure.field = values.field(load.place);
        pressure.slope = values.slope(load.place);
      } else {
        pressure.pressure = values.at(load.place.quantity);
      }
      for (const std::string& surface : load.surfaces) {
        pressure.surface = surface;
        result.pressures.push_back(pressure);
      }
      break;
    }
    case LoadKind::Traction: {
      loads::SurfaceTraction traction = traction_of(load, values);
      for (const std::string& surface : load.surfaces) {
        traction.surface = surface;
        result.tractions.push_back(traction);
      }
      break;
    }
    case LoadKind::Gravity:
      result.gravity += values.at(load.vector);
      break;
    case LoadKind::Spin:
      result.spin = loads::Spin{values.at(load.at), values.at(load.vector),
                                values.at(load.number)};
      break;
    case LoadKind::Temperature: {
      loads::Temperature temperature{.reference = values.at(load.number)};
      if (load.place.of_place) {
        temperature.field = values.field(load.place);
        temperature.slope = values.slope(load.place);
      } else {
        temperature.value = values.at(load.place.quantity);
      }
      result.temperature = std::move(temperature);
      break;
    }
  }
}

}  // namespace

element::Material material_of(const Case& input, const MaterialEntry& entry,
                              const CaseValues& values) {
  element::Material material{.name = entry.name};
  material.orthotropic = entry.orthotropic;
  material.thermal_expansion = entry.thermal_expansion;
  if (!entry.orthotropic) {
    material.youngs_modulus = values.positive(entry.youngs_modulus);
    material.poisson_ratio = values.at(
        entry.poisson_ratio, [](double x) { return x > -1.0 && x < 0.5; },
        "above -1 and below 0.5");
  }
  material.density = values.at(
      entry.density, [](double x) { return x >= 0.0; }, "0 or above");
  if (entry.yield_strength) {
    material.yield_strength = values.positive(*entry.yield_strength);
  }
  if (entry.orthotropic && !values.are_rates()) {
    try {
      element::check_material(material);
    } catch (const InvalidInput& error) {
      values.problems().push_back(
          fmt::format("{}: {}", place(input, entry.line), error.what()));
    }
  }
  return material;
}

loads::LoadCase load_case_of(const LoadCaseEntry& entry,
                             const CaseValues& values) {
  loads::LoadCase result{.name = entry.name, .supports = entry.supports};
  result.springs = entry.springs;
  for (const LoadEntry& load : entry.loads) {
    add_load(load, values, result);
  }
  return result;
}

bool has_weight(const loads::LoadCase& load_case) {
  return !load_case.gravity.isZero(0.0) ||
         (load_case.spin && load_case.spin->rate != 0.0);
}

bool is_loaded(const loads::LoadCase& load_case) {
  const auto& t = load_case.temperature;
  return has_weight(load_case) ||
         (t && (t->field || t->value != t->reference)) ||
         std::any_of(load_case.forces.begin(), load_case.forces.end(),
                     [](const auto& f) { return f.total.norm() > 0.0; }) ||
         std::any_of(
             load_case.pressures.begin(), load_case.pressures.end(),
             [](const auto& p) { return p.field || p.pressure != 0.0; }) ||
         std::any_of(load_case.tractions.begin(), load_case.tractions.end(),
                     [](const auto& p) {
                       return p.field || p.traction.norm() > 0.0;
                     }) ||
         std::any_of(load_case.remote_loads.begin(),
                     load_case.remote_loads.end(), [](const auto& r) {
                       return r.force.norm() + r.moment.norm() > 0.0;
                     });
}

}  // namespace meniscus::case_data
