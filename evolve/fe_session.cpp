#include "evolve/fe_session.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "evolve/descent.h"
#include "evolve/equilibrium.h"
#include "evolve/grooming.h"
#include "evolve/pop.h"

namespace meniscus {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return text;
}

int number_at_end(const std::string& name) {
  const std::size_t at = name.find_last_of('_');
  return at == std::string::npos ? -1 : std::atoi(name.c_str() + at + 1);
}

bool plain(const ComplexEdge& e) {
  return e.kind == VertexKind::Free && e.curve < 0 && e.constraints < 0 &&
         e.integrals < 0;
}

}  // namespace

FeSession::FeSession(const FeFile& file,
                     const std::map<std::string, double>& parameters,
                     Monitor* monitor)
    : file_(file), monitor_(monitor) {
  for (const auto& [name, value] : parameters) {
    parameters_[lower(name)] = value;
  }
  complex_ = complex_of(file, parameters_);
  FeValues values;
  for (const FeParameter& parameter : file.parameters) {
    const auto given = parameters_.find(parameter.name);
    const double value = given != parameters_.end()
                             ? given->second
                             : number_of(parameter.value, values, file.name);
    values[parameter.name] = value;
    parameters_[parameter.name] = value;
  }
  changed();
}

void FeSession::changed() {
  edges_.clear();
  edge_mark_.clear();
  const FilmTargets targets = targets_of(complex_);
  pressure_.resize(targets.bodies.size(), 0.0);
}

const std::vector<Edge>& FeSession::edges() const {
  if (edges_.empty()) {
    std::vector<Triangle> facet_edges;
    list_edges(complex_.mesh.facets, edges_, facet_edges);
    std::map<Edge, int> marks;
    for (std::size_t m = 0; m < complex_.edges.size(); ++m) {
      const ComplexEdge& e = complex_.edges[m];
      marks[{std::min(e.a, e.b), std::max(e.a, e.b)}] = static_cast<int>(m);
    }
    for (const Edge& e : edges_) {
      const auto at = marks.find({std::min(e[0], e[1]), std::max(e[0], e[1])});
      edge_mark_.push_back(at == marks.end() ? -1 : at->second);
    }
  }
  return edges_;
}

int FeSession::mark_of(int edge) const {
  edges();
  return edge_mark_[edge];
}

void FeSession::descend_steps(int count) {
  const FilmEnergy energy(complex_);
  const FilmTargets targets = targets_of(complex_);
  for (int step = 0; step < count;) {
    // Directions follow the film: anew every few steps.
    const int few = std::min(conjugate_ ? 10 : 1, count - step);
    const DescentReport report =
        descend(energy, targets, energy.space().directions(complex_.mesh.points),
                complex_.mesh.points,
                {.method = conjugate_ ? DescentMethod::ConjugateGradients
                                      : DescentMethod::Gradient,
                 .max_steps = few,
                 .monitor = monitor_});
    for (Eigen::Index b = 0; b < report.pressure.size(); ++b) {
      pressure_[b] = report.pressure[b];
    }
    iterations_ += report.steps;
    step += few;
    if (report.steps == 0) {
      break;  // nothing more falls
    }
  }
}

void FeSession::newton_step() {
  const FilmEnergy energy(complex_);
  const FilmState state =
      settle_in_normals(energy, complex_, targets_of(complex_),
                        complex_.mesh.points,
                        {.max_iterations = 1, .monitor = monitor_});
  ++iterations_;
  complex_.mesh.points = state.points;
  for (std::size_t b = 0; b < pressure_.size(); ++b) {
    pressure_[b] = state.report.bodies[b].pressure;
  }
}

void FeSession::refine_all() {
  complex_ = refine(complex_).complex;
  changed();
}

void FeSession::refine_edges(const Filter& chosen) {
  // Every other edge stays whole: marked so, and unmarked afterwards.
  const std::vector<Edge> all = edges();
  FilmComplex work = complex_;
  std::vector<bool> split;  // per mark
  std::vector<bool> allowed;
  for (const ComplexEdge& e : complex_.edges) {
    split.push_back(false);
    allowed.push_back(e.refine);
  }
  for (ComplexEdge& e : work.edges) {
    e.refine = false;
  }
  for (int e = 0; e < static_cast<int>(all.size()); ++e) {
    const bool halved = chosen(e);
    if (const int m = mark_of(e); m >= 0) {
      split[m] = halved;
      work.edges[m].refine = halved;
    } else if (!halved) {
      ComplexEdge whole;
      whole.a = all[e][0];
      whole.b = all[e][1];
      whole.refine = false;
      work.edges.push_back(whole);
    }
  }
  work = refine(work).complex;
  std::vector<ComplexEdge> kept;
  std::size_t at = 0;
  for (std::size_t m = 0; m < split.size(); ++m) {
    for (int half = 0; half < (split[m] ? 2 : 1); ++half) {
      kept.push_back(work.edges[at++]);
      kept.back().refine = allowed[m];
    }
  }
  work.edges = std::move(kept);
  complex_ = std::move(work);
  changed();
}

void FeSession::flip() {
  equiangulate(complex_);
  changed();
}

void FeSession::average() { average_vertices(complex_); }

void FeSession::remove_tiny(double length) {
  collapse_tiny_edges(complex_, length);
  changed();
}

void FeSession::pop_all() {
  pop_edges(complex_);
  pop_vertices(complex_);
  changed();
}

void FeSession::gravity(double constant) {
  complex_.gravity = Vec3(0, 0, -constant);
}

bool FeSession::has_name(const std::string& name) const {
  double ignored = 0.0;
  static_cast<void>(ignored);
  return parameters_.count(name) != 0 || variables_.count(name) != 0 ||
         name == "total_area" || name == "total_energy" || name == "pi" ||
         name == "e" || name == "vertex_count" || name == "edge_count" ||
         name == "facet_count" || name == "body_count";
}

double FeSession::value(const std::string& name) const {
  if (const auto at = parameters_.find(name); at != parameters_.end()) {
    return at->second;
  }
  if (const auto at = variables_.find(name); at != variables_.end()) {
    return at->second;
  }
  if (name == "total_area") {
    return FilmEnergy(complex_).area(complex_.mesh.points);
  }
  if (name == "total_energy") {
    return FilmEnergy(complex_).value(complex_.mesh.points,
                                      targets_of(complex_));
  }
  if (name == "pi") {
    return std::numbers::pi;
  }
  if (name == "e") {
    return std::numbers::e;
  }
  return count(name == "vertex_count" ? Kind::Vertex
               : name == "edge_count" ? Kind::Edge
               : name == "facet_count" ? Kind::Facet
                                       : Kind::Body);
}

void FeSession::assign(const std::string& name, double value) {
  const auto at = parameters_.find(name);
  if (at == parameters_.end()) {
    variables_[name] = value;
    return;
  }
  at->second = value;
  recalculate(complex_, file_, parameters_);
  for (std::size_t v = 0; v < complex_.vertices.size(); ++v) {
    const ComplexVertex& vertex = complex_.vertices[v];
    if (vertex.kind == VertexKind::OnCurve) {
      complex_.mesh.points[v] =
          point_at(complex_.curves[vertex.curve].shape, vertex.t);
    }
  }
  FilmSpace(complex_).project(complex_.mesh.points);
}

int FeSession::count(Kind kind) const {
  switch (kind) {
    case Kind::Vertex:
      return static_cast<int>(complex_.mesh.points.size());
    case Kind::Edge:
      return static_cast<int>(edges().size());
    case Kind::Facet:
      return static_cast<int>(complex_.mesh.facets.size());
    case Kind::Body:
      break;
  }
  return static_cast<int>(complex_.bodies.size());
}

bool FeSession::attribute(Kind kind, int index, const std::string& name,
                          int number, double& result) const {
  if (name == "id") {
    result = kind == Kind::Body ? number_at_end(complex_.bodies[index].name)
                                : index + 1;
    return true;
  }
  const auto on_set = [&](int set) {
    if (set < 0) {
      return false;
    }
    const auto& walls = complex_.constraint_sets[set];
    return std::any_of(walls.begin(), walls.end(), [&](int w) {
      return number_at_end(complex_.level_sets[w].name) == number;
    });
  };
  const auto on_curve = [&](int curve) {
    return curve >= 0 && number_at_end(complex_.curves[curve].name) == number;
  };
  if (kind == Kind::Vertex) {
    const ComplexVertex& v = complex_.vertices[index];
    const Vec3& p = complex_.mesh.points[index];
    if (name == "x" || name == "y" || name == "z") {
      result = p[name[0] - 'x'];
    } else if (name == "x1" || name == "x2" || name == "x3") {
      result = p[name[1] - '1'];
    } else if (name == "fixed") {
      result = v.kind != VertexKind::Free && v.kind != VertexKind::Slides;
    } else if (name == "on_constraint") {
      result = on_set(v.constraints);
    } else if (name == "on_boundary") {
      result = on_curve(v.curve);
    } else {
      return false;
    }
    return true;
  }
  if (kind == Kind::Edge) {
    const Edge& e = edges()[index];
    const int m = mark_of(index);
    if (name == "length") {
      result = (complex_.mesh.points[e[1]] - complex_.mesh.points[e[0]]).norm();
    } else if (name == "fixed") {
      result = m >= 0 && (complex_.edges[m].kind == VertexKind::Fixed ||
                          complex_.edges[m].kind == VertexKind::OnCurve);
    } else if (name == "on_constraint") {
      result = m >= 0 && on_set(complex_.edges[m].constraints);
    } else if (name == "on_boundary") {
      result = m >= 0 && on_curve(complex_.edges[m].curve);
    } else {
      return false;
    }
    return true;
  }
  if (kind == Kind::Facet) {
    const ComplexSurface& surface =
        complex_.surfaces[complex_.mesh.facet_label[index]];
    if (name == "area") {
      result = 0.5 * area_vector2(complex_.mesh, index).norm();
    } else if (name == "tension" || name == "density") {
      result = surface.tension;
    } else if (name == "fixed") {
      result = !surface.liquid;
    } else {
      return false;
    }
    return true;
  }
  const ComplexBody& body = complex_.bodies[index];
  if (name == "target") {
    result = body.volume.value_or(0.0);
  } else if (name == "pressure") {
    result = body.pressure.value_or(pressure_[index]);
  } else if (name == "density") {
    result = body.density;
  } else if (name == "volume") {
    result = FilmEnergy(complex_).volumes(complex_.mesh.points)[index];
  } else {
    return false;
  }
  return true;
}

int FeSession::split_surface(int surface, double tension) {
  for (std::size_t s = 0; s < complex_.surfaces.size(); ++s) {
    const ComplexSurface& other = complex_.surfaces[s];
    if (other.tension == tension && !other.tension_field &&
        other.name.rfind(complex_.surfaces[surface].name + "/", 0) == 0) {
      return static_cast<int>(s);
    }
  }
  ComplexSurface made = complex_.surfaces[surface];
  made.tension = tension;
  made.tension_field.reset();
  made.name += "/" + std::to_string(complex_.surfaces.size());
  complex_.mesh.labels.push_back(made.name);
  complex_.surfaces.push_back(made);
  const auto added = static_cast<int>(complex_.surfaces.size()) - 1;
  for (ComplexBody& body : complex_.bodies) {
    for (std::size_t k = 0, n = body.sides.size(); k < n; ++k) {
      if (body.sides[k].surface == surface) {
        body.sides.push_back({added, body.sides[k].sign});
      }
    }
  }
  for (FilmQuantity& quantity : complex_.quantities) {
    if (std::find(quantity.surfaces.begin(), quantity.surfaces.end(),
                  surface) != quantity.surfaces.end()) {
      quantity.surfaces.push_back(added);
    }
  }
  return added;
}

bool FeSession::set_attribute(Kind kind, int index, const std::string& name,
                              double value) {
  if (kind == Kind::Vertex && name.size() <= 2) {
    const int axis = name.size() == 1   ? name[0] - 'x'
                     : name[0] == 'x' ? name[1] - '1'
                                      : -1;
    if (axis < 0 || axis > 2) {
      return false;
    }
    complex_.mesh.points[index][axis] = value;
    return true;
  }
  if (kind == Kind::Facet && (name == "tension" || name == "density")) {
    int& label = complex_.mesh.facet_label[index];
    if (complex_.surfaces[label].tension != value) {
      label = split_surface(label, value);
    }
    return true;
  }
  if (kind == Kind::Body) {
    ComplexBody& body = complex_.bodies[index];
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
  return false;
}

bool FeSession::mark(Kind kind, int index, const std::string& name, int number,
                     bool on) {
  if (kind == Kind::Vertex) {
    ComplexVertex& v = complex_.vertices[index];
    double holds = 0.0;
    if (name == "fixed") {
      if (on) {
        v.kind = VertexKind::Fixed;
      } else if (v.kind == VertexKind::Fixed) {
        v.kind = VertexKind::Free;
      } else if (v.kind == VertexKind::OnCurve) {
        v.kind = VertexKind::Slides;
      }
      return true;
    }
    if (on || (name != "constraint" && name != "boundary")) {
      return false;
    }
    attribute(kind, index, "on_" + name, number, holds);
    if (holds != 0.0 && name == "constraint") {
      std::vector<int> rest;
      for (const int w : complex_.constraint_sets[v.constraints]) {
        if (number_at_end(complex_.level_sets[w].name) != number) {
          rest.push_back(w);
        }
      }
      v.constraints = -1;
      if (!rest.empty()) {
        v.constraints = static_cast<int>(complex_.constraint_sets.size());
        complex_.constraint_sets.push_back(rest);
      }
    } else if (holds != 0.0) {
      v.kind = VertexKind::Free;
      v.curve = -1;
    }
    return true;
  }
  if (kind == Kind::Edge) {
    const int m = mark_of(index);
    if (on || m < 0) {
      return !on;
    }
    ComplexEdge& e = complex_.edges[m];
    if (name == "fixed" && e.kind == VertexKind::Fixed) {
      e.kind = VertexKind::Free;
    } else if (name == "boundary") {
      e.kind = VertexKind::Free;
      e.curve = -1;
    } else if (name == "constraint") {
      e.constraints = -1;
      e.integrals = -1;
    }
    if (plain(e) && e.refine) {
      complex_.edges.erase(complex_.edges.begin() + m);
      edges_.clear();
      edge_mark_.clear();
    }
    return true;
  }
  return false;
}

int FeSession::body_of(int id) const {
  for (std::size_t b = 0; b < complex_.bodies.size(); ++b) {
    if (number_at_end(complex_.bodies[b].name) == id) {
      return static_cast<int>(b);
    }
  }
  return -1;
}

}  // namespace meniscus
