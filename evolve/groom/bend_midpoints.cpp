#include "evolve/groom/bend_midpoints.h"

namespace meniscus::groom {

namespace {

bool runs_to(const energy::FilmSpace& space, int a, int b) {
  const Edge& ends = space.line_ends(a);
  return ends[0] == b || ends[1] == b;
}

/// Unit tangent at `a` of the line through it, pointing to its neighbour b.
Vec3 tangent(const energy::FilmSpace& space, const Points& points, int a,
             int b) {
  const Edge& ends = space.line_ends(a);
  const int other = ends[0] == b ? ends[1] : ends[0];
  return (points[b] - points[other]).normalized();
}

}  // namespace

void bend_midpoints(const energy::FilmSpace& coarse,
                    const Points& coarse_points, Refinement& refinement) {
  // `rise` is the part of an edge along a vertex normal: the edge without it is
  // the tangent that the film has there.
  const Points directions = coarse.directions(coarse_points);
  std::vector<char> walled(coarse.vertex_count(), 0);
  for (const int v : coarse.walled()) {
    walled[v] = 1;
  }
  const auto smooth = [&](int v) { return coarse.rank(v) == 1 && !walled[v]; };
  const auto rise = [&](int v, const Vec3& way) -> Vec3 {
    const Vec3& n = directions[coarse.first(v)];
    return way.dot(n) * n;
  };
  films::FilmComplex& fine = refinement.complex;
  const int old = coarse.vertex_count();
  for (std::size_t e = 0; e < refinement.parents.size(); ++e) {
    const int made = old + static_cast<int>(e);
    if (fine.vertices[made].kind != films::VertexKind::Free) {
      continue;
    }
    const auto [a, b] = refinement.parents[e];
    const Vec3 way = coarse_points[b] - coarse_points[a];
    Vec3 move = Vec3::Zero();
    const bool line_a = runs_to(coarse, a, b);
    const bool line_b = runs_to(coarse, b, a);
    // On a line: the middle of the cubic Hermite arc with the line's tangents
    // at both ends, or of the parabola with one; only across the edge, so that
    // spacing stays.
    if (line_a || line_b) {
      const double length = way.norm();
      const double share = line_a && line_b ? 0.125 : 0.25;
      if (line_a) {
        move += share * (length * tangent(coarse, coarse_points, a, b) - way);
      }
      if (line_b) {
        move += share * (length * tangent(coarse, coarse_points, b, a) + way);
      }
      move -= move.dot(way) / way.squaredNorm() * way;
    } else if (smooth(a) && smooth(b)) {
      // The same for a smooth film, tangents across the normals: the middle of
      // a PN triangle's edge (Vlachos et al. 2001).
      move = -0.125 * (rise(a, way) - rise(b, way));
    } else if (smooth(a)) {
      move = -0.25 * rise(a, way);
    } else if (smooth(b)) {
      move = 0.25 * rise(b, way);
    }
    // A bend of more than a quarter of the edge is no smooth film's.
    if (move.allFinite() && move.norm() < 0.25 * way.norm()) {
      fine.mesh.points[made] += move;
    }
  }
}

}  // namespace meniscus::groom
