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

/// Of a pressure or a temperature: a rate has none where nothing moves it, and
/// no slope.
template <class Load>
void set_field(const PlaceQuantity& place, const CaseValues& values,
               Load& load) {
  if (!values.are_rates()) {
    load.field = values.field(place);
    load.slope = values.slope(place);
  } else if (values.moves(place.quantity)) {
    load.field = values.field(place);
  }
}

/// A rigid load and a rigid support on the same surfaces are of one pin.
void add_pin(const loads::Surfaces& surfaces, loads::LoadCase& result) {
  if (std::none_of(result.pins.begin(), result.pins.end(),
                   [&](const loads::RigidPin& pin) {
                     return are_same_surfaces(pin.surfaces, surfaces);
                   })) {
    result.pins.push_back({.surfaces = surfaces});
  }
}

/// A number that nothing would follow is a mistake.
void require_fixed(const std::optional<QuantityVector>& numbers,
                   const std::array<bool, 3>& fixed, const char* key,
                   const CaseValues& values) {
  for (std::size_t k = 0; numbers && k < 3; ++k) {
    if (!fixed[k]) {
      values.at(
          (*numbers)[k], [](double x) { return x == 0.0; },
          fmt::format("0 where {} does not hold that component", key).c_str());
    }
  }
}

std::optional<Vec3> value_of(const std::optional<QuantityVector>& numbers,
                             const CaseValues& values) {
  return numbers ? std::optional<Vec3>(values.at(*numbers)) : std::nullopt;
}

loads::Support support_of(const SupportEntry& entry, const CaseValues& values) {
  loads::Support support = entry.support;
  require_fixed(entry.displacement,
                {support.fix_x, support.fix_y, support.fix_z}, "fix", values);
  require_fixed(entry.rotation, support.fix_rotation, "fix_rotation", values);
  support.displacement = value_of(entry.displacement, values);
  support.rotation = value_of(entry.rotation, values);
  support.at = value_of(entry.at, values);
  return support;
}

loads::RigidPin pin_of(const PinEntry& entry, const CaseValues& values) {
  loads::RigidPin pin = entry.pin;
  pin.point = values.at(entry.at);
  require_fixed(entry.displacement, pin.fix, "fix", values);
  require_fixed(entry.rotation, pin.fix_rotation, "fix_rotation", values);
  pin.displacement = value_of(entry.displacement, values);
  pin.rotation = value_of(entry.rotation, values);
  return pin;
}

/// Of a tightened bolt: pressed into the seat and pulled from the thread, as
/// much about any point.
void add_preload(const LoadEntry& load, const CaseValues& values,
                 loads::LoadCase& result) {
  values.positive(load.number);
  const Dual1 tension = values.dual(load.number);
  std::array<Dual1, 3> axis;
  Dual1 square(0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    axis[k] = values.dual(load.vector[k]);
    square = square + axis[k] * axis[k];
  }
  if (!(square.value > 0.0)) {
    values.at(
        load.vector[0], [](double) { return false; },
        "part of a direction with a length");
    return;
  }
  Vec3 pull;
  for (std::size_t k = 0; k < 3; ++k) {
    const Dual1 force = tension * axis[k] / sqrt(square);
    pull[static_cast<Eigen::Index>(k)] =
        values.are_rates() ? (force.varies ? force.gradient[0] : 0.0)
                           : force.value;
  }
  const Vec3 at = values.at(load.at);
  result.remote_loads.push_back(
      {.surfaces = load.surfaces, .point = at, .force = -pull});
  result.remote_loads.push_back(
      {.surfaces = load.thread, .point = at, .force = pull});
}

void add_load(const LoadEntry& load, const CaseValues& values,
              loads::LoadCase& result) {
  if (load.size) {
    values.positive(*load.size);
  }
  if (load.by == LoadPath::Bearing) {
    result.bearings.push_back(
        {.surfaces = load.surfaces, .force = values.at(load.vector)});
    if (load.has_at) {
      result.bearings.back().point = values.at(load.at);
    }
    result.bearings.back().axis = value_of(load.axis, values);
    return;
  }
  if (load.by == LoadPath::Rigid) {
    add_pin(load.surfaces, result);
  }
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
        set_field(load.place, values, pressure);
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
    case LoadKind::RimTension:
      for (const std::string& surface : load.surfaces) {
        result.rim_tensions.push_back({surface, values.at(load.number)});
      }
      break;
    case LoadKind::Gravity:
      result.gravity += values.at(load.vector);
      break;
    case LoadKind::Spin:
      result.spin = loads::Spin{values.at(load.at), values.at(load.vector),
                                values.at(load.number)};
      break;
    case LoadKind::Preload:
      add_preload(load, values, result);
      break;
    case LoadKind::Temperature: {
      loads::Temperature temperature{.reference = values.at(load.number)};
      if (load.place.of_place) {
        set_field(load.place, values, temperature);
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
  material.endurance_limit = entry.endurance_limit;
  material.tensile_strength = entry.tensile_strength;
  material.torsion_limit = entry.torsion_limit;
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

bool are_same_surfaces(const loads::Surfaces& a, const loads::Surfaces& b) {
  return std::is_permutation(a.begin(), a.end(), b.begin(), b.end());
}

loads::LoadCase load_case_of(const LoadCaseEntry& entry,
                             const CaseValues& values) {
  loads::LoadCase result{.name = entry.name};
  for (const SupportEntry& support : entry.supports) {
    result.supports.push_back(support_of(support, values));
  }
  result.springs = entry.springs;
  for (const PinEntry& pin : entry.pins) {
    result.pins.push_back(pin_of(pin, values));
  }
  for (const LoadEntry& load : entry.loads) {
    add_load(load, values, result);
  }
  return result;
}

bool has_weight(const loads::LoadCase& load_case) {
  return !load_case.gravity.isZero(0.0) ||
         (load_case.spin && load_case.spin->rate != 0.0);
}

namespace {

bool moves_supports(const loads::LoadCase& load_case) {
  return std::any_of(
             load_case.supports.begin(), load_case.supports.end(),
             [](const loads::Support& support) {
               return !loads::value_of(support.displacement).isZero(0.0) ||
                      !loads::value_of(support.rotation).isZero(0.0);
             }) ||
         std::any_of(load_case.pins.begin(), load_case.pins.end(),
                     [](const loads::RigidPin& pin) {
                       return !loads::value_of(pin.displacement).isZero(0.0) ||
                              !loads::value_of(pin.rotation).isZero(0.0);
                     });
}

}  // namespace

bool is_loaded(const loads::LoadCase& load_case) {
  const auto& t = load_case.temperature;
  return has_weight(load_case) || moves_supports(load_case) ||
         (t && (t->field || t->value != t->reference)) ||
         std::any_of(load_case.bearings.begin(), load_case.bearings.end(),
                     [](const auto& b) { return b.force.norm() > 0.0; }) ||
         std::any_of(load_case.forces.begin(), load_case.forces.end(),
                     [](const auto& f) { return f.total.norm() > 0.0; }) ||
         std::any_of(
             load_case.pressures.begin(), load_case.pressures.end(),
             [](const auto& p) { return p.field || p.pressure != 0.0; }) ||
         std::any_of(load_case.tractions.begin(), load_case.tractions.end(),
                     [](const auto& p) {
                       return p.field || p.traction.norm() > 0.0;
                     }) ||
         std::any_of(load_case.rim_tensions.begin(),
                     load_case.rim_tensions.end(),
                     [](const auto& r) { return r.tension != 0.0; }) ||
         std::any_of(load_case.remote_loads.begin(),
                     load_case.remote_loads.end(), [](const auto& r) {
                       return r.force.norm() + r.moment.norm() > 0.0;
                     });
}

}  // namespace meniscus::case_data
