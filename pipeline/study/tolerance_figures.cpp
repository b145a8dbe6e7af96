#include "pipeline/study/tolerance_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/responses/responses.h"

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;

// Standard errors of the sampled deviation that are still no disagreement, and
// what counts as none where the sample has hardly any error.
constexpr double kErrors = 3.0;
constexpr double kLinear = 0.05;

/// The row of a response among those with derivatives, or -1.
Eigen::Index row_of(const ToleranceFigures& figures, int response) {
  const auto at =
      std::find(figures.responses.begin(), figures.responses.end(), response);
  return at == figures.responses.end() ? -1 : at - figures.responses.begin();
}

Json sampled_json(const samples::SampledSpread& sampled, Eigen::Index k) {
  return {{"mean", sampled.mean[k]},
          {"mean_error", sampled.mean_error[k]},
          {"deviation", sampled.deviation[k]},
          {"deviation_error", sampled.deviation_error[k]},
          {"least", sampled.least[k]},
          {"largest", sampled.largest[k]}};
}

}  // namespace

std::vector<std::string> tolerance_warnings(const case_data::Case& input,
                                            const ToleranceFigures& figures) {
  std::vector<std::string> warnings;
  if (!figures.sampled) {
    return warnings;
  }
  for (std::size_t row = 0; row < figures.responses.size(); ++row) {
    const Eigen::Index k = figures.responses[row];
    const double linear =
        figures.linear.deviation[static_cast<Eigen::Index>(row)];
    const double sampled = figures.sampled->deviation[k];
    const double error = figures.sampled->deviation_error[k];
    if (std::abs(sampled - linear) >
        std::max(kErrors * error, kLinear * linear)) {
      const ShownUnit unit = case_data::shown_unit(input, static_cast<int>(k));
      warnings.push_back(fmt::format(
          "the standard deviation of '{}' is {} by gradient and {} +- {} by {} "
          "samples: it is not linear over this scatter, believe the samples",
          input.responses[static_cast<std::size_t>(k)].name,
          unit.text(linear, 3), unit.text(sampled, 3), unit.text(error, 1),
          figures.sampled->count));
    }
  }
  return warnings;
}

nlohmann::ordered_json tolerance_json(const case_data::Case& input,
                                      const ToleranceFigures& figures) {
  Json json = {{"deviations", Json::object()},
               {"samples", figures.samples},
               {"failed", figures.failed},
               {"responses", Json::object()}};
  for (std::size_t j = 0; j < input.design.size(); ++j) {
    json["deviations"][input.design[j].name] = input.study.deviations[j];
  }
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    Json entry = Json::object();
    const Eigen::Index row = row_of(figures, static_cast<int>(k));
    if (row >= 0) {
      entry["deviation"] = figures.linear.deviation[row];
      for (std::size_t j = 0; j < input.design.size(); ++j) {
        entry["shares"][input.design[j].name] =
            figures.linear.shares(row, static_cast<Eigen::Index>(j));
      }
    }
    if (figures.sampled) {
      entry["sampled"] =
          sampled_json(*figures.sampled, static_cast<Eigen::Index>(k));
    }
    json["responses"][input.responses[k].name] = std::move(entry);
  }
  return json;
}

std::string tolerance_text(const case_data::Case& input,
                           const ToleranceFigures& figures) {
  std::string text;
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const auto [factor, unit] =
        case_data::shown_unit(input, static_cast<int>(k));
    text += fmt::format("  {:<20} deviation", input.responses[k].name);
    const Eigen::Index row = row_of(figures, static_cast<int>(k));
    if (row >= 0) {
      text += fmt::format(" {:.4g} by gradient (",
                          factor * figures.linear.deviation[row]);
      for (std::size_t j = 0; j < input.design.size(); ++j) {
        text += fmt::format(
            "{}{} {:.0f} %", j == 0 ? "" : ", ", input.design[j].name,
            100.0 * figures.linear.shares(row, static_cast<Eigen::Index>(j)));
      }
      text += ")";
    }
    if (figures.sampled) {
      const auto i = static_cast<Eigen::Index>(k);
      text += fmt::format(
          "{} {:.4g} +- {:.1g} by {} samples", row >= 0 ? "," : "",
          factor * figures.sampled->deviation[i],
          factor * figures.sampled->deviation_error[i], figures.sampled->count);
    }
    text += (unit.empty() ? "" : " [" + unit + "]") + "\n";
  }
  return text;
}

}  // namespace meniscus::study
