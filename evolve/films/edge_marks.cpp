#include "evolve/films/edge_marks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Core>

#include "core/geometry/edge_key.h"
#include "core/geometry/exact_points.h"
#include "core/math/dense.h"
#include "core/math/golden_section.h"
#include "evolve/films/rims.h"

namespace meniscus::films {

namespace {

constexpr int kWallSteps = 30;
constexpr int kCurveSamples = 96;
constexpr int kMarchSteps = 64;

bool along_curve(const ComplexEdge& mark) {
  return mark.kind == VertexKind::OnCurve || mark.kind == VertexKind::Slides;
}

bool on_curve_of(const ComplexEdge& mark, const ComplexVertex& vertex) {
  return (vertex.kind == VertexKind::OnCurve ||
          vertex.kind == VertexKind::Slides) &&
         vertex.curve == mark.curve;
}

/// In closed form: samples may miss the near one of two sides close together.
double nearest_on(const curves::Polygon& polygon, const Vec3& at) {
  const auto sides = static_cast<double>(polygon.points.size());
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon.points.size(); ++k) {
    const Vec3& from = polygon.points[k];
    const Vec3 side = polygon.points[(k + 1) % polygon.points.size()] - from;
    const double share =
        std::clamp((at - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
    const double distance = (from + share * side - at).squaredNorm();
    if (distance < least) {
      least = distance;
      best = (static_cast<double>(k) + share) / sides;
    }
  }
  return best < 1.0 ? best : 0.0;
}

}  // namespace

double nearest_parameter(const curves::CurveShape& shape, const Vec3& at,
                         double near) {
  const auto distance = [&](double t) {
    return (curves::point_at(shape, t) - at).squaredNorm();
  };
  if (const auto* polygon = std::get_if<curves::Polygon>(&shape)) {
    return nearest_on(*polygon, at);
  }
  if (!std::holds_alternative<curves::ParametricCurve>(shape)) {
    double best = 0.0;
    for (int i = 1; i < kCurveSamples; ++i) {
      const double t = static_cast<double>(i) / kCurveSamples;
      best = distance(t) < distance(best) ? t : best;
    }
    constexpr double kStep = 1.0 / kCurveSamples;
    const double t = golden_section(best - kStep, best + kStep, distance);
    const double wrapped = t - std::floor(t);
    return wrapped < 1.0 ? wrapped : 0.0;
  }
  const double speed = curves::jet_at(shape, near).first.norm();
  double step = speed > 0.0 ? 0.1 * std::sqrt(distance(near)) / speed : 1e-3;
  if (!(step > 0.0)) {
    return near;
  }
  if (distance(near - step) < distance(near + step)) {
    step = -step;
  }
  double t = near;
  for (int i = 0; i < kMarchSteps && distance(t + step) < distance(t); ++i) {
    t += step;
  }
  return golden_section(std::min(t - step, t + step),
                        std::max(t - step, t + step), distance);
}

Vec3 onto_walls(const FilmComplex& complex, int set, bool held,
                const Vec3& at) {
  Vec3 place = at;
  for (int step = 0; step < kWallSteps; ++step) {
    const std::array<Dual, 3> xyz = {Dual::variable(place.x(), 0, 3),
                                     Dual::variable(place.y(), 1, 3),
                                     Dual::variable(place.z(), 2, 3)};
    Eigen::MatrixX3d rows(0, 3);
    VectorX gap(0);
    for (const int wall : complex.constraint_sets[set]) {
      const LevelSet& level = complex.level_sets[wall];
      const Dual f = level.formula.evaluate(std::span<const Dual>(xyz));
      const bool violated =
          level.side == LevelSet::Side::On || held ||
          (level.side == LevelSet::Side::AtLeast ? f.value < 0.0
                                                 : f.value > 0.0);
      if (!violated || f.is_constant()) {
        continue;
      }
      rows.conservativeResize(rows.rows() + 1, 3);
      gap.conservativeResize(gap.size() + 1);
      rows.row(rows.rows() - 1) = f.gradient.transpose();
      gap[gap.size() - 1] = f.value;
    }
    if (gap.size() == 0) {
      break;
    }
    const Vec3 move = least_norm(rows, gap);
    if (!move.allFinite()) {
      break;
    }
    place -= move;
    if (!(move.norm() > 1e-15 * (place.norm() + (place - at).norm()))) {
      break;
    }
  }
  return place;
}

EdgeMarks::EdgeMarks(const FilmComplex& complex)
    : all_(complex.edges), touched_(complex.vertices.size(), 0) {
  const std::vector<int> next = rim_neighbours(complex);
  for (int v = 0; v < static_cast<int>(next.size()); ++v) {
    // A rim of two vertices has one edge.
    if (next[v] >= 0 && next[v] != v && !(next[next[v]] == v && next[v] < v)) {
      ComplexEdge mark;
      mark.a = v;
      mark.b = next[v];
      mark.kind = VertexKind::OnCurve;
      mark.curve = complex.vertices[v].curve;
      all_.push_back(mark);
    }
  }
  for (const ComplexEdge& mark : all_) {
    touched_[mark.a] = 1;
    touched_[mark.b] = 1;
  }
  sorted_.resize(all_.size());
  std::iota(sorted_.begin(), sorted_.end(), 0);
  std::stable_sort(sorted_.begin(), sorted_.end(), [&](int i, int j) {
    return edge_key(all_[i].a, all_[i].b) < edge_key(all_[j].a, all_[j].b);
  });
}

int EdgeMarks::search(int a, int b) const {
  const Edge key = edge_key(a, b);
  const auto at = std::lower_bound(
      sorted_.begin(), sorted_.end(), key, [&](int i, const Edge& wanted) {
        return edge_key(all_[i].a, all_[i].b) < wanted;
      });
  return at != sorted_.end() && edge_key(all_[*at].a, all_[*at].b) == key ? *at
                                                                          : -1;
}

PlacedVertex born_on(const FilmComplex& complex, const ComplexEdge& mark,
                     const PlacedVertex& a, const PlacedVertex& b) {
  PlacedVertex made;
  made.vertex.kind = mark.kind;
  made.place = 0.5 * (a.place + b.place);
  if (along_curve(mark)) {
    const curves::CurveShape& shape = complex.curves[mark.curve].shape;
    const bool from_a = on_curve_of(mark, a.vertex);
    const bool from_b = on_curve_of(mark, b.vertex);
    made.vertex.curve = mark.curve;
    made.vertex.t =
        from_a && from_b
            ? curves::middle_parameter(shape, a.vertex.t, b.vertex.t)
            : nearest_parameter(
                  shape, made.place,
                  from_a ? a.vertex.t : (from_b ? b.vertex.t : 0.0));
    made.place = curves::point_at(shape, made.vertex.t);
  } else if (mark.kind == VertexKind::OnBand) {
    return born_on_band(complex, mark.curve, a, b);
  } else if (mark.kind == VertexKind::OnEdge) {
    const ExactEdge& edge = complex.solid_edges[mark.curve].edge();
    made.vertex.curve = mark.curve;
    made.vertex.t = nearest_on(edge, made.place);
    made.place = point_on(edge.curve, made.vertex.t);
  } else if (mark.constraints >= 0) {
    const auto left = [](const ComplexVertex& v) {
      return v.kind == VertexKind::Free && v.constraints >= 0 && !v.held;
    };
    made.vertex.constraints = mark.constraints;
    made.vertex.held = !left(a.vertex) && !left(b.vertex);
    if (mark.kind == VertexKind::Free) {
      made.place =
          onto_walls(complex, mark.constraints, made.vertex.held, made.place);
    }
  }
  return made;
}

BandPlace place_on_band(const FilmComplex& complex, int band,
                        const PlacedVertex& at) {
  const RuledBand& here = complex.bands[band];
  const ComplexVertex& vertex = at.vertex;
  if (vertex.kind == VertexKind::OnBand && vertex.curve == band) {
    return {vertex.t, vertex.share};
  }
  if (vertex.kind == VertexKind::OnCurve && vertex.curve == here.outer) {
    if (here.is_patch()) {
      return place_on_patch(here, vertex.t);
    }
    return {vertex.t, 0.0};
  }
  if (vertex.kind == VertexKind::OnCurve && vertex.curve == here.inner) {
    return {here.partner_of_inner(vertex.t), 1.0};
  }
  // On a side that another curve shares, whose parameter the vertex has.
  return nearest_on_band(here, complex.curves, at.place);
}

PlacedVertex born_on_band(const FilmComplex& complex, int band,
                          const PlacedVertex& a, const PlacedVertex& b) {
  const BandPlace middle = middle_on_band(place_on_band(complex, band, a),
                                          place_on_band(complex, band, b));
  return {{.kind = VertexKind::OnBand,
           .curve = band,
           .t = middle.t,
           .share = middle.share},
          point_on_band(complex.bands[band], complex.curves, middle.t,
                        middle.share)};
}

PlacedVertex born_on_face(const FilmComplex& complex, int face,
                          const PlacedVertex& a, const PlacedVertex& b) {
  const ExactSurface& surface = complex.solid_faces[face].face().surface;
  const Vec3 middle = 0.5 * (a.place + b.place);
  Vec2 near = Vec2::Zero();
  int known = 0;
  for (const ComplexVertex& vertex : {a.vertex, b.vertex}) {
    if (vertex.kind == VertexKind::OnFace && vertex.curve == face) {
      near += Vec2(vertex.t, vertex.share);
      ++known;
    }
  }
  const Vec2 place = known > 0 ? place_on(surface, middle, near / known)
                               : place_on(surface, middle);
  return {{.kind = VertexKind::OnFace,
           .curve = face,
           .t = place[0],
           .share = place[1]},
          point_on(surface, place)};
}

}  // namespace meniscus::films
