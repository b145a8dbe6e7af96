#include "pipeline/case.h"

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus {

namespace {

/// All names' values at one design: design variables, then parameters. What
/// has no good value is told in `problems` and counts as 0.
class Values {
 public:
  Values(const Case& input, const VectorX& design,
         std::vector<std::string>& problems)
      : input_(input), problems_(problems) {
    if (design.size() != static_cast<Eigen::Index>(input.design.size())) {
      throw InvalidInput(fmt::format("{}: {} design values for {} variables",
                                     input.path, design.size(),
                                     input.design.size()));
    }
    values_.assign(design.begin(), design.end());
    values_.resize(input.design.size() + input.parameters.size(), 0.0);
    for (const int k : input.parameter_order) {
      values_[input.design.size() + static_cast<std::size_t>(k)] =
          at(input.parameters[static_cast<std::size_t>(k)].value);
    }
  }

  double at(const Quantity& quantity) const {
    try {
      return quantity.expression.evaluate(values_);
    } catch (const ExpressionError& error) {
      problems_.push_back(
          fmt::format("{}: {}: {}{}", place(input_, quantity.line),
                      quantity.key, error.what(), where(quantity)));
      return 0.0;
    }
  }

  Vec3 at(const QuantityVector& vector) const {
    return {at(vector[0]), at(vector[1]), at(vector[2])};
  }

  /// The value; when it has one that is not `good`, what it must be is told.
  template <class Condition>
  double at(const Quantity& quantity, const Condition& good,
            const char* must_be) const {
    const std::size_t before = problems_.size();
    const double value = at(quantity);
    if (problems_.size() == before && !good(value)) {
      problems_.push_back(fmt::format(
          "{}: {} is {:g}{}; it must be {}", place(input_, quantity.line),
          quantity.key, value, where(quantity), must_be));
    }
    return value;
  }

  double positive(const Quantity& quantity) const {
    return at(
        quantity, [](double x) { return x > 0.0; }, "above 0");
  }

  /// " where support_x = 3, gap = 2"; nothing for plain numbers.
  template <class... Quantities>
  std::string where(const Quantities&... quantities) const {
    std::vector<char> used(values_.size(), 0);
    (mark(quantities, used), ...);
    std::string text;
    for (std::size_t k = 0; k < used.size(); ++k) {
      if (used[k] != 0) {
        const bool is_design = k < input_.design.size();
        text += fmt::format(
            "{}{} = {:g}", text.empty() ? " where " : ", ",
            is_design ? input_.design[k].name
                      : input_.parameters[k - input_.design.size()].name,
            values_[k]);
      }
    }
    return text;
  }

  std::vector<std::string>& problems() const { return problems_; }

 private:
  static void mark(const Quantity& quantity, std::vector<char>& used) {
    for (const int name : quantity.expression.names_used()) {
      used[static_cast<std::size_t>(name)] = 1;
    }
  }
  template <class Items>
  static void mark(const Items& items, std::vector<char>& used) {
    for (const auto& item : items) {
      mark(item, used);
    }
  }

  const Case& input_;
  std::vector<std::string>& problems_;
  std::vector<double> values_;
};

CurveShape shape_of(const CurveEntry& curve, const Values& values) {
  switch (curve.kind) {
    case CurveKind::Circle:
      return Circle{values.at(curve.center), values.at(curve.normal),
                    values.at(curve.radius)};
    case CurveKind::Ellipse:
      return Ellipse{values.at(curve.center), values.at(curve.normal),
                     values.at(curve.axis), values.at(curve.radius_1),
                     values.at(curve.radius_2)};
    case CurveKind::Rectangle:
      return Rectangle{values.at(curve.center), values.at(curve.normal),
                       values.at(curve.axis),   values.at(curve.width),
                       values.at(curve.height), values.at(curve.corner_radius)};
    case CurveKind::Polygon:
      break;
  }
  Polygon polygon;
  for (const QuantityVector& point : curve.points) {
    polygon.points.push_back(values.at(point));
  }
  return polygon;
}

Curve curve_of(const Case& input, const CurveEntry& entry,
               const Values& values) {
  const std::size_t before = values.problems().size();
  Curve curve{entry.name, shape_of(entry, values)};
  if (values.problems().size() == before) {
    try {
      validate(curve);
    } catch (const InvalidInput& error) {
      values.problems().push_back(fmt::format(
          "{}: {}{}", place(input, entry.line), error.what(),
          values.where(entry.center, entry.normal, entry.axis, entry.radius,
                       entry.radius_1, entry.radius_2, entry.width,
                       entry.height, entry.corner_radius, entry.points)));
    }
  }
  return curve;
}

FilmSystem films_of(const Case& input, const Values& values) {
  FilmSystem system;
  for (const CurveEntry& curve : input.curves) {
    system.curves.push_back(curve_of(input, curve, values));
  }
  for (const FilmEntry& film : input.films) {
    system.films.push_back(film.spec);
    system.films.back().tension = values.positive(film.tension);
  }
  for (const CapEntry& cap : input.caps) {
    system.caps.push_back(cap.spec);
  }
  for (const BodyEntry& body : input.bodies) {
    BodySpec spec{.name = body.name, .enclosed_by = body.enclosed_by};
    if (body.volume) {
      spec.volume = values.positive(*body.volume);
    }
    if (body.pressure) {
      spec.pressure = values.at(*body.pressure);
    }
    system.bodies.push_back(std::move(spec));
  }
  return system;
}

Material material_of(const MaterialEntry& entry, const Values& values) {
  Material material{.name = entry.name};
  material.youngs_modulus = values.positive(entry.youngs_modulus);
  material.poisson_ratio = values.at(
      entry.poisson_ratio, [](double x) { return x > -1.0 && x < 0.5; },
      "above -1 and below 0.5");
  material.density = values.at(
      entry.density, [](double x) { return x >= 0.0; }, "0 or above");
  if (entry.yield_strength) {
    material.yield_strength = values.positive(*entry.yield_strength);
  }
  return material;
}

LoadCase load_case_of(const LoadCaseEntry& entry, const Values& values) {
  LoadCase load_case{.name = entry.name, .supports = entry.supports};
  for (const LoadEntry& load : entry.loads) {
    if (load.force) {
      load_case.forces.push_back({load.surface, values.at(*load.force)});
    } else {
      load_case.pressures.push_back({load.surface, values.at(*load.pressure)});
    }
  }
  return load_case;
}

Vec3 direction_of(const Case& input, const ResponseEntry& response,
                  const Values& values) {
  const std::size_t before = values.problems().size();
  Vec3 direction = values.at(response.direction);
  if (response.kind == ResponseKind::MeanDisplacement &&
      values.problems().size() == before && !(direction.norm() > 0.0)) {
    values.problems().push_back(
        fmt::format("{}: responses.{}.direction has length 0{}; expected any "
                    "other",
                    place(input, response.direction[0].line), response.name,
                    values.where(response.direction)));
  }
  return direction;
}

void throw_first(const std::vector<std::string>& problems) {
  if (!problems.empty()) {
    const std::size_t more = problems.size() - 1;
    throw InvalidInput(problems.front() +
                       (more > 0 ? fmt::format(" (and {} more)", more) : ""));
  }
}

}  // namespace

EvaluatedCase evaluate(const Case& input, const VectorX& design,
                       std::vector<std::string>& problems) {
  const std::size_t before = problems.size();
  const Values values(input, design, problems);
  EvaluatedCase result;
  if (problems.size() > before) {
    return result;  // what follows from a bad parameter is no news
  }
  result.film_system = films_of(input, values);
  for (const BodyEntry& body : input.bodies) {
    result.materials.push_back(material_of(
        input.materials[static_cast<std::size_t>(body.material)], values));
  }
  for (const LoadCaseEntry& entry : input.load_cases) {
    result.load_cases.push_back(load_case_of(entry, values));
  }
  for (const ResponseEntry& response : input.responses) {
    result.response_directions.push_back(direction_of(input, response, values));
  }
  result.fea_edge = input.resolution.fea;
  return result;
}

EvaluatedCase evaluate(const Case& input, const VectorX& design) {
  std::vector<std::string> problems;
  EvaluatedCase result = evaluate(input, design, problems);
  throw_first(problems);
  return result;
}

std::string place(const Case& input, SourceLine line) {
  if (line > 0) {
    return fmt::format("{}:{}", input.path, line);
  }
  return line == 0 ? input.path
                   : fmt::format(
                         "{}: --set {}", input.path,
                         input.overrides[static_cast<std::size_t>(-line - 1)]);
}

std::vector<std::pair<std::string, double>> parameter_values(
    const Case& input, const VectorX& design) {
  std::vector<std::string> problems;
  const Values values(input, design, problems);
  std::vector<std::pair<std::string, double>> result;
  for (const Parameter& parameter : input.parameters) {
    result.emplace_back(parameter.name, values.at(parameter.value));
  }
  throw_first(problems);
  return result;
}

VectorX initial_design(const Case& input) {
  VectorX design(static_cast<Eigen::Index>(input.design.size()));
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    design[static_cast<Eigen::Index>(k)] = input.design[k].initial;
  }
  return design;
}

std::vector<std::string> design_names(const Case& input) {
  std::vector<std::string> names;
  for (const DesignVariable& variable : input.design) {
    names.push_back(variable.name);
  }
  return names;
}

std::vector<std::string> response_names(const Case& input) {
  std::vector<std::string> names;
  for (const ResponseEntry& response : input.responses) {
    names.push_back(response.name);
  }
  return names;
}

Dimension dimension_of(ResponseKind kind) {
  switch (kind) {
    case ResponseKind::MeanDisplacement:
      return Dimension::Length;
    case ResponseKind::Mass:
      return Dimension::Mass;
    case ResponseKind::Volume:
      return Dimension::Volume;
    case ResponseKind::MaxVonMises:
      return Dimension::Pressure;
    case ResponseKind::StrainEnergy:
      return Dimension::Energy;
    case ResponseKind::FilmArea:
      return Dimension::Area;
  }
  return Dimension::None;
}

std::string response_unit(const Case& input, int response) {
  return input.units.unit_of(
      dimension_of(input.responses[static_cast<std::size_t>(response)].kind));
}

}  // namespace meniscus
