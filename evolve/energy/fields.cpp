#include "evolve/energy/fields.h"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/nearest_name.h"

namespace meniscus::energy {

namespace {

void require(bool holds, const std::string& message) {
  if (!holds) {
    throw InvalidInput(message);
  }
}

/// direction . (x, y, z) + shift.
std::string linear(const Vec3& direction, double shift) {
  return fmt::format("(({})*x+({})*y+({})*z+({}))", direction.x(),
                     direction.y(), direction.z(), shift);
}

std::string square_from(const Vec3& at) {
  return fmt::format("sqr(x-({}))+sqr(y-({}))+sqr(z-({}))", at.x(), at.y(),
                     at.z());
}

/// |x - c|^2 less the part along the segment that lies within it. With h along
/// the segment from its middle c: - h^2 + max(|h| - half, 0)^2.
std::string square_from_segment(const Vec3& from, const Vec3& to) {
  const Vec3 middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from).norm();
  const Vec3 way = (to - from) / (2.0 * half);
  const std::string h = linear(way, -way.dot(middle));
  return fmt::format("{}-sqr{}+sqr(max(abs{}-({}),0))", square_from(middle), h,
                     h, half);
}

struct SquareDistance {
  const films::FieldSpec& field;

  std::string operator()(const films::PointPole& pole) const {
    check(pole.at);
    return square_from(pole.at);
  }
  std::string operator()(const films::SegmentPole& pole) const {
    return segment(pole.from, pole.to);
  }
  std::string operator()(const films::PolylinePole& pole) const {
    require(pole.points.size() >= 2,
            fmt::format("field '{}': a polyline needs two points or more, "
                        "found {}",
                        field.name, pole.points.size()));
    std::string text = segment(pole.points[0], pole.points[1]);
    for (std::size_t i = 2; i < pole.points.size(); ++i) {
      text = fmt::format("min({},{})",
                         segment(pole.points[i - 1], pole.points[i]), text);
    }
    return text;
  }
  std::string operator()(const films::PlanePole& pole) const {
    check(pole.at);
    check(pole.normal);
    require(
        pole.normal.norm() > 0.0,
        fmt::format("field '{}': the plane's normal has length 0", field.name));
    const Vec3 normal = pole.normal.normalized();
    return "sqr" + linear(normal, -normal.dot(pole.at));
  }

 private:
  void check(const Vec3& v) const {
    require(v.allFinite(), fmt::format("field '{}': its place ({}, {}, {}) is "
                                       "not finite",
                                       field.name, v.x(), v.y(), v.z()));
  }
  std::string segment(const Vec3& from, const Vec3& to) const {
    check(from);
    check(to);
    require((to - from).norm() > 0.0,
            fmt::format("field '{}': a segment at ({}, {}, {}) has length 0; "
                        "use a point or drop the repeated point",
                        field.name, from.x(), from.y(), from.z()));
    return square_from_segment(from, to);
  }
};

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

/// s - offset along the direction.
std::string past(const Vec3& direction, double offset, double power) {
  const double length = direction.norm();
  require(std::isfinite(length) && length > 0.0,
          fmt::format("Macaulay bracket: the direction ({}, {}, {}) has no "
                      "length above 0",
                      direction.x(), direction.y(), direction.z()));
  require(std::isfinite(offset) && std::isfinite(power) && power >= 0.0,
          fmt::format("Macaulay bracket: offset {} and power {} must be "
                      "finite, the power not below 0",
                      offset, power));
  return linear(direction / length, -offset);
}

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

Expression field_expression(const films::FieldSpec& field) {
  require(std::isfinite(field.strength),
          fmt::format("field '{}': its strength {} is not finite", field.name,
                      field.strength));
  require(std::isfinite(field.power) && field.power > 0.0,
          fmt::format("field '{}': its power {} must be above 0", field.name,
                      field.power));
  require(std::isfinite(field.core) && field.core > 0.0,
          fmt::format("field '{}': its core {} must be a length above 0",
                      field.name, field.core));
  const std::string square = std::visit(SquareDistance{field}, field.shape);
  const std::string text =
      fmt::format("({})*(1+({})/({}))^({})", -field.strength, square,
                  field.core * field.core, -0.5 * field.power);
  try {
    return Expression::parse(text, {"x", "y", "z"});
  } catch (const ExpressionError& error) {
    throw InvalidInput(fmt::format(
        "field '{}': its formula of {} characters cannot be used ({}); sample "
        "the curve by fewer points",
        field.name, text.size(), error.what()));
  }
}

films::FilmQuantity field_quantity(const films::FilmComplex& complex,
                                   const films::FieldSpec& field) {
  const Expression phi = field_expression(field);
  if (const auto* per = std::get_if<films::PerVolume>(&field.per)) {
    films::FilmQuantity quantity =
        body_integral(complex, field.name, per->body);
    quantity.scalar = phi;
    quantity.origin = std::visit(PoleOrigin{}, field.shape);
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
                                      const Expression& pressure) {
  films::FilmQuantity quantity = body_integral(complex, name, body);
  quantity.scalar = pressure;
  quantity.modulus = -1.0;
  return quantity;
}

std::string macaulay(const Vec3& direction, double offset, double power) {
  const std::string s = past(direction, offset, power);
  return power == 0.0 ? fmt::format("({}>=0)", s)
                      : fmt::format("if({}>0,{}^({}),0)", s, s, power);
}

std::string smooth_macaulay(const Vec3& direction, double offset, double power,
                            double width) {
  require(std::isfinite(width) && width > 0.0,
          fmt::format("Macaulay bracket: its width {} must be a length above 0",
                      width));
  const std::string s = past(direction, offset, power);
  const double square = width * width;
  const std::string root = fmt::format("sqrt(sqr{}+({}))", s, square);
  if (power == 0.0) {
    return fmt::format("0.5*(1+{}/{})", s, root);
  }
  // Below the corner the same number without the difference of near equals.
  return fmt::format("if({}>0,0.5*({}+{}),({})/({}-{}))^({})", s, s, root,
                     0.5 * square, root, s, power);
}

}  // namespace meniscus::energy
