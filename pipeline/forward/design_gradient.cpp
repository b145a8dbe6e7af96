#include "pipeline/forward/design_gradient.h"

#include <algorithm>
#include <functional>

#include "core/timer.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/loads/load_rates.h"
#include "fea/loads/material_rates.h"
#include "fea/supports/enforced.h"
#include "pipeline/case_data/case_values.h"
#include "pipeline/case_data/composed_responses.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/frozen_part.h"
#include "pipeline/shells/joint_part.h"
#include "pipeline/shells/shell_holds.h"

namespace meniscus::forward {

namespace {

/// The way back through one load case's equations.
struct BackwardCase {
  int load_case = 0;
  VectorX lambda;  // adjoint displacement; empty: does not depend on it
  VectorX adjoint_reactions;
  std::optional<loads::LoadGradient> loads;
};

/// A response that is not made of others, on its way back through the stages.
struct Backward {
  std::size_t response = 0;
  responses::ResponsePartials partials;
  std::vector<BackwardCase> cases;  // of the partials'
  std::vector<double> by_density;   // per region, of all stages
  std::vector<double> by_modulus;   // likewise
  std::vector<double> by_angle;     // of shells' layers; empty, all: 0
  frozen::FilmGradient film;
  std::vector<VectorX> by_thickness;  // of walls; empty: 0
  VectorX by_radius;                  // of fillets; empty: 0
};

void add(const std::vector<double>& more, std::vector<double>& sum) {
  sum.resize(std::max(sum.size(), more.size()), 0.0);
  std::transform(more.begin(), more.end(), sum.begin(), sum.begin(),
                 std::plus<>());
}

class Adjoint {
 public:
  explicit Adjoint(const GradientInput& input) : in_(input) {}

  DesignGradient run(const std::vector<int>& wanted);

 private:
  std::vector<char> needed(const std::vector<int>& wanted) const;
  bool solve_adjoints(DesignGradient& result);
  void solve_shell_adjoints(DesignGradient& result);
  shell::ShellGradient work_by_places(const Backward& backward,
                                      std::size_t k) const;
  void through_shell(Backward& backward) const;
  double load_rate(const Backward& backward, std::size_t k,
                   const case_data::CaseRates& rates) const;
  bool materials_move() const;
  void through_materials(Backward& backward) const;
  void through_equations(const responses::CasePartials& partials,
                         BackwardCase& backward, Points& by_nodes) const;
  void through_mesh(Backward& backward) const;
  void through_film();
  double rate(const Backward& backward,
              const case_data::CaseRates& rates) const;
  void add_composed(const std::vector<char>& needed, int variable,
                    VectorX& rates) const;
  const case_data::ResponseEntry& entry(const Backward& backward) const {
    return in_.part.input.responses[backward.response];
  }

  const loads::LoadCase& load_case_of(const BackwardCase& back) const {
    return in_.context.inputs
        .load_cases[static_cast<std::size_t>(back.load_case)];
  }

  /// Of a shell: whether something is held elsewhere than at 0, or by rigid
  /// rims, whose derivatives are by the adjoint's reactions.
  bool needs_reactions(const BackwardCase& back) const {
    const loads::LoadCase& load_case = load_case_of(back);
    return loads::enforces(load_case) || !load_case.pins.empty();
  }

  /// Of a shell; on loan.
  shell::RimPair rim_pair(const BackwardCase& back) const {
    const shells::ShellCase& own =
        in_.context.shell->cases[static_cast<std::size_t>(back.load_case)];
    return {own.displacement, own.reaction, back.lambda,
            back.adjoint_reactions};
  }

  const GradientInput& in_;
  std::vector<Backward> backwards_;
};

/// The responses wanted, and those that they are made of.
std::vector<char> Adjoint::needed(const std::vector<int>& wanted) const {
  const case_data::Case& input = in_.part.input;
  std::vector<char> result(input.responses.size(), 0);
  for (const int response : wanted) {
    result[response] = 1;
  }
  for (std::size_t k = input.responses.size(); k-- > 0;) {
    if (result[k] != 0) {
      for (const int part :
           case_data::responses_in(input, input.responses[k])) {
        result[part] = 1;
      }
    }
  }
  return result;
}

/// 6 per node, by the factors that the solutions had.
void Adjoint::solve_shell_adjoints(DesignGradient& result) {
  for (Backward& backward : backwards_) {
    for (const responses::CasePartials& partials : backward.partials.cases) {
      const shells::ShellCase& solved =
          in_.context.shell
              ->cases[static_cast<std::size_t>(partials.load_case)];
      BackwardCase& back = backward.cases.emplace_back();
      back.load_case = partials.load_case;
      if (partials.self_adjoint != 0.0) {
        back.lambda = partials.self_adjoint *
                      (solved.joint ? solved.both : solved.displacement);
        back.adjoint_reactions = partials.self_adjoint * solved.reaction;
        continue;
      }
      VectorX right = partials.by_displacement;
      if (solved.joint) {
        back.lambda =
            solved.joint->solve(shells::by_both(*in_.context.shell, right));
        ++result.solves;
        continue;
      }
      if (right.size() != solved.displacement.size()) {
        right = shell::with_rotations(right);
      }
      back.lambda = solved.system->solve_forces(right);
      if (needs_reactions(back)) {
        back.adjoint_reactions =
            solved.system->stiffness_times(back.lambda) - right;
      }
      ++result.solves;
    }
  }
}

/// v . (f - K u) of its case k.
shell::ShellGradient Adjoint::work_by_places(const Backward& backward,
                                             std::size_t k) const {
  const shells::ShellPart& shell = *in_.context.shell;
  const BackwardCase& back = backward.cases[k];
  const auto c = static_cast<std::size_t>(back.load_case);
  const shells::ShellCase& own = shell.cases[c];
  if (!own.joint) {
    shell::ShellGradient work =
        shells::work_gradient(shell, c, back.lambda, own.displacement);
    shell::add_rim_gradient(own.system->freedom().rims(), rim_pair(back),
                            work.by_nodes);
    return work;
  }
  const responses::CasePartials& partials = backward.partials.cases[k];
  const VectorX by_displacement =
      partials.self_adjoint != 0.0
          ? VectorX(partials.self_adjoint * own.forces)
          : shells::by_both(shell, partials.by_displacement);
  return shells::joint_gradient(shell, in_.context.inputs, c, back.lambda,
                                by_displacement);
}

/// Nodes and thicknesses to the film's points and the thicknesses' numbers;
/// layers.
void Adjoint::through_shell(Backward& backward) const {
  const shells::ShellPart& shell = *in_.context.shell;
  responses::ResponsePartials& partials = backward.partials;
  partials.by_nodes.resize(in_.context.mesh.nodes.size(), Vec3::Zero());
  partials.by_thickness.resize(shell.mesh.facets.size(), Vec3::Zero());
  add(partials.by_density, backward.by_density);
  add(partials.by_modulus, backward.by_modulus);
  add(partials.by_angle, backward.by_angle);
  for (std::size_t k = 0; k < backward.cases.size(); ++k) {
    const shell::ShellGradient state = work_by_places(backward, k);
    for (std::size_t i = 0; i < state.by_nodes.size(); ++i) {
      partials.by_nodes[i] += state.by_nodes[i];
    }
    for (std::size_t f = 0; f < state.by_thickness.size(); ++f) {
      partials.by_thickness[f] += state.by_thickness[f];
    }
    const shells::LayerGradient layers =
        shells::layer_gradient(shell, state.by_ply);
    add(layers.density, backward.by_density);
    add(layers.modulus, backward.by_modulus);
    add(layers.angle, backward.by_angle);
  }
  const shells::ShellModel& model = *in_.part.shells;
  const auto first = partials.by_nodes.end() - std::ssize(shell.mesh.nodes);
  Points by_film = model.to_film({first, partials.by_nodes.end()},
                                 in_.context.film_state->points.size());
  if (shell.solid) {
    const Points by_solid =
        in_.part
            .to_surface(in_.context.inputs, in_.context.film_state->points,
                        shell.solid->mesh, {partials.by_nodes.begin(), first})
            .film;
    std::transform(by_film.begin(), by_film.end(), by_solid.begin(),
                   by_film.begin(), std::plus<>());
  }
  if (partials.film.points.empty()) {
    partials.film.points = std::move(by_film);
  } else {
    for (std::size_t i = 0; i < by_film.size(); ++i) {
      partials.film.points[i] += by_film[i];
    }
  }
  backward.by_thickness =
      model.to_numbers(in_.context.inputs, partials.by_thickness);
}

/// All that are open in one call, which solves load cases held alike in step.
bool Adjoint::solve_adjoints(DesignGradient& result) {
  if (in_.context.shell != nullptr) {
    solve_shell_adjoints(result);
    return true;
  }
  const equations::ElasticSolution& solution = in_.context.solution;
  std::vector<BackwardCase*> open;
  std::vector<int> load_cases;
  std::vector<VectorX> right;
  for (Backward& backward : backwards_) {
    for (const responses::CasePartials& partials : backward.partials.cases) {
      backward.cases.push_back({.load_case = partials.load_case});
    }
    for (std::size_t k = 0; k < backward.cases.size(); ++k) {
      const responses::CasePartials& partials = backward.partials.cases[k];
      BackwardCase& back = backward.cases[k];
      if (const double factor = partials.self_adjoint; factor != 0.0) {
        const auto c = static_cast<std::size_t>(partials.load_case);
        back.lambda = factor * solution.displacements[c];
        back.adjoint_reactions = factor * solution.reactions[c];
        continue;
      }
      if (partials.of_first) {
        continue;
      }
      open.push_back(&back);
      load_cases.push_back(partials.load_case);
      right.push_back(partials.by_displacement);
    }
  }
  equations::AdjointSolution adjoint;
  if (!open.empty()) {
    adjoint = in_.part.elasticity->solve_adjoints(in_.elastic_state, load_cases,
                                                  right);
  }
  result.solves += static_cast<int>(open.size());
  result.failure = adjoint.failure;
  for (std::size_t k = 0; k < open.size() && !result.failure; ++k) {
    open[k]->lambda = std::move(adjoint.lambda[k]);
    open[k]->adjoint_reactions = std::move(adjoint.reactions[k]);
  }
  for (Backward& backward : backwards_) {
    for (std::size_t k = 0; k < backward.cases.size(); ++k) {
      if (const auto factor = backward.partials.cases[k].of_first) {
        const BackwardCase& first = backward.cases.front();
        backward.cases[k].lambda = *factor * first.lambda;
        backward.cases[k].adjoint_reactions = *factor * first.adjoint_reactions;
      }
    }
  }
  return !result.failure;
}

/// Some material depends on some design variable.
bool Adjoint::materials_move() const {
  const case_data::Case& input = in_.part.input;
  std::vector<std::string> problems;
  const case_data::CaseValues values(input, in_.context.inputs.design,
                                     problems);
  const std::vector<case_data::BodyEntry> bodies =
      case_data::solid_bodies(input);
  return std::any_of(
      bodies.begin(), bodies.end(), [&](const case_data::BodyEntry& body) {
        const case_data::MaterialEntry& entry = input.materials[body.material];
        return values.follows_design(entry.density) ||
               (!entry.orthotropic &&
                values.follows_design(entry.youngs_modulus));
      });
}

/// lambda . (f - K u) by the materials, and the loads' part of the response
/// itself.
void Adjoint::through_materials(Backward& backward) const {
  const responses::ResponseContext& fields = in_.context;
  const responses::ResponsePartials& partials = backward.partials;
  add(partials.by_density, backward.by_density);
  add(partials.by_modulus, backward.by_modulus);
  for (std::size_t k = 0; k < backward.cases.size(); ++k) {
    const auto load_case =
        static_cast<std::size_t>(backward.cases[k].load_case);
    const VectorX& u = fields.solution.displacements[load_case];
    const auto add_work = [&](const VectorX& moved, const VectorX& lambda) {
      const loads::MaterialGradient by = loads::material_gradient(
          fields.mesh, fields.inputs.materials,
          fields.inputs.load_cases[load_case], moved, lambda);
      add(by.density, backward.by_density);
      add(by.youngs_modulus, backward.by_modulus);
    };
    add_work(u, backward.cases[k].lambda);
    if (const VectorX& by_forces = partials.cases[k].by_forces;
        by_forces.size() > 0) {
      add_work(VectorX::Zero(u.size()), by_forces);
    }
  }
}

/// `by_nodes` receives what the equations change the response by.
void Adjoint::through_equations(const responses::CasePartials& partials,
                                BackwardCase& backward,
                                Points& by_nodes) const {
  const responses::ResponseContext& fields = in_.context;
  const auto c = static_cast<std::size_t>(backward.load_case);
  const loads::LoadCase& load_case = fields.inputs.load_cases[c];
  const loads::AdjointPair pair{fields.solution.displacements[c],
                                fields.solution.reactions[c], backward.lambda,
                                backward.adjoint_reactions};
  const Points state = elastic::residual_gradient(
      fields.mesh, fields.inputs.materials, load_case, pair);
  for (std::size_t i = 0; i < state.size(); ++i) {
    by_nodes[i] += state[i];
  }
  VectorX by_forces = backward.lambda;
  if (partials.by_forces.size() > 0) {
    by_forces += partials.by_forces;
  }
  backward.loads = loads::load_gradient(fields.mesh, fields.inputs.materials,
                                        load_case, by_forces);
  supports::add_enforced_gradient(fields.mesh, load_case, pair,
                                  backward.loads->by_number);
  loads::add_temperature_gradient(fields.mesh, load_case,
                                  partials.by_temperature, *backward.loads);
}

void Adjoint::through_mesh(Backward& backward) const {
  if (in_.context.shell != nullptr) {
    return through_shell(backward);
  }
  const responses::ResponseContext& fields = in_.context;
  responses::ResponsePartials& partials = backward.partials;
  for (std::size_t k = 0; k < backward.cases.size(); ++k) {
    through_equations(partials.cases[k], backward.cases[k], partials.by_nodes);
  }
  if (!partials.by_nodes.empty()) {
    SurfaceGradient by =
        in_.part.to_surface(fields.inputs, fields.film_state->points,
                            fields.mesh, partials.by_nodes);
    partials.film.points = std::move(by.film);
    backward.by_thickness = std::move(by.thickness);
    backward.by_radius = std::move(by.fillets);
  }
}

void Adjoint::through_film() {
  std::vector<frozen::FilmCovector> covectors;
  covectors.reserve(backwards_.size());
  for (const Backward& backward : backwards_) {
    covectors.push_back(backward.partials.film);
  }
  std::vector<frozen::FilmGradient> gradients = in_.context.film->transpose(
      *in_.context.film_state, in_.context.inputs.film_system, covectors);
  for (std::size_t k = 0; k < gradients.size(); ++k) {
    backwards_[k].film = std::move(gradients[k]);
  }
}

/// By the numbers of one of its load cases.
double Adjoint::load_rate(const Backward& backward, std::size_t k,
                          const case_data::CaseRates& rates) const {
  const BackwardCase& back = backward.cases[k];
  const auto c = static_cast<std::size_t>(back.load_case);
  if (in_.context.shell == nullptr) {
    return loads::load_rate(*back.loads, rates.load_cases[c]);
  }
  VectorX v = back.lambda;
  if (const VectorX& by_forces = backward.partials.cases[k].by_forces;
      by_forces.size() > 0) {
    v += by_forces;
  }
  const shells::ShellPart& part = *in_.context.shell;
  const loads::LoadCase& load_case = load_case_of(back);
  const loads::LoadCase& by = rates.load_cases[c];
  if (part.solid) {
    return shells::joint_work_rate(part, load_case, by, v);
  }
  double rate = shells::work_rate(part, load_case, by, v) +
                shells::action_rate(part, load_case, by,
                                    backward.partials.cases[k].by_actions);
  if (needs_reactions(back)) {
    rate += shells::held_rate(part, load_case, by, rim_pair(back));
  }
  return rate;
}

/// The response's derivative by the variable that `rates` belong to.
double Adjoint::rate(const Backward& backward,
                     const case_data::CaseRates& rates) const {
  const responses::ResponsePartials& partials = backward.partials;
  double sum = in_.context.film->rate(
      backward.film, in_.context.inputs.film_system, rates.film_system);
  sum +=
      partials.by_direction.dot(rates.responses[backward.response].direction);
  sum += partials.by_point.dot(rates.responses[backward.response].point);
  for (std::size_t p = 0; p < partials.by_pin_point.size(); ++p) {
    const loads::LoadCase& held = rates.load_cases[entry(backward).load_case];
    sum += partials.by_pin_point[p].dot(held.pins[p].point);
  }
  for (std::size_t k = 0; k < backward.cases.size(); ++k) {
    sum += load_rate(backward, k, rates);
  }
  for (std::size_t k = 0; k < backward.by_density.size(); ++k) {
    sum += backward.by_density[k] * rates.materials[k].density;
  }
  for (std::size_t k = 0; k < backward.by_modulus.size(); ++k) {
    sum += backward.by_modulus[k] * rates.materials[k].youngs_modulus;
  }
  for (std::size_t k = 0; k < backward.by_angle.size(); ++k) {
    sum += backward.by_angle[k] * rates.layer_angles[k];
  }
  for (std::size_t w = 0; w < backward.by_thickness.size(); ++w) {
    const walls::WallSpec& wall =
        in_.context.shell != nullptr ? rates.shells[w] : rates.walls[w];
    sum += backward.by_thickness[w].dot(wall.thickness.numbers);
  }
  for (Eigen::Index f = 0; f < backward.by_radius.size(); ++f) {
    const auto k = static_cast<std::size_t>(f);
    sum += backward.by_radius[f] * rates.film_system.fillets[k].radius;
  }
  return sum +
         responses::place_rate(entry(backward),
                               in_.context.inputs.responses[backward.response],
                               rates.responses[backward.response],
                               partials.worst_direction, in_.context);
}

/// `rates`: of the responses that are not made of others; receives those.
void Adjoint::add_composed(const std::vector<char>& needed, int variable,
                           VectorX& rates) const {
  const case_data::Case& input = in_.part.input;
  const VectorX& responses = in_.responses;
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const case_data::ResponseEntry& response = input.responses[k];
    if (needed[k] != 0 && case_data::is_composed(response)) {
      rates[static_cast<Eigen::Index>(k)] = case_data::composed_rate(
          input, response, in_.context.inputs.design, variable,
          {responses.data(), k}, {rates.data(), k});
    }
  }
}

DesignGradient Adjoint::run(const std::vector<int>& wanted) {
  const Timer timer;
  const case_data::Case& input = in_.part.input;
  const std::vector<char> needed = this->needed(wanted);
  DesignGradient result;
  // Partial derivatives of each response by what it sees directly.
  for (std::size_t k = 0; k < needed.size(); ++k) {
    const case_data::ResponseEntry& response = input.responses[k];
    if (needed[k] != 0 && !case_data::is_composed(response)) {
      backwards_.push_back({.response = k,
                            .partials = responses::partials_of(
                                response, in_.context.inputs.responses[k],
                                in_.context, element::Derivatives::All)});
    }
  }
  // K lambda = dJ/du, one solve per response that depends on u.
  if (!solve_adjoints(result)) {
    result.seconds = timer.seconds();
    return result;
  }
  // Backwards through tetrahedra, surface and walls to the film; the film's
  // adjoint takes all responses at once.
  const bool materials = in_.context.shell == nullptr && materials_move();
  for (Backward& backward : backwards_) {
    through_mesh(backward);
    if (materials) {
      through_materials(backward);
    }
  }
  through_film();
  // Forwards over the case's numbers: a column is dot products of what came
  // back with their rates along one design variable.
  const auto variables = static_cast<Eigen::Index>(input.design.size());
  result.jacobian.resize(static_cast<Eigen::Index>(wanted.size()), variables);
  for (Eigen::Index j = 0; j < variables; ++j) {
    const auto variable = static_cast<int>(j);
    const case_data::CaseRates rates =
        meniscus::case_data::rates(input, in_.context.inputs.design, variable);
    VectorX column =
        VectorX::Zero(static_cast<Eigen::Index>(input.responses.size()));
    for (const Backward& backward : backwards_) {
      column[static_cast<Eigen::Index>(backward.response)] =
          rate(backward, rates);
    }
    // What is made of responses by the chain rule, in the order of the case.
    add_composed(needed, variable, column);
    for (std::size_t r = 0; r < wanted.size(); ++r) {
      result.jacobian(static_cast<Eigen::Index>(r), j) = column[wanted[r]];
    }
  }
  result.seconds = timer.seconds();
  return result;
}

}  // namespace

DesignGradient design_gradient(const GradientInput& input,
                               const std::vector<int>& wanted) {
  return Adjoint(input).run(wanted);
}

}  // namespace meniscus::forward
