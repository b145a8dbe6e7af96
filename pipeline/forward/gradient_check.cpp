#include "pipeline/forward/gradient_check.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/timer.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

namespace {

std::vector<optimize::Variable> variables_at(const case_data::Case& input,
                                             const VectorX& design) {
  std::vector<optimize::Variable> variables;
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    const case_data::DesignVariable& variable = input.design[k];
    variables.push_back({.name = variable.name,
                         .initial = design[static_cast<Eigen::Index>(k)],
                         .lower = variable.lower,
                         .upper = variable.upper});
  }
  return variables;
}

void refuse_without_design(const case_data::Case& input,
                           const VectorX& design) {
  if (input.design.empty()) {
    throw InvalidInput(fmt::format(
        "{}: there is nothing to differentiate by: add [design.NAME] with "
        "initial and bounds",
        input.path));
  }
  if (design.size() != static_cast<Eigen::Index>(input.design.size())) {
    throw InvalidInput(fmt::format("{}: {} design values for {} variables",
                                   input.path, design.size(),
                                   input.design.size()));
  }
}

}  // namespace

CaseGradientCheck check_case_gradient(
    const case_data::Case& input, const VectorX& design,
    const optimize::GradientCheckOptions& options) {
  refuse_without_design(input, design);
  if (input.analysis.solver == equations::SolverKind::Distributed) {
    throw InvalidInput(fmt::format(
        "{}: the solver petsc keeps its matrix in other processes and gives no "
        "gradients; choose another analysis.solver",
        input.path));
  }
  CaseGradientCheck check{.design = design};
  std::vector<int> wanted;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const auto response = static_cast<int>(k);
    const std::string& name = input.responses[k].name;
    if (case_data::has_derivatives(input, response)) {
      wanted.push_back(response);
      names.push_back(name);
    } else {
      check.left_out.push_back(name);
    }
  }
  if (wanted.empty()) {
    throw InvalidInput(fmt::format(
        "{}: there is nothing to differentiate: add a response that has "
        "derivatives (docs/case-file.md)",
        input.path));
  }
  // The model is frozen at the case's own initial design, not at `design`.
  const ForwardModel model(input, {.monitor = options.monitor});
  if (model.failure()) {
    throw SolverError("the initial design cannot be evaluated: " +
                      model.failure()->message);
  }
  EvaluationFields fields;
  AdjointState adjoint;
  const Timer timer;
  const Evaluation here = model.evaluate(design, &fields, &adjoint);
  check.evaluation_seconds = timer.seconds();
  if (here.failure) {
    throw SolverError("the design cannot be evaluated: " +
                      here.failure->message);
  }
  // The adjoint's Jacobian, all responses at one evaluated design.
  const DesignGradient gradient = model.gradient(here, fields, adjoint, wanted);
  check.gradient_seconds = gradient.seconds;
  if (gradient.failure) {
    throw SolverError("the adjoint: " + gradient.failure->message);
  }
  // Differences see the same frozen model, so that both are derivatives of
  // one smooth function.
  const optimize::VectorFunction function = [&](const VectorX& x) {
    const Evaluation there = model.evaluate(x);
    optimize::VectorAnswer answer{.values = {}, .failure = there.failure};
    if (!there.failure) {
      answer.values.resize(static_cast<Eigen::Index>(wanted.size()));
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        answer.values[static_cast<Eigen::Index>(k)] =
            there.responses[wanted[k]];
      }
    }
    return answer;
  };
  check.report = optimize::check_gradient(variables_at(input, design), names,
                                          function, gradient.jacobian, options);
  return check;
}

std::string gradient_check_text(const case_data::Case& input,
                                const CaseGradientCheck& check) {
  const std::vector<optimize::GradientCheckRow>& rows = check.report.rows;
  std::size_t responses = 8;
  std::size_t variables = 8;
  for (const optimize::GradientCheckRow& row : rows) {
    responses = std::max(responses, row.response.size());
    variables = std::max(variables, row.variable.size());
  }
  std::string text;
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    text += fmt::format("{}{} = {:.10g}", k == 0 ? "at " : ", ",
                        input.design[k].name,
                        check.design[static_cast<Eigen::Index>(k)]);
  }
  text += fmt::format("\n{:<{}}  {:<{}}  {:>16}  {:>16}  {:>8}  {:>8}  {:>8}\n",
                      "response", responses, "variable", variables, "adjoint",
                      "difference", "step", "error", "allowed");
  for (const optimize::GradientCheckRow& row : rows) {
    text += fmt::format(
        "{:<{}}  {:<{}}  {:>16.9e}  {:>16.9e}  {:>8.1e}  {:>8.1e}  "
        "{:>8.1e}{}\n",
        row.response, responses, row.variable, variables, row.given,
        row.difference, row.step, row.error, row.allowed,
        row.passed ? "" : "  DIFFERS");
  }
  for (const std::string& name : check.left_out) {
    text += fmt::format("{}: has no derivatives, left out\n", name);
  }
  text += fmt::format(
      "{}\n{} evaluations; one takes {:.2f} s, the gradient {:.2f} s\n",
      check.report.message, check.report.evaluations, check.evaluation_seconds,
      check.gradient_seconds);
  return text;
}

}  // namespace meniscus::forward
