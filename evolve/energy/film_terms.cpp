#include "evolve/energy/film_terms.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/energy/bent_facets.h"
#include "evolve/energy/pole_field.h"
#include "evolve/energy/term_kinds.h"

namespace meniscus::energy {

namespace {

/// Of a film whose tension is one number, the first of its own.
PlaceField own_tension() {
  PlaceField field(Expression::parse("tension", {"x", "y", "z", "tension"}));
  field.names = {"tension"};
  field.numbers = VectorX::Ones(1);
  return field;
}

}  // namespace

/// Collects terms; keeps their order fixed.
class FilmTermBuilder {
 public:
  explicit FilmTermBuilder(const films::FilmComplex& complex)
      : complex_(complex) {}

  void add(std::unique_ptr<FilmTerm> term,
           std::vector<FilmTerm::Element> elements, int functional,
           int quantity = -1, int field = -1) {
    if (elements.empty()) {
      return;
    }
    term->elements_ = std::move(elements);
    term->functional_ = functional;
    term->quantity_ = quantity;
    term->field_ = field >= 0 ? field : quantity;
    terms_.push_back(std::move(term));
  }

  std::vector<FilmTerm::Element> facets_of(const std::vector<int>& surfaces,
                                           double factor) const {
    std::vector<FilmTerm::Element> result;
    const auto& labels = complex_.mesh.facet_label;
    for (std::size_t f = 0; f < labels.size(); ++f) {
      if (surfaces.empty() || std::find(surfaces.begin(), surfaces.end(),
                                        labels[f]) != surfaces.end()) {
        result.push_back({static_cast<int>(f), factor, 0});
      }
    }
    return result;
  }

  std::vector<FilmTerm::Element> facets_of_body(int body, double factor) const {
    std::vector<FilmTerm::Element> result;
    const auto& labels = complex_.mesh.facet_label;
    for (std::size_t f = 0; f < labels.size(); ++f) {
      if (const int sign = side(labels[f], body); sign != 0) {
        result.push_back({static_cast<int>(f), factor * sign, 0});
      }
    }
    return result;
  }

  void add_tension() {
    for (std::size_t s = 0; s < complex_.surfaces.size(); ++s) {
      const films::ComplexSurface& surface = complex_.surfaces[s];
      if (surface.liquid &&
          (surface.tension_field || !surface.drop_shape.empty())) {
        add(scalar_term(surface.tension_field.value_or(own_tension()),
                        static_cast<int>(surface.drop_shape.size())),
            facets_of({static_cast<int>(s)}, 1.0), -1, -1,
            static_cast<int>(complex_.quantities.size() + s));
      }
    }
  }

  void add_bodies() {
    for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
      const auto body = static_cast<int>(b);
      const double density = complex_.bodies[b].density;
      if (density != 0.0 && !complex_.gravity.isZero(0.0)) {
        add(flux_term(weight_field(density, complex_.gravity), 2),
            facets_of_body(body, 1.0), -1);
      }
      if (complex_.volume_rule == films::VolumeRule::Column &&
          !closed_by_facets(complex_, body)) {
        add(flux_term(column_field, 1), facets_of_body(body, 1.0), body);
      }
    }
  }

  /// What cones over the flat facets of bent faces leave out.
  void add_lenses() {
    for (std::size_t s = 0; s < complex_.surfaces.size(); ++s) {
      const auto& wetted = complex_.surfaces[s].wetted;
      for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
        const auto body = static_cast<int>(b);
        const int sign = side(static_cast<int>(s), body);
        if (wetted && wetted->bent && sign != 0) {
          add(bent_lens_term(*wetted->bent),
              facets_of({static_cast<int>(s)}, sign), body);
        }
      }
    }
  }

  void add_lines() {
    const bool gaps =
        complex_.gap_constant != 0.0 &&
        std::any_of(complex_.level_sets.begin(), complex_.level_sets.end(),
                    [](const films::LevelSet& wall) { return wall.convex; });
    if (complex_.edges.empty() || (complex_.integrals.empty() && !gaps)) {
      return;
    }
    const std::map<Edge, std::vector<int>> around = facets_at_marked_edges();
    for (std::size_t w = 0; w < complex_.level_sets.size() && gaps; ++w) {
      if (complex_.level_sets[w].convex) {
        add(gap_term(complex_.level_sets[w].formula, complex_.gap_constant),
            gap_elements(static_cast<int>(w), around), -1);
      }
    }
    for (std::size_t i = 0; i < complex_.integrals.size(); ++i) {
      const films::LineIntegral& integral = complex_.integrals[i];
      const auto add_line = [&](const auto& elements, int functional) {
        add(line_term(expression_field(integral.field), complex_.line_points),
            elements, functional);
      };
      if (integral.role == films::LineIntegral::Role::Energy) {
        add_line(energy_elements(static_cast<int>(i), around), -1);
        continue;
      }
      for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
        const auto body = static_cast<int>(b);
        add_line(content_elements(static_cast<int>(i), body, around), body);
      }
    }
  }

  void add_quantities() {
    int held = static_cast<int>(complex_.bodies.size());
    for (std::size_t q = 0; q < complex_.quantities.size(); ++q) {
      const films::FilmQuantity& quantity = complex_.quantities[q];
      const bool energy = quantity.role == films::FilmQuantity::Role::Energy;
      const int functional =
          energy ? -1
                 : (quantity.role == films::FilmQuantity::Role::Held ? held++
                                                                     : -2);
      const double factor = energy ? quantity.modulus : 1.0;
      const auto number = static_cast<int>(q);
      switch (quantity.kind) {
        case films::FilmQuantity::Kind::VectorIntegral:
          add(flux_term(expression_field(quantity.field)),
              facets_of(quantity.surfaces, factor), functional, number);
          break;
        case films::FilmQuantity::Kind::ScalarIntegral:
          add(scalar_term(quantity.scalar),
              facets_of(quantity.surfaces, factor), functional, number);
          break;
        case films::FilmQuantity::Kind::Area:
          add(scalar_term(Expression(1.0)),
              facets_of(quantity.surfaces, factor), functional, number);
          break;
        case films::FilmQuantity::Kind::BodyVolume:
          add_body_quantity(
              quantity,
              flux_term(complex_.volume_rule == films::VolumeRule::Column
                            ? FieldFunction(column_field)
                            : FieldFunction(cone_field),
                        1),
              factor, functional, number);
          break;
        case films::FilmQuantity::Kind::BodyScalarIntegral:
          add_body_quantity(quantity,
                            body_term(quantity.scalar, quantity.origin), factor,
                            functional, number);
          break;
        case films::FilmQuantity::Kind::BodyPoles:
          add_poles(quantity, factor, functional, number);
          break;
      }
    }
  }

  std::vector<std::unique_ptr<FilmTerm>> take() { return std::move(terms_); }

 private:
  int side(int surface, int body) const {
    int sign = 0;
    for (const films::BodySide& s : complex_.bodies[body].sides) {
      sign += s.surface == surface ? s.sign : 0;
    }
    return sign;
  }

  std::vector<FilmTerm::Element> elements_of(
      const films::FilmQuantity& quantity, double factor) const {
    std::vector<FilmTerm::Element> elements;
    for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
      if (quantity.body < 0 || quantity.body == static_cast<int>(b)) {
        const auto more = facets_of_body(static_cast<int>(b), factor);
        elements.insert(elements.end(), more.begin(), more.end());
      }
    }
    return elements;
  }

  void add_body_quantity(const films::FilmQuantity& quantity,
                         std::unique_ptr<FilmTerm> term, double factor,
                         int functional, int number) {
    add(std::move(term), elements_of(quantity, factor), functional, number);
  }

  void add_poles(const films::FilmQuantity& quantity, double factor,
                 int functional, int number) {
    std::vector<FilmTerm::Element> elements = elements_of(quantity, factor);
    std::unique_ptr<FilmTerm> term =
        pole_term(complex_.mesh, quantity.poles, elements);
    add(std::move(term), std::move(elements), functional, number);
  }

  std::map<Edge, std::vector<int>> facets_at_marked_edges() const {
    std::map<Edge, std::vector<int>> around;
    for (const films::ComplexEdge& e : complex_.edges) {
      if (e.integrals >= 0 || e.constraints >= 0) {
        around[edge_key(e.a, e.b)];
      }
    }
    for (std::size_t f = 0; f < complex_.mesh.facets.size(); ++f) {
      const Triangle& t = complex_.mesh.facets[f];
      for (int k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        const auto at = around.find(edge_key(a, b));
        if (at != around.end()) {
          at->second.push_back(static_cast<int>(f));
        }
      }
    }
    return around;
  }

  bool has(const films::ComplexEdge& e, int integral) const {
    if (e.integrals < 0) {
      return false;
    }
    const auto& set = complex_.integral_sets[e.integrals];
    return std::find(set.begin(), set.end(), integral) != set.end();
  }

  /// Corner of `facet` where the edge a-b starts, and +1 when it runs a to b.
  FilmTerm::Element on_facet(const films::ComplexEdge& e, int facet) const {
    const Triangle& t = complex_.mesh.facets[facet];
    for (int k = 0; k < 3; ++k) {
      const int from = t[k];
      const int to = t[(k + 1) % 3];
      if (from == e.a && to == e.b) {
        return {facet, 1.0, k};
      }
      if (from == e.b && to == e.a) {
        return {facet, -1.0, k};
      }
    }
    return {facet, 0.0, 0};
  }

  std::vector<FilmTerm::Element> energy_elements(
      int integral, const std::map<Edge, std::vector<int>>& around) const {
    std::vector<FilmTerm::Element> result;
    for (const films::ComplexEdge& e : complex_.edges) {
      if (!has(e, integral)) {
        continue;
      }
      const auto& facets = around.at(edge_key(e.a, e.b));
      if (!facets.empty()) {
        result.push_back(on_facet(e, facets.front()));
      }
    }
    return result;
  }

  std::vector<FilmTerm::Element> gap_elements(
      int wall, const std::map<Edge, std::vector<int>>& around) const {
    std::vector<FilmTerm::Element> result;
    for (const films::ComplexEdge& e : complex_.edges) {
      if (e.constraints < 0 || e.kind != films::VertexKind::Free) {
        continue;
      }
      const auto& set = complex_.constraint_sets[e.constraints];
      const auto& facets = around.at(edge_key(e.a, e.b));
      if (std::find(set.begin(), set.end(), wall) != set.end() &&
          !facets.empty()) {
        FilmTerm::Element element = on_facet(e, facets.front());
        element.sign = 1.0;
        result.push_back(element);
      }
    }
    return result;
  }

  std::vector<FilmTerm::Element> content_elements(
      int integral, int body,
      const std::map<Edge, std::vector<int>>& around) const {
    std::vector<FilmTerm::Element> result;
    for (const films::ComplexEdge& e : complex_.edges) {
      if (!has(e, integral)) {
        continue;
      }
      for (const int f : around.at(edge_key(e.a, e.b))) {
        const int sign = side(complex_.mesh.facet_label[f], body);
        if (sign != 0) {
          // Along the facet's own run, which has sign `sign` in the body.
          FilmTerm::Element element = on_facet(e, f);
          element.sign = sign;
          result.push_back(element);
        }
      }
    }
    return result;
  }

  const films::FilmComplex& complex_;
  std::vector<std::unique_ptr<FilmTerm>> terms_;
};

std::vector<std::unique_ptr<FilmTerm>> film_terms(
    const films::FilmComplex& complex) {
  FilmTermBuilder builder(complex);
  builder.add_tension();
  builder.add_bodies();
  builder.add_lenses();
  builder.add_lines();
  builder.add_quantities();
  return builder.take();
}

bool closed_by_facets(const films::FilmComplex& complex, int body) {
  std::vector<int> sign(complex.surfaces.size(), 0);
  for (const films::BodySide& s : complex.bodies[body].sides) {
    sign[s.surface] += s.sign;
  }
  // Every edge must be run as often each way.
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(complex.mesh.facets, edges, facet_edges);
  std::vector<int> runs(edges.size(), 0);
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    const Triangle& t = complex.mesh.facets[f];
    const int s = sign[complex.mesh.facet_label[f]];
    for (int k = 0; k < 3; ++k) {
      runs[facet_edges[f][k]] += t[k] < t[(k + 1) % 3] ? s : -s;
    }
  }
  return std::all_of(runs.begin(), runs.end(), [](int n) { return n == 0; });
}

std::vector<int> held_quantities(const films::FilmComplex& complex) {
  std::vector<int> result;
  for (std::size_t q = 0; q < complex.quantities.size(); ++q) {
    if (complex.quantities[q].role == films::FilmQuantity::Role::Held) {
      result.push_back(static_cast<int>(q));
    }
  }
  return result;
}

films::FilmTargets targets_of(const films::FilmComplex& complex) {
  films::FilmTargets targets;
  for (const films::ComplexSurface& surface : complex.surfaces) {
    targets.tension.push_back(surface.liquid || surface.wetted
                                  ? surface.tension *
                                        films::mean_support(surface.drop_shape)
                                  : 0.0);
  }
  targets.bodies = complex.bodies;
  for (const int q : held_quantities(complex)) {
    films::ComplexBody held;
    held.name = complex.quantities[q].name;
    held.volume = complex.quantities[q].target;
    targets.bodies.push_back(std::move(held));
  }
  for (const films::FilmQuantity& quantity : complex.quantities) {
    targets.numbers.push_back(quantity.kind ==
                                      films::FilmQuantity::Kind::BodyPoles
                                  ? pole_numbers(quantity.poles)
                                  : quantity.scalar.numbers);
  }
  for (const films::ComplexSurface& surface : complex.surfaces) {
    targets.numbers.push_back(films::tension_numbers(surface));
  }
  return targets;
}

}  // namespace meniscus::energy
