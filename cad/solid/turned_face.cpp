#include "cad/solid/turned_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace meniscus::solid {

namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

Vec3 axis_of(const SimpleFilm& film) {
  const auto* tube = std::get_if<CylinderSurface>(&film.surface);
  return tube != nullptr ? tube->axis
                         : std::get<SphereSurface>(film.surface).axis;
}

/// The point with first parameter 0.
Vec3 seam_point(const SimpleFilm& film, double b) {
  if (const auto* tube = std::get_if<CylinderSurface>(&film.surface)) {
    return tube->center + tube->radius * tube->zero + b * tube->axis;
  }
  const auto& ball = std::get<SphereSurface>(film.surface);
  return ball.center +
         ball.radius * (std::cos(b) * ball.zero + std::sin(b) * ball.axis);
}

double distance_to_simple(const SimpleFilm& film, const Vec3& p) {
  if (const auto* tube = std::get_if<CylinderSurface>(&film.surface)) {
    return std::abs(tube->axis.cross(p - tube->center).norm() - tube->radius);
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
    if (const auto* tube = std::get_if<CylinderSurface>(&shape_.surface)) {
      face.surface = *tube;
      inward = tube->inward;
    } else {
      const auto& ball = std::get<SphereSurface>(shape_.surface);
      face.surface = ball;
      inward = ball.inward;
    }
    if (inward) {
      turn_loop();
    }
    face.loops.push_back(std::move(loop_));
    brep_.faces.push_back(std::move(face));
  }

 private:
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
