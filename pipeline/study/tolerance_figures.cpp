#include "pipeline/study/tolerance_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/files/named_values.h"
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
  const std::vector<std::string> names = case_data::design_names(input);
  json["deviations"] = files::named_json(
      names, Eigen::Map<const VectorX>(input.study.deviations.data(),
                                       std::ssize(input.study.deviations)));
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    Json entry = Json::object();
    const Eigen::Index row = row_of(figures, static_cast<int>(k));
    if (row >= 0) {
      entry["deviation"] = figures.linear.deviation[row];
      entry["shares"] =
          files::named_json(names, figures.linear.shares.row(row).transpose());
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
      for (const case_data::DesignRow& of : case_data::design_rows(input)) {
        const double share = figures.linear.shares.row(row)
                                 .segment(static_cast<Eigen::Index>(of.first),
                                          static_cast<Eigen::Index>(of.count))
                                 .sum();
        text += fmt::format("{}{} {:.0f} %", of.first == 0 ? "" : ", ", of.name,
                            100.0 * share);
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
