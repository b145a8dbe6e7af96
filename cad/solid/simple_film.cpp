#include "cad/solid/simple_film.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "cad/solid/turned_shapes.h"
#include "core/math/dense.h"

namespace meniscus::solid {

namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr int kRimSamples = 32;
constexpr int kMostSecants = 12;

std::optional<SimpleFilm> plane_of(const FilmMesh& mesh,
                                   const std::vector<FilmRim>& rims,
                                   double limit) {
  // The sum of area vectors gives the side that the film looks to.
  Vec3 normal = Vec3::Zero();
  for (const Triangle& t : mesh.facets) {
    const Vec3 u = mesh.points[t[1]] - mesh.points[t[0]];
    normal += u.cross(mesh.points[t[2]] - mesh.points[t[0]]);
  }
  if (rims.empty() || normal.norm() == 0.0) {
    return {};
  }
  // The rims' own plane: they are exact, and other faces meet them.
  const RimCurve& outline = *rims[0].curve;
  Vec3 middle = Vec3::Zero();
  Points points;
  for (int k = 0; k < kRimSamples; ++k) {
    points.push_back(outline.point(outline.length() * k / kRimSamples));
    middle += points.back() / kRimSamples;
  }
  // Newell's normal of the first rim, a closed polygon of samples.
  Vec3 area = Vec3::Zero();
  for (int k = 0; k < kRimSamples; ++k) {
    area += (points[k] - middle).cross(points[(k + 1) % kRimSamples] - middle);
  }
  if (area.norm() == 0.0) {
    return {};
  }
  area.normalize();
  area = area.dot(normal) < 0.0 ? Vec3(-area) : area;
  // All rims must lie in that plane, and the film as near as it can tell.
  for (const FilmRim& rim : rims) {
    for (int k = 0; k < 4 * kRimSamples; ++k) {
      const Vec3 p =
          rim.curve->point(rim.curve->length() * k / (4 * kRimSamples));
      if (std::abs(area.dot(p - middle)) > kExactRim * size_of(mesh)) {
        return {};
      }
    }
  }
  SimpleFilm film{PlaneSurface{middle, area}};
  for (const Vec3& p : mesh.points) {
    film.off = std::max(film.off, std::abs(area.dot(p - middle)));
  }
  return film.off <= limit ? std::optional(film) : std::nullopt;
}

/// Center and radius by least squares of |p|^2 = 2 c.p + const, which is close
/// to distances where the points are near a sphere.
bool fit_ball(const FilmMesh& mesh, Vec3& center, double& radius) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : mesh.points) {
    middle += p / static_cast<double>(mesh.points.size());
  }
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Vec3& p : mesh.points) {
    const Vec3 d = p - middle;
    const Eigen::Vector4d row(2.0 * d[0], 2.0 * d[1], 2.0 * d[2], 1.0);
    normal += row * row.transpose();
    right += d.squaredNorm() * row;
  }
  const Eigen::Vector4d x = solve_ldlt4(normal, right);
  const double square = x[3] + x.head<3>().squaredNorm();
  center = middle + x.head<3>();
  radius = std::sqrt(std::max(square, 0.0));
  return std::isfinite(radius) && radius > 0.0;
}

/// The height of the center above the circle, along `axis`, of the sphere
/// through it that fits the film best: |p - c|^2 = r^2 + t^2 is linear in t.
double best_height(const FilmMesh& mesh, const RimCircle& circle,
                   const Vec3& axis) {
  double normal = 0.0;
  double right = 0.0;
  for (const Vec3& p : mesh.points) {
    const Vec3 d = p - circle.center;
    const double z = axis.dot(d);
    normal += 4.0 * z * z;
    right += 2.0 * z * (d.squaredNorm() - circle.radius * circle.radius);
  }
  return normal > 0.0 ? right / normal : 0.0;
}

/// Mean distance of the smooth film from `center`.
double mean_distance(const FilmMesh& mesh, const Vec3& center) {
  double sum = 0.0;
  double whole = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Triangle& t = mesh.facets[f];
    const Vec3 u = mesh.points[t[1]] - mesh.points[t[0]];
    const double area = u.cross(mesh.points[t[2]] - mesh.points[t[0]]).norm();
    for (int k = 0; k < 3; ++k) {
      Vec3 at = Vec3::Constant(0.5);
      at[k] = 0.0;
      sum +=
          area * (smooth_point(mesh, static_cast<int>(f), at) - center).norm();
    }
    whole += 3.0 * area;
  }
  return sum / whole;
}

/// From that of best_height() on: where the film lies as much inside of the
/// sphere as outside, so that both enclose the same volume. By secants.
double even_height(const FilmMesh& mesh, const RimCircle& circle,
                   const Vec3& axis) {
  const auto off = [&](double t) {
    return mean_distance(mesh, circle.center + t * axis) -
           std::hypot(circle.radius, t);
  };
  double t = best_height(mesh, circle, axis);
  double last = t + 1e-3 * circle.radius;
  double off_last = off(last);
  for (int round = 0; round < kMostSecants; ++round) {
    const double here = off(t);
    if (here == off_last ||
        std::abs(here) < kExactRim * kExactRim * circle.radius) {
      break;
    }
    const double next = t - here * (t - last) / (here - off_last);
    last = t;
    off_last = here;
    t = next;
  }
  return t;
}

std::optional<SimpleFilm> sphere_of(const FilmMesh& mesh,
                                    const std::vector<RimCircle>& rims,
                                    double limit, double edge) {
  if (rims.size() > 2 ||
      (rims.size() == 2 && !coaxial(rims[0], rims[1], size_of(mesh)))) {
    return {};
  }
  SphereSurface surface;
  SimpleFilm film;
  film.low = -0.5 * kHalfTurn;
  film.high = 0.5 * kHalfTurn;
  // A bubble: the least-squares sphere, its radius made even by area.
  if (rims.empty()) {
    if (!fit_ball(mesh, surface.center, surface.radius)) {
      return {};
    }
    surface.radius = mean_distance(mesh, surface.center);
  } else {
    // On a circle of radius a the centre is on its axis at height t and the
    // radius sqrt(a^2 + t^2): one unknown.
    const RimCircle& low = rims[0];
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : mesh.points) {
      mean += p - low.center;
    }
    const Vec3 up = rims.size() == 2 ? Vec3(rims[1].center - low.center) : mean;
    surface.axis = low.normal.dot(up) < 0.0 ? Vec3(-low.normal) : low.normal;
    surface.zero = low.zero;
    double t = even_height(mesh, low, surface.axis);
    // A second circle, radius b at height h: a^2 + t^2 = b^2 + (h - t)^2.
    if (rims.size() == 2) {
      const double h = up.norm();  // both circles lie on it
      t = (h * h + std::pow(rims[1].radius, 2) - std::pow(low.radius, 2)) /
          (2.0 * h);
      film.high = std::atan2(h - t, rims[1].radius);
      film.high_rim = 1;
    }
    surface.center = low.center + t * surface.axis;
    surface.radius = std::hypot(low.radius, t);
    film.low = std::atan2(-t, low.radius);
    film.low_rim = 0;
  }
  // Accepted within the limit, or as far off as a chord leaves the sphere.
  for (const Vec3& p : mesh.points) {
    film.off = std::max(film.off,
                        std::abs((p - surface.center).norm() - surface.radius));
  }
  if (film.off > std::max(limit, sagitta(edge, surface.radius))) {
    return {};
  }
  surface.inward = looks_inward(mesh, surface.center, Vec3::Zero());
  film.surface = surface;
  return film;
}

}  // namespace

std::optional<SimpleFilm> simple_film(const FilmMesh& mesh,
                                      const std::vector<FilmRim>& rims,
                                      double edge, double limit_in_edges) {
  const double limit = limit_in_edges * edge;
  if (auto plane = plane_of(mesh, rims, limit)) {
    return plane;
  }
  if (auto part = part_cylinder_of(mesh, rims, limit, edge)) {
    return part;
  }
  const auto circles = circles_of(rims);
  if (!circles) {
    return {};
  }
  if (auto cylinder = cylinder_of(mesh, *circles, limit, edge)) {
    return cylinder;
  }
  // Short zones of both look alike: whichever is nearer.
  const auto cone = cone_of(mesh, *circles, limit);
  const auto ball = sphere_of(mesh, *circles, limit, edge);
  return cone && (!ball || cone->off <= ball->off) ? cone : ball;
}

std::string name_of(const SimpleFilm& film) {
  if (const auto* tube = std::get_if<CylinderSurface>(&film.surface)) {
    return fmt::format("{}cylinder of radius {:.6g}",
                       film.is_part ? "part of a " : "", tube->radius);
  }
  if (const auto* cone = std::get_if<ConeSurface>(&film.surface)) {
    return fmt::format("cone of {:.6g} degrees",
                       std::abs(cone->angle) * 180.0 / std::numbers::pi);
  }
  if (const auto* ball = std::get_if<SphereSurface>(&film.surface)) {
    return fmt::format("sphere of radius {:.6g}", ball->radius);
  }
  return "plane";
}

}  // namespace meniscus::solid
