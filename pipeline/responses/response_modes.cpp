#include "pipeline/responses/response_modes.h"

#include <algorithm>

#include <fmt/format.h>

#include "fea/modes/buckling.h"
#include "fea/modes/eigenvalue_bound.h"
#include "fea/modes/mode_shapes.h"
#include "fea/modes/modes.h"
#include "fea/shell_modes/shell_mode_works.h"
#include "pipeline/shells/shell_eigen.h"

namespace meniscus::responses {

namespace {

using case_data::ResponseEntry;
using case_data::ResponseKind;

/// Of modes: gradients err in proportion to it, values by its square.
constexpr double kModeTolerance = 1e-7;
constexpr double kLargestFactor = 1e6;
/// With guards these are whole fours of vectors.
constexpr int kFirstCount = 2;
constexpr int kMostCount = 62;  // and more than any number
static_assert(kMostCount > case_data::AnalysisEntry::kMostModes);

bool is_modal(ResponseKind kind) {
  return kind == ResponseKind::BucklingFactor ||
         kind == ResponseKind::Frequency;
}

/// The lowest so many of a problem, in `found`.
class ModeSearch {
 public:
  ModeSearch(const ModeTask& task, FoundModes& found)
      : task_(task), found_(found) {}

  /// How many are known of where there are no more.
  bool is_complete(int count) const {
    return found_.values.size() < static_cast<std::size_t>(count);
  }

  std::optional<Failure> run(int count, const std::vector<VectorX>* start) {
    try {
      return found_.kind == ResponseKind::BucklingFactor
                 ? buckling(count, start)
                 : vibration(count, start);
    } catch (const InvalidInput& error) {
      return Failure{FailureKind::SolverFailed, error.what()};
    } catch (const MeshError& error) {
      return Failure{FailureKind::ElementsInverted, error.what()};
    } catch (const SolverError& error) {
      return Failure{FailureKind::SolverFailed, error.what()};
    }
  }

 private:
  std::optional<Failure> buckling(int count,
                                  const std::vector<VectorX>* start) {
    const auto c = static_cast<std::size_t>(found_.load_case);
    const modes::BucklingOptions options{.count = count,
                                         .tolerance = kModeTolerance,
                                         .largest = kLargestFactor,
                                         .monitor = task_.monitor,
                                         .materials = &task_.inputs.materials,
                                         .start = start,
                                         .may_factor = true};
    modes::BucklingModes modes =
        task_.shell != nullptr
            ? shells::buckling_modes(*task_.shell, c,
                                     task_.inputs.load_cases[c].name, options)
            : modes::buckling_modes(*task_.model, task_.mesh,
                                    task_.inputs.load_cases, found_.load_case,
                                    task_.solution.displacements[c], options);
    found_.values = std::move(modes.factors);
    found_.shapes = std::move(modes.shapes);
    if (!modes.failure && found_.values.empty()) {
      return Failure{
          FailureKind::SolverFailed,
          fmt::format("load case '{}': no buckling factor below {:.3g} x its "
                      "loads, which compress nothing; a buckling_factor needs "
                      "one",
                      task_.inputs.load_cases[c].name, modes.none_below)};
    }
    return modes.failure;
  }

  std::optional<Failure> vibration(int count,
                                   const std::vector<VectorX>* start) {
    const modes::ModeOptions options{.count = count,
                                     .tolerance = kModeTolerance,
                                     .monitor = task_.monitor,
                                     .materials = &task_.inputs.materials,
                                     .start = start,
                                     .may_factor = true};
    modes::NaturalModes modes = natural_modes(options);
    found_.values = std::move(modes.frequencies);
    found_.shapes = std::move(modes.shapes);
    return modes.failure;
  }

  modes::NaturalModes natural_modes(const modes::ModeOptions& options) const {
    if (task_.shell != nullptr) {
      return shells::natural_modes(*task_.shell, found_.load_case, options);
    }
    return found_.load_case == case_data::AnalysisEntry::kFree
               ? modes::natural_modes(task_.mesh, task_.inputs.materials,
                                      held_as(task_.inputs, found_.load_case),
                                      options)
               : modes::natural_modes(*task_.model, task_.mesh,
                                      task_.inputs.load_cases, found_.load_case,
                                      options);
  }

  const ModeTask& task_;
  FoundModes& found_;
};

/// Of the inner product that modes are followed in: of buckling by volume.
std::vector<double> densities(const ModeTask& task, ResponseKind kind) {
  std::vector<double> density;
  for (const element::Material& material : task.inputs.materials) {
    density.push_back(kind == ResponseKind::Frequency ? material.density : 1.0);
  }
  return density;
}

std::optional<std::size_t> followed_mode(const ModeTask& task,
                                         const FoundModes& found,
                                         const VectorX& reference) {
  if (task.shell == nullptr) {
    return modes::same_mode(task.mesh, densities(task, found.kind),
                            found.shapes, reference);
  }
  const SparseMatrix M = shell::nodal_mass(
      task.shell->mesh, found.kind == ResponseKind::Frequency
                            ? task.shell->sections
                            : shells::with_density(task.shell->sections, 1.0));
  return modes::same_mode(
      [&](const VectorX& x) -> VectorX {
        return M.selfadjointView<Eigen::Lower>() * x;
      },
      found.shapes, reference);
}

/// The sum of a bound over a cluster; nothing where more modes must be known.
std::optional<ModalSum> bounded(const ResponseEntry& response,
                                const FoundModes& found, bool complete) {
  if (found.values.empty()) {
    return std::nullopt;
  }
  const modes::EigenvalueBound bound =
      modes::eigenvalue_bound(found.values, response.cluster);
  if (!complete && found.values.back() < bound.reach) {
    return std::nullopt;
  }
  return ModalSum{.value = bound.value, .weights = bound.by_value};
}

/// That of one mode, by its number at the base, by its shape elsewhere.
std::optional<ModalSum> followed(const ModeTask& task,
                                 const ResponseEntry& response,
                                 const FoundModes& found,
                                 const FoundModes* base) {
  const auto number = static_cast<std::size_t>(response.number) - 1;
  std::optional<std::size_t> at;
  if (base != nullptr) {
    at = followed_mode(task, found, base->shapes[number]);
  } else if (number < found.values.size()) {
    at = number;
  }
  if (!at) {
    return std::nullopt;
  }
  return ModalSum{
      .value = found.values[*at],
      .weights = VectorX::Unit(static_cast<Eigen::Index>(found.values.size()),
                               static_cast<Eigen::Index>(*at))};
}

Failure too_few(const ResponseEntry& response, std::size_t known,
                bool is_base) {
  if (response.cluster > 0.0) {
    return {FailureKind::SolverFailed,
            fmt::format("response '{}': more than {} modes lie within its "
                        "cluster of {:g}; make it narrower",
                        response.name, known, response.cluster)};
  }
  return {FailureKind::SolverFailed,
          is_base
              ? fmt::format("response '{}': the part has {} modes; number {} "
                            "is not among them",
                            response.name, known, response.number)
              : fmt::format("response '{}': none of the lowest {} modes has "
                            "half of mode {} of the base design: it mixed "
                            "with others; keep closer to that design, or take "
                            "number = 1 with a cluster",
                            response.name, known, response.number)};
}

/// All responses of one problem.
class Problem {
 public:
  Problem(const ModeTask& task, FoundModes& found, const FoundModes* base,
          std::vector<int> responses)
      : task_(task),
        found_(found),
        base_(base),
        responses_(std::move(responses)) {}

  std::optional<Failure> solve(std::vector<ModalSum>& sums) {
    int count = kFirstCount;
    for (const int r : responses_) {
      count = std::max(count, entry(r).number);
    }
    if (base_ != nullptr) {
      count = std::max(count, static_cast<int>(base_->shapes.size()));
    }
    const std::vector<VectorX>* start =
        base_ != nullptr ? &base_->shapes : nullptr;
    std::vector<VectorX> last;
    for (;;) {
      ModeSearch search(task_, found_);
      if (std::optional<Failure> failure = search.run(count, start)) {
        return failure;
      }
      const bool complete = search.is_complete(count);
      const std::optional<int> missed = sum_up(complete, sums);
      if (!missed) {
        return std::nullopt;
      }
      if (complete || count >= kMostCount) {
        return too_few(entry(*missed), found_.values.size(), base_ == nullptr);
      }
      count = std::min(2 * count + 2, kMostCount);
      last = found_.shapes;
      start = &last;
    }
  }

 private:
  const ResponseEntry& entry(int response) const {
    return task_.input.responses[static_cast<std::size_t>(response)];
  }

  /// The first response that needs more modes.
  std::optional<int> sum_up(bool complete, std::vector<ModalSum>& sums) const {
    std::vector<ModalSum> own;
    for (const int r : responses_) {
      std::optional<ModalSum> sum =
          entry(r).cluster > 0.0 ? bounded(entry(r), found_, complete)
                                 : followed(task_, entry(r), found_, base_);
      if (!sum) {
        return r;
      }
      sum->response = entry(r).name;
      own.push_back(*std::move(sum));
    }
    std::move(own.begin(), own.end(), std::back_inserter(sums));
    return std::nullopt;
  }

  const ModeTask& task_;
  FoundModes& found_;
  const FoundModes* base_;
  std::vector<int> responses_;
};

}  // namespace

bool asks_for_modes(const case_data::Case& input) {
  return std::any_of(
      input.responses.begin(), input.responses.end(),
      [](const ResponseEntry& response) { return is_modal(response.kind); });
}

ResponseModes find_response_modes(const ModeTask& task) {
  const std::vector<ResponseEntry>& responses = task.input.responses;
  ResponseModes result;
  std::vector<std::vector<int>> asked;
  for (std::size_t r = 0; r < responses.size(); ++r) {
    if (!is_modal(responses[r].kind)) {
      continue;
    }
    const auto known =
        std::find_if(result.problems.begin(), result.problems.end(),
                     [&](const FoundModes& found) {
                       return found.kind == responses[r].kind &&
                              found.load_case == responses[r].load_case;
                     });
    const auto at = static_cast<std::size_t>(known - result.problems.begin());
    if (known == result.problems.end()) {
      result.problems.push_back(
          {.kind = responses[r].kind, .load_case = responses[r].load_case});
      asked.emplace_back();
    }
    asked[at].push_back(static_cast<int>(r));
  }
  for (std::size_t p = 0; p < asked.size() && !result.failure; ++p) {
    std::vector<ModalSum> sums;
    result.failure =
        Problem(task, result.problems[p],
                task.base != nullptr ? &task.base->problems[p] : nullptr,
                asked[p])
            .solve(sums);
    for (ModalSum& sum : sums) {
      sum.problem = p;
      result.sums.push_back(std::move(sum));
    }
  }
  return result;
}

const ModalSum& modal_sum(const ResponseModes& modes,
                          const std::string& response) {
  return *std::find_if(
      modes.sums.begin(), modes.sums.end(),
      [&](const ModalSum& sum) { return sum.response == response; });
}

loads::LoadCase held_as(const case_data::EvaluatedCase& inputs, int load_case) {
  return load_case == case_data::AnalysisEntry::kFree
             ? loads::LoadCase{.name = "free"}
             : inputs.load_cases[static_cast<std::size_t>(load_case)];
}

}  // namespace meniscus::responses
