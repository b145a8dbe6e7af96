#include "pipeline/forward/design_gradient.h"

#include <algorithm>
#include <functional>

#include "core/timer.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/loads/load_rates.h"
#include "fea/loads/material_rates.h"
#include "fea/supports/enforced.h"
#include "pipeline/case_data/case_values.h"
#include "pipeline/forward/frozen_part.h"

namespace meniscus::forward {

namespace {

/// A response that is no expression, on its way back through the stages.
struct Backward {
  std::size_t response = 0;
  ResponsePartials partials;
  VectorX lambda;  // adjoint displacement; empty: does not depend on it
  VectorX adjoint_reactions;
  std::optional<loads::LoadGradient> loads;
  std::vector<double> by_density;  // per region, of all stages
  std::vector<double> by_modulus;  // likewise; both empty: 0
  frozen::FilmGradient film;
  VectorX by_thickness;  // of walls; empty: 0
};

class Adjoint {
 public:
  explicit Adjoint(const GradientInput& input) : in_(input) {}

  DesignGradient run(const std::vector<int>& wanted);

 private:
  std::vector<char> needed(const std::vector<int>& wanted) const;
  bool solve_adjoints(DesignGradient& result);
  bool solve_adjoints(std::size_t load_case, DesignGradient& result);
  bool materials_move() const;
  void through_materials(Backward& backward) const;
  void through_mesh(Backward& backward) const;
  void through_film();
  double rate(const Backward& backward,
              const case_data::CaseRates& rates) const;
  void add_expressions(const std::vector<char>& needed, int variable,
                       VectorX& rates) const;
  const case_data::ResponseEntry& entry(const Backward& backward) const {
    return in_.part.input.responses[backward.response];
  }

  const GradientInput& in_;
  std::vector<Backward> backwards_;
};

/// The responses wanted, and those that they are made of.
std::vector<char> Adjoint::needed(const std::vector<int>& wanted) const {
  const case_data::Case& input = in_.part.input;
  const auto names =
      static_cast<int>(input.design.size() + input.parameters.size());
  std::vector<char> result(input.responses.size(), 0);
  for (const int response : wanted) {
    result[response] = 1;
  }
  for (std::size_t k = input.responses.size(); k-- > 0;) {
    const case_data::ResponseEntry& response = input.responses[k];
    if (result[k] == 0 ||
        response.kind != case_data::ResponseKind::Expression) {
      continue;
    }
    for (const int name : response.value.expression.names_used()) {
      if (name >= names) {
        result[name - names] = 1;
      }
    }
  }
  return result;
}

bool Adjoint::solve_adjoints(std::size_t load_case, DesignGradient& result) {
  const equations::ElasticSolution& solution = in_.context.solution;
  std::vector<Backward*> open;
  std::vector<VectorX> right;
  for (Backward& backward : backwards_) {
    if (entry(backward).load_case != static_cast<int>(load_case) ||
        backward.partials.by_displacement.size() == 0) {
      continue;
    }
    if (backward.partials.self_adjoint != 0.0) {
      const double factor = backward.partials.self_adjoint;
      backward.lambda = factor * solution.displacements[load_case];
      backward.adjoint_reactions = factor * solution.reactions[load_case];
      continue;
    }
    open.push_back(&backward);
    right.push_back(backward.partials.by_displacement);
  }
  if (open.empty()) {
    return true;
  }
  equations::AdjointSolution adjoint = in_.part.elasticity->solve_adjoint(
      in_.elastic_state, static_cast<int>(load_case), right);
  result.solves += static_cast<int>(open.size());
  result.failure = adjoint.failure;
  for (std::size_t k = 0; k < open.size() && !result.failure; ++k) {
    open[k]->lambda = std::move(adjoint.lambda[k]);
    open[k]->adjoint_reactions = std::move(adjoint.reactions[k]);
  }
  return !result.failure;
}

bool Adjoint::solve_adjoints(DesignGradient& result) {
  for (std::size_t c = 0; c < in_.context.inputs.load_cases.size(); ++c) {
    if (!solve_adjoints(c, result)) {
      return false;
    }
  }
  return true;
}

/// Some material depends on some design variable.
bool Adjoint::materials_move() const {
  const case_data::Case& input = in_.part.input;
  std::vector<std::string> problems;
  for (std::size_t j = 0; j < input.design.size(); ++j) {
    const case_data::CaseValues rates(input, in_.context.inputs.design,
                                      problems, static_cast<int>(j));
    for (const case_data::BodyEntry& body : case_data::solid_bodies(input)) {
      const case_data::MaterialEntry& entry = input.materials[body.material];
      if (rates.at(entry.density) != 0.0 ||
          (!entry.orthotropic && rates.at(entry.youngs_modulus) != 0.0)) {
        return true;
      }
    }
  }
  return false;
}

void add(const std::vector<double>& more, std::vector<double>& sum) {
  sum.resize(std::max(sum.size(), more.size()), 0.0);
  std::transform(more.begin(), more.end(), sum.begin(), sum.begin(),
                 std::plus<>());
}

/// lambda . (f - K u) by the materials, and the loads' part of the response
/// itself.
void Adjoint::through_materials(Backward& backward) const {
  const ResponseContext& fields = in_.context;
  const ResponsePartials& partials = backward.partials;
  add(partials.by_density, backward.by_density);
  add(partials.by_modulus, backward.by_modulus);
  if (backward.lambda.size() == 0) {
    return;
  }
  const auto load_case = static_cast<std::size_t>(entry(backward).load_case);
  const VectorX& u = fields.solution.displacements[load_case];
  const auto add_work = [&](const VectorX& moved, const VectorX& lambda) {
    const loads::MaterialGradient by = loads::material_gradient(
        fields.mesh, fields.inputs.materials,
        fields.inputs.load_cases[load_case], moved, lambda);
    add(by.density, backward.by_density);
    add(by.youngs_modulus, backward.by_modulus);
  };
  add_work(u, backward.lambda);
  if (partials.by_forces.size() > 0) {
    add_work(VectorX::Zero(u.size()), partials.by_forces);
  }
}

void Adjoint::through_mesh(Backward& backward) const {
  const ResponseContext& fields = in_.context;
  ResponsePartials& partials = backward.partials;
  const auto load_case = static_cast<std::size_t>(entry(backward).load_case);
  if (backward.lambda.size() > 0) {
    const loads::AdjointPair pair{fields.solution.displacements[load_case],
                                  fields.solution.reactions[load_case],
                                  backward.lambda, backward.adjoint_reactions};
    const Points state =
        elastic::residual_gradient(fields.mesh, fields.inputs.materials,
                                   fields.inputs.load_cases[load_case], pair);
    for (std::size_t i = 0; i < state.size(); ++i) {
      partials.by_nodes[i] += state[i];
    }
    VectorX by_forces = backward.lambda;
    if (partials.by_forces.size() > 0) {
      by_forces += partials.by_forces;
    }
    backward.loads =
        loads::load_gradient(fields.mesh, fields.inputs.materials,
                             fields.inputs.load_cases[load_case], by_forces);
    supports::add_enforced_gradient(fields.mesh,
                                    fields.inputs.load_cases[load_case], pair,
                                    backward.loads->by_number);
    loads::add_temperature_gradient(fields.mesh,
                                    fields.inputs.load_cases[load_case],
                                    partials.by_temperature, *backward.loads);
  }
  if (!partials.by_nodes.empty()) {
    SurfaceGradient by =
        in_.part.to_surface(fields.inputs, fields.film_state->points,
                            fields.mesh, partials.by_nodes);
    partials.film.points = std::move(by.film);
    backward.by_thickness = std::move(by.thickness);
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

/// The response's derivative by the variable that `rates` belong to.
double Adjoint::rate(const Backward& backward,
                     const case_data::CaseRates& rates) const {
  const ResponsePartials& partials = backward.partials;
  double sum = in_.context.film->rate(
      backward.film, in_.context.inputs.film_system, rates.film_system);
  sum +=
      partials.by_direction.dot(rates.responses[backward.response].direction);
  if (backward.loads) {
    sum += loads::load_rate(*backward.loads,
                            rates.load_cases[entry(backward).load_case]);
  }
  for (std::size_t k = 0; k < backward.by_density.size(); ++k) {
    sum += backward.by_density[k] * rates.materials[k].density;
  }
  for (std::size_t k = 0; k < backward.by_modulus.size(); ++k) {
    sum += backward.by_modulus[k] * rates.materials[k].youngs_modulus;
  }
  for (Eigen::Index w = 0; w < backward.by_thickness.size(); ++w) {
    const walls::WallSpec& wall = rates.walls[static_cast<std::size_t>(w)];
    sum += backward.by_thickness[w] * wall.number.value_or(0.0);
  }
  return sum + place_rate(entry(backward),
                          in_.context.inputs.responses[backward.response],
                          rates.responses[backward.response], in_.context);
}

/// `rates`: of the responses that are no expressions; receives the others.
void Adjoint::add_expressions(const std::vector<char>& needed, int variable,
                              VectorX& rates) const {
  const case_data::Case& input = in_.part.input;
  const VectorX& design = in_.context.inputs.design;
  std::vector<std::string> problems;
  const case_data::CaseValues values(input, design, problems, variable);
  const VectorX& responses = in_.responses;
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const case_data::ResponseEntry& response = input.responses[k];
    if (needed[k] != 0 &&
        response.kind == case_data::ResponseKind::Expression) {
      rates[static_cast<Eigen::Index>(k)] =
          values.rate(response.value, {responses.data(), k}, {rates.data(), k});
    }
  }
  if (!problems.empty()) {
    throw InvalidInput(problems.front());
  }
}

DesignGradient Adjoint::run(const std::vector<int>& wanted) {
  const Timer timer;
  const case_data::Case& input = in_.part.input;
  const std::vector<char> needed = this->needed(wanted);
  DesignGradient result;
  // Partial derivatives of each response by what it sees directly.
  bool expressions = false;
  for (std::size_t k = 0; k < needed.size(); ++k) {
    const case_data::ResponseEntry& response = input.responses[k];
    const bool composed = response.kind == case_data::ResponseKind::Expression;
    expressions = expressions || (needed[k] != 0 && composed);
    if (needed[k] != 0 && !composed) {
      backwards_.push_back(
          {.response = k,
           .partials = partials_of(response, in_.context.inputs.responses[k],
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
  const bool materials = materials_move();
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
    // Expressions of responses by the chain rule, in the order of the case.
    if (expressions) {
      add_expressions(needed, variable, column);
    }
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
