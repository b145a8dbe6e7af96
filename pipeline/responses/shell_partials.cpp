#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "fea/shell/rigid_rims.h"
#include "fea/shell/shell_moments.h"
#include "fea/shell_modes/shell_mode_works.h"
#include "fea/shell_peaks/shell_norm.h"
#include "fea/stress/peak_stress.h"
#include "pipeline/responses/response_partials.h"
#include "pipeline/shells/joint_part.h"

namespace meniscus::responses {

namespace {

void add_layers(const shells::ShellPart& part,
                const shell::PlyGradients& by_ply, ResponsePartials& result) {
  shells::LayerGradient by = shells::layer_gradient(part, by_ply);
  result.by_modulus = std::move(by.modulus);
  result.by_density = std::move(by.density);
  result.by_angle = std::move(by.angle);
}

/// u . K u / 2, which what is held at other than 0 has a part in.
ResponsePartials enforced_energy(const ResponseTask& task,
                                 const VectorX& inner) {
  const shells::ShellPart& part = *task.fields.shell;
  const VectorX& u =
      part.cases[static_cast<std::size_t>(task.response.load_case)]
          .displacement;
  ResponsePartials result;
  if (task.derivatives == element::Derivatives::All) {
    result = shell_to_partials(
        part,
        shell::residual_gradient(part.mesh, part.sections, {}, -0.5 * u, u));
    result.cases.push_back({.load_case = task.response.load_case,
                            .by_displacement = inner,
                            .by_forces = {},
                            .by_temperature = {}});
  }
  result.value = 0.5 * u.dot(inner);
  return result;
}

/// Work of the loads, or half of it where nothing else does any.
ResponsePartials shell_energy(const ResponseTask& task) {
  const auto load_case = static_cast<std::size_t>(task.response.load_case);
  const shells::ShellPart& part = *task.fields.shell;
  const shells::ShellCase& own = part.cases[load_case];
  const VectorX& u = part.solid ? own.both : own.displacement;
  const VectorX forces =
      part.solid
          ? own.forces
          : shell::nodal_forces(part.mesh, part.sections, own.actions.loads);
  const bool strain =
      task.response.kind == case_data::ResponseKind::StrainEnergy;
  const bool enforced =
      loads::enforces(task.fields.inputs.load_cases[load_case]);
  if (strain && enforced) {
    return enforced_energy(task, forces + own.reaction);
  }
  const double share = strain ? 0.5 : 1.0;
  ResponsePartials result;
  if (task.derivatives == element::Derivatives::All) {
    result = shell_to_partials(
        part, part.solid ? shells::joint_force_gradient(
                               part, task.fields.inputs, load_case, share * u)
                         : shells::work_gradient(part, load_case, share * u,
                                                 VectorX::Zero(u.size())));
    result.cases.push_back({.load_case = task.response.load_case,
                            .by_displacement = share * forces,
                            .self_adjoint = enforced ? 0.0 : share,
                            .by_forces = share * u,
                            .by_temperature = {}});
  }
  result.value = share * u.dot(forces);
  return result;
}

/// The mass of the part, or its volume: that of a density of 1.
ResponsePartials shell_mass(const ResponseTask& task, bool is_volume) {
  const shells::ShellPart& part = *task.fields.shell;
  const std::vector<shell::Section> sections =
      is_volume ? shells::with_density(part.sections, 1.0) : part.sections;
  ResponsePartials result;
  if (task.derivatives == element::Derivatives::All) {
    shell::ShellGradient gradient = shell::mass_integral(
        part.mesh, sections, {.constant = 1.0}, Vec3::Zero());
    if (is_volume) {
      gradient.by_ply.clear();
    }
    result = shell_to_partials(part, std::move(gradient));
  }
  result.value = shell::mass_moments(part.mesh, sections, Vec3::Zero()).mass;
  return result;
}

/// Along the direction, made unit: the first moment over the mass.
ResponsePartials shell_centre(const ResponseTask& task) {
  const shells::ShellPart& part = *task.fields.shell;
  const double length = task.inputs.direction.norm();
  const Vec3 unit = task.inputs.direction / length;
  const shell::MassMoments moments =
      shell::mass_moments(part.mesh, part.sections, Vec3::Zero());
  if (!(moments.mass > 0.0)) {
    throw InvalidInput(fmt::format(
        "response '{}': the shell has no mass, and so no centre of it; give "
        "its material a density",
        task.response.name));
  }
  const Vec3 centre = moments.first / moments.mass;
  ResponsePartials result;
  if (task.derivatives == element::Derivatives::All) {
    result = shell_to_partials(
        part, shell::mass_integral(part.mesh, part.sections,
                                   {.linear = unit / moments.mass}, centre));
    result.by_direction = (centre - unit.dot(centre) * unit) / length;
  }
  result.value = unit.dot(centre);
  return result;
}

/// As functionals::inertia_functional() has it.
ResponsePartials shell_inertia(const ResponseTask& task) {
  const shells::ShellPart& part = *task.fields.shell;
  const double length = task.inputs.direction.norm();
  const Vec3 unit = task.inputs.direction / length;
  const Mat3 across = Mat3::Identity() - unit * unit.transpose();
  Vec3 from = task.inputs.point;
  if (!task.response.point) {
    const shell::MassMoments whole =
        shell::mass_moments(part.mesh, part.sections, Vec3::Zero());
    from = whole.first / whole.mass;
  }
  const shell::MassMoments moments =
      shell::mass_moments(part.mesh, part.sections, from);
  ResponsePartials result;
  if (task.derivatives == element::Derivatives::All) {
    // About the centre of mass its own motion does not count.
    result =
        shell_to_partials(part, shell::mass_integral(part.mesh, part.sections,
                                                     {.square = across}, from));
    result.by_direction = -2.0 / length * across * moments.second * unit;
    if (task.response.point) {
      result.by_point = -2.0 * across * moments.first;
    }
  }
  result.value = across.cwiseProduct(moments.second).sum();
  return result;
}

ResponsePartials mean_on_rim(const ResponseTask& task) {
  const shells::ShellPart& part = *task.fields.shell;
  const auto load_case = static_cast<std::size_t>(task.response.load_case);
  shell::LineMean mean = shell::mean_displacement(
      part.mesh, shells::rim_of(part, task.response.surface),
      task.inputs.direction, part.cases[load_case].displacement);
  ResponsePartials result;
  result = shell_to_partials(part, {.value = mean.value,
                                    .by_nodes = std::move(mean.by_nodes),
                                    .by_thickness = {}});
  result.by_direction = mean.by_direction;
  result.cases.push_back({.load_case = task.response.load_case,
                          .by_displacement = std::move(mean.by_displacement),
                          .by_forces = {},
                          .by_temperature = {}});
  return result;
}

ResponsePartials shell_peak_stress(const ResponseTask& task) {
  if (task.derivatives == element::Derivatives::All) {
    throw InvalidInput(fmt::format(
        "response '{}' is a max_von_mises, which has no derivative: use "
        "von_mises_norm",
        task.response.name));
  }
  const shells::ShellPart& part = *task.fields.shell;
  const auto load_case = static_cast<std::size_t>(task.response.load_case);
  ResponsePartials result;
  result.value = shells::shell_peak(part, load_case).von_mises;
  if (part.solid) {
    result.value = std::max(
        result.value, stress::peak_of(part.solid->mesh,
                                      shells::solid_stress(part, load_case), {})
                          .von_mises);
  }
  return result;
}

ResponsePartials shell_stress_mean(const ResponseTask& task) {
  const shells::ShellPart& part = *task.fields.shell;
  const case_data::ResponseEntry& response = task.response;
  const shells::ShellCase& own =
      part.cases[static_cast<std::size_t>(response.load_case)];
  const auto derivatives = task.derivatives == element::Derivatives::All
                               ? shell::NormDerivatives::All
                               : shell::NormDerivatives::None;
  shell::StressNorm norm =
      response.kind == case_data::ResponseKind::VonMisesNorm
          ? shell::von_mises_norm(part.mesh, part.sections, own.actions.loads,
                                  own.displacement, response.power, derivatives)
          : shell::von_mises_ks(
                part.mesh, part.sections, own.actions.loads, own.displacement,
                {.sharpness = response.sharpness,
                 .scale = ks_scale(response, task.fields.inputs.materials)},
                derivatives);
  ResponsePartials result;
  result.value = norm.value;
  result.by_nodes = std::move(norm.by_nodes);
  result.by_thickness = std::move(norm.by_thickness);
  add_layers(part, norm.by_ply, result);
  result.cases.push_back({.load_case = response.load_case,
                          .by_displacement = std::move(norm.by_displacement),
                          .by_forces = {},
                          .by_temperature = {},
                          .by_actions = std::move(norm.by_actions)});
  return result;
}

/// What a mode's springs and rigid rims do as nodes and points move.
void add_held_work(const shells::ShellPart& part, const FoundModes& found,
                   std::size_t mode, const VectorX& x, shell::ModeWork& work) {
  const auto load_case = static_cast<std::size_t>(found.load_case);
  shells::add_spring_gradient(part, load_case, x, x, work.by_nodes);
  const shells::ShellCase& own = part.cases[load_case];
  const std::vector<shell::RigidRim>& rims = own.system->freedom().rims();
  if (rims.empty()) {
    return;
  }
  const double value = found.values[mode];
  VectorX left = own.system->stiffness_times(x);
  if (found.kind == case_data::ResponseKind::BucklingFactor) {
    left += value *
            own.system->geometric_times(own.actions.loads, own.displacement, x);
  } else {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    left -= std::pow(kTurn * value, 2) * own.system->mass_times(x);
  }
  const shell::RimPair pair{x, left, x, left};
  shell::add_rim_gradient(rims, pair, work.by_nodes);
  for (const shell::RigidRim& rim : rims) {
    work.by_points.push_back(shell::by_rim_point(rim, pair));
  }
}

ResponsePartials mode_partials(const shells::ShellPart& part,
                               shell::ModeWork work) {
  Points by_points = std::move(work.by_points);
  ResponsePartials result = shell_to_partials(part, std::move(work));
  result.by_pin_point = std::move(by_points);
  return result;
}

/// A sum over modes that were found with the design.
ResponsePartials shell_modal(const ResponseTask& task) {
  const ModalSum& sum = modal_sum(*task.fields.modes, task.response.name);
  const shells::ShellPart& part = *task.fields.shell;
  ResponsePartials result;
  if (task.derivatives == element::Derivatives::All) {
    const FoundModes& found = task.fields.modes->problems[sum.problem];
    const modes::WeightedModes modes{found.values, found.shapes, sum.weights};
    const auto held = [&](std::size_t mode, const VectorX& x,
                          shell::ModeWork& work) {
      if (found.load_case != case_data::AnalysisEntry::kFree) {
        add_held_work(part, found, mode, x, work);
      }
    };
    if (found.kind == case_data::ResponseKind::BucklingFactor) {
      const shells::ShellCase& own =
          part.cases[static_cast<std::size_t>(found.load_case)];
      shell::ModeWork work =
          shell::factor_functional(part.mesh, part.sections, own.actions.loads,
                                   own.displacement, modes, held);
      VectorX by_displacement = std::move(work.by_displacement);
      shell::ActionGradient by_actions = std::move(work.by_actions);
      result = mode_partials(part, std::move(work));
      result.cases.push_back({.load_case = found.load_case,
                              .by_displacement = std::move(by_displacement),
                              .by_forces = {},
                              .by_temperature = {},
                              .by_actions = std::move(by_actions)});
    } else {
      result = mode_partials(part, shell::frequency_functional(
                                       part.mesh, part.sections, modes, held));
    }
  }
  result.value = sum.value;
  return result;
}

}  // namespace

ResponsePartials shell_to_partials(const shells::ShellPart& part,
                                   shell::ShellGradient gradient) {
  ResponsePartials result;
  add_layers(part, gradient.by_ply, result);
  // Its nodes stand behind those of solids.
  if (part.solid && gradient.by_nodes.size() == part.mesh.nodes.size()) {
    gradient.by_nodes.insert(gradient.by_nodes.begin(),
                             part.solid->mesh.nodes.size(), Vec3::Zero());
  }
  result.value = gradient.value;
  result.by_nodes = std::move(gradient.by_nodes);
  result.by_thickness = std::move(gradient.by_thickness);
  return result;
}

std::optional<ResponsePartials> shell_partials(const ResponseTask& task) {
  using Kind = case_data::ResponseKind;
  const shells::ShellPart& part = *task.fields.shell;
  switch (task.response.kind) {
    case Kind::Compliance:
    case Kind::StrainEnergy:
      return shell_energy(task);
    case Kind::BucklingFactor:
    case Kind::Frequency:
      return shell_modal(task);
    case Kind::Mass:
    case Kind::Volume:
      return shell_mass(task, task.response.kind == Kind::Volume);
    case Kind::CentreOfMass:
      return shell_centre(task);
    case Kind::Inertia:
      return shell_inertia(task);
    case Kind::MaxVonMises:
      return shell_peak_stress(task);
    case Kind::VonMisesNorm:
    case Kind::VonMisesKs:
      return shell_stress_mean(task);
    case Kind::MeanDisplacement:
      if (part.rims.contains(task.response.surface)) {
        return mean_on_rim(task);
      }
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

}  // namespace meniscus::responses
