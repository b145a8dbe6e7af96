/// Shapes of fields: smooth functions of place that tensions and pressures may
/// be made of, their coefficients design variables. Part of the case-file
/// reader.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/place_shape.h"
#include "evolve/walls/rim_shape.h"
#include "pipeline/case_data/case_kinds.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

enum class ShapeKind { Box, Axis, Radial, Rims };

struct ShapeRow {
  const char* name;
  ShapeKind kind;
  case_data::KindKeys keys;
  std::size_t counts;  // that it takes
};

const std::vector<ShapeRow>& shape_kinds() {
  static const std::vector<ShapeRow> kinds = {
      {"box", ShapeKind::Box, {{"from", "to", "coefficients"}, {"counts"}}, 3},
      {"axis",
       ShapeKind::Axis,
       {{"from", "to", "coefficients"}, {"counts", "zero"}},
       2},
      {"radial",
       ShapeKind::Radial,
       {{"points", "coefficients"}, {"counts", "width"}},
       1},
      {"rims",
       ShapeKind::Rims,
       {{"curves", "coefficients"}, {"counts", "zero"}},
       2}};
  return kinds;
}

/// The vector that `coefficients` names, or null.
const case_data::DesignVector* named_vector(const CaseTable& table,
                                            const case_data::Case& result) {
  const toml::node* node = table.node("coefficients");
  const auto* text = node != nullptr ? node->as_string() : nullptr;
  const auto found =
      std::find_if(result.vectors.begin(), result.vectors.end(),
                   [&](const case_data::DesignVector& v) {
                     return text != nullptr && v.name == text->get();
                   });
  return found == result.vectors.end() ? nullptr : &*found;
}

/// As many as the kind takes: counts, else the vector's shape, else 1 each.
std::vector<int> read_counts(CaseContext& context, const CaseTable& table,
                             std::size_t wanted,
                             const case_data::DesignVector* vector) {
  std::vector<int> counts = read_shape(context, table, "counts");
  const bool of_vector = counts.empty() && vector != nullptr;
  if (of_vector) {
    counts = vector->shape;
  } else if (vector != nullptr && counts != vector->shape &&
             counts.size() == vector->shape.size()) {
    context.problems.add(
        table.line("counts"),
        fmt::format("{}.counts are [{}], and '{}' has the shape [{}]; expected "
                    "the same",
                    table.path(), fmt::join(counts, ", "), vector->name,
                    fmt::join(vector->shape, ", ")));
  }
  if (counts.size() > wanted) {
    context.problems.add(
        table.line(),
        fmt::format(
            "{} has counts [{}]{}; this kind takes {}", table.path(),
            fmt::join(counts, ", "),
            of_vector ? fmt::format(", the shape of '{}'", vector->name) : "",
            wanted));
  }
  counts.resize(wanted, 1);
  return counts;
}

Points constant_points(CaseContext& context, const CaseTable& table) {
  std::vector<double> values(context.names.size(), 0.0);
  for (std::size_t k = 0; k < context.constants.size(); ++k) {
    values[k] = context.constants[k].value_or(0.0);
  }
  Points points;
  for (const case_data::QuantityVector& vector : table.vectors("points")) {
    Vec3& point = points.emplace_back();
    for (int m = 0; m < 3; ++m) {
      require_frozen(context, vector[m], "a shape of fields");
      try {
        point[m] = vector[m].expression.evaluate(values);
      } catch (const ExpressionError& error) {
        context.problems.add(
            vector[m].line, fmt::format("{}: {}", vector[m].key, error.what()));
      }
    }
  }
  return points;
}

/// `count` points along the straight pieces between `points`, evenly.
Points points_along(const Points& points, int count) {
  std::vector<double> along = {0.0};
  for (std::size_t k = 1; k < points.size(); ++k) {
    along.push_back(along.back() + (points[k] - points[k - 1]).norm());
  }
  Points result;
  std::size_t piece = 1;
  for (int i = 0; i < count; ++i) {
    const double s = along.back() * i / std::max(count - 1, 1);
    while (piece + 1 < points.size() && along[piece] < s) {
      ++piece;
    }
    const double length = along[piece] - along[piece - 1];
    const double t = length > 0.0 ? (s - along[piece - 1]) / length : 0.0;
    result.push_back((1.0 - t) * points[piece - 1] + t * points[piece]);
  }
  return result;
}

std::shared_ptr<const PlaceShape> radial_shape(CaseContext& context,
                                               const CaseTable& table,
                                               int count) {
  RadialShape shape{.points = constant_points(context, table)};
  if (shape.points.empty()) {
    return nullptr;  // told
  }
  if (table.has("counts")) {
    if (shape.points.size() < 2) {
      context.problems.add(table.line("counts"),
                           fmt::format("{}.counts spreads along its points; "
                                       "expected two or more of these",
                                       table.path()));
      return nullptr;
    }
    shape.points = points_along(shape.points, count);
  }
  shape.width = table.constant("width").value_or(usual_width(shape.points));
  return radial_functions(shape);
}

std::shared_ptr<const PlaceShape> rim_shape(CaseContext& context,
                                            const CaseTable& table,
                                            const std::vector<int>& counts) {
  const std::size_t before = context.problems.size();
  const std::vector<std::string> curves = table.names("curves");
  if (context.problems.size() > before || !table.has("curves")) {
    return nullptr;  // told
  }
  if (curves.size() != 2) {
    context.problems.add(
        table.line("curves"),
        fmt::format("{}.curves has {}; expected two, from one to the other",
                    table.path(), curves.size()));
    return nullptr;
  }
  return walls::rim_splines({.first = curves[0],
                             .second = curves[1],
                             .along = counts[0],
                             .around = counts[1],
                             .zero = table.constant_vector("zero")});
}

std::shared_ptr<const PlaceShape> make_shape(CaseContext& context,
                                             const CaseTable& table,
                                             const ShapeRow& row,
                                             const std::vector<int>& counts) {
  const std::size_t before = context.problems.size();
  const Vec3 from = table.constant_vector("from").value_or(Vec3::Zero());
  const Vec3 to = table.constant_vector("to").value_or(Vec3::UnitZ());
  const Vec3 zero = table.constant_vector("zero").value_or(
      (to - from).cross(Vec3::UnitX()).squaredNorm() >
              1e-6 * (to - from).squaredNorm()
          ? Vec3::UnitX()
          : Vec3::UnitY());
  try {
    switch (row.kind) {
      case ShapeKind::Radial:
        return radial_shape(context, table, counts[0]);
      case ShapeKind::Box:
        if (context.problems.size() > before) {
          return nullptr;
        }
        return box_splines({from, to, {counts[0], counts[1], counts[2]}});
      case ShapeKind::Axis:
        if (context.problems.size() > before) {
          return nullptr;
        }
        return axis_splines({from, to, zero, counts[0], counts[1]});
      case ShapeKind::Rims:
        return rim_shape(context, table, counts);
    }
  } catch (const InvalidInput& error) {
    context.problems.add(table.line(),
                         fmt::format("{}: {}", table.path(), error.what()));
  }
  return nullptr;
}

std::vector<case_data::Quantity> read_coefficients(
    CaseContext& context, const CaseTable& table,
    const case_data::DesignVector* vector, std::size_t wanted) {
  std::vector<case_data::Quantity> result;
  if (vector != nullptr) {
    for (std::size_t k = vector->first; k < vector->first + vector->size();
         ++k) {
      result.push_back(
          {.expression = Expression::parse(context.names[k], context.names),
           .line = table.line("coefficients"),
           .key = table.path() + ".coefficients",
           .measure =
               k < context.measures.size() ? context.measures[k] : Measure{}});
    }
  } else {
    result = table.quantities("coefficients");
  }
  if (result.size() == 1) {
    result.resize(wanted, result.front());
  }
  if (!result.empty() && result.size() != wanted) {
    context.problems.add(
        table.line("coefficients"),
        fmt::format("{}.coefficients has {}; the shape takes {}: expected as "
                    "many, or one for all",
                    table.path(), result.size(), wanted));
    result.clear();
  }
  return result;
}

void check_shape_name(CaseContext& context, const CaseTable& table) {
  const auto is_taken = [&](const std::string& name) {
    return name.substr(0, name.find('[')) == table.name();
  };
  static const std::set<std::string> letters = {"i", "j", "k"};  // of repeat
  if (is_reserved_name(table.name()) || letters.count(table.name()) > 0 ||
      std::any_of(context.names.begin(), context.names.end(), is_taken)) {
    context.problems.add(table.line(),
                         fmt::format("'{}' is a name that expressions know "
                                     "already; choose another",
                                     table.name()));
  }
}

}  // namespace

void require_space(CaseContext& context, const case_data::Case& result,
                   const case_data::PlaceQuantity& quantity) {
  const std::size_t first = context.names.size() + 3;  // after x, y, z
  for (const int name : quantity.quantity.expression.names_used()) {
    const auto k = static_cast<std::size_t>(name);
    if (k >= first && k - first < result.shapes.size() &&
        result.shapes[k - first].shape != nullptr &&
        walls::rim_splines_of(*result.shapes[k - first].shape) != nullptr) {
      context.problems.add(
          quantity.quantity.line,
          fmt::format("{}: shape '{}' is of kind rims, which follows a film's "
                      "points and is for a wall's thickness; a liquid's "
                      "tension and pressure are of places: expected kind box, "
                      "axis or radial",
                      quantity.quantity.key, result.shapes[k - first].name));
    }
  }
}

void check_rim_shapes(CaseContext& context, const case_data::Case& result) {
  std::vector<std::string> known;
  for (const case_data::CurveEntry& curve : result.curves) {
    known.push_back(curve.name);
  }
  for (const case_data::ShapeEntry& entry : result.shapes) {
    const walls::RimSplines* splines =
        entry.shape != nullptr ? walls::rim_splines_of(*entry.shape) : nullptr;
    for (const std::string& curve :
         splines != nullptr
             ? std::vector<std::string>{splines->first, splines->second}
             : std::vector<std::string>()) {
      const auto at = std::find(known.begin(), known.end(), curve);
      if (at == known.end()) {
        context.problems.unknown(entry.line, "curve", curve, known);
      } else if (result.curves[static_cast<std::size_t>(at - known.begin())]
                     .is_free_somewhere()) {
        context.problems.add(
            entry.line,
            fmt::format("shapes.{} begins or ends at curve '{}', which is "
                        "free; name curves that hold films",
                        entry.name, curve));
      }
    }
  }
}

TableSpec shape_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "shapes",
      true,
      TableNeed::Optional,
      "A smooth function of place, sum of coefficient times bump, that "
      "expressions of a film's tension, of a pressure and of a wall's "
      "thickness know by its name. It "
      "lies between its least and largest coefficient; away from the bumps "
      "the nearest coefficient goes on",
      {{"kind", K::Choice, D::None, true,
        "where the bumps stand: evenly in a box, along and around an axis, "
        "about points, or, for a wall's thickness alone, from one rim of its "
        "films to another and around",
        case_data::choices_of(shape_kinds())},
       {"coefficients", K::Quantities, std::nullopt, true,
        "one per bump, the last of the counts running fastest: the name of a "
        "design vector, or numbers and expressions; one for all"},
       {"from", K::ConstantVector, D::Length, false,
        "of box: its corner of least x, y, z; of axis: where it starts"},
       {"to", K::ConstantVector, D::Length, false,
        "of box: the opposite corner; of axis: where it ends"},
       {"counts", K::Shape, D::None, false,
        "of box: along x, y, z; of axis: along and around it, where the axis "
        "itself has no value with more than one around; of rims: from the one "
        "to the other and around; of radial: so "
        "many, evenly along the path of the points. Left out: the shape of the "
        "vector, of radial the points"},
       {"zero", K::ConstantVector, std::nullopt, false,
        "of axis and rims: the direction of the first bump around. Left out: "
        "of "
        "axis x, or y, of rims where the first curve starts"},
       {"curves", K::Names, D::None, false,
        "of rims: two, where films of the wall end. The bumps follow the "
        "film's own harmonic coordinates: 0 on the first curve, 1 on the "
        "second, and the angle, the way of the first"},
       {"points", K::Vectors, D::Length, false, "of radial: the bumps'"},
       {"width", K::Constant, D::Length, false,
        "of radial: exp(-d^2 / (2 width^2)); the mean distance to the nearest "
        "other point when left out"}}};
}

void read_shapes(CaseContext& context, const toml::table& root,
                 case_data::Case& result) {
  for (const CaseTable& table : named_tables(context, root, "shapes")) {
    // Known even where something is wrong: its users are not to be told too.
    context.shapes.push_back(table.name());
    case_data::ShapeEntry& entry = result.shapes.emplace_back();
    entry.name = table.name();
    entry.line = table.line();
    check_shape_name(context, table);
    const auto kind = table.choice("kind");
    if (!kind) {
      continue;
    }
    const ShapeRow& row = case_data::row_named(shape_kinds(), *kind);
    table.check_kind(*kind, row.keys);
    const case_data::DesignVector* vector = named_vector(table, result);
    entry.shape = make_shape(context, table, row,
                             read_counts(context, table, row.counts, vector));
    if (entry.shape != nullptr) {
      entry.coefficients = read_coefficients(
          context, table, vector,
          static_cast<std::size_t>(entry.shape->coefficients()));
    }
  }
}

}  // namespace meniscus::reader
