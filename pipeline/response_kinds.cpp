#include "pipeline/response_kinds.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "fea/displacement_functionals.h"
#include "fea/energy_functionals.h"
#include "fea/place_functionals.h"
#include "fea/stress_functionals.h"
#include "fea/volume_functionals.h"

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

ResponsePartials taken(FilmResponse film) {
  ResponsePartials result;
  result.value = film.value;
  result.film = std::move(film.by);
  return result;
}

/// Of its load case, 3 per node.
const VectorX& displacement(const ResponseTask& task) {
  return task.fields.solution.displacements[task.response.load_case];
}

const std::vector<Material>& materials(const ResponseTask& task) {
  return task.fields.numbers.materials;
}

ResponsePartials mean_displacement(const ResponseTask& task) {
  if (!task.response.weight) {
    return taken(mean_displacement_functional(
        task.fields.mesh, task.response.surface, task.numbers.direction,
        displacement(task), task.derivatives));
  }
  return taken(weighted_displacement_functional(
      task.fields.mesh, task.response.surface, task.numbers.direction,
      {task.numbers.weight, task.numbers.weight_slope}, displacement(task),
      task.derivatives));
}

ResponsePartials displacement_norm(const ResponseTask& task) {
  return taken(displacement_norm_functional(
      task.fields.mesh, task.response.surface, task.numbers.direction,
      task.response.power, displacement(task), task.derivatives));
}

ResponsePartials rotation(const ResponseTask& task) {
  return taken(rotation_functional(task.fields.mesh, task.response.surface,
                                   task.numbers.direction, displacement(task),
                                   task.derivatives));
}

/// Half the work of the loads is the strain energy where it all goes into the
/// solid.
ResponsePartials energy(const ResponseTask& task) {
  const LoadCase& load_case =
      task.fields.numbers.load_cases[task.response.load_case];
  const VectorX& u = displacement(task);
  const bool strain = task.response.kind == ResponseKind::StrainEnergy;
  if (strain && (!load_case.springs.empty() || load_case.temperature)) {
    return taken(strain_energy_functional(task.fields.mesh, materials(task),
                                          load_case, u, task.derivatives));
  }
  const double share = strain ? 0.5 : 1.0;
  ResponsePartials result = taken(compliance_functional(
      task.fields.mesh, materials(task), load_case, u, task.derivatives));
  result.value *= share;
  for (Vec3& by_node : result.by_nodes) {
    by_node *= share;
  }
  if (task.derivatives == Derivatives::All) {
    result.self_adjoint = share;
    result.by_forces = share * u;
  }
  return result;
}

ResponsePartials mass(const ResponseTask& task) {
  return taken(
      mass_functional(task.fields.mesh, materials(task), task.derivatives));
}

ResponsePartials volume(const ResponseTask& task) {
  return taken(volume_functional(task.fields.mesh, task.derivatives));
}

/// Along a direction the centre of mass is a coordinate: of a unit vector.
ResponsePartials centre_of_mass(const ResponseTask& task) {
  const double length = task.numbers.direction.norm();
  const Vec3 unit = task.numbers.direction / length;
  ResponsePartials result = taken(centre_of_mass_functional(
      task.fields.mesh, materials(task), unit, task.derivatives));
  if (task.derivatives == Derivatives::All) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 across = (Vec3::Unit(k) - unit[k] * unit) / length;
      if (!across.isZero(0.0)) {
        result.by_direction[k] =
            centre_of_mass_functional(task.fields.mesh, materials(task), across,
                                      Derivatives::None)
                .value;
      }
    }
  }
  return result;
}

ResponsePartials peak(const ResponseTask& task) {
  if (task.derivatives == Derivatives::All) {
    throw InvalidInput(fmt::format(
        "response '{}' is a max_von_mises, which has no derivative: use "
        "von_mises_norm or von_mises_ks",
        task.response.name));
  }
  ResponsePartials result;
  result.value = load_case_stress(task.fields.mesh, task.fields.numbers,
                                  task.response.load_case, displacement(task),
                                  task.fields.excluded)
                     .max_von_mises;
  return result;
}

StressFunctionalInput stress_input(const ResponseTask& task) {
  return {task.fields.mesh,
          materials(task),
          task.fields.numbers.load_cases[task.response.load_case],
          displacement(task),
          task.fields.excluded,
          task.derivatives};
}

ResponsePartials von_mises_norm(const ResponseTask& task) {
  return taken(
      von_mises_norm_functional(stress_input(task), task.response.power));
}

double least_yield(const std::vector<Material>& materials) {
  double least = std::numeric_limits<double>::infinity();
  for (const Material& material : materials) {
    least = std::min(least, material.yield_strength.value_or(least));
  }
  return least;
}

ResponsePartials von_mises_ks(const ResponseTask& task) {
  const double yield = least_yield(materials(task));
  return taken(von_mises_ks_functional(
      stress_input(task), {.sharpness = task.response.sharpness,
                           .scale = task.response.scale.value_or(yield)}));
}

ResponsePartials uniformity(const ResponseTask& task) {
  return taken(von_mises_variation_functional(stress_input(task)));
}

ResponsePartials energy_uniformity(const ResponseTask& task) {
  return taken(energy_density_variation_functional(stress_input(task)));
}

ResponsePartials film_area(const ResponseTask& task) {
  const FilmModel& film = *task.fields.film;
  const VectorX areas = film.areas(task.fields.film_state->points);
  const std::vector<std::string>& labels = film.labels();
  ResponsePartials result;
  result.film.areas = VectorX::Ones(areas.size());
  if (!task.response.film.empty()) {
    result.film.areas = VectorX::Unit(
        areas.size(),
        std::find(labels.begin(), labels.end(), task.response.film) -
            labels.begin());
  }
  result.value = areas.dot(result.film.areas);
  return result;
}

ResponsePartials film_energy(const ResponseTask& task) {
  ResponsePartials result;
  result.value = task.fields.film_state->report.energy;
  result.film.energy = 1.0;
  return result;
}

ResponsePartials body_pressure(const ResponseTask& task) {
  const std::vector<BodyState>& bodies = task.fields.film_state->report.bodies;
  ResponsePartials result;
  result.value = bodies[task.response.body].pressure;
  result.film.pressures = VectorX::Unit(
      static_cast<Eigen::Index>(bodies.size()), task.response.body);
  return result;
}

ResponsePartials collapse_margin(const ResponseTask& task) {
  return taken(task.fields.film->margin(*task.fields.film_state,
                                        task.fields.numbers.film_system));
}

ResponsePartials radius(const ResponseTask& task) {
  return taken(task.fields.film->smallest_radius(
      task.fields.film_state->points, static_cast<int>(task.response.power)));
}

ResponsePartials thickness(const ResponseTask& task) {
  return taken(thickness_functional(task.fields.mesh, *task.fields.pairs,
                                    sharpness_of(task.response, task.fields),
                                    task.derivatives));
}

ResponsePartials distance(const ResponseTask& task) {
  return taken(intrusion_functional(
      task.fields.mesh, {task.numbers.level, task.numbers.level_slope},
      sharpness_of(task.response, task.fields), task.derivatives));
}

ResponsePartials gap(const ResponseTask& task) {
  // Films run beside each other over wide areas, and many vertices count.
  constexpr double kGapPartOfEdge = 0.02;
  const double usual = kGapPartOfEdge * task.fields.numbers.fea_edge;
  return taken(task.fields.film->gap(
      task.fields.film_state->points, task.response.films[0],
      task.response.films[1], task.response.smoothing.value_or(usual)));
}

ResponsePartials scan_distance(const ResponseTask& task) {
  const Points& points = task.fields.film_state->points;
  return taken(measure(scan_distances(task.response, *task.fields.scans,
                                      *task.fields.film, points),
                       task.response.measure, points.size()));
}

}  // namespace

const std::vector<ResponseRow>& response_kinds() {
  using D = Dimension;
  using E = ErrorSource;
  using Kind = ResponseKind;
  constexpr bool kOfFilms = true;
  static const std::vector<ResponseRow> rows = {
      {"mean_displacement",
       Kind::MeanDisplacement,
       D::Length,
       "area-weighted over a surface along a direction",
       {{"on", "direction"}, {"load_case", "weight"}},
       mean_displacement,
       E::ByDual},
      {"displacement_norm",
       Kind::DisplacementNorm,
       D::Length,
       "its p-norm, nearly the largest for a large power",
       {{"on", "direction"}, {"load_case", "power"}},
       displacement_norm,
       E::ByDual},
      {"rotation",
       Kind::Rotation,
       D::None,
       "of a surface about an axis, in radians",
       {{"on", "axis"}, {"load_case"}},
       rotation,
       E::ByDual},
      {"compliance",
       Kind::Compliance,
       D::Energy,
       "work of the loads, twice strain_energy where only forces act",
       {{}, {"load_case"}},
       energy,
       E::ByDual},
      {"strain_energy",
       Kind::StrainEnergy,
       D::Energy,
       kSaidElsewhere,
       {{}, {"load_case"}},
       energy,
       E::ByDual},
      {"mass", Kind::Mass, D::Mass, kSaidElsewhere, {}, mass},
      {"volume", Kind::Volume, D::Volume, kSaidElsewhere, {}, volume},
      {"centre_of_mass",
       Kind::CentreOfMass,
       D::Length,
       "its place along a direction",
       {{"direction"}, {}},
       centre_of_mass},
      {"max_von_mises",
       Kind::MaxVonMises,
       D::Pressure,
       "of nodal stresses, without derivatives",
       {{}, {"load_case"}},
       peak,
       E::Unknown,
       !kOfFilms,
       false},
      {"von_mises_norm",
       Kind::VonMisesNorm,
       D::Pressure,
       kWithNext,
       {{}, {"load_case", "power"}},
       von_mises_norm,
       E::ByDual},
      {"von_mises_ks",
       Kind::VonMisesKs,
       D::Pressure,
       "smooth ones by volume (p-norm, Kreisselmeier-Steinhauser)",
       {{}, {"load_case", "sharpness", "scale"}},
       von_mises_ks,
       E::Unknown},
      {"uniformity",
       Kind::Uniformity,
       D::None,
       kWithNext,
       {{}, {"load_case"}},
       uniformity,
       E::ByDual},
      {"energy_uniformity",
       Kind::EnergyUniformity,
       D::None,
       "coefficients of variation of von Mises stress and of strain energy "
       "density by volume",
       {{}, {"load_case"}},
       energy_uniformity,
       E::ByDual},
      {"film_area",
       Kind::FilmArea,
       D::Area,
       kWithNext,
       {{}, {"film"}},
       film_area,
       E::Exact,
       kOfFilms},
      {"film_energy",
       Kind::FilmEnergy,
       D::Energy,
       "of the films",
       {},
       film_energy,
       E::Exact,
       kOfFilms},
      {"pressure",
       Kind::Pressure,
       D::Pressure,
       "of a body",
       {{"body"}, {}},
       body_pressure,
       E::Exact,
       kOfFilms},
      {"collapse_margin",
       Kind::CollapseMargin,
       D::None,
       "a smooth lower bound of the film's smallest eigenvalue, force per "
       "length cubed",
       {},
       collapse_margin,
       E::Exact,
       kOfFilms},
      {"radius",
       Kind::Radius,
       D::Length,
       "the films' smallest one, smooth",
       {{}, {"power"}},
       radius,
       E::Exact,
       kOfFilms},
      {"thickness",
       Kind::Thickness,
       D::Length,
       "the solid's smallest one, smooth",
       {{}, {"smoothing"}},
       thickness},
      {"distance",
       Kind::Distance,
       D::Length,
       "how far the solid reaches into a region to keep out of, or out of one "
       "to keep in, below 0 where it keeps clear, smooth",
       {{}, {"keep_out", "keep_in", "smoothing"}},
       distance},
      {"gap",
       Kind::Gap,
       D::Length,
       "the least distance of two films, smooth; films that cross have none: a "
       "design that fails",
       {{"films"}, {"smoothing"}},
       gap,
       E::Exact,
       kOfFilms},
      {"scan_distance",
       Kind::ScanDistance,
       D::Length,
       "of films to a scan, over their vertices",
       {{"scan"}, {"films", "measure"}},
       scan_distance,
       E::Exact,
       kOfFilms},
      {"expression",
       Kind::Expression,
       D::None,
       "of the responses above it",
       {{"value"}, {}},
       nullptr},
  };
  return rows;
}

const ResponseRow& row_of(ResponseKind kind) {
  return *std::find_if(
      response_kinds().begin(), response_kinds().end(),
      [&](const ResponseRow& row) { return row.kind == kind; });
}

bool needs_key(const ResponseRow& row, const char* key) {
  return std::find(row.keys.needed.begin(), row.keys.needed.end(), key) !=
         row.keys.needed.end();
}

double sharpness_of(const ResponseEntry& response,
                    const ResponseInput& fields) {
  constexpr double kPartOfEdge = 0.1;
  return 1.0 /
         response.smoothing.value_or(kPartOfEdge * fields.numbers.fea_edge);
}

}  // namespace meniscus
