#include "evolve/datafile/fe_complex.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/datafile/fe_formulas.h"
#include "evolve/films/put_on_constraints.h"

namespace meniscus::datafile {

namespace {

// What the facets of one surface have in common.
struct SurfaceKey {
  double tension = 1.0;
  bool fixed = false;
  bool no_refine = false;
  double color = 0.0;  // of fixed facets: what tells one solid from another
  int constraints = -1;
  std::vector<int> quantities;
  std::vector<std::array<int, 2>> sides;  // body, sign

  bool operator<(const SurfaceKey& other) const {
    return std::tie(tension, fixed, no_refine, color, constraints, quantities,
                    sides) <
           std::tie(other.tension, other.fixed, other.no_refine, other.color,
                    other.constraints, other.quantities, other.sides);
  }
};

class ComplexBuilder {
 public:
  ComplexBuilder(const FeFile& file,
                 const std::map<std::string, double>& parameters)
      : file_(file), values_(fe_values(file, parameters)) {}

  films::FilmComplex build() {
    if (file_.faces.empty()) {
      fe_fail(file_, {},
              "the file has no faces; films are faces, and edges alone (string "
              "models) are not supported");
    }
    integrals_ = fe_formulas(file_, values_, complex_);
    for (std::size_t c = 0; c < file_.constraints.size(); ++c) {
      if (file_.constraints[c].global) {
        global_.push_back(static_cast<int>(c));
      }
    }
    vertices();
    marked_edges();
    list_sides();
    for (std::size_t f = 0; f < file_.faces.size(); ++f) {
      face(static_cast<int>(f));
    }
    bodies();
    attach_quantities();
    complex_.gravity = Vec3(0.0, 0.0, -values_.at("g"));
    complex_.line_points = file_.line_order / 2 + 1;
    set_gap_constant();
    complex_.volume_rule = file_.symmetric_content ? films::VolumeRule::Cone
                                                   : films::VolumeRule::Column;
    return std::move(complex_);
  }

 private:
  double number(const FeExpression& expression) const {
    return number_of(expression, values_, file_.name);
  }

  int constraint_set(const FeMarks& marks) {
    std::vector<int> wanted = global_;
    for (const FeOnConstraint& on : marks.constraints) {
      wanted.push_back(on.constraint);
    }
    return index_in(complex_.constraint_sets, std::move(wanted));
  }

  // Index of a set of indices, added when new; -1 for none.
  static int index_in(std::vector<std::vector<int>>& sets,
                      std::vector<int> wanted) {
    if (wanted.empty()) {
      return -1;
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    const auto found = std::find(sets.begin(), sets.end(), wanted);
    if (found != sets.end()) {
      return static_cast<int>(found - sets.begin());
    }
    sets.push_back(std::move(wanted));
    return static_cast<int>(sets.size()) - 1;
  }

  static films::VertexKind kind_of(const FeMarks& marks) {
    if (marks.boundary >= 0) {
      return marks.fixed ? films::VertexKind::OnCurve
                         : films::VertexKind::Slides;
    }
    return marks.fixed ? films::VertexKind::Fixed : films::VertexKind::Free;
  }

  // Vertices that a face uses, in the order of the file.
  void vertices() {
    used_.assign(file_.edges.size(), 0);
    std::vector<char> wanted(file_.vertices.size(), 0);
    for (const FeFace& face : file_.faces) {
      for (const int signed_edge : face.edges) {
        const int e = std::abs(signed_edge) - 1;
        used_[e] = 1;
        wanted[file_.edges[e].tail] = 1;
        wanted[file_.edges[e].head] = 1;
      }
    }
    point_.assign(file_.vertices.size(), -1);
    for (std::size_t v = 0; v < file_.vertices.size(); ++v) {
      if (wanted[v] != 0) {
        point_[v] = static_cast<int>(complex_.mesh.points.size());
        vertex(file_.vertices[v]);
      }
    }
  }

  void vertex(const FeVertex& vertex) {
    films::ComplexVertex made;
    made.kind = kind_of(vertex.marks);
    Vec3 p;
    if (vertex.marks.boundary >= 0) {
      made.curve = vertex.marks.boundary;
      made.t = number(vertex.coordinates[0]);
      try {
        p = curves::point_at(complex_.curves[made.curve].shape, made.t);
      } catch (const ExpressionError& error) {
        fe_fail(file_, vertex.marks.place, error.what());
      }
    } else {
      p = Vec3(number(vertex.coordinates[0]), number(vertex.coordinates[1]),
               number(vertex.coordinates[2]));
      const int set = constraint_set(vertex.marks);
      p = projected(p, set, vertex.marks.place);
      made.constraints = made.kind == films::VertexKind::Free ? set : -1;
    }
    if (!p.allFinite()) {
      fe_fail(file_, vertex.marks.place,
              fmt::format("vertex {} is not at a finite place", vertex.id));
    }
    complex_.mesh.points.push_back(p);
    complex_.vertices.push_back(made);
  }

  Vec3 projected(const Vec3& from, int set, const FePlace& place) const {
    try {
      return films::put_on_constraints(complex_, set, from);
    } catch (const InvalidInput& error) {
      fe_fail(file_, place, error.what());
    }
  }

  void marked_edges() {
    std::map<Edge, int> joined;
    for (std::size_t e = 0; e < file_.edges.size(); ++e) {
      const FeEdge& edge = file_.edges[e];
      if (used_[e] == 0) {
        if (!integrals_[e].empty()) {
          fe_fail(file_, edge.marks.place,
                  fmt::format("edge {} carries integrals but belongs to no "
                              "face",
                              edge.id));
        }
        continue;
      }
      const Edge pair = edge_key(edge.tail, edge.head);
      const auto [other, added] = joined.emplace(pair, edge.id);
      if (!added) {
        fe_fail(
            file_, edge.marks.place,
            fmt::format("edges {} and {} join the same vertices, {} and "
                        "{}; split one of them",
                        other->second, edge.id, file_.vertices[edge.tail].id,
                        file_.vertices[edge.head].id));
      }
      mark(point_[edge.tail], point_[edge.head], edge.marks,
           index_in(complex_.integral_sets, integrals_[e]));
    }
  }

  void mark(int a, int b, const FeMarks& marks, int integrals) {
    films::ComplexEdge made;
    made.a = a;
    made.b = b;
    made.kind = kind_of(marks);
    made.curve = marks.boundary;
    made.constraints =
        made.kind == films::VertexKind::Free && !marks.constraints.empty()
            ? constraint_set(marks)
            : -1;
    made.refine = !marks.no_refine;
    made.integrals = integrals;
    if (made.kind != films::VertexKind::Free || made.constraints >= 0 ||
        !made.refine || integrals >= 0) {
      complex_.edges.push_back(made);
    }
  }

  // Per face the bodies beside it.
  void list_sides() {
    sides_.resize(file_.faces.size());
    for (std::size_t b = 0; b < file_.bodies.size(); ++b) {
      for (const int signed_face : file_.bodies[b].faces) {
        const int f = std::abs(signed_face) - 1;
        const int sign = signed_face > 0 ? 1 : -1;
        for (const std::array<int, 2>& side : sides_[f]) {
          if (side[1] == sign) {
            fe_fail(file_, file_.bodies[b].place,
                    fmt::format("body {} lists the {} of face {}, which body "
                                "{} has already",
                                file_.bodies[b].id, sign > 0 ? "front" : "back",
                                file_.faces[f].id, file_.bodies[side[0]].id));
          }
        }
        sides_[f].push_back({static_cast<int>(b), sign});
      }
    }
  }

  int surface_of(int f) {
    const FeFace& face = file_.faces[f];
    SurfaceKey key;
    key.tension = face.tension ? number(*face.tension) : 1.0;
    key.fixed = face.marks.fixed;
    key.no_refine = face.marks.no_refine;
    key.color = key.fixed && face.color ? number(*face.color) : 0.0;
    key.constraints = key.fixed ? -1 : constraint_set(face.marks);
    key.quantities = face.marks.quantities;
    std::sort(key.quantities.begin(), key.quantities.end());
    key.sides = sides_[f];
    std::sort(key.sides.begin(), key.sides.end());
    const auto [found, added] =
        surface_.emplace(key, static_cast<int>(complex_.surfaces.size()));
    if (added) {
      films::ComplexSurface made;
      int& count = key.fixed ? solids_ : films_;
      made.name = fmt::format("{}_{}", key.fixed ? "solid" : "film", ++count);
      made.liquid = !key.fixed;
      made.tension = key.tension;
      made.refine = !key.no_refine;
      made.constraints = key.constraints;
      complex_.mesh.labels.push_back(made.name);
      complex_.surfaces.push_back(std::move(made));
      keys_.push_back(key);
    }
    return found->second;
  }

  void face(int f) {
    const FeFace& face = file_.faces[f];
    const int surface = surface_of(f);
    std::vector<int> loop;
    for (const int signed_edge : face.edges) {
      const FeEdge& edge = file_.edges[std::abs(signed_edge) - 1];
      const int v = signed_edge > 0 ? edge.tail : edge.head;
      const films::VertexKind kind = complex_.vertices[point_[v]].kind;
      if (face.marks.fixed && (kind == films::VertexKind::Free ||
                               kind == films::VertexKind::Slides)) {
        fe_fail(file_, face.marks.place,
                fmt::format("face {} is fixed but its vertex {} moves: fix "
                            "the vertex or free the face",
                            face.id, file_.vertices[v].id));
      }
      loop.push_back(point_[v]);
    }
    if (loop.size() == 3) {
      facet({loop[0], loop[1], loop[2]}, surface);
      return;
    }
    const int center = born_center(face, loop);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      facet({loop[k], loop[(k + 1) % loop.size()], center}, surface);
      mark(loop[k], center, face.marks, -1);
    }
  }

  void facet(const Triangle& corners, int surface) {
    complex_.mesh.facets.push_back(corners);
    complex_.mesh.facet_label.push_back(surface);
  }

  // The vertex in the middle of a face of more than three edges.
  int born_center(const FeFace& face, const std::vector<int>& loop) {
    Vec3 sum = Vec3::Zero();
    for (const int v : loop) {
      sum += complex_.mesh.points[v];
    }
    const int set = constraint_set(face.marks);
    films::ComplexVertex made;
    made.kind = kind_of(face.marks);
    made.constraints = made.kind == films::VertexKind::Free ? set : -1;
    complex_.mesh.points.push_back(projected(
        sum / static_cast<double>(loop.size()), set, face.marks.place));
    complex_.vertices.push_back(made);
    return static_cast<int>(complex_.mesh.points.size()) - 1;
  }

  void bodies() {
    for (std::size_t b = 0; b < file_.bodies.size(); ++b) {
      const FeBody& body = file_.bodies[b];
      films::ComplexBody made;
      made.name = fmt::format("body_{}", body.id);
      for (std::size_t s = 0; s < keys_.size(); ++s) {
        for (const auto& [owner, sign] : keys_[s].sides) {
          if (owner == static_cast<int>(b)) {
            made.sides.push_back({static_cast<int>(s), sign});
          }
        }
      }
      if (body.volume) {
        made.volume = number(*body.volume);
      }
      if (body.pressure) {
        made.pressure = number(*body.pressure);
      }
      made.density = body.density ? number(*body.density) : 0.0;
      made.volume_offset = body.volconst ? number(*body.volconst) : 0.0;
      complex_.bodies.push_back(std::move(made));
    }
  }

  void attach_quantities() {
    std::size_t next = 0;
    for (std::size_t q = 0; q < file_.quantities.size(); ++q) {
      for (const FeMethod& method : file_.quantities[q].methods) {
        films::FilmQuantity& quantity = complex_.quantities[next++];
        if (method.global) {
          continue;
        }
        for (std::size_t s = 0; s < keys_.size(); ++s) {
          if (std::binary_search(keys_[s].quantities.begin(),
                                 keys_[s].quantities.end(),
                                 static_cast<int>(q))) {
            quantity.surfaces.push_back(static_cast<int>(s));
          }
        }
        if (quantity.surfaces.empty()) {
          fe_fail(file_, file_.quantities[q].place,
                  fmt::format("quantity '{}' is neither global nor on any face",
                              quantity.name));
        }
      }
    }
  }

  void set_gap_constant() {
    bool convex = false;
    complex_.gap_constant =
        file_.gap_constant ? number(*file_.gap_constant) : 1.0;
    for (const FeBoundary& boundary : file_.boundaries) {
      if (boundary.integrals.convex && complex_.gap_constant != 0.0) {
        fe_fail(file_, boundary.place,
                "gap energy of boundaries (convex) is not supported; say "
                "'gap_constant 0', or use a constraint");
      }
    }
    for (const FeConstraint& constraint : file_.constraints) {
      convex = convex || constraint.integrals.convex;
    }
    if (!convex) {
      complex_.gap_constant = 0.0;
    }
  }

  const FeFile& file_;
  FeValues values_;
  films::FilmComplex complex_;
  std::vector<int> global_;  // constraints
  std::vector<std::vector<int>> integrals_;
  std::vector<char> used_;  // edges in a face
  std::vector<int> point_;  // of vertices; -1: in no face
  std::vector<std::vector<std::array<int, 2>>> sides_;
  std::map<SurfaceKey, int> surface_;
  std::vector<SurfaceKey> keys_;  // of surfaces
  int films_ = 0;
  int solids_ = 0;
};

}  // namespace

films::FilmComplex complex_of(const FeFile& file,
                              const std::map<std::string, double>& parameters) {
  return ComplexBuilder(file, parameters).build();
}

void recalculate(films::FilmComplex& complex, const FeFile& file,
                 const std::map<std::string, double>& parameters) {
  films::FilmComplex fresh;
  fe_formulas(file, fe_values(file, parameters), fresh);
  if (fresh.integrals.size() != complex.integrals.size() ||
      fresh.quantities.size() != complex.quantities.size() ||
      fresh.curves.size() != complex.curves.size()) {
    fe_fail(file, {}, "the complex does not come from this file");
  }
  complex.curves = std::move(fresh.curves);
  complex.level_sets = std::move(fresh.level_sets);
  complex.integrals = std::move(fresh.integrals);
  for (std::size_t q = 0; q < complex.quantities.size(); ++q) {
    complex.quantities[q].field = std::move(fresh.quantities[q].field);
    complex.quantities[q].scalar = std::move(fresh.quantities[q].scalar);
  }
}

}  // namespace meniscus::datafile
