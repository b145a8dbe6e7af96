#include "pipeline/study/front_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/files/named_values.h"

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;

/// (value - least) / (largest - least), 0 where all are the same.
double share(const std::vector<FrontPoint>& points, const FrontPoint& point,
             double FrontPoint::*value) {
  const auto [least, largest] =
      std::minmax_element(points.begin(), points.end(),
                          [&](const FrontPoint& a, const FrontPoint& b) {
                            return a.*value < b.*value;
                          });
  const double range = (*largest).*value - (*least).*value;
  return range > 0.0 ? (point.*value - (*least).*value) / range : 0.0;
}

std::string value_text(const case_data::Case& input, int response,
                       double value) {
  return input.responses[response].name + " = " +
         case_data::shown_unit(input, response).text(value);
}

}  // namespace

int middle_of_front(const std::vector<FrontPoint>& points) {
  int nearest = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double distance =
        std::hypot(share(points, points[k], &FrontPoint::first),
                   share(points, points[k], &FrontPoint::second));
    if (distance < shortest) {
      shortest = distance;
      nearest = static_cast<int>(k);
    }
  }
  return nearest;
}

nlohmann::ordered_json front_json(const case_data::Case& input,
                                  const FrontFigures& figures) {
  const std::string& first = input.responses[*input.study.objective].name;
  const std::string& second = input.responses[*input.study.second].name;
  Json json = {{"objectives", {first, second}},
               {"left_out", figures.left_out},
               {"points", Json::array()}};
  for (const FrontPoint& point : figures.points) {
    Json entry = {
        {first, point.first},
        {second, point.second},
        {"end", point.end},
        {"parameters",
         files::named_json(case_data::design_names(input), point.design)}};
    if (point.own_mesh) {
      entry["own_mesh"] = {{first, point.own_mesh->first},
                           {second, point.own_mesh->second},
                           {"kept", point.own_mesh->kept}};
    }
    json["points"].push_back(std::move(entry));
  }
  return json;
}

std::string front_text(const case_data::Case& input,
                       const FrontFigures& figures) {
  std::string text = "  front:\n";
  for (const FrontPoint& point : figures.points) {
    text += fmt::format("    {}, {} at {} ({})\n",
                        value_text(input, *input.study.objective, point.first),
                        value_text(input, *input.study.second, point.second),
                        case_data::design_text(input, point.design), point.end);
    if (point.own_mesh) {
      text += fmt::format(
          "      on a mesh of its own {}, {}{}\n",
          value_text(input, *input.study.objective, point.own_mesh->first),
          value_text(input, *input.study.second, point.own_mesh->second),
          point.own_mesh->kept ? "" : ": not every constraint is kept");
    }
  }
  return text;
}

}  // namespace meniscus::study
