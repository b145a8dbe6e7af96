#include "pipeline/files/earlier_run.h"

#include <limits>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/json.h"
#include "pipeline/files/named_values.h"

namespace meniscus::files {

namespace {

using Json = nlohmann::ordered_json;

/// The member of an object; null where there is none.
const Json& member(const Json& json, const char* key) {
  static const Json nothing;
  const auto at = json.is_object() ? json.find(key) : json.end();
  return at == json.end() ? nothing : *at;
}

Json parse_result(const std::string& text) {
  Json json = parse_json(text);
  if (!member(member(json, "units"), "system").is_string()) {
    throw InvalidInput("no result.json of a run");
  }
  if (!member(json, "parameters").is_object() ||
      !member(member(json, "start"), "parameters").is_object()) {
    throw InvalidInput("its run has no answer");
  }
  return json;
}

double number_named(const Json& values, const Json& otherwise,
                    const std::string& name) {
  for (const Json* json : {&values, &otherwise}) {
    const Json* found = find_named(*json, name);
    if (found != nullptr && found->is_number()) {
      return found->get<double>();
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string earlier_run_text(const std::string& result_json) {
  const Json json = parse_result(result_json);
  Json kept = {{"units", {{"system", json["units"]["system"]}}},
               {"parameters", json["parameters"]},
               {"start", {{"parameters", json["start"]["parameters"]}}},
               {"refrozen", Json::array()}};
  for (const Json& model : member(json, "refrozen")) {
    kept["refrozen"].push_back({{"parameters", member(model, "parameters")}});
  }
  return kept.dump();
}

EarlierRun read_earlier_run(const std::string& text,
                            const std::vector<std::string>& names) {
  const Json json = parse_result(text);
  std::vector<const Json*> designs = {&json["start"]["parameters"]};
  for (const Json& model : member(json, "refrozen")) {
    designs.push_back(&member(model, "parameters"));
  }
  const Json& answer = json["parameters"];
  designs.push_back(&answer);

  EarlierRun run{.units = json["units"]["system"].get<std::string>(),
                 .values = {}};
  for (const Json* design : designs) {
    VectorX values(static_cast<Eigen::Index>(names.size()));
    for (std::size_t k = 0; k < names.size(); ++k) {
      values[static_cast<Eigen::Index>(k)] =
          number_named(*design, answer, names[k]);
    }
    if (run.values.empty() || values != run.values.back()) {
      run.values.push_back(std::move(values));
    }
  }
  return run;
}

}  // namespace meniscus::files
