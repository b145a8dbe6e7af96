// The values that commands read and write in their film.
#include <algorithm>
#include <cstdlib>
#include <numbers>

#include <Eigen/Geometry>

#include "evolve/datafile/fe_session.h"
#include "evolve/energy/energy.h"

namespace meniscus::datafile {

namespace {

// complex_of() names things "constraint_3".
int number_of_name(const std::string& name) {
  const std::size_t at = name.find_last_of('_');
  return at == std::string::npos ? -1 : std::atoi(name.c_str() + at + 1);
}

bool is_ordinary(const films::ComplexEdge& e) {
  return e.kind == films::VertexKind::Free && e.curve < 0 &&
         e.constraints < 0 && e.integrals < 0 && e.refine;
}

// x, y, z or x1, x2, x3.
int axis_of(const std::string& name) {
  if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z') {
    return name[0] - 'x';
  }
  if (name.size() == 2 && name[0] == 'x' && name[1] >= '1' && name[1] <= '3') {
    return name[1] - '1';
  }
  return -1;
}

}  // namespace

std::optional<double> FeSession::value(const std::string& name) const {
  for (const auto* values : {&parameters_, &variables_}) {
    if (const auto at = values->find(name); at != values->end()) {
      return at->second;
    }
  }
  if (name == "total_area") {
    return energy::FilmEnergy(complex_).area(complex_.mesh.points);
  }
  if (name == "total_energy") {
    return energy::FilmEnergy(complex_).value(complex_.mesh.points,
                                              energy::targets_of(complex_));
  }
  static const std::map<std::string, double> kNumbers = {
      {"pi", std::numbers::pi}, {"e", std::numbers::e}};
  if (const auto at = kNumbers.find(name); at != kNumbers.end()) {
    return at->second;
  }
  static const std::map<std::string, FeKind> kCounts = {
      {"vertex_count", FeKind::Vertices},
      {"edge_count", FeKind::Edges},
      {"facet_count", FeKind::Facets},
      {"body_count", FeKind::Bodies}};
  if (const auto at = kCounts.find(name); at != kCounts.end()) {
    return count(at->second);
  }
  return std::nullopt;
}

std::optional<double> FeSession::quantity(const std::string& name,
                                          const std::string& attribute) const {
  int held = static_cast<int>(complex_.bodies.size());
  for (std::size_t q = 0; q < complex_.quantities.size(); ++q) {
    const films::FilmQuantity& quantity = complex_.quantities[q];
    if (quantity.name == name) {
      if (attribute == "value") {
        return energy::FilmEnergy(complex_).quantities(
            complex_.mesh.points,
            energy::targets_of(complex_))[static_cast<Eigen::Index>(q)];
      }
      const bool is_held = quantity.role == films::FilmQuantity::Role::Held;
      return attribute == "target" && is_held ? std::optional(quantity.target)
             : attribute == "modulus"         ? std::optional(quantity.modulus)
             : attribute == "pressure" && is_held
                 ? std::optional(pressure_[held])
                 : std::nullopt;
    }
    held += quantity.role == films::FilmQuantity::Role::Held ? 1 : 0;
  }
  return std::nullopt;
}

int FeSession::count(FeKind kind) const {
  switch (kind) {
    case FeKind::Vertices:
      return static_cast<int>(complex_.mesh.points.size());
    case FeKind::Edges:
      return static_cast<int>(edges().size());
    case FeKind::Facets:
      return static_cast<int>(complex_.mesh.facets.size());
    case FeKind::Bodies:
      break;
  }
  return static_cast<int>(complex_.bodies.size());
}

std::optional<FeElementRef> FeSession::element(FeKind kind, int id) const {
  for (int index = 0; index < count(kind); ++index) {
    const FeElementRef element{kind, index};
    if (attribute(element, "id", 0) == id) {
      return element;
    }
  }
  return std::nullopt;
}

bool FeSession::on_wall(int set, int number) const {
  if (set < 0) {
    return false;
  }
  const std::vector<int>& walls = complex_.constraint_sets[set];
  return std::any_of(walls.begin(), walls.end(), [&](int w) {
    return number_of_name(complex_.level_sets[w].name) == number;
  });
}

bool FeSession::on_curve(int curve, int number) const {
  return curve >= 0 && number_of_name(complex_.curves[curve].name) == number;
}

std::optional<double> FeSession::attribute(const FeElementRef& element,
                                           const std::string& name,
                                           int number) const {
  if (name == "id") {
    return element.kind == FeKind::Bodies
               ? number_of_name(complex_.bodies[element.index].name)
               : element.index + 1;
  }
  switch (element.kind) {
    case FeKind::Vertices:
      return vertex_attribute(element.index, name, number);
    case FeKind::Edges:
      return edge_attribute(element.index, name, number);
    case FeKind::Facets:
      return facet_attribute(element.index, name);
    case FeKind::Bodies:
      break;
  }
  return body_attribute(element.index, name);
}

std::optional<double> FeSession::vertex_attribute(int v,
                                                  const std::string& name,
                                                  int number) const {
  const films::ComplexVertex& vertex = complex_.vertices[v];
  if (const int axis = axis_of(name); axis >= 0) {
    return complex_.mesh.points[v][axis];
  }
  if (name == "fixed") {
    return truth(vertex.kind != films::VertexKind::Free &&
                 vertex.kind != films::VertexKind::Slides);
  }
  if (name == "on_constraint") {
    return truth(on_wall(vertex.constraints, number));
  }
  if (name == "on_boundary") {
    return truth(on_curve(vertex.curve, number));
  }
  return std::nullopt;
}

std::optional<double> FeSession::edge_attribute(int e, const std::string& name,
                                                int number) const {
  const Edge& edge = edges()[e];
  const Vec3 along =
      complex_.mesh.points[edge[1]] - complex_.mesh.points[edge[0]];
  const int m = mark_of(e);
  if (name == "length") {
    return along.norm();
  }
  if (const int axis = axis_of(name); axis >= 0) {
    return along[axis];
  }
  if (name == "fixed") {
    return truth(m >= 0 &&
                 (complex_.edges[m].kind == films::VertexKind::Fixed ||
                  complex_.edges[m].kind == films::VertexKind::OnCurve));
  }
  if (name == "on_constraint") {
    return truth(m >= 0 && on_wall(complex_.edges[m].constraints, number));
  }
  if (name == "on_boundary") {
    return truth(m >= 0 && on_curve(complex_.edges[m].curve, number));
  }
  return std::nullopt;
}

std::optional<double> FeSession::facet_attribute(
    int f, const std::string& name) const {
  const films::ComplexSurface& surface =
      complex_.surfaces[complex_.mesh.facet_label[f]];
  if (name == "area") {
    return 0.5 * area_vector2(complex_.mesh, f).norm();
  }
  if (name == "tension" || name == "density") {
    return surface.tension;
  }
  if (name == "fixed") {
    return truth(!surface.liquid);
  }
  return std::nullopt;
}

std::optional<double> FeSession::body_attribute(int b,
                                                const std::string& name) const {
  const films::ComplexBody& body = complex_.bodies[b];
  if (name == "target") {
    return body.volume.value_or(0.0);
  }
  if (name == "pressure") {
    return body.pressure.value_or(pressure_[b]);
  }
  if (name == "density") {
    return body.density;
  }
  if (name == "volume") {
    return energy::FilmEnergy(complex_).volumes(complex_.mesh.points)[b];
  }
  return std::nullopt;
}

int FeSession::surface_with_tension(int surface, double tension) {
  const std::string origin = complex_.surfaces[surface].name + "/";
  for (std::size_t s = 0; s < complex_.surfaces.size(); ++s) {
    const films::ComplexSurface& other = complex_.surfaces[s];
    if (other.tension == tension && !other.tension_field &&
        other.name.rfind(origin, 0) == 0) {
      return static_cast<int>(s);
    }
  }
  const auto added = static_cast<int>(complex_.surfaces.size());
  films::ComplexSurface made = complex_.surfaces[surface];
  made.tension = tension;
  made.tension_field.reset();
  made.name = origin + std::to_string(added);
  complex_.mesh.labels.push_back(made.name);
  complex_.surfaces.push_back(std::move(made));
  for (films::ComplexBody& body : complex_.bodies) {
    for (std::size_t k = 0, n = body.sides.size(); k < n; ++k) {
      if (body.sides[k].surface == surface) {
        body.sides.push_back({added, body.sides[k].sign});
      }
    }
  }
  for (films::FilmQuantity& quantity : complex_.quantities) {
    if (std::find(quantity.surfaces.begin(), quantity.surfaces.end(),
                  surface) != quantity.surfaces.end()) {
      quantity.surfaces.push_back(added);
    }
  }
  return added;
}

bool FeSession::set_attribute(const FeElementRef& element,
                              const std::string& name, double value) {
  if (element.kind == FeKind::Vertices) {
    const int axis = axis_of(name);
    if (axis >= 0) {
      complex_.mesh.points[element.index][axis] = value;
    }
    return axis >= 0;
  }
  if (element.kind == FeKind::Facets &&
      (name == "tension" || name == "density")) {
    int& label = complex_.mesh.facet_label[element.index];
    if (complex_.surfaces[label].tension != value) {
      label = surface_with_tension(label, value);
    }
    return true;
  }
  if (element.kind != FeKind::Bodies) {
    return false;
  }
  films::ComplexBody& body = complex_.bodies[element.index];
  if (name == "target" || name == "volume") {
    body.volume = value;
    body.pressure.reset();
  } else if (name == "pressure") {
    body.pressure = value;
    body.volume.reset();
  } else if (name == "density") {
    body.density = value;
  } else {
    return false;
  }
  return true;
}

bool FeSession::fix(const FeElementRef& element) {
  if (element.kind != FeKind::Vertices) {
    return false;
  }
  complex_.vertices[element.index].kind = films::VertexKind::Fixed;
  return true;
}

bool FeSession::unfix(const FeElementRef& element) {
  if (element.kind == FeKind::Vertices) {
    films::VertexKind& kind = complex_.vertices[element.index].kind;
    kind = kind == films::VertexKind::Fixed     ? films::VertexKind::Free
           : kind == films::VertexKind::OnCurve ? films::VertexKind::Slides
                                                : kind;
    return true;
  }
  if (element.kind == FeKind::Edges) {
    if (const int m = mark_of(element.index); m >= 0) {
      films::VertexKind& kind = complex_.edges[m].kind;
      kind = kind == films::VertexKind::Fixed     ? films::VertexKind::Free
             : kind == films::VertexKind::OnCurve ? films::VertexKind::Slides
                                                  : kind;
    }
    return true;
  }
  return false;
}

bool FeSession::release(const FeElementRef& element, const std::string& what,
                        int number) {
  if (element.kind == FeKind::Facets || element.kind == FeKind::Bodies ||
      (what != "constraint" && what != "boundary")) {
    return false;
  }
  if (attribute(element, "on_" + what, number) == 1.0) {
    if (element.kind == FeKind::Vertices) {
      release_vertex(element.index, what, number);
    } else {
      release_edge(element.index, what);
    }
  }
  return true;
}

void FeSession::release_vertex(int v, const std::string& what, int number) {
  films::ComplexVertex& vertex = complex_.vertices[v];
  if (what == "boundary") {
    vertex.kind = films::VertexKind::Free;
    vertex.curve = -1;
    return;
  }
  std::vector<int> rest;
  for (const int w : complex_.constraint_sets[vertex.constraints]) {
    if (number_of_name(complex_.level_sets[w].name) != number) {
      rest.push_back(w);
    }
  }
  vertex.constraints = -1;
  if (!rest.empty()) {
    vertex.constraints = static_cast<int>(complex_.constraint_sets.size());
    complex_.constraint_sets.push_back(std::move(rest));
  }
}

void FeSession::release_edge(int e, const std::string& what) {
  const int m = mark_of(e);
  films::ComplexEdge& edge = complex_.edges[m];
  if (what == "boundary") {
    edge.kind = films::VertexKind::Free;
    edge.curve = -1;
  } else {
    edge.constraints = -1;
    edge.integrals = -1;
  }
  if (is_ordinary(edge)) {
    complex_.edges.erase(complex_.edges.begin() + m);
    edges_.clear();
    edge_mark_.clear();
  }
}

}  // namespace meniscus::datafile
