/// The eigenvalues that responses ask of a design: found once and used by
/// values and gradients.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "fea/elastic/elasticity.h"
#include "pipeline/case_data/case.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::responses {

/// The lowest modes of one eigenproblem, that of a kind of response and a load
/// case.
struct FoundModes {
  case_data::ResponseKind kind = case_data::ResponseKind::BucklingFactor;
  int load_case = 0;            // index, or AnalysisEntry::kFree
  std::vector<double> values;   // ascending: factors, or frequencies [1/time]
  std::vector<VectorX> shapes;  // as of buckling_modes() and natural_modes(),
                                // of shells 6 numbers per node
};

/// A response as a sum over the modes of its problem.
struct ModalSum {
  std::string response;     // its name
  std::size_t problem = 0;  // index
  double value = 0.0;
  VectorX weights;  // its derivatives by their values, smaller modes' first
};

struct ResponseModes {
  std::vector<FoundModes> problems;
  std::vector<ModalSum> sums;  // one per response of such a kind, in order
  std::optional<Failure> failure;
};

/// What a mode search looks at, on loan.
struct ModeTask {
  const case_data::Case& input;
  const case_data::EvaluatedCase& inputs;
  const TetMesh& mesh;
  const equations::ElasticSolution& solution;
  const elastic::ElasticModel* model = nullptr;  // of solids
  const shells::ShellPart* shell = nullptr;      // of shells, solved
  /// Of the design that the model is frozen at: searches begin with its shapes,
  /// and modes are followed from there. Null where this is that design.
  const ResponseModes* base = nullptr;
  Monitor* monitor = nullptr;  // may be null
};

/// Whether the case's responses take any.
bool asks_for_modes(const case_data::Case& input);

/// As many modes of each eigenproblem of the case's responses as these take; an
/// eigenvalue that is not found is a failure. A pure function of the task.
/// Throws Interrupted.
ResponseModes find_response_modes(const ModeTask& task);

/// The sum of that response, which must be there.
const ModalSum& modal_sum(const ResponseModes& modes,
                          const std::string& response);

/// The load case of that index, or one that holds nothing.
loads::LoadCase held_as(const case_data::EvaluatedCase& inputs, int load_case);

}  // namespace meniscus::responses
