#include <algorithm>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

struct FieldRow {
  const char* name;
  case_data::FieldKind kind;
  case_data::KindKeys keys;
};

const std::vector<FieldRow>& field_kinds() {
  const auto pole = [](std::vector<std::string> shape) {
    shape.insert(shape.end(), {"strength", "core"});
    return case_data::KindKeys{std::move(shape), {"power", "films", "body"}};
  };
  static const std::vector<FieldRow> kinds = {
      {"point", case_data::FieldKind::Point, pole({"at"})},
      {"segment", case_data::FieldKind::Segment, pole({"from", "to"})},
      {"polyline", case_data::FieldKind::Polyline, pole({"points"})},
      {"plane", case_data::FieldKind::Plane, pole({"at", "normal"})},
      {"pressure", case_data::FieldKind::Pressure, {{"pressure", "body"}, {}}}};
  return kinds;
}

/// All but the pressure.
std::string pole_names() {
  std::string names;
  for (const FieldRow& row : field_kinds()) {
    if (row.kind != case_data::FieldKind::Pressure) {
      names += (names.empty() ? "" : ", ") + std::string(row.name);
    }
  }
  return names;
}

void read_field_targets(CaseContext& context, const CaseTable& table,
                        const case_data::Case& result,
                        case_data::FieldEntry& field) {
  const auto check = [&](const char* key, const char* what,
                         const std::string& name,
                         const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      context.problems.unknown(table.line(key), what, name, known);
    }
  };
  field.films = table.names("films");
  for (const std::string& film : field.films) {
    check("films", "film", film, case_data::film_names(result));
  }
  if (const auto body = table.text("body")) {
    field.body = *body;
    check("body", "body", *body, case_data::body_names(result));
  }
  if (field.kind != case_data::FieldKind::Pressure &&
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
case_data::Quantity read_strength(CaseContext& context,
                                  const CaseTable& table) {
  case_data::Quantity none{.line = table.line("strength"),
                           .key = table.path() + ".strength"};
  const toml::node* node = table.node("strength");
  return node == nullptr ? none
                         : read_quantity(context, *node,
                                         table.has("body") ? Dimension::Pressure
                                                           : Dimension::Tension,
                                         none.key)
                               .value_or(none);
}

struct SpineCurveRow {
  const char* name;
  bool value;  // is it smooth?
};

const std::vector<SpineCurveRow>& spine_curves() {
  static const std::vector<SpineCurveRow> kinds = {{"spline", true},
                                                   {"polyline", false}};
  return kinds;
}

/// The body that a spine holds: the only one when it names none.
std::string body_of_spine(CaseContext& context, const CaseTable& table,
                          const case_data::Case& result) {
  const std::vector<std::string> known = case_data::body_names(result);
  const auto body = table.text("body");
  if (!body && known.size() != 1) {
    context.problems.add(
        table.line(),
        fmt::format("{} has no body, and the case has {}; expected body = the "
                    "one whose liquid it holds",
                    table.path(), known.size()));
  }
  if (body && std::find(known.begin(), known.end(), *body) == known.end()) {
    context.problems.unknown(table.line("body"), "body", *body, known);
  }
  return body ? *body : known.size() == 1 ? known.front() : "";
}

/// That of the first film around the body.
case_data::Quantity tension_of_spine(CaseContext& context,
                                     const CaseTable& table,
                                     const case_data::Case& result,
                                     const std::string& body) {
  if (const auto own = table.quantity("tension")) {
    return *own;
  }
  for (const case_data::BodyEntry& entry : result.bodies) {
    for (const case_data::FilmEntry& film : result.films) {
      const bool around =
          entry.name == body &&
          std::find(entry.enclosed_by.begin(), entry.enclosed_by.end(),
                    film.spec.name) != entry.enclosed_by.end();
      if (around && film.has_one_tension()) {
        return film.tension.quantity;
      }
    }
  }
  if (!body.empty()) {
    context.problems.add(
        table.line(),
        fmt::format("{} does not know the tension that it holds against: no "
                    "film around body '{}' has one that is a number; expected "
                    "tension = a number",
                    table.path(), body));
  }
  return {.expression = Expression(1.0), .line = table.line()};
}

/// One per point, or one for all, which may know how far along the spine a
/// point is.
void read_radii(CaseContext& context, const CaseTable& table,
                case_data::SpineEntry& spine) {
  const char* const share = "s";
  const bool free = std::find(context.names.begin(), context.names.end(),
                              share) == context.names.end();
  const bool one = table.has("radius") && !table.node("radius")->is_array();
  if (!free || !one) {
    spine.radii = table.quantities("radius");
    return;
  }
  const auto position = static_cast<int>(context.names.size());
  context.names.emplace_back(share);
  context.used.push_back(0);
  spine.radii = table.quantities("radius");
  context.names.pop_back();
  context.used.pop_back();
  const std::vector<int> used = spine.radii.empty()
                                    ? std::vector<int>()
                                    : spine.radii[0].expression.names_used();
  spine.along = !used.empty() && used.back() == position;
}

}  // namespace

TableSpec spine_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "spines",
      true,
      TableNeed::Optional,
      "A line along which a body's liquid is held as an arm, of any length",
      {{"points", K::Vectors, D::Length, true,
        "along it, from one end to the other, two or more"},
       {"kind", K::Choice, D::None, false,
        "through the points: a smooth curve, or straight pieces; spline when "
        "left out",
        case_data::choices_of(spine_curves())},
       {"radius", K::Quantities, D::Length, true,
        "of the arm, above 0; an array gives that at each point, and so does "
        "an "
        "expression of s, from 0 at the first to 1 at the last"},
       {"body", K::Name, D::None, false,
        "whose liquid it holds; the only one when left out"},
       {"tension", K::Quantity, D::Tension, false,
        "that it holds against; that of the body's film when left out"}}};
}

void read_spines(CaseContext& context, const toml::table& root,
                 case_data::Case& result) {
  for (const CaseTable& table : named_tables(context, root, "spines")) {
    case_data::SpineEntry spine{.name = table.name(), .line = table.line()};
    spine.points = table.vectors("points");
    spine.smooth = case_data::row_named(spine_curves(),
                                        table.choice("kind").value_or("spline"))
                       .value;
    read_radii(context, table, spine);
    if (table.has("points") && spine.points.size() < 2) {
      context.problems.add(table.line("points"),
                           fmt::format("{}.points has {}; expected two or more",
                                       table.path(), spine.points.size()));
    }
    if (spine.radii.size() > 1 && spine.radii.size() != spine.points.size()) {
      context.problems.add(
          table.line("radius"),
          fmt::format("{}.radius has {} for {} points; expected one, or as "
                      "many as points",
                      table.path(), spine.radii.size(), spine.points.size()));
      spine.radii.resize(1);
    }
    spine.body = body_of_spine(context, table, result);
    spine.tension = tension_of_spine(context, table, result, spine.body);
    result.spines.push_back(std::move(spine));
  }
}

TableSpec field_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "fields",
      true,
      TableNeed::Optional,
      "A field energy. Poles (" + pole_names() +
          ") at distance d add -strength (1 + (d / core)^2)^(-power / 2) to "
          "the energy per area of films or per volume of a body; a pressure "
          "adds to a body's own. Design variables may move all of it",
      {{"kind", K::Choice, D::None, true, "what acts",
        case_data::choices_of(field_kinds())},
       {"at", K::Vector, D::Length, false, "of point, plane"},
       {"normal", K::Vector, std::nullopt, false, "of plane; any length but 0"},
       {"from", K::Vector, D::Length, false, "of segment"},
       {"to", K::Vector, D::Length, false, "of segment"},
       {"points", K::Vectors, D::Length, false,
        "of polyline, in order; it closes where the last is the first"},
       {"strength", K::Quantity, std::nullopt, false,
        "of poles: energy on the pole per area or volume, above 0 attracts, "
        "below repels. A film whose tension it exceeds crumples there"},
       {"power", K::Quantity, D::None, false,
        "of poles: falls as d^-power far away; 2 when left out"},
       {"core", K::Quantity, D::Length, false,
        "of poles: within it the field is soft"},
       {"films", K::Names, D::None, false,
        "of poles: acts per area of these, or"},
       {"body", K::Name, D::None, false,
        "of poles and pressure: acts per volume of this"},
       {"pressure", K::Field, D::Pressure, false,
        "of pressure: above 0 inflates"}}};
}

void read_fields(CaseContext& context, const toml::table& root,
                 case_data::Case& result) {
  for (const CaseTable& table : named_tables(context, root, "fields")) {
    case_data::FieldEntry field;
    field.name = table.name();
    field.line = table.line();
    const auto kind = table.choice("kind");
    if (!kind) {
      continue;
    }
    const FieldRow& row = case_data::row_named(field_kinds(), *kind);
    field.kind = row.kind;
    table.check_kind(*kind, row.keys);
    field.at = table.vector_or_zero("at");
    field.normal = table.vector_or_zero("normal");
    field.from = table.vector_or_zero("from");
    field.to = table.vector_or_zero("to");
    field.points = table.vectors("points");
    field.strength = read_strength(context, table);
    field.power = table.quantity("power").value_or(case_data::Quantity{
        .expression = Expression(2.0), .line = table.line()});
    field.core = table.quantity_or_zero("core");
    read_field_targets(context, table, result, field);
    field.pressure =
        table.place_quantity("pressure").value_or(case_data::PlaceQuantity{});
    require_space(context, result, field.pressure);
    result.fields.push_back(std::move(field));
  }
}

}  // namespace meniscus::reader
