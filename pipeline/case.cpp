#include "pipeline/case.h"

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus {

namespace {

/// All names' values at one design: design variables, then parameters.
class Values {
 public:
  Values(const Case& input, const VectorX& design) : input_(input) {
    if (design.size() != static_cast<Eigen::Index>(input.design.size())) {
      throw InvalidInput(fmt::format("{}: {} design values for {} variables",
                                     input.path, design.size(),
                                     input.design.size()));
    }
    values_.assign(design.begin(), design.end());
    values_.resize(input.design.size() + input.parameters.size(), 0.0);
    for (const int k : input.parameter_order) {
      values_[input.design.size() + k] = at(input.parameters[k].value);
    }
  }

  double at(const Quantity& quantity) const {
    try {
      return quantity.expression.evaluate(values_);
    } catch (const ExpressionError& error) {
      throw InvalidInput(fmt::format("{}:{}: {}: {}{}", input_.path,
                                     quantity.line, quantity.key, error.what(),
                                     where(quantity.expression)));
    }
  }

  Vec3 at(const QuantityVector& vector) const {
    return {at(vector[0]), at(vector[1]), at(vector[2])};
  }

 private:
  std::string where(const Expression& expression) const {
    std::string text;
    for (const int name : expression.names_used()) {
      const auto k = static_cast<std::size_t>(name);
      const bool is_design = k < input_.design.size();
      text += fmt::format(
          "{}{} = {:g}", text.empty() ? " where " : ", ",
          is_design ? input_.design[k].name
                    : input_.parameters[k - input_.design.size()].name,
          values_[k]);
    }
    return text;
  }

  const Case& input_;
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

FilmSystem films_of(const Case& input, const Values& values) {
  FilmSystem system;
  for (const CurveEntry& curve : input.curves) {
    system.curves.push_back({curve.name, shape_of(curve, values)});
    try {
      validate(system.curves.back());
    } catch (const InvalidInput& error) {
      throw InvalidInput(
          fmt::format("{}:{}: {}", input.path, curve.line, error.what()));
    }
  }
  for (const FilmEntry& film : input.films) {
    system.films.push_back(film.spec);
    system.films.back().tension = values.at(film.tension);
    if (!(system.films.back().tension > 0.0)) {
      throw InvalidInput(fmt::format(
          "{}:{}: films.{}.tension is {:g}; it must be above 0", input.path,
          film.tension.line, film.spec.name, system.films.back().tension));
    }
  }
  for (const CapEntry& cap : input.caps) {
    system.caps.push_back(cap.spec);
  }
  for (const BodyEntry& body : input.bodies) {
    BodySpec spec{.name = body.name, .enclosed_by = body.enclosed_by};
    if (body.volume) {
      spec.volume = values.at(*body.volume);
      if (!(*spec.volume > 0.0)) {
        throw InvalidInput(fmt::format(
            "{}:{}: bodies.{}.volume is {:g}; it must be above 0", input.path,
            body.volume->line, body.name, *spec.volume));
      }
    }
    if (body.pressure) {
      spec.pressure = values.at(*body.pressure);
    }
    system.bodies.push_back(std::move(spec));
  }
  return system;
}

Material material_of(const MaterialEntry& entry, const Values& values) {
  Material material{.name = entry.name,
                    .youngs_modulus = values.at(entry.youngs_modulus),
                    .poisson_ratio = values.at(entry.poisson_ratio),
                    .density = values.at(entry.density)};
  if (entry.yield_strength) {
    material.yield_strength = values.at(*entry.yield_strength);
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

}  // namespace

EvaluatedCase evaluate(const Case& input, const VectorX& design) {
  const Values values(input, design);
  EvaluatedCase result;
  result.film_system = films_of(input, values);
  for (const BodyEntry& body : input.bodies) {
    result.materials.push_back(
        material_of(input.materials[body.material], values));
  }
  for (const LoadCaseEntry& entry : input.load_cases) {
    result.load_cases.push_back(load_case_of(entry, values));
  }
  for (const ResponseEntry& response : input.responses) {
    result.response_directions.push_back(values.at(response.direction));
  }
  result.fea_edge = input.resolution.fea;
  return result;
}

std::vector<std::pair<std::string, double>> parameter_values(
    const Case& input, const VectorX& design) {
  const Values values(input, design);
  std::vector<std::pair<std::string, double>> result;
  for (const Parameter& parameter : input.parameters) {
    result.emplace_back(parameter.name, values.at(parameter.value));
  }
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

std::string response_unit(const Case& input, int response) {
  constexpr std::array<Dimension, 6> kDimensions = {
      Dimension::Length,   Dimension::Mass,   Dimension::Volume,
      Dimension::Pressure, Dimension::Energy, Dimension::Area};
  const auto kind = static_cast<std::size_t>(input.responses[response].kind);
  return input.units.unit_of(kDimensions[kind]);
}

}  // namespace meniscus
