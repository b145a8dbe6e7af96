#include "pipeline/forward/eigen_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/timer.h"
#include "fea/shell_modes/shell_mode_stress.h"
#include "pipeline/forward/worst_cases.h"
#include "pipeline/shells/shell_eigen.h"

namespace meniscus::forward {

namespace {

using Json = nlohmann::ordered_json;

// Unasked, the factor serves a warning and a line of the summary.
constexpr double kRoughly = 1e-3;
constexpr double kLargestOfInterest = 1e3;
// As many steps as the solve took, so that it costs about as much, within:
constexpr int kLeastSteps = 40;
constexpr int kMostSteps = 150;

/// Why there are no factors that nobody asked for; empty where there are.
const char* left_out(const case_data::AnalysisEntry& analysis,
                     const EvaluationFields& fields) {
  if (analysis.solver == equations::SolverKind::Distributed) {
    return "no buckling factors: the solver petsc keeps its matrix in other "
           "processes; another solver, or a coarser mesh with one, gives them";
  }
  if (fields.shell && fields.shell->solid) {
    return "no buckling factors: shells beside solids have none yet; a case of "
           "shells alone, or of solids, gives them";
  }
  return "";
}

modes::BucklingOptions buckling_options(
    const case_data::AnalysisEntry& analysis,
    const equations::ElasticReport& solve, Monitor* monitor) {
  if (!analysis.buckling) {
    return {
        .tolerance = kRoughly,
        .largest = kLargestOfInterest,
        .guards = 1,
        .max_iterations = std::clamp(solve.iterations, kLeastSteps, kMostSteps),
        .monitor = monitor};
  }
  return {.count = *analysis.buckling, .monitor = monitor};
}

/// solve(), or why it could not begin.
template <class Modes, class Solve>
Modes or_failure(const Solve& solve) {
  Modes modes;
  try {
    modes = solve();
  } catch (const InvalidInput& error) {
    modes.failure = Failure{FailureKind::SolverFailed, error.what()};
  } catch (const SolverError& error) {
    modes.failure = Failure{FailureKind::SolverFailed, error.what()};
  }
  return modes;
}

FrequencyFigures frequencies_of(const case_data::AnalysisEntry& analysis,
                                const EvaluationFields& fields,
                                const std::vector<loads::LoadCase>& cases,
                                const elastic::ElasticModel* model,
                                Monitor* monitor) {
  const modes::ModeOptions options{.count = analysis.frequencies,
                                   .monitor = monitor,
                                   .materials = &fields.inputs.materials};
  const int held = analysis.supports_of;
  const bool is_free = held == case_data::AnalysisEntry::kFree;
  return {is_free ? "free" : cases[static_cast<std::size_t>(held)].name,
          or_failure<modes::NaturalModes>([&] {
            if (fields.shell) {
              return shells::natural_modes(*fields.shell, held, options);
            }
            return is_free ? modes::natural_modes(
                                 fields.mesh, fields.inputs.materials,
                                 loads::LoadCase{.name = "free"}, options)
                           : modes::natural_modes(*model, fields.mesh, cases,
                                                  held, options);
          })};
}

/// The factors of a load case, and the stress that each is of.
modes::BucklingFigures buckling_of(const EvaluationFields& fields,
                                   const std::vector<loads::LoadCase>& cases,
                                   const elastic::ElasticModel* model,
                                   std::size_t c,
                                   const modes::BucklingOptions& options) {
  const VectorX& u = fields.solution.displacements[c];
  modes::BucklingFigures figures{
      .load_case = cases[c].name,
      .modes = or_failure<modes::BucklingModes>([&] {
        return fields.shell
                   ? shells::buckling_modes(*fields.shell, c, cases[c].name,
                                            options)
                   : modes::buckling_modes(*model, fields.mesh, cases,
                                           static_cast<int>(c), u, options);
      })};
  for (const VectorX& shape : figures.modes.shapes) {
    figures.stresses.push_back(stress_in_mode(fields, c, shape));
  }
  return figures;
}

}  // namespace

modes::ModeStress stress_in_mode(const EvaluationFields& fields, std::size_t c,
                                 const VectorX& shape) {
  if (fields.shell) {
    const shells::ShellCase& own = fields.shell->cases[c];
    return shell::mode_stress(fields.shell->mesh, fields.shell->sections,
                              own.actions.loads, own.displacement, shape);
  }
  return modes::mode_stress(fields.mesh, fields.inputs.materials,
                            fields.inputs.load_cases[c],
                            fields.solution.displacements[c], shape);
}

EigenFigures eigen_figures(const case_data::Case& input,
                           const EvaluationFields& fields,
                           const elastic::ElasticModel* model,
                           Monitor* monitor) {
  const Timer timer;
  const case_data::AnalysisEntry& analysis = input.analysis;
  const std::vector<loads::LoadCase> cases = solved_load_cases(fields);
  EigenFigures figures;
  modes::BucklingOptions options = buckling_options(
      analysis,
      fields.shell ? fields.solution.report : model->base_solution().report,
      monitor);
  options.materials = &fields.inputs.materials;
  const std::string none = left_out(analysis, fields);
  if (!none.empty()) {
    options.count = 0;
  }
  for (std::size_t c = 0; c < cases.size() && options.count > 0; ++c) {
    if (is_unit_load(fields, c) && !analysis.buckling) {
      continue;
    }
    figures.buckling.push_back(buckling_of(fields, cases, model, c, options));
  }
  if (!analysis.buckling) {
    figures.remark = none;
  }
  for (const WorstCase& worst : fields.worst_cases) {
    if (!analysis.buckling && figures.remark.empty()) {
      figures.remark = fmt::format(
          "no buckling factors of '{}', whose load comes from any direction; "
          "analysis.buckling gives those of its unit loads",
          fields.inputs.load_cases[worst.load_case].name);
    }
  }
  if (analysis.frequencies > 0) {
    figures.frequencies =
        frequencies_of(analysis, fields, cases, model, monitor);
  }
  for (modes::BucklingFigures& b : figures.buckling) {
    const bool stable = !b.modes.factors.empty() && !matters(b, 0);
    if (!analysis.buckling && b.modes.failure && stable) {
      b.modes.failure.reset();
      b.roughly = true;
    }
  }
  figures.seconds = timer.seconds();
  return figures;
}

bool deserve_errors(const case_data::Case& input, const EigenFigures& figures) {
  return input.analysis.buckling.value_or(0) > 0 ||
         input.analysis.frequencies > 0 ||
         std::any_of(figures.buckling.begin(), figures.buckling.end(),
                     [](const modes::BucklingFigures& b) {
                       return factors_that_matter(b) > 0;
                     });
}

void add_eigen_json(const EigenFigures& figures, Json& json) {
  Json buckling = Json::object();
  for (const modes::BucklingFigures& b : figures.buckling) {
    Json entry = {{"verdict", modes::name_of(modes::verdict_of(b))},
                  {"above", safe_factor(b)},
                  {"factors", b.modes.factors},
                  {"residuals", b.modes.residuals}};
    for (std::size_t k = 0; k < b.stresses.size(); ++k) {
      const modes::ModeStress& stress = b.stresses[k];
      entry["stress"].push_back(
          {{"von_mises", stress.von_mises},
           {"strain", stress.strain},
           {"position",
            {stress.position.x(), stress.position.y(), stress.position.z()}},
           {"slenderness", slenderness(b, k)},
           {"matters", matters(b, k)}});
    }
    if (!b.errors.empty()) {
      entry["errors"] = b.errors;
    }
    if (b.modes.factors.empty() && !b.modes.failure) {
      entry["none_below"] = b.modes.none_below;
    }
    buckling[b.load_case] = std::move(entry);
  }
  json["buckling"] = std::move(buckling);
  if (figures.frequencies) {
    const modes::NaturalModes& modes = figures.frequencies->modes;
    json["natural_frequencies"] = {
        {"supports_of", figures.frequencies->load_case},
        {"rigid_motions", modes.rigid_motions},
        {"values", modes.frequencies},
        {"residuals", modes.residuals}};
    if (!figures.frequencies->errors.empty()) {
      json["natural_frequencies"]["errors"] = figures.frequencies->errors;
    }
  }
}

std::string eigen_text(const EigenFigures& figures) {
  std::string text;
  for (const modes::BucklingFigures& b : figures.buckling) {
    text +=
        fmt::format("  buckling of '{}': {}\n", b.load_case, buckling_text(b));
  }
  if (figures.frequencies) {
    std::vector<std::string> values;
    for (const double f : figures.frequencies->modes.frequencies) {
      values.push_back(fmt::format("{:.5g}", f));
    }
    const std::vector<double>& errors = figures.frequencies->errors;
    for (std::size_t k = 0; k < std::min(values.size(), errors.size()); ++k) {
      if (std::isfinite(errors[k])) {
        values[k] += fmt::format(" +- {:.2g}", errors[k]);
      }
    }
    const modes::NaturalModes& modes = figures.frequencies->modes;
    const std::string held =
        modes.rigid_motions == 0
            ? fmt::format("held as in '{}'", figures.frequencies->load_case)
            : fmt::format("{} rigid motions left out", modes.rigid_motions);
    text += fmt::format("  natural frequencies, {}: {} Hz{}\n", held,
                        fmt::join(values, ", "),
                        modes.failure ? " (not converged)" : "");
  }
  return text;
}

std::vector<ModeShape> mode_shapes(const case_data::Case& input,
                                   const EigenFigures& figures) {
  std::vector<ModeShape> shapes;
  const auto moved = [&](const VectorX& shape) {
    return input.shells.empty() ? shape : shell::displacements_of(shape);
  };
  if (figures.frequencies) {
    const modes::NaturalModes& modes = figures.frequencies->modes;
    for (std::size_t k = 0; k < modes.shapes.size(); ++k) {
      shapes.push_back({fmt::format("mode_{}", k + 1),
                        fmt::format("{:.8g} Hz", modes.frequencies[k]),
                        moved(modes.shapes[k])});
    }
  }
  if (!input.analysis.buckling) {
    return shapes;
  }
  for (const modes::BucklingFigures& b : figures.buckling) {
    for (std::size_t k = 0; k < b.modes.shapes.size(); ++k) {
      shapes.push_back({fmt::format("buckling_{}_{}", b.load_case, k + 1),
                        fmt::format("factor {:.8g}", b.modes.factors[k]),
                        moved(b.modes.shapes[k])});
    }
  }
  return shapes;
}

}  // namespace meniscus::forward
