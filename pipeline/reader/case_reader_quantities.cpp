#include <cmath>
#include <regex>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/bound_text.h"
#include "pipeline/reader/case_reader_repeat.h"

namespace meniscus::reader {

namespace {

const char* const kQuantity =
    "a number, an expression in quotes or a value with a unit";

/// Notes which names the expression has, and its text where it has indices.
void note_use(CaseContext& context, const Expression& expression,
              const std::string& text) {
  const std::size_t places = context.used.size() + 3;  // names, then x, y, z
  for (const int name : expression.names_used()) {
    const auto k = static_cast<std::size_t>(name);
    if (k < context.used.size()) {
      context.used[k] = 1;
    } else if (k >= places) {
      context.used_shapes.insert(k - places);
    }
  }
  if (text.find('[') == std::string::npos) {
    return;
  }
  for (std::size_t k = 0; k < context.constants.size(); ++k) {
    if (context.constants[k] &&
        std::regex_search(text, std::regex("\\b" + context.names[k] + "\\b"))) {
      context.used[k] = 1;
    }
  }
}

/// `names`: those of the context, and more after them.
std::optional<case_data::Quantity> read_expression(
    CaseContext& context, const toml::node& node,
    std::optional<Dimension> dimension, const std::string& key,
    const std::vector<std::string>& names) {
  case_data::Quantity result{.line = context.line_of(node), .key = key};
  const auto* text = node.as_string();
  if (text == nullptr) {
    const auto value = node.value<double>();
    if (node.is_number() && value && std::isfinite(*value)) {
      result.expression = Expression(*value);
      return result;
    }
    context.problems.add(result.line, fmt::format("{} is {}; expected {}", key,
                                                  described(node), kQuantity));
    return std::nullopt;
  }
  static const std::vector<std::string> letters = {"i", "j", "k"};
  std::string bound = text->get();
  if (!context.indices.empty()) {
    bound = with_values(
        filled(context, bound, context.indices, result.line, key),
        {letters.begin(), letters.begin() + std::ssize(context.indices)},
        std::vector<double>(context.indices.begin(), context.indices.end()));
  }
  try {
    if (looks_like_quantity(bound)) {
      result.expression =
          Expression(parse_quantity(bound, dimension, context.units));
      result.measure = Measure::of(quantity_powers(bound));
      return result;
    }
    result.expression = Expression::parse(bound, names, context.constants);
    note_use(context, result.expression, bound);
    result.measure = measure_of(context, result);
    if (dimension) {
      require_powers(context, result, powers_of(*dimension));
    }
    return result;
  } catch (const ExpressionError& error) {
    context.problems.add(
        result.line, fmt::format("{}: {} at character {}", key, error.what(),
                                 error.column()));
  } catch (const InvalidInput& error) {
    context.problems.add(result.line, fmt::format("{}: {}", key, error.what()));
  }
  return std::nullopt;
}

/// " (load is a mass)": the names of known dimension behind an expression.
std::string origins(const CaseContext& context,
                    const case_data::Quantity& quantity) {
  std::string text;
  for (const int name : quantity.expression.names_used()) {
    const auto k = static_cast<std::size_t>(name);
    if (k < context.measures.size() && context.measures[k].is_known()) {
      text +=
          fmt::format("{}{} is {}", text.empty() ? " (" : ", ",
                      context.names[k], described(context.measures[k].powers));
    }
  }
  return text.empty() ? text : text + ")";
}

/// The first name that a design variable moves or that has no value; empty
/// when there is none.
std::string moving_name(const CaseContext& context,
                        const case_data::Quantity& quantity) {
  for (const int name : quantity.expression.names_used()) {
    const auto k = static_cast<std::size_t>(name);
    if (k < context.names.size() &&
        (k >= context.constants.size() || !context.constants[k])) {
      return context.names[k];
    }
  }
  return "";
}

}  // namespace

Measure measure_of(CaseContext& context, const case_data::Quantity& quantity) {
  if (context.measures.empty() && !quantity.expression.is_constant()) {
    return {};  // parameters are not ordered yet
  }
  std::vector<Measure> measures = context.measures;
  const std::vector<int> used = quantity.expression.names_used();
  if (!used.empty() &&
      static_cast<std::size_t>(used.back()) >= measures.size()) {
    measures.resize(static_cast<std::size_t>(used.back()) + 1);  // x, y, z
  }
  try {
    return meniscus::measure_of(quantity.expression, measures);
  } catch (const ExpressionError& error) {
    context.problems.add(
        quantity.line,
        fmt::format("{}: {} at character {}{}; only like can be added or "
                    "compared: write what differs with its unit, or without "
                    "one",
                    quantity.key, error.what(), error.column(),
                    origins(context, quantity)));
    return {};
  }
}

void require_powers(CaseContext& context, const case_data::Quantity& quantity,
                    const UnitPowers& powers) {
  const Measure& measure = quantity.measure;
  if (measure.is_known() && !(measure.powers == powers)) {
    context.problems.add(
        quantity.line,
        fmt::format("{}: '{}' is {}{}; expected {}", quantity.key,
                    quantity.expression.text(), described(measure.powers),
                    origins(context, quantity), described(powers)));
  }
}

std::optional<case_data::Quantity> read_quantity(
    CaseContext& context, const toml::node& node,
    std::optional<Dimension> dimension, const std::string& key) {
  return read_expression(context, node, dimension, key, context.names);
}

std::optional<case_data::PlaceQuantity> read_place_quantity(
    CaseContext& context, const toml::node& node,
    std::optional<Dimension> dimension, const std::string& key,
    const std::vector<std::string>& more) {
  std::vector<std::string> names = context.names;
  names.insert(names.end(), {"x", "y", "z"});
  names.insert(names.end(), more.begin(), more.end());
  auto quantity = read_expression(context, node, dimension, key, names);
  if (!quantity) {
    return std::nullopt;
  }
  const std::vector<int> used = quantity->expression.names_used();
  const bool of_place =
      !used.empty() && used.back() >= static_cast<int>(context.names.size());
  return case_data::PlaceQuantity{*std::move(quantity), of_place};
}

void require_frozen(CaseContext& context, const case_data::Quantity& quantity,
                    const char* what) {
  if (const std::string name = moving_name(context, quantity); !name.empty()) {
    context.problems.add(
        quantity.line,
        fmt::format("{} depends on '{}', which a design variable moves or "
                    "which has no value; {} is part of the frozen model and "
                    "must be the same for every design: take '{}' out of it",
                    quantity.key, name, what, name));
  }
}

std::optional<Constant> read_measured(CaseContext& context,
                                      const toml::node& node,
                                      std::optional<Dimension> dimension,
                                      const std::string& key) {
  const auto quantity = read_quantity(context, node, dimension, key);
  if (!quantity) {
    return std::nullopt;
  }
  if (const std::string name = moving_name(context, *quantity); !name.empty()) {
    context.problems.add(
        quantity->line,
        fmt::format("{} depends on '{}', which a design variable moves or "
                    "which has no value; expected a number that is the same "
                    "for every design",
                    key, name));
    return std::nullopt;
  }
  std::vector<double> values(context.names.size(), 0.0);
  for (const int name : quantity->expression.names_used()) {
    const auto k = static_cast<std::size_t>(name);
    values[k] = *context.constants[k];
  }
  try {
    return Constant{quantity->expression.evaluate(values), quantity->measure};
  } catch (const ExpressionError& error) {
    context.problems.add(quantity->line,
                         fmt::format("{}: {}", key, error.what()));
    return std::nullopt;
  }
}

std::optional<double> read_constant(CaseContext& context,
                                    const toml::node& node,
                                    std::optional<Dimension> dimension,
                                    const std::string& key) {
  const auto found = read_measured(context, node, dimension, key);
  return found ? std::optional(found->value) : std::nullopt;
}

}  // namespace meniscus::reader
