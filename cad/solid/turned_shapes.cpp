#include "cad/solid/turned_shapes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace meniscus::solid {

namespace {

/// Nothing where a vertex is farther off.
std::optional<SimpleFilm> on_cylinder(const FilmMesh& mesh,
                                      CylinderSurface surface, double limit,
                                      double edge) {
  SimpleFilm film;
  for (const Vec3& p : mesh.points) {
    const double r = surface.axis.cross(p - surface.center).norm();
    film.off = std::max(film.off, std::abs(r - surface.radius));
  }
  if (film.off > std::max(limit, sagitta(edge, surface.radius))) {
    return {};
  }
  surface.inward = looks_inward(mesh, surface.center, surface.axis);
  film.surface = surface;
  return film;
}

/// Nothing for what is no circular arc.
std::optional<RimCircle> circle_of(const EdgeCurve& curve) {
  const auto* arc = std::get_if<EllipseCurve>(&curve);
  if (arc == nullptr ||
      std::abs(arc->u.norm() - arc->v.norm()) > kExactRim * arc->u.norm()) {
    return {};
  }
  return RimCircle{arc->center, arc->u.cross(arc->v).normalized(),
                   arc->u.normalized(), arc->u.norm()};
}

/// The arcs of a rim of lines and circular arcs; none where it has others.
std::vector<RimCircle> arcs_of(const RimCurve& rim) {
  std::vector<RimCircle> arcs;
  for (int k = 0; k < rim.piece_count(); ++k) {
    const EdgeCurve& curve = rim.piece(k).curve;
    if (std::holds_alternative<StraightLine>(curve)) {
      continue;
    }
    const auto arc = circle_of(curve);
    if (!arc) {
      return {};
    }
    arcs.push_back(*arc);
  }
  return arcs;
}

}  // namespace

double size_of(const FilmMesh& mesh) { return bounding_diagonal(mesh.points); }

std::optional<std::vector<RimCircle>> circles_of(
    const std::vector<FilmRim>& rims) {
  std::vector<RimCircle> circles;
  for (const FilmRim& rim : rims) {
    const auto circle = circle_of(rim.curve->piece(0).curve);
    if (rim.curve->piece_count() != 1 || !circle) {
      return {};
    }
    circles.push_back(*circle);
  }
  return circles;
}

bool coaxial(const RimCircle& a, const RimCircle& b, double size) {
  const Vec3 way = b.center - a.center;
  return a.normal.cross(b.normal).norm() < kExactRim &&
         a.normal.cross(way).norm() < kExactRim * size &&
         way.norm() > kExactRim * size;
}

double sagitta(double edge, double radius) {
  return edge * edge / (8.0 * radius);
}

bool looks_inward(const FilmMesh& mesh, const Vec3& center, const Vec3& axis) {
  double outward = 0.0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3 d = mesh.points[v] - center;
    outward += mesh.normals[v].dot(d - d.dot(axis) * axis);
  }
  return outward < 0.0;
}

std::optional<SimpleFilm> cylinder_of(const FilmMesh& mesh,
                                      const std::vector<RimCircle>& rims,
                                      double limit, double edge) {
  if (rims.size() != 2 || !coaxial(rims[0], rims[1], size_of(mesh)) ||
      std::abs(rims[0].radius - rims[1].radius) > kExactRim * rims[0].radius) {
    return {};
  }
  const RimCircle& low = rims[0];
  const Vec3 way = rims[1].center - low.center;
  auto film = on_cylinder(
      mesh, {low.center, way.normalized(), low.zero, low.radius}, limit, edge);
  if (film) {
    film->high = way.norm();
    film->low_rim = 0;
    film->high_rim = 1;
  }
  return film;
}

std::optional<SimpleFilm> cone_of(const FilmMesh& mesh,
                                  const std::vector<RimCircle>& rims,
                                  double limit) {
  if (rims.size() != 2 || !coaxial(rims[0], rims[1], size_of(mesh))) {
    return {};
  }
  const RimCircle& low = rims[0];
  const Vec3 way = rims[1].center - low.center;
  const double wider = rims[1].radius - low.radius;
  ConeSurface surface{low.center, way.normalized(), low.zero, low.radius,
                      std::atan2(wider, way.norm())};
  SimpleFilm film;
  for (const Vec3& p : mesh.points) {
    const Vec3 d = p - surface.center;
    const double r = surface.axis.cross(d).norm();
    const double z = surface.axis.dot(d);
    film.off =
        std::max(film.off, std::abs((r - low.radius) * std::cos(surface.angle) -
                                    z * std::sin(surface.angle)));
  }
  if (film.off > limit) {
    return {};
  }
  surface.inward = looks_inward(mesh, surface.center, surface.axis);
  film.surface = surface;
  film.high = std::hypot(way.norm(), wider);
  film.low_rim = 0;
  film.high_rim = 1;
  return film;
}

std::optional<SimpleFilm> part_cylinder_of(const FilmMesh& mesh,
                                           const std::vector<FilmRim>& rims,
                                           double limit, double edge) {
  if (rims.size() != 1 || rims[0].curve->piece_count() != 4) {
    return {};
  }
  const RimCurve& rim = *rims[0].curve;
  std::vector<RimCircle> arcs = arcs_of(rim);
  if (arcs.size() != 2 ||
      std::abs(arcs[0].radius - arcs[1].radius) > kExactRim * arcs[0].radius) {
    return {};
  }
  arcs[1].normal = arcs[1].normal.dot(arcs[0].normal) < 0.0
                       ? Vec3(-arcs[1].normal)
                       : arcs[1].normal;
  if (!coaxial(arcs[0], arcs[1], size_of(mesh))) {
    return {};
  }
  const Vec3 way = arcs[1].center - arcs[0].center;
  CylinderSurface surface{arcs[0].center, way.normalized(), Vec3::Zero(),
                          arcs[0].radius};
  for (int k = 0; k < rim.piece_count(); ++k) {
    const auto* line = std::get_if<StraightLine>(&rim.piece(k).curve);
    if (line != nullptr &&
        line->direction.cross(surface.axis).norm() > kExactRim) {
      return {};
    }
  }
  // Away from the part: opposite to the middle of its first arc.
  const int first =
      std::holds_alternative<EllipseCurve>(rim.piece(0).curve) ? 0 : 1;
  const RimPiece& arc = rim.piece(first);
  surface.zero =
      (surface.center - point_of(arc.curve, 0.5 * (arc.first + arc.last)))
          .normalized();
  auto film = on_cylinder(mesh, surface, limit, edge);
  if (film) {
    film->high = way.norm();
    film->is_part = true;
  }
  return film;
}

}  // namespace meniscus::solid
