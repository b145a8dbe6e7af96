#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus {

namespace {

struct PoleKeys {
  FieldKind kind;
  KindKeys keys;
};

const std::map<std::string, PoleKeys>& field_kinds() {
  const auto pole = [](std::vector<std::string> shape) {
    shape.insert(shape.end(), {"strength", "core"});
    return KindKeys{std::move(shape), {"power", "films", "body"}};
  };
  static const std::map<std::string, PoleKeys> kinds = {
      {"point", {FieldKind::Point, pole({"at"})}},
      {"segment", {FieldKind::Segment, pole({"from", "to"})}},
      {"polyline", {FieldKind::Polyline, pole({"points"})}},
      {"plane", {FieldKind::Plane, pole({"at", "normal"})}},
      {"pressure", {FieldKind::Pressure, {{"pressure", "body"}, {}}}}};
  return kinds;
}

void read_field_targets(CaseContext& context, const CaseTable& table,
                        const Case& result, FieldEntry& field) {
  const auto check = [&](const char* key, const char* what,
                         const std::string& name,
                         const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      context.problems.unknown(table.line(key), what, name, known);
    }
  };
  field.films = table.names("films");
  for (const std::string& film : field.films) {
    check("films", "film", film, film_names(result));
  }
  if (const auto body = table.text("body")) {
    field.body = *body;
    check("body", "body", *body, body_names(result));
  }
  if (field.kind != FieldKind::Pressure &&
      table.has("films") == table.has("body")) {
    context.problems.add(
        table.line(),
        fmt::format("{} has {}; expected films (acts per area) or body (acts "
                    "per volume)",
                    table.path(),
                    table.has("films") ? "both films and a body"
                                       : "neither films nor a body"));
  }
}

/// Per area a tension, per volume a pressure.
Quantity read_strength(CaseContext& context, const CaseTable& table) {
  Quantity none{.line = table.line("strength"),
                .key = table.path() + ".strength"};
  const toml::node* node = table.node("strength");
  return node == nullptr ? none
                         : read_quantity(context, *node,
                                         table.has("body") ? Dimension::Pressure
                                                           : Dimension::Tension,
                                         none.key)
                               .value_or(none);
}

void require_frozen_field(CaseContext& context, const FieldEntry& field) {
  std::vector<Quantity> all = {field.strength, field.power, field.core,
                               field.pressure.quantity};
  for (const QuantityVector& v :
       {field.at, field.normal, field.from, field.to}) {
    all.insert(all.end(), v.begin(), v.end());
  }
  for (const QuantityVector& v : field.points) {
    all.insert(all.end(), v.begin(), v.end());
  }
  for (const Quantity& quantity : all) {
    require_frozen(context, quantity, "a field energy");
  }
}

}  // namespace

void read_fields(CaseContext& context, const toml::table& root, Case& result) {
  for (const CaseTable& table : named_tables(context, root, "fields")) {
    FieldEntry field;
    field.name = table.name();
    field.line = table.line();
    const auto kind = table.choice("kind");
    if (!kind) {
      continue;
    }
    field.kind = field_kinds().at(*kind).kind;
    table.check_kind(*kind, field_kinds().at(*kind).keys);
    field.at = table.vector_or_zero("at");
    field.normal = table.vector_or_zero("normal");
    field.from = table.vector_or_zero("from");
    field.to = table.vector_or_zero("to");
    field.points = table.vectors("points");
    field.strength = read_strength(context, table);
    field.power = table.quantity("power").value_or(
        Quantity{.expression = Expression(2.0), .line = table.line()});
    field.core = table.quantity_or_zero("core");
    read_field_targets(context, table, result, field);
    field.pressure = table.place_quantity("pressure").value_or(PlaceQuantity{});
    require_frozen_field(context, field);
    result.fields.push_back(std::move(field));
  }
}

}  // namespace meniscus
