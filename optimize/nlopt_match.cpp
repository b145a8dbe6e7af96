#include "optimize/nlopt_match.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlopt.hpp>

#include "optimize/nlopt_minimize.h"
#include "optimize/nlopt_vector.h"

namespace meniscus::optimize {
namespace {

// A first step of a tenth of the range sees past rounding and stays well
// inside the bounds (BOBYQA needs them two steps apart).
constexpr double kMatchFirstStep = 0.1;
// Below these the proposals no longer differ in any figure that matters.
constexpr double kMatchStepTolerance = 1e-8;  // x range
constexpr double kMatchCostTolerance = 1e-10;
// A restart that leaves more than this part of the cost was the last.
constexpr double kMatchGain = 0.99;

const NloptTraits& match_traits_of(const std::string& name) {
  for (const NloptTraits& traits : nlopt_traits()) {
    if (traits.of_match && traits.method.name == name) {
      return traits;
    }
  }
  throw InvalidInput("match: NLopt method '" + name + "' is not known");
}

struct Context {
  MatchEvaluator* evaluator = nullptr;
  nlopt::opt* optimizer = nullptr;
};

// Called from C: nothing may be thrown here.
double objective(unsigned n, const double* x, double* /*gradient*/,
                 void* data) {
  const Context& context = *static_cast<Context*>(data);
  MatchEvaluator& evaluator = *context.evaluator;
  const ResidualAnswer* answer = evaluator.evaluate(
      Eigen::Map<const VectorX>(x, n), EvaluationPhase::Step);
  const double penalty = 2.0 * evaluator.worst_cost();
  if (answer == nullptr) {
    context.optimizer->force_stop();
    return penalty;
  }
  return answer->failure ? penalty : cost_of(*answer);
}

const char* nlopt_words(nlopt::result result) {
  switch (result) {
    case nlopt::FTOL_REACHED:
      return "the cost no longer changes";
    case nlopt::XTOL_REACHED:
      return "the steps are too small to matter";
    case nlopt::ROUNDOFF_LIMITED:
      return "rounding limits further progress";
    default:
      return "the method ended by itself";
  }
}

BackendResult run_once(MatchEvaluator& evaluator, const VectorX& start,
                       const NloptTraits& method) {
  nlopt::opt optimizer(static_cast<nlopt::algorithm>(method.algorithm),
                       static_cast<unsigned>(evaluator.size()));
  Context context{&evaluator, &optimizer};
  optimizer.set_min_objective(objective, &context);
  optimizer.set_lower_bounds(to_vector(evaluator.lower()));
  optimizer.set_upper_bounds(to_vector(evaluator.upper()));
  optimizer.set_initial_step(to_vector(kMatchFirstStep * evaluator.ranges()));
  optimizer.set_xtol_abs(to_vector(kMatchStepTolerance * evaluator.ranges()));
  optimizer.set_ftol_rel(kMatchCostTolerance);

  BackendResult result;
  std::vector<double> x = to_vector(start);
  double cost = 0.0;
  try {
    result.message = nlopt_words(optimizer.optimize(x, cost));
  } catch (const nlopt::forced_stop&) {
    result.message = "stopped";
  } catch (const nlopt::roundoff_limited&) {
    result.message = nlopt_words(nlopt::ROUNDOFF_LIMITED);
  } catch (const std::exception& error) {
    result.message = fmt::format("NLopt gave up: {}", error.what());
  }
  result.iterations = optimizer.get_numevals();
  return result;
}

}  // namespace

const std::vector<std::string>& nlopt_match_methods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NloptTraits& traits : nlopt_traits()) {
      if (traits.of_match) {
        list.push_back(traits.method.name);
      }
    }
    std::sort(list.begin(), list.end());
    return list;
  }();
  return names;
}

BackendResult nlopt_match(MatchEvaluator& evaluator, const VectorX& start,
                          const std::string& method_name) {
  const NloptTraits& method = match_traits_of(method_name);
  BackendResult result = run_once(evaluator, start, method);
  while (method.restarts && !evaluator.halted()) {
    const double before = cost_of(evaluator.best_answer());
    const BackendResult again = run_once(evaluator, evaluator.best(), method);
    result.iterations += again.iterations;
    if (cost_of(evaluator.best_answer()) >= kMatchGain * before) {
      break;
    }
  }
  return result;
}

}  // namespace meniscus::optimize
