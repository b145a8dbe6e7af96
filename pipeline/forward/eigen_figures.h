/// A part's buckling factors and natural frequencies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "fea/modes/buckling_verdict.h"
#include "fea/modes/modes.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

struct FrequencyFigures {
  std::string load_case;  // whose supports hold the part; or "free"
  modes::NaturalModes modes;
  std::vector<double> errors;  // of each [Hz]; empty: not estimated
};

struct EigenFigures {
  std::vector<modes::BucklingFigures> buckling;  // of load cases, by name
  std::optional<FrequencyFigures> frequencies;
  std::string remark;  // why nothing was computed, unasked; or empty
  double seconds = 0.0;
};

/// What the case's [analysis] asks for; without it the first buckling factor of
/// every load case up to 1000, to three digits, or a remark where the solver
/// keeps its matrix in other processes or loads come from any direction.
/// `model` must know the fields' mesh; of shells it is not read, and null. An
/// answer that did not come is a failure within. Throws Interrupted.
EigenFigures eigen_figures(const case_data::Case& input,
                           const EvaluationFields& fields,
                           const elastic::ElasticModel* model,
                           Monitor* monitor = nullptr);

/// Of a mode of buckling of load case `c`: 3 numbers per node, of shells 6.
modes::ModeStress stress_in_mode(const EvaluationFields& fields, std::size_t c,
                                 const VectorX& shape);

/// Whether other meshes have something to say: of what was asked for, and of
/// factors that matter.
bool deserve_errors(const case_data::Case& input, const EigenFigures& figures);

/// Adds "buckling" and "natural_frequencies" to result.json (docs/results.md).
void add_eigen_json(const EigenFigures& figures, nlohmann::ordered_json& json);

/// Lines for people, indented by two.
std::string eigen_text(const EigenFigures& figures);

/// The modes that [analysis] asked for by number, for part.vtu.
std::vector<ModeShape> mode_shapes(const case_data::Case& input,
                                   const EigenFigures& figures);

}  // namespace meniscus::forward
