#include "evolve/datafile/fe_formulas.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/nearest_name.h"
#include "evolve/datafile/fe_format.h"

namespace meniscus::datafile {

namespace {

// One line integral: whose, which, which way, at which edge attributes.
struct IntegralKey {
  bool boundary = false;
  int owner = 0;
  films::LineIntegral::Role role = films::LineIntegral::Role::Energy;
  bool reversed = false;
  std::vector<double> attributes;

  bool operator<(const IntegralKey& other) const {
    return std::tie(boundary, owner, role, reversed, attributes) <
           std::tie(other.boundary, other.owner, other.role, other.reversed,
                    other.attributes);
  }
};

const FeIntegrals& owner_of(const FeFile& file, const IntegralKey& key) {
  return key.boundary ? file.boundaries[key.owner].integrals
                      : file.constraints[key.owner].integrals;
}

const FeField& field_of(const FeFile& file, const IntegralKey& key) {
  const FeIntegrals& owner = owner_of(file, key);
  return key.role == films::LineIntegral::Role::Energy ? *owner.energy
                                                       : *owner.content;
}

// Edge attributes that a field names, by index.
std::set<int> attributes_in(const FeFile& file, const FeField& field) {
  std::set<int> used;
  for (const FeExpression& formula : field) {
    for (const FeNode* node : names_in(formula)) {
      for (std::size_t k = 0; k < file.attributes.size(); ++k) {
        if (file.attributes[k].element == FeElement::Edges &&
            file.attributes[k].name == node->name) {
          used.insert(static_cast<int>(k));
        }
      }
    }
  }
  return used;
}

std::vector<IntegralKey> keys_of(const FeFile& file, const FeValues& values,
                                 const FeEdge& edge) {
  std::vector<IntegralKey> keys;
  const auto add = [&](bool boundary, int owner, bool reversed) {
    IntegralKey key{
        boundary, owner, films::LineIntegral::Role::Energy, reversed, {}};
    const FeIntegrals& integrals = owner_of(file, key);
    for (const bool energy : {true, false}) {
      if (!(energy ? integrals.energy : integrals.content)) {
        continue;
      }
      key.role = energy ? films::LineIntegral::Role::Energy
                        : films::LineIntegral::Role::Content;
      key.attributes.clear();
      for (const int attribute : attributes_in(file, field_of(file, key))) {
        double value = 0.0;
        for (const auto& [index, given] : edge.marks.attributes) {
          value =
              index == attribute ? number_of(given, values, file.name) : value;
        }
        key.attributes.push_back(value);
      }
      keys.push_back(key);
    }
  };
  if (edge.marks.boundary >= 0) {
    add(true, edge.marks.boundary, false);
  }
  for (const FeOnConstraint& on : edge.marks.constraints) {
    add(false, on.constraint, on.reversed);
  }
  return keys;
}

std::map<IntegralKey, int> all_integrals(const FeFile& file,
                                         const FeValues& values) {
  std::map<IntegralKey, int> integrals;
  for (const FeEdge& edge : file.edges) {
    if (edge.marks.boundary < 0 && edge.marks.constraints.empty()) {
      continue;
    }
    for (IntegralKey& key : keys_of(file, values, edge)) {
      integrals.emplace(std::move(key), 0);
    }
  }
  int next = 0;
  for (auto& [key, index] : integrals) {
    index = next++;
  }
  return integrals;
}

films::VectorField compiled_field(const FeField& field, const FeValues& values,
                                  const FeFile& file) {
  films::VectorField made;
  for (std::size_t k = 0; k < made.size(); ++k) {
    made[k] = compiled(field[k], values, place_names(), file.name);
  }
  return made;
}

Expression negative(const Expression& expression) {
  return expression.is_constant()
             ? Expression(-expression.evaluate(std::array{0.0, 0.0, 0.0}))
             : Expression::parse("-(" + expression.text() + ")",
                                 {"x", "y", "z"});
}

films::LineIntegral line_integral(const FeFile& file, FeValues values,
                                  const IntegralKey& key) {
  const FeField& field = field_of(file, key);
  std::size_t next = 0;
  for (const int attribute : attributes_in(file, field)) {
    values[file.attributes[attribute].name] = key.attributes[next++];
  }
  films::LineIntegral made;
  made.name = fmt::format(
      "{} of {} {}",
      key.role == films::LineIntegral::Role::Energy ? "energy" : "content",
      key.boundary ? "boundary" : "constraint",
      key.boundary ? file.boundaries[key.owner].name
                   : file.constraints[key.owner].name);
  made.role = key.role;
  made.field = compiled_field(field, values, file);
  // Evolver adds content of boundaries with the other sign.
  if (key.reversed !=
      (key.boundary && key.role == films::LineIntegral::Role::Content)) {
    for (Expression& component : made.field) {
      component = negative(component);
    }
  }
  return made;
}

films::FilmQuantity film_quantity(const FeFile& file, const FeValues& values,
                                  const FeQuantity& quantity,
                                  const FeMethod& method) {
  films::FilmQuantity made;
  made.name = quantity.name;
  made.role = quantity.role == FeQuantity::Role::Energy
                  ? films::FilmQuantity::Role::Energy
              : quantity.role == FeQuantity::Role::Fixed
                  ? films::FilmQuantity::Role::Held
                  : films::FilmQuantity::Role::Info;
  made.modulus = number_of(quantity.modulus, values, file.name) *
                 number_of(method.modulus, values, file.name);
  if (made.role != films::FilmQuantity::Role::Energy && made.modulus != 1.0) {
    fe_fail(file, quantity.place,
            fmt::format("quantity '{}': a modulus other than 1 is supported "
                        "for energies only, found {}",
                        quantity.name, made.modulus));
  }
  made.target = number_of(quantity.target, values, file.name);
  switch (method.kind) {
    case FeMethod::Kind::VectorIntegral:
      made.field = compiled_field(method.vector, values, file);
      break;
    case FeMethod::Kind::ScalarIntegral:
      made.kind = films::FilmQuantity::Kind::ScalarIntegral;
      made.scalar = compiled(method.scalar, values, place_names(), file.name);
      break;
    case FeMethod::Kind::Area:
      made.kind = films::FilmQuantity::Kind::Area;
      break;
    case FeMethod::Kind::Volume: {
      const std::vector<std::string> names = {"x", "y", "z"};
      made.field[2] = Expression::parse("z", names);
      if (file.symmetric_content) {
        made.field = {Expression::parse("x/3", names),
                      Expression::parse("y/3", names),
                      Expression::parse("z/3", names)};
      }
      break;
    }
  }
  return made;
}

}  // namespace

void fe_fail(const FeFile& file, const FePlace& place,
             const std::string& what) {
  throw InvalidInput(
      fmt::format("{}:{}:{}: {}", file.name, place.line, place.column, what));
}

FeValues fe_values(const FeFile& file,
                   const std::map<std::string, double>& parameters) {
  std::map<std::string, double> others;
  for (const auto& [name, value] : parameters) {
    others[lower(name)] = value;
  }
  FeValues values = {{"pi", 3.14159265358979323846}, {"g", 1.0}};
  std::vector<std::string> known;
  for (const FeParameter& parameter : file.parameters) {
    const auto other = others.find(parameter.name);
    values[parameter.name] =
        other != others.end() ? other->second
                              : number_of(parameter.value, values, file.name);
    known.push_back(parameter.name);
  }
  for (const auto& [name, value] : others) {
    if (name != "g" &&
        std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = nearest_name(name, known);
      throw InvalidInput(
          fmt::format("{}: there is no parameter '{}'{}", file.name, name,
                      near.empty() ? "" : "; is '" + near + "' meant?"));
    }
    if (!std::isfinite(value)) {
      throw InvalidInput(
          fmt::format("{}: parameter '{}' is {}", file.name, name, value));
    }
  }
  if (file.gravity) {
    values["g"] = number_of(*file.gravity, values, file.name);
  }
  if (const auto other = others.find("g"); other != others.end()) {
    values["g"] = other->second;
  }
  return values;
}

std::vector<std::vector<int>> fe_formulas(const FeFile& file,
                                          const FeValues& values,
                                          films::FilmComplex& complex) {
  for (const FeBoundary& boundary : file.boundaries) {
    curves::ParametricCurve shape;
    for (std::size_t k = 0; k < shape.coordinates.size(); ++k) {
      shape.coordinates[k] = compiled(boundary.coordinates[k], values,
                                      parameter_names(), file.name);
    }
    complex.curves.push_back({"boundary_" + boundary.name, std::move(shape)});
  }
  for (const FeConstraint& constraint : file.constraints) {
    films::LevelSet made;
    made.name = "constraint_" + constraint.name;
    made.formula =
        compiled(constraint.formula, values, place_names(), file.name);
    made.side = constraint.side == FeConstraint::Side::On
                    ? films::LevelSet::Side::On
                : constraint.side == FeConstraint::Side::Nonnegative
                    ? films::LevelSet::Side::AtLeast
                    : films::LevelSet::Side::AtMost;
    made.convex = constraint.integrals.convex;
    complex.level_sets.push_back(std::move(made));
  }
  const std::map<IntegralKey, int> integrals = all_integrals(file, values);
  for (const auto& [key, index] : integrals) {
    complex.integrals.push_back(line_integral(file, values, key));
  }
  for (const FeQuantity& quantity : file.quantities) {
    if (quantity.role != FeQuantity::Role::Energy &&
        quantity.methods.size() > 1) {
      fe_fail(file, quantity.place,
              fmt::format("quantity '{}': sums of several methods are "
                          "supported for energies only",
                          quantity.name));
    }
    for (const FeMethod& method : quantity.methods) {
      complex.quantities.push_back(
          film_quantity(file, values, quantity, method));
    }
  }
  std::vector<std::vector<int>> of_edge(file.edges.size());
  for (std::size_t e = 0; e < file.edges.size(); ++e) {
    for (const IntegralKey& key : keys_of(file, values, file.edges[e])) {
      of_edge[e].push_back(integrals.at(key));
    }
    std::sort(of_edge[e].begin(), of_edge[e].end());
  }
  return of_edge;
}

}  // namespace meniscus::datafile
