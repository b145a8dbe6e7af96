#include "pipeline/forward/gradient_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "core/timer.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

namespace {

/// What is moved: the design is `design + ways * x`.
struct Moves {
  std::vector<optimize::Variable> variables;
  Eigen::MatrixXd ways;
};

Moves by_variable(const case_data::Case& input, const VectorX& design) {
  Moves moves;
  moves.ways.setIdentity(design.size(), design.size());
  for (Eigen::Index k = 0; k < design.size(); ++k) {
    const case_data::DesignVariable& variable =
        input.design[static_cast<std::size_t>(k)];
    moves.variables.push_back({.name = variable.name,
                               .initial = 0.0,
                               .lower = variable.lower - design[k],
                               .upper = variable.upper - design[k]});
  }
  return moves;
}

/// Parts of the variables' ranges, evenly from -1 to 1, away from a bound on
/// which a variable lies; a variable of equal bounds rests.
Moves along_directions(const case_data::Case& input, const VectorX& design,
                       int count) {
  constexpr double kAtBound = 1e-9;  // of the range
  std::mt19937 random(1);            // the same in each run, on each machine
  Moves moves;
  moves.ways.resize(design.size(), count);
  for (int d = 0; d < count; ++d) {
    double back = std::numeric_limits<double>::infinity();
    double on = back;
    for (Eigen::Index k = 0; k < design.size(); ++k) {
      const case_data::DesignVariable& v =
          input.design[static_cast<std::size_t>(k)];
      const double range = v.upper - v.lower;
      const double below = design[k] - v.lower;
      const double above = v.upper - design[k];
      double way = (random() / 2147483648.0 - 1.0) * range;
      if (below <= kAtBound * range) {
        way = std::abs(way);
      } else if (above <= kAtBound * range) {
        way = -std::abs(way);
      }
      moves.ways(k, d) = way;
      if (way != 0.0) {
        on = std::min(on, (way > 0.0 ? above : below) / std::abs(way));
        const double room = (way > 0.0 ? below : above) / std::abs(way);
        back = std::min(back, room <= kAtBound ? 0.0 : room);
      }
    }
    moves.variables.push_back({.name = fmt::format("direction {}", d + 1),
                               .initial = 0.0,
                               .lower = -back,
                               .upper = on});
  }
  return moves;
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
    const optimize::GradientCheckOptions& options, int directions) {
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
  const Moves moves = directions > 0
                          ? along_directions(input, design, directions)
                          : by_variable(input, design);
  const optimize::VectorFunction function = [&](const VectorX& x) {
    const Evaluation there = model.evaluate(design + moves.ways * x);
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
  check.report =
      optimize::check_gradient(moves.variables, names, function,
                               gradient.jacobian * moves.ways, options);
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
