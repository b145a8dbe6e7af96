#include "pipeline/shells/joint_part.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/timer.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/loads/load_rates.h"
#include "fea/loads/loads.h"
#include "pipeline/shells/shell_holds.h"
#include "pipeline/shells/shell_model.h"

namespace meniscus::shells {

namespace {

Eigen::Index solid_size(const ShellPart& part) {
  return 3L * static_cast<Eigen::Index>(part.solid->mesh.nodes.size());
}

VectorX of_solid(const ShellPart& part, const VectorX& both) {
  return both.head(solid_size(part));
}

VectorX of_shell(const ShellPart& part, const VectorX& both) {
  return both.tail(both.size() - solid_size(part));
}

VectorX joined(const VectorX& first, const VectorX& second) {
  VectorX both(first.size() + second.size());
  both << first, second;
  return both;
}

/// `first` or the surface's is asked, as all of them are alike (shell_checks).
const std::string& surface_of(const loads::Surfaces& surfaces) {
  return surfaces.front();
}

loads::LoadCase picked(const ShellPart& part, const loads::LoadCase& load_case,
                       bool shells) {
  loads::LoadCase result = load_case;
  const auto keep = [&](auto& items, const auto& surface) {
    std::erase_if(items, [&](const auto& item) {
      return is_of_shells(part, surface(item)) != shells;
    });
  };
  const auto own = [](const auto& item) -> const std::string& {
    return item.surface;
  };
  const auto first = [](const auto& item) -> const std::string& {
    return surface_of(item.surfaces);
  };
  keep(result.supports, own);
  keep(result.forces, first);
  keep(result.pressures, own);
  keep(result.tractions, own);
  keep(result.remote_loads, first);
  keep(result.bearings, first);
  keep(result.springs, own);
  if (!shells) {
    result.rim_tensions.clear();
  }
  return result;
}

/// What holds tied nodes alone holds nothing: these follow the solid.
void refuse_held_joint(const ShellPart& part,
                       const loads::LoadCase& load_case) {
  for (const loads::Support& support : load_case.supports) {
    loads::LoadCase one;
    one.supports = {support};
    const std::vector<shell::NodeSupport> held = node_supports(part, one);
    const auto is_tied = [&](const shell::NodeSupport& node) {
      return std::any_of(
          part.solid->tie->nodes.begin(), part.solid->tie->nodes.end(),
          [&](const joint::TiedNode& tied) { return tied.node == node.node; });
    };
    if (std::all_of(held.begin(), held.end(), is_tied)) {
      throw InvalidInput(fmt::format(
          "load case '{}' holds '{}', which lies on a solid and follows it; "
          "hold a surface of the solid",
          load_case.name, support.surface));
    }
  }
}

std::shared_ptr<const joint::JointSystem> joint_of(
    const case_data::EvaluatedCase& inputs, std::size_t load_case,
    const ShellPart& part) {
  const loads::LoadCase& own = inputs.load_cases[load_case];
  for (std::size_t k = 0; k < load_case; ++k) {
    if (inputs.load_cases[k].supports == own.supports &&
        inputs.load_cases[k].springs == own.springs) {
      return part.cases[k].joint;
    }
  }
  const loads::LoadCase held = on_shells(part, own);
  refuse_held_joint(part, held);
  const SolidPart& solid = *part.solid;
  return std::make_shared<joint::JointSystem>(
      solid.mesh, solid.materials, on_solids(part, own), part.mesh,
      part.sections, node_supports(part, held), *solid.tie);
}

/// |reactions + loads| over the sum of |loads|, of both.
double joint_imbalance(const ShellPart& part, const VectorX& forces,
                       const VectorX& reactions, const VectorX& held) {
  Vec3 left = Vec3::Zero();
  double all = 0.0;
  const Eigen::Index first = solid_size(part);
  for (Eigen::Index i = 0; i < first; i += 3) {
    left += forces.segment<3>(i) + reactions.segment<3>(i);
    all += forces.segment<3>(i).norm();
  }
  for (Eigen::Index i = first; i < forces.size(); i += 6) {
    left += forces.segment<3>(i) + held.segment<3>(i - first);
    all += forces.segment<3>(i).norm();
  }
  return all > 0.0 ? left.norm() / all : 0.0;
}

void solve_both(const loads::LoadCase& load_case, ShellPart& part,
                ShellCase& own, equations::ElasticSolution& solution) {
  equations::ElasticReport& report = solution.report;
  const Timer timer;
  const SolidPart& solid = *part.solid;
  own.actions = shell_actions(part, on_shells(part, load_case));
  own.forces =
      joined(loads::nodal_forces(solid.mesh, on_solids(part, load_case),
                                 solid.materials),
             shell::nodal_forces(part.mesh, part.sections, own.actions.loads));
  own.both = own.joint->solve(own.forces);
  own.displacement = of_shell(part, own.both);
  const VectorX left = own.joint->residual(own.both, own.forces);
  report.residual =
      std::max(report.residual, own.joint->imbalance(left, own.forces));
  own.solid_reactions = own.joint->reactions(left);
  VectorX held = of_shell(part, left);  // of what is held, not tied
  for (const joint::TiedNode& tied : solid.tie->nodes) {
    held.segment<6>(6L * tied.node).setZero();
  }
  if (solution.displacements.empty()) {
    report.dofs = own.joint->unknowns();
    report.strain_energy = 0.5 * own.both.dot(own.forces);
    report.reaction_imbalance =
        joint_imbalance(part, own.forces, own.solid_reactions, held);
  }
  solution.displacements.push_back(joined(
      of_solid(part, own.both), shell::displacements_of(own.displacement)));
  solution.reactions.push_back(
      joined(own.solid_reactions, shell::displacements_of(held)));
  report.solve_seconds += timer.seconds();
}

/// Puts the solid's nodes before the shell's.
void put_before(Points solid, shell::ShellGradient& gradient) {
  solid.insert(solid.end(), gradient.by_nodes.begin(), gradient.by_nodes.end());
  gradient.by_nodes = std::move(solid);
}

}  // namespace

TetMesh joint_mesh(const TetMesh& solid, const TetMesh& skin) {
  TetMesh mesh = solid;
  const auto first = static_cast<int>(solid.nodes.size());
  mesh.nodes.insert(mesh.nodes.end(), skin.nodes.begin(), skin.nodes.end());
  for (const int node : skin.faces) {
    mesh.faces.push_back(first + node);
  }
  std::vector<int> label;  // of the skin's
  for (const std::string& name : skin.labels) {
    if (mesh.label_of(name) < 0) {
      mesh.labels.push_back(name);
    }
    label.push_back(mesh.label_of(name));
  }
  for (const int own : skin.face_label) {
    mesh.face_label.push_back(label[own]);
  }
  mesh.face_element.resize(mesh.face_label.size(), -1);
  if (!mesh.face_front.empty()) {
    mesh.face_front.resize(mesh.face_label.size(), -1);
  }
  return mesh;
}

bool is_of_shells(const ShellPart& part, const std::string& surface) {
  const int label = part.skin.label_of(film_of(surface));
  return part.rims.contains(surface) ||
         (label >= 0 &&
          std::find(part.skin.face_label.begin(), part.skin.face_label.end(),
                    label) != part.skin.face_label.end());
}

loads::LoadCase on_solids(const ShellPart& part,
                          const loads::LoadCase& load_case) {
  return picked(part, load_case, false);
}

loads::LoadCase on_shells(const ShellPart& part,
                          const loads::LoadCase& load_case) {
  return picked(part, load_case, true);
}

equations::ElasticSolution solve_joint(const case_data::EvaluatedCase& inputs,
                                       ShellPart& part) {
  return solve_load_cases(
      inputs, part, [&](std::size_t k, equations::ElasticSolution& solution) {
        const Timer setup;
        part.cases[k].joint = joint_of(inputs, k, part);
        solution.report.setup_seconds += setup.seconds();
        solve_both(inputs.load_cases[k], part, part.cases[k], solution);
      });
}

VectorX by_both(const ShellPart& part, const VectorX& by_displacement) {
  const auto shell = 6L * static_cast<Eigen::Index>(part.mesh.nodes.size());
  if (by_displacement.size() == solid_size(part) + shell) {
    return by_displacement;
  }
  return by_displacement.size() == solid_size(part) + shell / 2
             ? joined(of_solid(part, by_displacement),
                      shell::with_rotations(of_shell(part, by_displacement)))
             : joined(VectorX::Zero(solid_size(part)), by_displacement);
}

shell::ShellGradient joint_gradient(const ShellPart& part,
                                    const case_data::EvaluatedCase& inputs,
                                    std::size_t load_case,
                                    const VectorX& lambda,
                                    const VectorX& by_displacement) {
  const SolidPart& solid = *part.solid;
  const ShellCase& own = part.cases[load_case];
  const VectorX left = own.joint->residual(own.both, own.forces);
  const VectorX adjoint_left = own.joint->residual(lambda, by_displacement);
  const VectorX u = of_solid(part, own.both);
  const VectorX v = of_solid(part, lambda);
  Points by_solid = elastic::residual_gradient(
      solid.mesh, solid.materials,
      on_solids(part, inputs.load_cases[load_case]),
      {u, own.solid_reactions, v, own.joint->reactions(adjoint_left)});
  shell::ShellGradient gradient = work_gradient(
      part, load_case, of_shell(part, lambda), of_shell(part, own.both));
  // What the solid holds tied nodes with works as the tie changes.
  joint::add_tie_gradient(*solid.tie, solid.mesh.nodes, part.mesh.nodes, v,
                          of_shell(part, lambda), -of_shell(part, left),
                          by_solid, gradient.by_nodes);
  joint::add_tie_gradient(*solid.tie, solid.mesh.nodes, part.mesh.nodes, u,
                          of_shell(part, own.both),
                          -of_shell(part, adjoint_left), by_solid,
                          gradient.by_nodes);
  put_before(std::move(by_solid), gradient);
  return gradient;
}

shell::ShellGradient joint_force_gradient(
    const ShellPart& part, const case_data::EvaluatedCase& inputs,
    std::size_t load_case, const VectorX& v) {
  const VectorX on_shell = of_shell(part, v);
  shell::ShellGradient gradient =
      work_gradient(part, load_case, on_shell, VectorX::Zero(on_shell.size()));
  put_before(
      elastic::force_gradient(part.solid->mesh, part.solid->materials,
                              on_solids(part, inputs.load_cases[load_case]),
                              of_solid(part, v)),
      gradient);
  return gradient;
}

double joint_work_rate(const ShellPart& part, const loads::LoadCase& load_case,
                       const loads::LoadCase& rates, const VectorX& v) {
  if (!loads::changes(rates)) {  // by most variables
    return 0.0;
  }
  const SolidPart& solid = *part.solid;
  return loads::load_rate(loads::load_gradient(solid.mesh, solid.materials,
                                               on_solids(part, load_case),
                                               of_solid(part, v)),
                          on_solids(part, rates)) +
         work_rate(part, on_shells(part, load_case), on_shells(part, rates),
                   of_shell(part, v));
}

stress::RecoveredStress solid_stress(const ShellPart& part,
                                     std::size_t load_case) {
  const SolidPart& solid = *part.solid;
  return stress::recover_by_patches(
      solid.mesh,
      element::point_stress(solid.mesh, solid.materials,
                            of_solid(part, part.cases[load_case].both), {}));
}

}  // namespace meniscus::shells
