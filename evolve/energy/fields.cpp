#include "evolve/energy/fields.h"

#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "core/nearest_name.h"

namespace meniscus::energy {

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) {
    throw InvalidInput(message);
  }
}

/// A number in a formula: as it stands, or, of a field that follows a design,
/// by its name. Arithmetic of plain numbers is done at once.
struct Symbol {
  std::string text;
  std::optional<double> value;

  Symbol(double number)  // NOLINT: numbers are symbols
      : text(fmt::format("({})", number)), value(number) {}
  explicit Symbol(std::string formula) : text(std::move(formula)) {}
};

template <class Function>
Symbol combined(const Symbol& a, const char* sign, const Symbol& b,
                const Function& of) {
  return a.value && b.value
             ? Symbol(of(*a.value, *b.value))
             : Symbol(fmt::format("({}{}{})", a.text, sign, b.text));
}
Symbol operator+(const Symbol& a, const Symbol& b) {
  return combined(a, "+", b, std::plus<>());
}
Symbol operator-(const Symbol& a, const Symbol& b) {
  return combined(a, "-", b, std::minus<>());
}
Symbol operator*(const Symbol& a, const Symbol& b) {
  return combined(a, "*", b, std::multiplies<>());
}
Symbol operator/(const Symbol& a, const Symbol& b) {
  return combined(a, "/", b, std::divides<>());
}

using Symbols = std::array<Symbol, 3>;

template <class Function>
Symbols each_of(const Symbols& a, const Symbols& b, const Function& of) {
  return {of(a[0], b[0]), of(a[1], b[1]), of(a[2], b[2])};
}
Symbol product(const Symbols& a, const Symbols& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Symbol size_of(const Symbols& v) {
  const Symbol square = product(v, v);
  return square.value ? Symbol(std::sqrt(*square.value))
                      : Symbol(fmt::format("sqrt{}", square.text));
}
Symbols unit_of(const Symbols& v) {
  const Symbol size = size_of(v);
  return {v[0] / size, v[1] / size, v[2] / size};
}

/// direction . (x, y, z) + shift.
std::string linear(const Symbols& direction, const Symbol& shift) {
  return fmt::format("({}*x+{}*y+{}*z+{})", direction[0].text,
                     direction[1].text, direction[2].text, shift.text);
}

std::string square_from(const Symbols& at) {
  return fmt::format("sqr(x-{})+sqr(y-{})+sqr(z-{})", at[0].text, at[1].text,
                     at[2].text);
}

/// |x - c|^2 less the part along the segment that lies within it. With h along
/// the segment from its middle c: - h^2 + max(|h| - half, 0)^2.
std::string square_from_segment(const Symbols& from, const Symbols& to) {
  const Symbols middle = each_of(
      from, to, [](const Symbol& a, const Symbol& b) { return 0.5 * (a + b); });
  const Symbols along =
      each_of(from, to, [](const Symbol& a, const Symbol& b) { return b - a; });
  const Symbol half = 0.5 * size_of(along);
  const Symbols way = unit_of(along);
  const std::string h = linear(way, 0.0 - product(way, middle));
  return fmt::format("{}-sqr{}+sqr(max(abs{}-{},0))", square_from(middle), h, h,
                     half.text);
}

/// The numbers of a field one after the other, by their values or by names.
class FieldNumbers {
 public:
  void by_name(bool is_so) { by_name_ = is_so; }

  Symbol next(double value) {
    if (!by_name_) {
      return value;
    }
    numbers_.push_back(value);
    names_.push_back(fmt::format("n{}", numbers_.size()));
    return Symbol(names_.back());
  }
  Symbols next(const Vec3& v) {
    // In this order, which a list of calls would not promise everywhere.
    const Symbol x = next(v.x());
    const Symbol y = next(v.y());
    const Symbol z = next(v.z());
    return {x, y, z};
  }
  const std::vector<std::string>& names() const { return names_; }
  VectorX numbers() const {
    return Eigen::Map<const VectorX>(numbers_.data(), std::ssize(numbers_));
  }

 private:
  bool by_name_ = false;
  std::vector<std::string> names_;
  std::vector<double> numbers_;
};

struct SquareDistance {
  FieldNumbers& numbers;

  std::string operator()(const films::PointPole& pole) const {
    return square_from(numbers.next(pole.at));
  }
  std::string operator()(const films::SegmentPole& pole) const {
    const Symbols from = numbers.next(pole.from);
    return square_from_segment(from, numbers.next(pole.to));
  }
  std::string operator()(const films::PolylinePole& pole) const {
    std::string text;
    std::optional<Symbols> before;
    for (const Vec3& point : pole.points) {
      const Symbols here = numbers.next(point);
      if (before) {
        const std::string more = square_from_segment(*before, here);
        text = text.empty() ? more : fmt::format("min({},{})", more, text);
      }
      before = here;
    }
    return text;
  }
  std::string operator()(const films::PlanePole& pole) const {
    const Symbols at = numbers.next(pole.at);
    const Symbols normal = unit_of(numbers.next(pole.normal));
    return "sqr" + linear(normal, 0.0 - product(normal, at));
  }
};

struct CheckPole {
  const films::FieldSpec& field;

  void operator()(const films::PointPole& pole) const { check(pole.at); }
  void operator()(const films::SegmentPole& pole) const {
    segment(pole.from, pole.to);
  }
  void operator()(const films::PolylinePole& pole) const {
    require(pole.points.size() >= 2,
            fmt::format("field '{}': a polyline needs two points or more, "
                        "found {}",
                        field.name, pole.points.size()));
    for (std::size_t i = 1; i < pole.points.size(); ++i) {
      segment(pole.points[i - 1], pole.points[i]);
    }
  }
  void operator()(const films::PlanePole& pole) const {
    check(pole.at);
    check(pole.normal);
    require(
        pole.normal.norm() > 0.0,
        fmt::format("field '{}': the plane's normal has length 0", field.name));
  }

 private:
  void check(const Vec3& v) const {
    require(v.allFinite(), fmt::format("field '{}': its place ({}, {}, {}) is "
                                       "not finite",
                                       field.name, v.x(), v.y(), v.z()));
  }
  void segment(const Vec3& from, const Vec3& to) const {
    check(from);
    check(to);
    require((to - from).norm() > 0.0,
            fmt::format("field '{}': a segment at ({}, {}, {}) has length 0; "
                        "use a point or drop the repeated point",
                        field.name, from.x(), from.y(), from.z()));
  }
};

/// Formula and numbers, unchecked: rates are numbers too.
std::string formula_of(const films::FieldSpec& field, FieldNumbers& numbers) {
  const bool moves = field.moves || field.place_moves;
  numbers.by_name(moves);
  const Symbol strength = numbers.next(field.strength);
  const Symbol power = numbers.next(field.power);
  const Symbol core = numbers.next(field.core);
  numbers.by_name(field.place_moves);
  const std::string square = std::visit(SquareDistance{numbers}, field.shape);
  return fmt::format("{}*(1+({})/{})^{}", (0.0 - strength).text, square,
                     (core * core).text, (-0.5 * power).text);
}

template <typename Named>
int find_name(const std::vector<Named>& all, const std::string& name,
              const std::string& what) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) {
      return static_cast<int>(i);
    }
    names.push_back(all[i].name);
  }
  const std::string near = nearest_name(name, names);
  throw InvalidInput(fmt::format(
      "{} '{}' does not exist{}", what, name,
      near.empty() ? std::string() : fmt::format("; nearest: '{}'", near)));
}

/// Where rays to a body's surface best start.
struct PoleOrigin {
  Vec3 operator()(const films::PointPole& pole) const { return pole.at; }
  Vec3 operator()(const films::SegmentPole& pole) const {
    return 0.5 * (pole.from + pole.to);
  }
  Vec3 operator()(const films::PolylinePole& pole) const {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : pole.points) {
      sum += p;
    }
    return sum / static_cast<double>(pole.points.size());
  }
  Vec3 operator()(const films::PlanePole& pole) const { return pole.at; }
};

films::FilmQuantity body_integral(const films::FilmComplex& complex,
                                  const std::string& name,
                                  const std::string& body) {
  films::FilmQuantity quantity{name, films::FilmQuantity::Role::Energy,
                               films::FilmQuantity::Kind::BodyScalarIntegral};
  require(!complex.bodies.empty(),
          fmt::format("field '{}' acts per volume, but there is no body; "
                      "name the surfaces of one or act per area",
                      name));
  if (!body.empty()) {
    quantity.body =
        find_name(complex.bodies, body, fmt::format("field '{}': body", name));
  }
  return quantity;
}

/// Of a pole that moves: points that have their mean where rays best start.
struct PolePoints {
  int operator()(const films::PointPole& /*pole*/) const { return 1; }
  int operator()(const films::SegmentPole& /*pole*/) const { return 2; }
  int operator()(const films::PolylinePole& pole) const {
    return static_cast<int>(pole.points.size());
  }
  int operator()(const films::PlanePole& /*pole*/) const { return 1; }
};

/// Rays of a smooth scalar: from the middle of the films, on all plane walls
/// where there are some, for these close bodies only at the end and the flux of
/// F through a plane on which the rays begin is 0.
films::RayOrigin amid(const films::FilmComplex& complex,
                      const PlaceField& scalar) {
  films::RayOrigin origin{.is_pole = false};
  const Points& points = complex.mesh.points;
  if (points.empty()) {
    return origin;
  }
  origin.at = mean_of(points);
  Eigen::MatrixX3d normals(std::ssize(complex.level_sets), 3);
  VectorX off(std::ssize(complex.level_sets));
  Eigen::Index planes = 0;
  for (const films::LevelSet& wall : complex.level_sets) {
    if (!wall.bent) {
      const PlaceJet jet = jet_at(wall.formula, origin.at);
      normals.row(planes) = jet.gradient.transpose();
      off[planes++] = -jet.value;
    }
  }
  if (planes > 0) {
    origin.at +=
        normals.topRows(planes).completeOrthogonalDecomposition().solve(
            off.head(planes));
  }
  // A ray crosses so many bumps of the scalar's shapes.
  constexpr double kSpan = 3.0;  // their distance
  double reach = 0.0;
  for (const Vec3& p : points) {
    reach = std::max(reach, (p - origin.at).norm());
  }
  for (const auto& shape : scalar.shapes) {
    origin.spans = std::max(origin.spans,
                            static_cast<int>(std::ceil(std::min(
                                reach / (kSpan * shape->spacing()), 100.0))));
  }
  return origin;
}

/// s - offset along the direction.
}  // namespace

Expression place_expression(const std::string& text) {
  try {
    return Expression::parse(text, {"x", "y", "z"});
  } catch (const ExpressionError& error) {
    throw InvalidInput(fmt::format("expression '{}', column {}: {}",
                                   text.substr(0, 80), error.column(),
                                   error.what()));
  }
}

PlaceField place_field(const films::FieldSpec& field) {
  require(std::isfinite(field.strength),
          fmt::format("field '{}': its strength {} is not finite", field.name,
                      field.strength));
  require(std::isfinite(field.power) && field.power > 0.0,
          fmt::format("field '{}': its power {} must be above 0", field.name,
                      field.power));
  require(std::isfinite(field.core) && field.core > 0.0,
          fmt::format("field '{}': its core {} must be a length above 0",
                      field.name, field.core));
  std::visit(CheckPole{field}, field.shape);
  FieldNumbers numbers;
  const std::string text = formula_of(field, numbers);
  std::vector<std::string> names = {"x", "y", "z"};
  names.insert(names.end(), numbers.names().begin(), numbers.names().end());
  try {
    PlaceField result = Expression::parse(text, names);
    result.names = numbers.names();
    result.numbers = numbers.numbers();
    return result;
  } catch (const ExpressionError& error) {
    throw InvalidInput(fmt::format(
        "field '{}': its formula of {} characters cannot be used ({}); sample "
        "the curve by fewer points",
        field.name, text.size(), error.what()));
  }
}

VectorX field_numbers(const films::FieldSpec& field) {
  if (!field.moves && !field.place_moves) {
    return {};
  }
  FieldNumbers numbers;
  formula_of(field, numbers);
  return numbers.numbers();
}

films::FilmQuantity field_quantity(const films::FilmComplex& complex,
                                   const films::FieldSpec& field) {
  const PlaceField phi = place_field(field);
  if (const auto* per = std::get_if<films::PerVolume>(&field.per)) {
    films::FilmQuantity quantity =
        body_integral(complex, field.name, per->body);
    quantity.scalar = phi;
    quantity.origin.at = std::visit(PoleOrigin{}, field.shape);
    quantity.origin.moving_points =
        field.place_moves ? std::visit(PolePoints{}, field.shape) : 0;
    return quantity;
  }
  films::FilmQuantity quantity{field.name, films::FilmQuantity::Role::Energy,
                               films::FilmQuantity::Kind::ScalarIntegral};
  quantity.scalar = phi;
  for (const std::string& name : std::get<films::PerArea>(field.per).surfaces) {
    quantity.surfaces.push_back(
        find_name(complex.surfaces, name,
                  fmt::format("field '{}': surface", field.name)));
  }
  for (std::size_t s = 0; s < complex.surfaces.size() &&
                          std::get<films::PerArea>(field.per).surfaces.empty();
       ++s) {
    if (complex.surfaces[s].liquid) {
      quantity.surfaces.push_back(static_cast<int>(s));
    }
  }
  require(
      !quantity.surfaces.empty(),
      fmt::format("field '{}': there is no liquid film to act on", field.name));
  return quantity;
}

films::FilmQuantity pressure_quantity(const films::FilmComplex& complex,
                                      const std::string& name,
                                      const std::string& body,
                                      const PlaceField& pressure) {
  films::FilmQuantity quantity = body_integral(complex, name, body);
  quantity.scalar = pressure;
  quantity.origin = amid(complex, pressure);
  quantity.modulus = -1.0;
  return quantity;
}

}  // namespace meniscus::energy
