#include "pipeline/responses/response_partials.h"

#include <algorithm>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "fea/functionals/displacement_functionals.h"
#include "fea/functionals/energy_functionals.h"
#include "fea/functionals/facing_area.h"
#include "fea/functionals/groove.h"
#include "fea/functionals/inertia.h"
#include "fea/functionals/place_functionals.h"
#include "fea/functionals/stress_functionals.h"
#include "fea/functionals/volume_functionals.h"
#include "fea/loads/body_loads.h"
#include "fea/modes/eigenvalue_functionals.h"
#include "fea/stress/peak_stress.h"
#include "pipeline/shells/joint_part.h"

namespace meniscus::responses {

namespace {

/// `load_case`: the one that a displacement is of.
ResponsePartials to_partials(element::Functional functional,
                             int load_case = 0) {
  ResponsePartials result;
  result.value = functional.value;
  result.by_nodes = std::move(functional.by_nodes);
  if (functional.by_displacement.size() > 0) {
    result.cases.push_back(
        {.load_case = load_case,
         .by_displacement = std::move(functional.by_displacement),
         .by_forces = {},
         .by_temperature = std::move(functional.by_temperature)});
  }
  result.by_modulus = std::move(functional.by_modulus);
  return result;
}

ResponsePartials to_partials(element::DirectedFunctional functional,
                             int load_case = 0) {
  const Vec3 by_direction = functional.by_direction;
  ResponsePartials result =
      to_partials(static_cast<element::Functional&&>(functional), load_case);
  result.by_direction = by_direction;
  return result;
}

ResponsePartials to_partials(functionals::MassFunctional functional) {
  std::vector<double> by_density = std::move(functional.by_density);
  ResponsePartials result =
      to_partials(static_cast<element::Functional&&>(functional));
  result.by_density = std::move(by_density);
  return result;
}

ResponsePartials to_partials(modes::ModeFunctional functional, int load_case) {
  std::vector<double> by_density = std::move(functional.by_density);
  Points by_pin_point = std::move(functional.by_pin_point);
  ResponsePartials result =
      to_partials(static_cast<element::Functional&&>(functional), load_case);
  result.by_density = std::move(by_density);
  result.by_pin_point = std::move(by_pin_point);
  return result;
}

ResponsePartials to_partials(frozen::FilmResponse film) {
  ResponsePartials result;
  result.value = film.value;
  result.film = std::move(film.by);
  return result;
}

/// Of its load case, 3 per node.
const VectorX& displacement(const ResponseTask& task) {
  return task.fields.solution.displacements[task.response.load_case];
}

const std::vector<element::Material>& materials(const ResponseTask& task) {
  return task.fields.inputs.materials;
}

/// Of a shell, both sides of a film are its facets.
std::string surface_of(const ResponseTask& task) {
  const std::string& surface = task.response.surface;
  return task.fields.shell != nullptr &&
                 shells::is_of_shells(*task.fields.shell, surface)
             ? shells::film_of(surface)
             : surface;
}

ResponsePartials mean_displacement(const ResponseTask& task) {
  if (!task.response.weight) {
    return to_partials(
        functionals::mean_displacement_functional(
            task.fields.mesh, surface_of(task), task.inputs.direction,
            displacement(task), task.derivatives),
        task.response.load_case);
  }
  return to_partials(
      functionals::weighted_displacement_functional(
          task.fields.mesh, surface_of(task), task.inputs.direction,
          {task.inputs.weight, task.inputs.weight_slope}, displacement(task),
          task.derivatives),
      task.response.load_case);
}

ResponsePartials displacement_norm(const ResponseTask& task) {
  return to_partials(
      functionals::displacement_norm_functional(
          task.fields.mesh, surface_of(task), task.inputs.direction,
          task.response.power, displacement(task), task.derivatives),
      task.response.load_case);
}

ResponsePartials rotation(const ResponseTask& task) {
  return to_partials(
      functionals::rotation_functional(task.fields.mesh, surface_of(task),
                                       task.inputs.direction,
                                       displacement(task), task.derivatives),
      task.response.load_case);
}

ResponsePartials energy(const ResponseTask& task) {
  return energy_of(task, task.fields.inputs.load_cases[task.response.load_case],
                   displacement(task));
}

}  // namespace

/// Half the work of the loads is the strain energy where it all goes into the
/// solid and nothing else does work. Enforced displacements make the solution
/// another than the loads' own: it is not its adjoint then.
ResponsePartials energy_of(const ResponseTask& task,
                           const loads::LoadCase& load_case, const VectorX& u) {
  const bool strain =
      task.response.kind == case_data::ResponseKind::StrainEnergy;
  const bool enforced = loads::enforces(load_case);
  if (strain &&
      (!load_case.springs.empty() || load_case.temperature || enforced)) {
    return to_partials(
        functionals::strain_energy_functional(task.fields.mesh, materials(task),
                                              load_case, u, task.derivatives),
        task.response.load_case);
  }
  const double share = strain ? 0.5 : 1.0;
  ResponsePartials result = to_partials(
      functionals::compliance_functional(task.fields.mesh, materials(task),
                                         load_case, u, task.derivatives),
      task.response.load_case);
  result.value *= share;
  for (Vec3& by_node : result.by_nodes) {
    by_node *= share;
  }
  if (task.derivatives == element::Derivatives::All) {
    result.cases.front().by_displacement *= share;
    result.cases.front().self_adjoint = enforced ? 0.0 : share;
    result.cases.front().by_forces = share * u;
  }
  return result;
}

namespace {

/// A sum over modes that were found with the design.
ResponsePartials modal(const ResponseTask& task) {
  const ModalSum& sum = modal_sum(*task.fields.modes, task.response.name);
  ResponsePartials result;
  if (task.derivatives == element::Derivatives::All) {
    const FoundModes& found = task.fields.modes->problems[sum.problem];
    const modes::WeightedModes modes{found.values, found.shapes, sum.weights};
    const loads::LoadCase held = held_as(task.fields.inputs, found.load_case);
    result =
        found.kind == case_data::ResponseKind::BucklingFactor
            ? to_partials(
                  modes::factor_functional(task.fields.mesh, materials(task),
                                           held, displacement(task), modes),
                  found.load_case)
            : to_partials(modes::frequency_functional(
                              task.fields.mesh, materials(task), held, modes),
                          found.load_case);
  }
  result.value = sum.value;
  return result;
}

ResponsePartials mass(const ResponseTask& task) {
  return to_partials(functionals::mass_functional(
      task.fields.mesh, materials(task), task.derivatives));
}

ResponsePartials volume(const ResponseTask& task) {
  return to_partials(
      functionals::volume_functional(task.fields.mesh, task.derivatives));
}

/// Along a direction the centre of mass is a coordinate: of a unit vector.
ResponsePartials centre_of_mass(const ResponseTask& task) {
  const double length = task.inputs.direction.norm();
  const Vec3 unit = task.inputs.direction / length;
  ResponsePartials result = to_partials(functionals::centre_of_mass_functional(
      task.fields.mesh, materials(task), unit, task.derivatives));
  if (task.derivatives == element::Derivatives::All) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 across = (Vec3::Unit(k) - unit[k] * unit) / length;
      if (!across.isZero(0.0)) {
        result.by_direction[k] = functionals::centre_of_mass_functional(
                                     task.fields.mesh, materials(task), across,
                                     element::Derivatives::None)
                                     .value;
      }
    }
  }
  return result;
}

ResponsePartials inertia(const ResponseTask& task) {
  std::optional<Vec3> through;
  if (task.response.point) {
    through = task.inputs.point;
  }
  functionals::InertiaFunctional inertia = functionals::inertia_functional(
      task.fields.mesh, materials(task), task.inputs.direction, through,
      task.derivatives);
  const Vec3 by_axis = inertia.by_axis;
  const Vec3 by_point = inertia.by_point;
  ResponsePartials result =
      to_partials(static_cast<functionals::MassFunctional&&>(inertia));
  result.by_direction = by_axis;
  result.by_point = by_point;
  return result;
}

ResponsePartials peak(const ResponseTask& task) {
  if (task.derivatives == element::Derivatives::All) {
    throw InvalidInput(fmt::format(
        "response '{}' is a max_von_mises, which has no derivative: use "
        "von_mises_norm or von_mises_ks",
        task.response.name));
  }
  ResponsePartials result;
  const TetMesh& mesh = task.fields.mesh;
  const element::PointStress points = element::point_stress(
      mesh, materials(task), displacement(task),
      loads::temperature_change(
          mesh,
          task.fields.inputs
              .load_cases[static_cast<std::size_t>(task.response.load_case)]));
  result.value = stress::peak_of(mesh, stress::recover_by_patches(mesh, points),
                                 task.fields.excluded)
                     .von_mises;
  return result;
}

functionals::StressFunctionalInput stress_input(const ResponseTask& task) {
  return {task.fields.mesh,
          materials(task),
          task.fields.inputs.load_cases[task.response.load_case],
          displacement(task),
          task.fields.excluded.element,
          task.derivatives};
}

ResponsePartials von_mises_norm(const ResponseTask& task) {
  return to_partials(functionals::von_mises_norm_functional(
                         stress_input(task), task.response.power),
                     task.response.load_case);
}

ResponsePartials von_mises_ks(const ResponseTask& task) {
  return to_partials(functionals::von_mises_ks_functional(
                         stress_input(task),
                         {.sharpness = task.response.sharpness,
                          .scale = ks_scale(task.response, materials(task))}),
                     task.response.load_case);
}

ResponsePartials uniformity(const ResponseTask& task) {
  return to_partials(
      functionals::von_mises_variation_functional(stress_input(task)),
      task.response.load_case);
}

ResponsePartials energy_uniformity(const ResponseTask& task) {
  return to_partials(
      functionals::energy_density_variation_functional(stress_input(task)),
      task.response.load_case);
}

ResponsePartials overhang(const ResponseTask& task) {
  return to_partials(functionals::overhang_functional(
      task.fields.mesh, task.inputs.direction,
      {task.response.angle, task.response.width}, task.response.base,
      task.derivatives));
}

ResponsePartials draft(const ResponseTask& task) {
  return to_partials(
      functionals::draft_functional(task.fields.mesh, task.inputs.direction,
                                    {task.response.angle, task.response.width},
                                    task.response.surface, task.derivatives));
}

ResponsePartials film_area(const ResponseTask& task) {
  const frozen::FilmModel& film = *task.fields.film;
  const VectorX areas = film.areas(task.fields.film_state->points);
  const std::vector<std::string>& labels = film.labels();
  ResponsePartials result;
  result.film.areas = VectorX::Zero(areas.size());
  const auto add = [&](const std::string& name) {
    result.film
        .areas[std::find(labels.begin(), labels.end(), name) - labels.begin()] =
        1.0;
  };
  for (const films::FilmSpec& one : task.fields.inputs.film_system.films) {
    if (task.response.film.empty() || task.response.film == one.name) {
      add(one.name);
    }
  }
  for (const settle::PulledFilm& one : task.fields.film_state->report.popped) {
    if (task.response.film.empty()) {
      add(one.name);
    }
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
  const std::vector<settle::BodyState>& bodies =
      task.fields.film_state->report.bodies;
  ResponsePartials result;
  result.value = bodies[task.response.body].pressure;
  result.film.pressures = VectorX::Unit(
      static_cast<Eigen::Index>(bodies.size()), task.response.body);
  return result;
}

ResponsePartials collapse_margin(const ResponseTask& task) {
  return to_partials(task.fields.film->margin(*task.fields.film_state,
                                              task.fields.inputs.film_system));
}

ResponsePartials radius(const ResponseTask& task) {
  return to_partials(task.fields.film->smallest_radius(
      task.fields.film_state->points, static_cast<int>(task.response.power)));
}

ResponsePartials thickness(const ResponseTask& task) {
  const functionals::ThicknessPairs& pairs = *task.fields.pairs;
  const double sharpness = task.response.smoothing
                               ? 1.0 / *task.response.smoothing
                               : functionals::usual_sharpness(pairs);
  return to_partials(functionals::thickness_functional(
      task.fields.mesh, pairs, sharpness, task.derivatives));
}

ResponsePartials groove(const ResponseTask& task) {
  return to_partials(functionals::groove_functional(
      task.fields.mesh, 1.0 / kGrooveSmoothing, task.derivatives));
}

ResponsePartials distance(const ResponseTask& task) {
  return to_partials(functionals::intrusion_functional(
      task.fields.mesh, {task.inputs.level, task.inputs.level_slope},
      sharpness_of(task.response, task.fields), task.derivatives));
}

ResponsePartials gap(const ResponseTask& task) {
  const double usual = kGapSmoothing * task.fields.inputs.fea_edge;
  return to_partials(task.fields.film->gap(
      task.fields.film_state->points, task.response.films[0],
      task.response.films[1], task.response.smoothing.value_or(usual)));
}

ResponsePartials scan_distance(const ResponseTask& task) {
  const Points& points = task.fields.film_state->points;
  return to_partials(
      scan::measure(scan_distances(task.response, *task.fields.scans,
                                   *task.fields.film, points),
                    task.response.measure, points.size()));
}

/// As solids have it, and shells what has to do with faces and films alone.
ResponsePartials of_solids(const ResponseTask& task) {
  using Kind = case_data::ResponseKind;
  switch (task.response.kind) {
    case Kind::MeanDisplacement:
      return mean_displacement(task);
    case Kind::DisplacementNorm:
      return displacement_norm(task);
    case Kind::Rotation:
      return rotation(task);
    case Kind::Compliance:
    case Kind::StrainEnergy:
      return energy(task);
    case Kind::BucklingFactor:
    case Kind::Frequency:
      return modal(task);
    case Kind::Mass:
      return mass(task);
    case Kind::Volume:
      return volume(task);
    case Kind::CentreOfMass:
      return centre_of_mass(task);
    case Kind::Inertia:
      return inertia(task);
    case Kind::MaxVonMises:
      return peak(task);
    case Kind::VonMisesNorm:
      return von_mises_norm(task);
    case Kind::VonMisesKs:
      return von_mises_ks(task);
    case Kind::Uniformity:
      return uniformity(task);
    case Kind::EnergyUniformity:
      return energy_uniformity(task);
    case Kind::FilmArea:
      return film_area(task);
    case Kind::FilmEnergy:
      return film_energy(task);
    case Kind::Pressure:
      return body_pressure(task);
    case Kind::CollapseMargin:
      return collapse_margin(task);
    case Kind::Radius:
      return radius(task);
    case Kind::Thickness:
      return thickness(task);
    case Kind::Groove:
      return groove(task);
    case Kind::Distance:
      return distance(task);
    case Kind::Gap:
      return gap(task);
    case Kind::ScanDistance:
      return scan_distance(task);
    case Kind::Overhang:
      return overhang(task);
    case Kind::Draft:
      return draft(task);
    case Kind::StressRatio:
      return stress_ratio(task);
    case Kind::Fatigue:
      return fatigue(task);
    case Kind::Envelope:
    case Kind::Expression:
      break;  // of the responses above it
  }
  return {};
}

/// Adds a response of the mesh alone.
void add_of_mesh(const ResponsePartials& more, ResponsePartials& sum) {
  sum.value += more.value;
  for (std::size_t i = 0; i < more.by_nodes.size(); ++i) {  // none: not asked
    sum.by_nodes[i] += more.by_nodes[i];
  }
}

/// Of the part that the case draws.
ResponsePartials of_drawn_part(const ResponseTask& task) {
  using Kind = case_data::ResponseKind;
  if (task.response.worst_in) {
    return worst_partials(task);
  }
  const shells::ShellPart* shell = task.fields.shell;
  std::optional<ResponsePartials> own =
      shell != nullptr ? shell_partials(task) : std::nullopt;
  if (!own) {
    return of_solids(task);
  }
  if (shell->solid && (task.response.kind == Kind::Mass ||
                       task.response.kind == Kind::Volume)) {
    add_of_mesh(of_solids(task), *own);
  }
  return *std::move(own);
}

template <class Items>
void multiply_all(Items& items, double factor) {
  for (auto& item : items) {
    item *= factor;
  }
}

/// `factor` times the response.
void multiply(ResponsePartials& partials, double factor) {
  partials.value *= factor;
  multiply_all(partials.by_nodes, factor);
  multiply_all(partials.by_thickness, factor);
  for (CasePartials& of_case : partials.cases) {
    of_case.by_displacement *= factor;
    of_case.self_adjoint *= factor;
    of_case.by_forces *= factor;
    of_case.by_temperature *= factor;
    of_case.by_actions.multiply(factor);
  }
  partials.by_direction *= factor;
  partials.by_point *= factor;
  multiply_all(partials.by_pin_point, factor);
  multiply_all(partials.by_density, factor);
  multiply_all(partials.by_modulus, factor);
  multiply_all(partials.by_angle, factor);
  frozen::FilmCovector& film = partials.film;
  multiply_all(film.points, factor);
  film.pressures *= factor;
  film.volumes *= factor;
  film.areas *= factor;
  film.energy *= factor;
  multiply_all(film.directions, factor);
  multiply_all(film.bends, factor);
  film.tensions *= factor;
  multiply_all(film.numbers, factor);
}

}  // namespace

ResponsePartials compute_partials(const ResponseTask& task) {
  ResponsePartials result = of_drawn_part(task);
  if (task.response.images > 1) {
    multiply(result, task.response.images);
  }
  return result;
}

double ks_scale(const case_data::ResponseEntry& response,
                const std::vector<element::Material>& materials) {
  double yield = std::numeric_limits<double>::infinity();
  for (const element::Material& material : materials) {
    yield = std::min(yield, material.yield_strength.value_or(yield));
  }
  return response.scale.value_or(yield);
}

double sharpness_of(const case_data::ResponseEntry& response,
                    const ResponseContext& fields) {
  constexpr double kPartOfEdge = 0.1;
  return 1.0 /
         response.smoothing.value_or(kPartOfEdge * fields.inputs.fea_edge);
}

}  // namespace meniscus::responses
