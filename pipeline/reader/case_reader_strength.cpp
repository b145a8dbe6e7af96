#include <algorithm>
#include <cmath>

#include "pipeline/case_data/response_kinds.h"
#include "pipeline/reader/case_reader_responses.h"

namespace meniscus::reader {

const std::vector<case_data::Named<case_data::StressMeasure>>&
stress_measures() {
  using case_data::StressMeasure;
  static const std::vector<case_data::Named<StressMeasure>> measures = {
      {"von_mises", StressMeasure::VonMises},
      {"tension", StressMeasure::Tension}};
  return measures;
}

const std::vector<case_data::Named<case_data::FatigueCriterion>>&
fatigue_criteria() {
  using case_data::FatigueCriterion;
  static const std::vector<case_data::Named<FatigueCriterion>> criteria = {
      {"goodman", FatigueCriterion::Goodman},
      {"crossland", FatigueCriterion::Crossland}};
  return criteria;
}

namespace {

/// Bodies without the property of their material that `response` needs are
/// told.
template <class Has>
void require_materials(CaseContext& context, const CaseTable& table,
                       const case_data::Case& result, const char* key,
                       const char* instead, const Has& has) {
  if (!context.bodies_good) {
    return;
  }
  for (const case_data::BodyEntry& body : case_data::solid_bodies(result)) {
    const auto k = static_cast<std::size_t>(body.material);
    if (k < result.materials.size() && !has(result.materials[k])) {
      context.problems.add(
          table.line(),
          fmt::format("{} is of body '{}' too, whose material '{}' has no {}; "
                      "add it to the material{}",
                      table.path(), body.name, result.materials[k].name, key,
                      instead));
    }
  }
}

double read_excess(CaseContext& context, const CaseTable& table,
                   double standard) {
  const double excess = table.constant("excess").value_or(standard);
  if (excess > 0.0 && excess < 1.0) {
    return excess;
  }
  context.problems.add(
      table.line("excess"),
      fmt::format("{}.excess is {:g}; expected a part above 0 and below 1, as "
                  "{:g}",
                  table.path(), excess, standard));
  return standard;
}

/// Load cases by name, each once; all when the key is left out.
std::vector<AskedCase> read_load_cases_of(CaseContext& context,
                                          const CaseTable& table,
                                          const case_data::Case& result) {
  std::vector<std::string> known;
  for (const AskedCase& asked : asked_cases(result)) {
    known.push_back(asked.name);
  }
  std::vector<AskedCase> load_cases;
  for (const std::string& name :
       table.has("load_cases") ? table.names("load_cases") : known) {
    const auto asked = asked_case(result, name);
    if (!asked) {
      context.problems.unknown(table.line("load_cases"), "load case", name,
                               known);
    } else if (std::any_of(load_cases.begin(), load_cases.end(),
                           [&](const AskedCase& other) {
                             return other.name == name;
                           })) {
      context.problems.add(table.line("load_cases"),
                           fmt::format("{}.load_cases names '{}' twice; name "
                                       "each once",
                                       table.path(), name));
    } else {
      load_cases.push_back(*asked);
    }
  }
  return load_cases;
}

/// The response above that `name` is; none, and a note, where there is none.
std::optional<int> response_above(CaseContext& context, const CaseTable& table,
                                  const char* key, const std::string& name,
                                  const case_data::Case& result) {
  const std::vector<std::string> known = case_data::response_names(result);
  const auto at = std::find(known.begin(), known.end(), name);
  if (at == known.end()) {
    context.problems.unknown(table.line(key), "response above", name, known);
    return std::nullopt;
  }
  return static_cast<int>(at - known.begin());
}

/// `of` asked of each load case: the responses that are not there yet are
/// added.
std::vector<int> over_load_cases(CaseContext& context, const CaseTable& table,
                                 const case_data::ResponseEntry& of,
                                 std::optional<int> own,
                                 const std::vector<AskedCase>& load_cases,
                                 case_data::Case& result) {
  std::vector<int> parts;
  parts.reserve(load_cases.size());
  for (const AskedCase& asked : load_cases) {
    if (own && of.load_case == asked.load_case &&
        of.worst_in.has_value() == asked.worst_in.has_value()) {
      parts.push_back(*own);
      continue;
    }
    case_data::ResponseEntry part = of;
    part.name = fmt::format("{}[{}]", of.name, asked.name);
    ask(context, table.line("load_cases"), asked, part);
    const std::vector<std::string> known = case_data::response_names(result);
    const auto at = std::find(known.begin(), known.end(), part.name);
    parts.push_back(static_cast<int>(at - known.begin()));
    if (at == known.end()) {
      result.responses.push_back(std::move(part));
    }
  }
  return parts;
}

/// The responses that an envelope is of.
std::vector<int> read_parts(CaseContext& context, const CaseTable& table,
                            case_data::Case& result) {
  std::vector<int> parts;
  if (table.has("of") == table.has("responses")) {
    context.problems.add(
        table.line(),
        fmt::format("{} has {} of 'of' and 'responses'; expected one: of = a "
                    "response above, asked of each load case, or responses = "
                    "a list of them",
                    table.path(), table.has("of") ? "both" : "none"));
  } else if (table.has("of")) {
    const std::optional<std::string> name = table.text("of");
    if (!name) {
      return parts;
    }
    const auto of = response_above(context, table, "of", *name, result);
    const std::vector<AskedCase> load_cases =
        read_load_cases_of(context, table, result);
    if (!of) {
      return parts;
    }
    const case_data::ResponseEntry entry =
        result.responses[static_cast<std::size_t>(*of)];
    if (takes_load_case(entry)) {
      return over_load_cases(context, table, entry, of, load_cases, result);
    }
    context.problems.add(
        table.line("of"),
        fmt::format("{}.of is '{}', which is of no one load case; give an "
                    "envelope of several responses their names: responses = "
                    "[...]",
                    table.path(), entry.name));
  } else {
    for (const std::string& name : table.names("responses")) {
      if (const auto at =
              response_above(context, table, "responses", name, result)) {
        parts.push_back(*at);
      }
    }
  }
  return parts;
}

/// The largest or least of numbers of one unit.
void check_parts(CaseContext& context, const CaseTable& table,
                 const case_data::ResponseEntry& envelope,
                 const case_data::Case& result) {
  if (context.problems.empty() && envelope.parts.empty()) {
    context.problems.add(table.line(),
                         fmt::format("{} is an envelope of nothing; name at "
                                     "least one response",
                                     table.path()));
  }
  for (const int part : envelope.parts) {
    const case_data::ResponseEntry& entry =
        result.responses[static_cast<std::size_t>(part)];
    const case_data::ResponseEntry& first =
        result.responses[static_cast<std::size_t>(envelope.parts.front())];
    const Measure a = case_data::measure_of(first);
    const Measure b = case_data::measure_of(entry);
    if (a.is_known() && b.is_known() && !(a.powers == b.powers)) {
      context.problems.add(
          table.line("responses"),
          fmt::format("{}: '{}' and '{}' are of different units; the largest "
                      "is of numbers that can be compared",
                      table.path(), first.name, entry.name));
      return;
    }
  }
}

}  // namespace

void read_strength(CaseContext& context, const CaseTable& table,
                   const case_data::Case& result,
                   case_data::ResponseEntry& response) {
  using case_data::FatigueCriterion;
  using case_data::MaterialEntry;
  if (response.kind == case_data::ResponseKind::StressRatio) {
    response.excess = read_excess(context, table, response.excess);
    response.stress = read_named(context, table, "measure", stress_measures());
    if (table.has("allowable")) {
      response.allowable =
          constant_above(context, table, "allowable", 0.0, 1.0);
    } else {
      require_materials(
          context, table, result, "yield_strength",
          ", or allowable = STRESS here",
          [](const MaterialEntry& m) { return m.yield_strength.has_value(); });
    }
    return;
  }
  if (response.kind != case_data::ResponseKind::Fatigue) {
    return;
  }
  response.excess = read_excess(context, table, response.excess);
  response.criterion =
      read_named(context, table, "criterion", fatigue_criteria());
  require_materials(
      context, table, result, "endurance_limit", "",
      [](const MaterialEntry& m) { return m.endurance_limit.has_value(); });
  if (response.criterion == FatigueCriterion::Goodman) {
    require_materials(
        context, table, result, "tensile_strength", "",
        [](const MaterialEntry& m) { return m.tensile_strength.has_value(); });
  } else {
    require_materials(context, table, result,
                      "torsion_limit of at least endurance_limit / "
                      "sqrt(3)",
                      "", [](const MaterialEntry& m) {
                        return m.torsion_limit &&
                               std::sqrt(3.0) * *m.torsion_limit >=
                                   m.endurance_limit.value_or(0.0);
                      });
  }
  for (const AskedCase& asked : read_load_cases_of(context, table, result)) {
    case_data::ResponseEntry of = response;
    ask(context, table.line("load_cases"), asked, of);
    response.load_cases.push_back(asked.load_case);
  }
  if (table.has("load_cases") && response.load_cases.size() != 2) {
    context.problems.add(
        table.line("load_cases"),
        fmt::format("{}.load_cases has {} names; fatigue is between two load "
                    "cases, as [\"up\", \"down\"]",
                    table.path(), response.load_cases.size()));
    response.load_cases.clear();
  }
}

void add_response(CaseContext& context, const CaseTable& table,
                  case_data::ResponseEntry response, case_data::Case& result) {
  constexpr double kExcess = 0.01;  // of envelopes
  using case_data::ResponseKind;
  if (response.kind == ResponseKind::Envelope) {
    response.parts = read_parts(context, table, result);
    response.excess = read_excess(context, table, kExcess);
    response.least = table.flag("least").value_or(false);
    check_parts(context, table, response, result);
  } else if (response.kind != ResponseKind::Fatigue &&
             table.has("load_cases")) {
    const std::vector<AskedCase> load_cases =
        read_load_cases_of(context, table, result);
    if (table.has("load_case") || load_cases.empty()) {
      context.problems.add(
          table.line("load_cases"),
          fmt::format(
              "{} has load_cases {}; expected load_case = one, or "
              "load_cases = a list of them",
              table.path(),
              table.has("load_case") ? "beside load_case" : "without a name"));
      return;
    }
    case_data::ResponseEntry envelope = response;
    envelope.kind = ResponseKind::Envelope;
    envelope.excess = kExcess;
    envelope.parts = over_load_cases(context, table, response, std::nullopt,
                                     load_cases, result);
    response = std::move(envelope);
  }
  if (!response.parts.empty()) {
    response.value.measure = case_data::measure_of(
        result.responses[static_cast<std::size_t>(response.parts.front())]);
  }
  result.responses.push_back(std::move(response));
}

}  // namespace meniscus::reader
