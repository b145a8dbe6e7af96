#include "evolve/datafile/fe_session.h"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"
#include "evolve/datafile/fe_format.h"
#include "evolve/groom/flip_average.h"
#include "evolve/groom/pop.h"
#include "evolve/groom/refine.h"
#include "evolve/settle/descent.h"
#include "evolve/settle/newton.h"

namespace meniscus::datafile {

namespace {

constexpr int kConjugate = 10;        // steps between new directions
constexpr double kMostRestore = 3.0;  // x the mean edge, per step

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
  const films::FilmTargets targets = energy::targets_of(complex_);
  pressure_.resize(targets.bodies.size(), 0.0);
}

const std::vector<Edge>& FeSession::edges() const {
  if (edges_.empty()) {
    std::vector<Triangle> facet_edges;
    list_edges(complex_.mesh.facets, edges_, facet_edges);
    std::map<Edge, int> marks;
    for (std::size_t m = 0; m < complex_.edges.size(); ++m) {
      const films::ComplexEdge& e = complex_.edges[m];
      marks[edge_key(e.a, e.b)] = static_cast<int>(m);
    }
    for (const Edge& e : edges_) {
      const auto at = marks.find(edge_key(e[0], e[1]));
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
  const energy::FilmEnergy energy(complex_, energy::FilmMotion::Anywhere);
  if (energy.unknowns() == 0) {
    return;  // nothing moves
  }
  const films::FilmTargets targets = energy::targets_of(complex_);
  for (int step = 0; step < count;) {
    // Directions follow the film: anew every few steps.
    const int few = std::min(conjugate_ ? kConjugate : 1, count - step);
    const settle::DescentReport report = settle::descend(
        energy, targets, energy.space().directions(complex_.mesh.points),
        complex_.mesh.points,
        {.method = conjugate_ ? settle::DescentMethod::ConjugateGradients
                              : settle::DescentMethod::Gradient,
         .metric = settle::DescentMetric::Unit,
         .max_steps = few,
         .most_restore = kMostRestore * energy.mean_edge(complex_.mesh.points),
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
  const energy::FilmEnergy energy(complex_);
  if (energy.unknowns() == 0) {
    return;  // nothing moves
  }
  const films::FilmTargets targets = energy::targets_of(complex_);
  const Points& points = complex_.mesh.points;
  settle::FilmNewton newton(energy, targets,
                            {.rule = settle::DirectionRule::CurrentNormals,
                             .max_iterations = 1,
                             .monitor = monitor_});
  const settle::NewtonResult result =
      newton.run(points, energy.space().directions(points), {});
  ++iterations_;
  complex_.mesh.points = result.points;
  for (Eigen::Index b = 0; b < result.pressure.size(); ++b) {
    pressure_[b] = result.pressure[b];
  }
}

void FeSession::refine_all() {
  complex_ = groom::refine(complex_).complex;
  changed();
}

void FeSession::refine_edges(const Filter& chosen) {
  // Every other edge stays whole: marked so, and unmarked afterwards.
  const std::vector<Edge> all = edges();
  films::FilmComplex work = complex_;
  std::vector<bool> split;  // per mark
  std::vector<bool> allowed;
  for (const films::ComplexEdge& e : complex_.edges) {
    split.push_back(false);
    allowed.push_back(e.refine);
  }
  for (films::ComplexEdge& e : work.edges) {
    e.refine = false;
  }
  for (int e = 0; e < static_cast<int>(all.size()); ++e) {
    const bool halved = chosen(e);
    if (const int m = mark_of(e); m >= 0) {
      split[m] = halved;
      work.edges[m].refine = halved;
    } else if (!halved) {
      films::ComplexEdge whole;
      whole.a = all[e][0];
      whole.b = all[e][1];
      whole.refine = false;
      work.edges.push_back(whole);
    }
  }
  work = groom::refine(work).complex;
  std::vector<films::ComplexEdge> kept;
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
  groom::equiangulate(complex_, groom::FlipRule::AnglesOnly);
  changed();
}

void FeSession::average() { groom::average_vertices(complex_); }

int FeSession::remove_tiny(double length) {
  const int removed = groom::collapse_tiny_edges(complex_, length);
  changed();
  return removed;
}

void FeSession::pop_all() {
  groom::pop_edges(complex_);
  groom::pop_vertices(complex_);
  changed();
}

void FeSession::gravity(double constant) {
  complex_.gravity = Vec3(0, 0, -constant);
}

void FeSession::recalculate_all() {
  recalculate(complex_, file_, parameters_);
  for (std::size_t v = 0; v < complex_.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = complex_.vertices[v];
    if (vertex.kind == films::VertexKind::OnCurve ||
        vertex.kind == films::VertexKind::Slides) {
      complex_.mesh.points[v] =
          curves::point_at(complex_.curves[vertex.curve].shape, vertex.t);
    }
  }
  energy::FilmSpace(complex_).project(complex_.mesh.points);
}

void FeSession::assign(const std::string& name, double value) {
  const auto at = parameters_.find(name);
  if (at == parameters_.end()) {
    variables_[name] = value;
    return;
  }
  at->second = value;
  recalculate_all();
}

}  // namespace meniscus::datafile
