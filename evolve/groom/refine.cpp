#include "evolve/groom/refine.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/films/edge_marks.h"

namespace meniscus::groom {

namespace {

// Per edge: its mark (index into EdgeMarks::all or -1), whether it is halved,
// and the vertex in its middle.
struct EdgePlan {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  std::vector<int> mark;
  std::vector<int> middle;  // -1: stays whole
  std::vector<char> in_film;
  std::vector<int> obstacle;  // constraint set of its surfaces, or -1
  std::vector<int> band;      // of its rings, or -1
  std::vector<int> face;      // of its solids, or -1
};

EdgePlan plan_edges(const films::FilmComplex& complex,
                    const films::EdgeMarks& marks) {
  EdgePlan plan;
  list_edges(complex.mesh.facets, plan.edges, plan.facet_edges);
  plan.in_film.assign(plan.edges.size(), 0);
  plan.obstacle.assign(plan.edges.size(), -1);
  plan.band.assign(plan.edges.size(), -1);
  plan.face.assign(plan.edges.size(), -1);
  // An edge is a film's, stays whole or meets an obstacle if any of its facets
  // says so.
  std::vector<char> whole(plan.edges.size(), 0);
  for (std::size_t f = 0; f < plan.facet_edges.size(); ++f) {
    const films::ComplexSurface& surface =
        complex.surfaces[complex.mesh.facet_label[f]];
    for (const int e : plan.facet_edges[f]) {
      plan.in_film[e] |= surface.liquid ? 1 : 0;
      whole[e] |= surface.refine ? 0 : 1;
      plan.obstacle[e] = std::max(plan.obstacle[e], surface.constraints);
      plan.band[e] = std::max(plan.band[e], surface.band);
      plan.face[e] = std::max(plan.face[e], surface.face);
    }
  }
  std::vector<char> seen(marks.all().size(), 0);
  plan.mark.resize(plan.edges.size());
  for (std::size_t e = 0; e < plan.edges.size(); ++e) {
    plan.mark[e] = marks.find(plan.edges[e][0], plan.edges[e][1]);
    if (plan.mark[e] >= 0) {
      seen[plan.mark[e]] = 1;
    }
  }
  // Wires: marked edges that no facet has.
  for (std::size_t m = 0; m < complex.edges.size(); ++m) {
    if (seen[m] == 0) {
      const films::ComplexEdge& wire = complex.edges[m];
      plan.edges.push_back(edge_key(wire.a, wire.b));
      plan.mark.push_back(static_cast<int>(m));
      plan.in_film.push_back(0);
      plan.obstacle.push_back(-1);
      plan.band.push_back(-1);
      plan.face.push_back(-1);
      whole.push_back(0);
    }
  }
  // Every edge that may be halved gets its midpoint's number after the old
  // vertices: both facets of an edge then share it.
  plan.middle.assign(plan.edges.size(), -1);
  int next = static_cast<int>(complex.mesh.points.size());
  for (std::size_t e = 0; e < plan.edges.size(); ++e) {
    const int m = plan.mark[e];
    if (whole[e] == 0 && (m < 0 || marks.all()[m].refine)) {
      plan.middle[e] = next++;
    }
  }
  return plan;
}

films::PlacedVertex middle_of(const films::FilmComplex& complex,
                              const films::EdgeMarks& marks,
                              const EdgePlan& plan, std::size_t e) {
  const auto [a, b] = plan.edges[e];
  const films::ComplexVertex& va = complex.vertices[a];
  const films::ComplexVertex& vb = complex.vertices[b];
  const Vec3& pa = complex.mesh.points[a];
  const Vec3& pb = complex.mesh.points[b];
  if (plan.mark[e] >= 0) {
    return films::born_on(complex, marks.all()[plan.mark[e]], {va, pa},
                          {vb, pb});
  }
  if (plan.band[e] >= 0 && plan.in_film[e] == 0) {
    return films::born_on_band(complex, plan.band[e], {va, pa}, {vb, pb});
  }
  if (plan.face[e] >= 0 && plan.in_film[e] == 0) {
    return films::born_on_face(complex, plan.face[e], {va, pa}, {vb, pb});
  }
  films::PlacedVertex made;
  made.place = 0.5 * (pa + pb);
  if (plan.in_film[e] != 0 && plan.obstacle[e] >= 0) {
    const auto touches = [](const films::ComplexVertex& v) {
      return v.constraints < 0 || v.held;
    };
    made.vertex.constraints = plan.obstacle[e];
    made.vertex.held = touches(va) && touches(vb);
    made.place = films::onto_walls(complex, plan.obstacle[e], made.vertex.held,
                                   made.place);
  }
  if (plan.in_film[e] == 0 && plan.obstacle[e] >= 0) {
    for (const int level : complex.constraint_sets[plan.obstacle[e]]) {
      if (const auto& bent = complex.level_sets[level].bent) {
        const Vec3 from = made.place;
        made.place = films::onto_wall(*bent, from);  // a wetted face
        if (!made.place.allFinite()) {
          throw InvalidInput(fmt::format(
              "an edge of the face on the wall of '{}' has its middle at "
              "({:.6g}, {:.6g}, {:.6g}), where that has no nearest point; take "
              "shorter edges",
              complex.level_sets[level].name, from.x(), from.y(), from.z()));
        }
      }
    }
  }
  if (plan.in_film[e] == 0) {
    const bool solid = va.kind == films::VertexKind::Fixed &&
                       vb.kind == films::VertexKind::Fixed;
    made.vertex.kind =
        solid ? films::VertexKind::Fixed : films::VertexKind::InCap;
  }
  return made;
}

// The children of a facet beside edges that stay whole; `m` are the middles
// of its edges (01), (12), (20), or -1.
void add_partial(const Points& points, const Triangle& t, const Triangle& m,
                 std::vector<Triangle>& children) {
  const auto halved =
      std::count_if(m.begin(), m.end(), [](int v) { return v >= 0; });
  if (halved == 0) {
    children.push_back(t);
    return;
  }
  // Turned so that edge (01) is the one halved, or (20) the one whole.
  int k = 0;
  while (halved == 1 ? m[k] < 0 : m[(k + 2) % 3] >= 0) {
    ++k;
  }
  const int a = t[k];
  const int b = t[(k + 1) % 3];
  const int c = t[(k + 2) % 3];
  const int ab = m[k];
  if (halved == 1) {
    children.push_back({a, ab, c});
    children.push_back({ab, b, c});
    return;
  }
  const int bc = m[(k + 1) % 3];
  children.push_back({ab, b, bc});
  if ((points[a] - points[bc]).squaredNorm() <=
      (points[c] - points[ab]).squaredNorm()) {
    children.push_back({a, ab, bc});
    children.push_back({a, bc, c});
  } else {
    children.push_back({a, ab, c});
    children.push_back({ab, bc, c});
  }
}

void refine_marks(const films::FilmComplex& complex, const EdgePlan& plan,
                  films::FilmComplex& fine) {
  std::vector<int> middle(complex.edges.size(), -1);
  for (std::size_t e = 0; e < plan.edges.size(); ++e) {
    const int m = plan.mark[e];
    if (m >= 0 && m < static_cast<int>(middle.size())) {
      middle[m] = plan.middle[e];
    }
  }
  fine.edges.clear();
  fine.edges.reserve(2 * complex.edges.size());
  for (std::size_t m = 0; m < complex.edges.size(); ++m) {
    films::ComplexEdge half = complex.edges[m];
    if (middle[m] >= 0) {
      half.b = middle[m];
      fine.edges.push_back(half);
      half.a = middle[m];
      half.b = complex.edges[m].b;
    }
    fine.edges.push_back(half);
  }
}

}  // namespace

Refinement refine(const films::FilmComplex& complex) {
  const films::EdgeMarks marks(complex);
  const EdgePlan plan = plan_edges(complex, marks);
  Refinement result;
  films::FilmComplex& fine = result.complex;
  fine = complex;
  const std::size_t points = complex.mesh.points.size();
  fine.mesh.points.reserve(points + plan.edges.size());
  fine.vertices.reserve(points + plan.edges.size());
  result.parents.reserve(plan.edges.size());
  // Midpoints of edges, on the curve or wall that holds their edge.
  for (std::size_t e = 0; e < plan.edges.size(); ++e) {
    if (plan.middle[e] >= 0) {
      const films::PlacedVertex made = middle_of(complex, marks, plan, e);
      fine.mesh.points.push_back(made.place);
      fine.vertices.push_back(made.vertex);
      result.parents.push_back(plan.edges[e]);
    }
  }
  // Red refinement: four similar children a facet, corner k in child k and the
  // middle one last, the order that multigrid relies on. Facets with whole
  // edges are cut as they need to be to stay conforming.
  std::vector<Triangle>& children = fine.mesh.facets;
  children.clear();
  children.reserve(4 * plan.facet_edges.size());
  fine.mesh.facet_label.clear();
  fine.mesh.facet_label.reserve(4 * plan.facet_edges.size());
  for (std::size_t f = 0; f < plan.facet_edges.size(); ++f) {
    const Triangle& t = complex.mesh.facets[f];
    const int ab = plan.middle[plan.facet_edges[f][0]];
    const int bc = plan.middle[plan.facet_edges[f][1]];
    const int ca = plan.middle[plan.facet_edges[f][2]];
    if (ab >= 0 && bc >= 0 && ca >= 0) {
      children.push_back({t[0], ab, ca});
      children.push_back({ab, t[1], bc});
      children.push_back({ca, bc, t[2]});
      children.push_back({ab, bc, ca});
    } else {
      add_partial(fine.mesh.points, t, {ab, bc, ca}, children);
    }
    fine.mesh.facet_label.resize(children.size(), complex.mesh.facet_label[f]);
  }
  // Marked edges halve with the facets beside them.
  refine_marks(complex, plan, fine);
  return result;
}

}  // namespace meniscus::groom
