#include "pipeline/forward/responses.h"

#include <algorithm>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "fea/functionals/displacement_functionals.h"
#include "fea/functionals/energy_functionals.h"
#include "fea/functionals/place_functionals.h"
#include "fea/functionals/stress_functionals.h"
#include "fea/functionals/volume_functionals.h"
#include "fea/loads/body_loads.h"
#include "pipeline/case_data/case_values.h"
#include "pipeline/case_data/response_entries.h"

namespace meniscus {

namespace {

ResponsePartials taken(Functional functional) {
  ResponsePartials result;
  result.value = functional.value;
  result.by_nodes = std::move(functional.by_nodes);
  result.by_displacement = std::move(functional.by_displacement);
  result.by_temperature = std::move(functional.by_temperature);
  result.by_modulus = std::move(functional.by_modulus);
  return result;
}

ResponsePartials taken(DirectedFunctional functional) {
  const Vec3 by_direction = functional.by_direction;
  ResponsePartials result = taken(static_cast<Functional&&>(functional));
  result.by_direction = by_direction;
  return result;
}

ResponsePartials taken(MassFunctional functional) {
  std::vector<double> by_density = std::move(functional.by_density);
  ResponsePartials result = taken(static_cast<Functional&&>(functional));
  result.by_density = std::move(by_density);
  return result;
}

/// Along a direction the centre of mass is a coordinate: of a unit vector.
ResponsePartials centre_of_mass(const ResponseNumbers& numbers,
                                const ResponseInput& fields,
                                Derivatives derivatives) {
  const double length = numbers.direction.norm();
  const Vec3 unit = numbers.direction / length;
  ResponsePartials result = taken(centre_of_mass_functional(
      fields.mesh, fields.numbers.materials, unit, derivatives));
  if (derivatives == Derivatives::All) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 across = (Vec3::Unit(k) - unit[k] * unit) / length;
      if (!across.isZero(0.0)) {
        result.by_direction[k] =
            centre_of_mass_functional(fields.mesh, fields.numbers.materials,
                                      across, Derivatives::None)
                .value;
      }
    }
  }
  return result;
}

ResponsePartials mean_displacement(const ResponseEntry& response,
                                   const ResponseNumbers& numbers,
                                   const ResponseInput& fields,
                                   Derivatives derivatives) {
  const VectorX& u = fields.solution.displacements[response.load_case];
  if (!response.weight) {
    return taken(mean_displacement_functional(
        fields.mesh, response.surface, numbers.direction, u, derivatives));
  }
  return taken(weighted_displacement_functional(
      fields.mesh, response.surface, numbers.direction,
      {numbers.weight, numbers.weight_slope}, u, derivatives));
}

double least_yield(const std::vector<Material>& materials) {
  double least = std::numeric_limits<double>::infinity();
  for (const Material& material : materials) {
    least = std::min(least, material.yield_strength.value_or(least));
  }
  return least;
}

ResponsePartials stress_partials(const ResponseEntry& response,
                                 const ResponseInput& fields,
                                 Derivatives derivatives) {
  const auto& materials = fields.numbers.materials;
  const StressFunctionalInput input{
      fields.mesh,
      materials,
      fields.numbers.load_cases[response.load_case],
      fields.solution.displacements[response.load_case],
      fields.excluded,
      derivatives};
  switch (response.kind) {
    case ResponseKind::VonMisesNorm:
      return taken(von_mises_norm_functional(input, response.power));
    case ResponseKind::VonMisesKs:
      return taken(von_mises_ks_functional(
          input, {.sharpness = response.sharpness,
                  .scale = response.scale.value_or(least_yield(materials))}));
    case ResponseKind::Uniformity:
      return taken(von_mises_variation_functional(input));
    default:
      return taken(energy_density_variation_functional(input));
  }
}

/// Half the work of the loads is the strain energy where it all goes into the
/// solid.
ResponsePartials energy_partials(const ResponseEntry& response,
                                 const ResponseInput& fields,
                                 Derivatives derivatives) {
  const LoadCase& load_case = fields.numbers.load_cases[response.load_case];
  const VectorX& u = fields.solution.displacements[response.load_case];
  const auto& materials = fields.numbers.materials;
  const bool strain = response.kind == ResponseKind::StrainEnergy;
  if (strain && (!load_case.springs.empty() || load_case.temperature)) {
    return taken(strain_energy_functional(fields.mesh, materials, load_case, u,
                                          derivatives));
  }
  const double share = strain ? 0.5 : 1.0;
  ResponsePartials result = taken(
      compliance_functional(fields.mesh, materials, load_case, u, derivatives));
  result.value *= share;
  for (Vec3& by_node : result.by_nodes) {
    by_node *= share;
  }
  if (derivatives == Derivatives::All) {
    result.self_adjoint = share;
    result.by_forces = share * u;
  }
  return result;
}

ResponsePartials film_area(const ResponseEntry& response,
                           const ResponseInput& fields) {
  const VectorX areas = fields.film->areas(fields.film_state->points);
  const std::vector<std::string>& labels = fields.film->labels();
  ResponsePartials result;
  result.film.areas = VectorX::Ones(areas.size());
  if (!response.film.empty()) {
    result.film.areas = VectorX::Unit(
        areas.size(), std::find(labels.begin(), labels.end(), response.film) -
                          labels.begin());
  }
  result.value = areas.dot(result.film.areas);
  return result;
}

ResponsePartials taken(FilmResponse film) {
  ResponsePartials result;
  result.value = film.value;
  result.film = std::move(film.by);
  return result;
}

/// Films run beside each other over wide areas, and many vertices count.
constexpr double kGapPartOfEdge = 0.02;

ResponsePartials film_partials(const ResponseEntry& response,
                               const ResponseInput& fields) {
  const FilmState& state = *fields.film_state;
  switch (response.kind) {
    case ResponseKind::FilmArea:
      return film_area(response, fields);
    case ResponseKind::CollapseMargin:
      return taken(fields.film->margin(state, fields.numbers.film_system));
    case ResponseKind::Radius:
      return taken(fields.film->smallest_radius(
          state.points, static_cast<int>(response.power)));
    case ResponseKind::Gap:
      return taken(fields.film->gap(
          state.points, response.films[0], response.films[1],
          response.smoothing.value_or(kGapPartOfEdge *
                                      fields.numbers.fea_edge)));
    case ResponseKind::ScanDistance:
      return taken(measure(
          scan_distances(response, *fields.scans, *fields.film, state.points),
          response.measure, state.points.size()));
    default:
      break;
  }
  ResponsePartials result;
  if (response.kind == ResponseKind::FilmEnergy) {
    result.value = state.report.energy;
    result.film.energy = 1.0;
    return result;
  }
  const auto bodies = static_cast<Eigen::Index>(state.report.bodies.size());
  result.value = state.report.bodies[response.body].pressure;
  result.film.pressures = VectorX::Unit(bodies, response.body);
  return result;
}

/// Of extremes over the part's surface, where the case says nothing else: to a
/// tenth of an edge.
double sharpness_of(const ResponseEntry& response,
                    const ResponseInput& fields) {
  constexpr double kPartOfEdge = 0.1;
  return 1.0 /
         response.smoothing.value_or(kPartOfEdge * fields.numbers.fea_edge);
}

ResponsePartials place_partials(const ResponseEntry& response,
                                const ResponseNumbers& numbers,
                                const ResponseInput& fields,
                                Derivatives derivatives) {
  const double sharpness = sharpness_of(response, fields);
  if (response.kind == ResponseKind::Thickness) {
    return taken(thickness_functional(fields.mesh, *fields.pairs, sharpness,
                                      derivatives));
  }
  return taken(intrusion_functional(fields.mesh,
                                    {numbers.level, numbers.level_slope},
                                    sharpness, derivatives));
}

ResponsePartials peak(const ResponseEntry& response,
                      const ResponseInput& fields, Derivatives derivatives) {
  if (derivatives == Derivatives::All) {
    throw InvalidInput(fmt::format(
        "response '{}' is a max_von_mises, which has no derivative: use "
        "von_mises_norm or von_mises_ks",
        response.name));
  }
  ResponsePartials result;
  result.value =
      load_case_stress(fields.mesh, fields.numbers, response.load_case,
                       fields.solution.displacements[response.load_case],
                       fields.excluded)
          .max_von_mises;
  return result;
}

/// Over the case's names and the values above.
double expression_value(const Case& input, const ResponseEntry& response,
                        const VectorX& design, std::span<const double> above) {
  std::vector<std::string> problems;
  const double value =
      CaseValues(input, design, problems).at(response.value, above);
  if (!problems.empty()) {
    throw InvalidInput(problems.front());
  }
  return value;
}

}  // namespace

StressField load_case_stress(const TetMesh& mesh, const EvaluatedCase& numbers,
                             std::size_t load_case, const VectorX& u,
                             const std::vector<char>& excluded) {
  StressField field =
      recover_stress(mesh, numbers.materials, u,
                     temperature_change(mesh, numbers.load_cases[load_case]));
  if (!excluded.empty()) {
    find_peak(mesh, excluded, field);
  }
  return field;
}

ThicknessPairs thickness_pairs_of(const Case& input, const TetMesh& base) {
  const bool asked = std::any_of(
      input.responses.begin(), input.responses.end(),
      [](const ResponseEntry& r) { return r.kind == ResponseKind::Thickness; });
  return asked ? thickness_pairs(base) : ThicknessPairs();
}

ResponsePartials partials_of(const ResponseEntry& response,
                             const ResponseNumbers& numbers,
                             const ResponseInput& fields,
                             Derivatives derivatives) {
  const TetMesh& mesh = fields.mesh;
  switch (response.kind) {
    case ResponseKind::MeanDisplacement:
      return mean_displacement(response, numbers, fields, derivatives);
    case ResponseKind::DisplacementNorm:
      return taken(displacement_norm_functional(
          mesh, response.surface, numbers.direction, response.power,
          fields.solution.displacements[response.load_case], derivatives));
    case ResponseKind::Rotation:
      return taken(rotation_functional(
          mesh, response.surface, numbers.direction,
          fields.solution.displacements[response.load_case], derivatives));
    case ResponseKind::Compliance:
    case ResponseKind::StrainEnergy:
      return energy_partials(response, fields, derivatives);
    case ResponseKind::Mass:
      return taken(
          mass_functional(mesh, fields.numbers.materials, derivatives));
    case ResponseKind::Volume:
      return taken(volume_functional(mesh, derivatives));
    case ResponseKind::CentreOfMass:
      return centre_of_mass(numbers, fields, derivatives);
    case ResponseKind::MaxVonMises:
      return peak(response, fields, derivatives);
    case ResponseKind::VonMisesNorm:
    case ResponseKind::VonMisesKs:
    case ResponseKind::Uniformity:
    case ResponseKind::EnergyUniformity:
      return stress_partials(response, fields, derivatives);
    case ResponseKind::FilmArea:
    case ResponseKind::FilmEnergy:
    case ResponseKind::Pressure:
    case ResponseKind::CollapseMargin:
    case ResponseKind::Radius:
    case ResponseKind::Gap:
    case ResponseKind::ScanDistance:
      return film_partials(response, fields);
    case ResponseKind::Thickness:
    case ResponseKind::Distance:
      return place_partials(response, numbers, fields, derivatives);
    case ResponseKind::Expression:
      break;
  }
  throw InvalidInput(
      fmt::format("response '{}' has no partial derivatives", response.name));
}

double place_rate(const ResponseEntry& response, const ResponseNumbers& numbers,
                  const ResponseNumbers& rates, const ResponseInput& fields) {
  if (rates.weight) {
    return weighted_displacement_functional(
               fields.mesh, response.surface, numbers.direction,
               {rates.weight, {}},
               fields.solution.displacements[response.load_case],
               Derivatives::None)
        .value;
  }
  return rates.level ? intrusion_rate(fields.mesh, numbers.level, rates.level,
                                      sharpness_of(response, fields))
                     : 0.0;
}

VectorX respond(const Case& input, const ResponseInput& fields) {
  VectorX values(static_cast<Eigen::Index>(input.responses.size()));
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const ResponseEntry& response = input.responses[k];
    values[static_cast<Eigen::Index>(k)] =
        response.kind == ResponseKind::Expression
            ? expression_value(input, response, fields.numbers.design,
                               {values.data(), k})
            : partials_of(response, fields.numbers.responses[k], fields,
                          Derivatives::None)
                  .value;
  }
  return values;
}

}  // namespace meniscus
