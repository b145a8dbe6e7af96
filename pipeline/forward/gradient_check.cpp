#include "pipeline/forward/gradient_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <fmt/format.h>

#include "core/timer.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

namespace {

/// What is moved: the design is `design + ways * x`.
struct Moves {
  std::vector<optimize::Variable> variables;
  Eigen::MatrixXd ways;

  void add(optimize::Variable variable, const VectorX& way) {
    variables.push_back(std::move(variable));
    ways.conservativeResize(way.size(), ways.cols() + 1);
    ways.rightCols(1) = way;
  }
};

constexpr std::size_t kMostOfVector = 8;  // of a vector, looked at one by one

/// Adds a random direction of the variables from `first` on: parts of their
/// ranges, evenly from -1 to 1, away from a bound on which a variable lies; a
/// variable of equal bounds rests.
void add_direction(const case_data::Case& input, const VectorX& design,
                   std::size_t first, std::size_t count,
                   const std::string& name, std::mt19937& random,
                   Moves& moves) {
  constexpr double kAtBound = 1e-9;  // of the range
  double back = std::numeric_limits<double>::infinity();
  double on = back;
  VectorX ways = VectorX::Zero(design.size());
  for (std::size_t k = first; k < first + count; ++k) {
    const case_data::DesignVariable& v = input.design[k];
    const double value = design[static_cast<Eigen::Index>(k)];
    const double range = v.upper - v.lower;
    const double below = value - v.lower;
    const double above = v.upper - value;
    double way = (random() / 2147483648.0 - 1.0) * range;
    if (below <= kAtBound * range) {
      way = std::abs(way);
    } else if (above <= kAtBound * range) {
      way = -std::abs(way);
    }
    ways[static_cast<Eigen::Index>(k)] = way;
    if (way != 0.0) {
      on = std::min(on, (way > 0.0 ? above : below) / std::abs(way));
      const double room = (way > 0.0 ? below : above) / std::abs(way);
      back = std::min(back, room <= kAtBound ? 0.0 : room);
    }
  }
  moves.add({.name = name, .initial = 0.0, .lower = -back, .upper = on}, ways);
}

void add_variable(const case_data::Case& input, const VectorX& design,
                  std::size_t k, Moves& moves) {
  const case_data::DesignVariable& variable = input.design[k];
  const auto i = static_cast<Eigen::Index>(k);
  moves.add({.name = variable.name,
             .initial = 0.0,
             .lower = variable.lower - design[i],
             .upper = variable.upper - design[i]},
            VectorX::Unit(design.size(), i));
}

/// So many of the row's variables, all different, in their order.
std::vector<std::size_t> some_of(const case_data::DesignRow& row,
                                 std::size_t count, std::mt19937& random) {
  std::set<std::size_t> chosen;
  while (chosen.size() < count) {
    chosen.insert(row.first + random() % row.count);
  }
  return {chosen.begin(), chosen.end()};
}

Moves by_variable(const case_data::Case& input, const VectorX& design,
                  std::vector<std::string>& sampled) {
  std::mt19937 random(1);  // the same in each run, on each machine
  Moves moves;
  for (const case_data::DesignRow& row : case_data::design_rows(input)) {
    if (row.count <= kMostOfVector) {
      for (std::size_t k = row.first; k < row.first + row.count; ++k) {
        add_variable(input, design, k, moves);
      }
      continue;
    }
    for (const std::size_t k : some_of(row, kMostOfVector, random)) {
      add_variable(input, design, k, moves);
    }
    add_direction(input, design, row.first, row.count, row.name + ", direction",
                  random, moves);
    sampled.push_back(
        fmt::format("{}: {} of its {} elements at random and a direction of "
                    "them all",
                    row.label(), kMostOfVector, row.count));
  }
  return moves;
}

Moves along_directions(const case_data::Case& input, const VectorX& design,
                       int count) {
  std::mt19937 random(1);
  Moves moves;
  for (int d = 0; d < count; ++d) {
    add_direction(input, design, 0, input.design.size(),
                  fmt::format("direction {}", d + 1), random, moves);
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
                          : by_variable(input, design, check.sampled);
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
  for (const case_data::DesignRow& row : case_data::design_rows(input)) {
    text += text.empty() ? "at " : ", ";
    text +=
        row.vector == nullptr
            ? fmt::format("{} = {:.10g}", row.name,
                          check.design[static_cast<Eigen::Index>(row.first)])
            : fmt::format("{} = {}", row.label(),
                          case_data::row_text(input, row, check.design));
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
  for (const std::string& of : check.sampled) {
    text += of + "\n";
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
