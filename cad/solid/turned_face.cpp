#include "cad/solid/turned_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace meniscus::solid {

namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

Vec3 axis_of(const SimpleFilm& film) {
  return std::visit(
      [](const auto& surface) -> Vec3 {
        if constexpr (requires { surface.axis; }) {
          return surface.axis;
        } else {
          return surface.normal;
        }
      },
      film.surface);
}

/// The point with first parameter 0.
Vec3 seam_point(const SimpleFilm& film, double b) {
  if (const auto* tube = std::get_if<CylinderSurface>(&film.surface)) {
    return tube->center + tube->radius * tube->zero + b * tube->axis;
  }
  if (const auto* cone = std::get_if<ConeSurface>(&film.surface)) {
    return cone->center +
           (cone->radius + b * std::sin(cone->angle)) * cone->zero +
           b * std::cos(cone->angle) * cone->axis;
  }
  const auto& ball = std::get<SphereSurface>(film.surface);
  return ball.center +
         ball.radius * (std::cos(b) * ball.zero + std::sin(b) * ball.axis);
}

double distance_to_simple(const SimpleFilm& film, const Vec3& p) {
  if (const auto* tube = std::get_if<CylinderSurface>(&film.surface)) {
    return std::abs(tube->axis.cross(p - tube->center).norm() - tube->radius);
  }
  if (const auto* cone = std::get_if<ConeSurface>(&film.surface)) {
    const Vec3 d = p - cone->center;
    const double r = cone->axis.cross(d).norm() - cone->radius;
    return std::abs(r * std::cos(cone->angle) -
                    cone->axis.dot(d) * std::sin(cone->angle));
  }
  const auto& ball = std::get<SphereSurface>(film.surface);
  return std::abs((p - ball.center).norm() - ball.radius);
}

class TurnedBuilder {
 public:
  TurnedBuilder(const TurnedFilm& film, const std::vector<RimEdges>& rims,
                Brep& brep)
      : film_(film), shape_(film.shape), rims_(rims), brep_(brep) {}

  void build() {
    if (shape_.is_part) {
      build_part();
      return;
    }
    const int bottom = end_vertex(shape_.low_rim, shape_.low);
    const int top = end_vertex(shape_.high_rim, shape_.high);
    const int seam = static_cast<int>(brep_.edges.size());
    brep_.edges.push_back({bottom, top, seam_curve(), shape_.low, shape_.high});
    add_end(shape_.low_rim, shape_.low, 0.0, kFullTurn);
    loop_.push_back(
        {seam, true, {kFullTurn, shape_.low}, {kFullTurn, shape_.high}});
    add_end(shape_.high_rim, shape_.high, kFullTurn, 0.0);
    loop_.push_back({seam, false, {0.0, shape_.low}, {0.0, shape_.high}});
    BrepFace face{film_.name, {}, {}};
    bool inward = false;
    std::visit(
        [&](const auto& surface) {
          face.surface = surface;
          if constexpr (requires { surface.inward; }) {
            inward = surface.inward;
          }
        },
        shape_.surface);
    if (inward) {
      turn_loop();
    }
    face.loops.push_back(std::move(loop_));
    brep_.faces.push_back(std::move(face));
  }

 private:
  /// Angle and height of a point of a cylinder.
  Vec2 place_of(const Vec3& point) const {
    const auto& tube = std::get<CylinderSurface>(shape_.surface);
    const Vec3 d = point - tube.center;
    const double angle =
        std::atan2(d.dot(tube.axis.cross(tube.zero)), d.dot(tube.zero));
    return {angle < 0.0 ? angle + kFullTurn : angle, d.dot(tube.axis)};
  }
  /// Within its rim, which nowhere crosses angle 0.
  void build_part() {
    const RimEdges& rim = rims_[film_.rims[0]];
    const std::vector<int> loop =
        boundary_loops(film_.mesh.facets, film_.mesh.points)[0];
    const Vec3& p = film_.mesh.points[loop[0]];
    const Vec3 way = film_.mesh.points[loop[1]] - p;
    const double here = rim.curve().nearest(p + 0.5 * way);
    const bool growing = rim.curve().tangent(here).dot(way) > 0.0;
    BrepFace face{film_.name, std::get<CylinderSurface>(shape_.surface), {}};
    for (const RimEdges::Step& step : rim.between(0.0, 0.0, growing)) {
      const BrepEdge& edge = brep_.edges[step.edge];
      loop_.push_back({step.edge, step.forward,
                       place_of(point_of(edge.curve, edge.first)),
                       place_of(point_of(edge.curve, edge.last))});
    }
    face.loops.push_back(std::move(loop_));
    brep_.faces.push_back(std::move(face));
  }
  /// On the rim, or a new one at the pole.
  int end_vertex(int rim, double b) {
    const Vec3 point = seam_point(shape_, b);
    if (rim >= 0) {
      const RimEdges& edges = rims_[film_.rims[rim]];
      return edges.vertex(edges.curve().nearest(point));
    }
    brep_.vertices.push_back(point);
    return static_cast<int>(brep_.vertices.size()) - 1;
  }
  EdgeCurve seam_curve() const {
    if (const auto* tube = std::get_if<CylinderSurface>(&shape_.surface)) {
      return StraightLine{seam_point(shape_, 0.0), tube->axis};
    }
    if (std::holds_alternative<ConeSurface>(shape_.surface)) {
      const Vec3 start = seam_point(shape_, 0.0);
      return StraightLine{start, seam_point(shape_, 1.0) - start};
    }
    const auto& ball = std::get<SphereSurface>(shape_.surface);
    return EllipseCurve{ball.center, ball.radius * ball.zero,
                        ball.radius * ball.axis};
  }
  /// Once around, from angle `from` to `to`, on the rim or across the pole.
  void add_end(int rim, double b, double from, double to) {
    if (rim < 0) {
      loop_.push_back({kPole, true, {from, b}, {to, b}});
      return;
    }
    const RimEdges& edges = rims_[film_.rims[rim]];
    const auto& circle = std::get<EllipseCurve>(edges.curve().piece(0).curve);
    const double sense =
        circle.u.cross(circle.v).dot(axis_of(shape_)) > 0.0 ? 1.0 : -1.0;
    const double run = to > from ? 1.0 : -1.0;
    const double start = edges.curve().nearest(seam_point(shape_, b));
    double a = from;
    for (const RimEdges::Step& step :
         edges.between(start, start, sense * run > 0.0)) {
      const BrepEdge& edge = brep_.edges[step.edge];
      const double next = a + run * (edge.last - edge.first);
      const Vec2 here(a, b);
      const Vec2 there(next, b);
      loop_.push_back({step.edge, step.forward, step.forward ? here : there,
                       step.forward ? there : here});
      a = next;
    }
  }
  void turn_loop() {
    std::reverse(loop_.begin(), loop_.end());
    for (BrepUse& use : loop_) {
      if (use.edge == kPole) {
        std::swap(use.at_first, use.at_last);
      } else {
        use.forward = !use.forward;
      }
    }
  }

  const TurnedFilm& film_;
  const SimpleFilm& shape_;
  const std::vector<RimEdges>& rims_;
  Brep& brep_;
  std::vector<BrepUse> loop_;  // counter-clockwise about the surface's normal
};

}  // namespace

void want_seam(const TurnedFilm& film, std::vector<RimEdges>& rims) {
  const SimpleFilm& shape = film.shape;
  if (shape.is_part) {
    return;
  }
  for (const auto& [rim, b] : {std::pair(shape.low_rim, shape.low),
                               std::pair(shape.high_rim, shape.high)}) {
    if (rim >= 0) {
      RimEdges& edges = rims[film.rims[rim]];
      edges.want_exactly(edges.curve().nearest(seam_point(shape, b)));
    }
  }
}

void add_turned_face(const TurnedFilm& film, const std::vector<RimEdges>& rims,
                     Brep& brep) {
  TurnedBuilder(film, rims, brep).build();
}

void measure_turned(const TurnedFilm& film, FilmSolidReport& report) {
  report.film_to_solid = std::max(report.film_to_solid, film.shape.off);
  for (const Triangle& t : film.mesh.facets) {
    const Vec3& a = film.mesh.points[t[0]];
    const Vec3& b = film.mesh.points[t[1]];
    const Vec3& c = film.mesh.points[t[2]];
    for (const Vec3& p : {Vec3((a + b + c) / 3.0), Vec3(0.5 * (a + b)),
                          Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a))}) {
      report.solid_to_film =
          std::max(report.solid_to_film, distance_to_simple(film.shape, p));
    }
  }
}

}  // namespace meniscus::solid
