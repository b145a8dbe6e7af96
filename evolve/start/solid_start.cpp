#include "evolve/start/solid_start.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/geometry/exact_points.h"
#include "core/geometry/plane_points.h"
#include "evolve/curves/curve_place.h"
#include "evolve/films/solid_frame.h"
#include "evolve/start/cap_faces.h"
#include "evolve/start/disk_fill.h"
#include "evolve/start/double_edges.h"
#include "evolve/start/unrolled.h"

namespace meniscus::start {

namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
constexpr double kLeastPieces = 12.0;  // of a turn, or of a closed rim
constexpr double kOffEdge = 1e-3;      // a rim off its edges [its size]
constexpr double kOneCut = 1e-7;       // parameters that are one

double upward(double from, double to) {
  const double way = to - from;
  return way - std::floor(way);
}

std::size_t index_of(const std::vector<double>& cuts, double t) {
  const auto at = std::min_element(
      cuts.begin(), cuts.end(),
      [&](double a, double b) { return std::abs(a - t) < std::abs(b - t); });
  return static_cast<std::size_t>(at - cuts.begin());
}

/// Increasing parameters, between those that must be.
std::vector<double> cuts_between(const curves::CurveShape& shape,
                                 const std::set<double>& wanted, double edge) {
  constexpr int kChords = 16;
  std::vector<double> result;
  for (auto at = wanted.begin(); at != wanted.end(); ++at) {
    const double next =
        std::next(at) == wanted.end() ? *wanted.begin() + 1.0 : *std::next(at);
    double length = 0.0;
    Vec3 last = curves::point_at(shape, *at);
    for (int k = 1; k <= kChords; ++k) {
      const double t = *at + (next - *at) * k / kChords;
      const Vec3 point = curves::point_at(shape, t - std::floor(t));
      length += (point - last).norm();
      last = point;
    }
    const double pieces =
        std::max({1.0, std::round(length / edge),
                  std::ceil(kLeastPieces * (next - *at) - 1e-9)});
    for (int k = 0; k < static_cast<int>(pieces); ++k) {
      const double t = *at + (next - *at) * k / pieces;
      result.push_back(t - std::floor(t));
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

bool turns(const ExactSurface& surface, int axis) {
  return axis == 0 ? !std::holds_alternative<ExactPlane>(surface) &&
                         !std::holds_alternative<ExactSplineSurface>(surface)
                   : std::holds_alternative<ExactTorus>(surface);
}

/// Loops within the outer one may stand whole turns beside it.
void shift_loops(const ExactSurface& surface,
                 std::vector<std::vector<Vec2>>& loops) {
  for (int axis = 0; axis < 2; ++axis) {
    if (!turns(surface, axis)) {
      continue;
    }
    const auto middle = [&](const std::vector<Vec2>& loop) {
      const auto [low, high] = std::minmax_element(
          loop.begin(), loop.end(),
          [&](const Vec2& a, const Vec2& b) { return a[axis] < b[axis]; });
      return 0.5 * ((*low)[axis] + (*high)[axis]);
    };
    for (std::size_t k = 1; k < loops.size(); ++k) {
      const double by =
          kWholeTurn *
          std::round((middle(loops[0]) - middle(loops[k])) / kWholeTurn);
      for (Vec2& place : loops[k]) {
        place[axis] += by;
      }
    }
  }
}

double area_of(const std::vector<Vec2>& loop) {
  double sum = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    sum += cross2(loop[k], loop[(k + 1) % loop.size()]);
  }
  return std::abs(sum);
}

}  // namespace

SolidStart::SolidStart(const films::FilmSystem& system, double edge)
    : system_(system), edge_(edge) {
  for (std::size_t s = 0; s < system.solids.size(); ++s) {
    Solid& solid = solids_.emplace_back();
    solid.shape = std::make_shared<const ExactShape>(
        films::shape_at(system.solids[s], system.curves));
    if (!system.solids[s].frame.empty()) {
      solid.frame = curve_named(system.solids[s].frame, system.solids[s].name);
    }
    const ExactShape& shape = *solid.shape;
    solid.on_rim.resize(shape.edges.size());
    solid.vertex_ids.assign(shape.vertices.size(), -1);
    solid.ids.resize(shape.edges.size());
    solid.edges.assign(shape.edges.size(), -1);
    for (const films::SolidSpec::Rim& rim : system.solids[s].rims) {
      cut_rim(s, rim);
    }
  }
}

int SolidStart::curve_named(const std::string& name,
                            const std::string& solid) const {
  const auto found =
      std::find_if(system_.curves.begin(), system_.curves.end(),
                   [&](const curves::Curve& c) { return c.name == name; });
  if (found == system_.curves.end()) {
    throw InvalidInput(fmt::format(
        "solid '{}' names the curve '{}', which does not exist", solid, name));
  }
  return static_cast<int>(found - system_.curves.begin());
}

std::map<int, std::vector<double>> SolidStart::take_cuts() {
  return std::move(cuts_);
}

Points SolidStart::places_along(std::size_t s,
                                const films::SolidSpec::Rim& rim) const {
  const ExactShape& shape = *solids_[s].shape;
  Points points;
  for (const int e : rim.edges) {
    const ExactEdge& edge = shape.edges[e];
    points.push_back(shape.vertices[edge.from]);
    points.push_back(shape.vertices[edge.to]);
    points.push_back(
        point_on(edge.curve, 0.75 * edge.first + 0.25 * edge.last));
  }
  return points;
}

std::vector<double> SolidStart::nearest_on_rim(const curves::Curve& curve,
                                               const Points& points,
                                               const std::string& solid) const {
  std::vector<double> t;
  const double allowed = kOffEdge * bounding_diagonal(points);
  for (const curves::CurvePlace& place :
       curves::nearest_places(curve.shape, points)) {
    if (place.distance > allowed) {
      throw InvalidInput(
          fmt::format("curve '{}' lies {:.3g} off an edge of solid '{}'",
                      curve.name, place.distance, solid));
    }
    t.push_back(place.t);
  }
  return t;
}

/// Cut at the ends of its edges, whatever the curve's own corners.
void SolidStart::cut_rim(std::size_t s, const films::SolidSpec::Rim& rim) {
  const ExactShape& shape = *solids_[s].shape;
  const int number = curve_named(rim.curve, system_.solids[s].name);
  const curves::Curve& curve = system_.curves[number];
  const std::vector<double> at =
      nearest_on_rim(curve, places_along(s, rim), system_.solids[s].name);
  std::map<int, double> t_of;  // of the solid's vertices
  const std::vector<double> corners = curves::corner_parameters(curve.shape);
  std::set<double> wanted(corners.begin(), corners.end());
  const auto want = [&](int vertex, double t) {
    for (const double other : wanted) {  // a corner, or the same vertex
      if (std::min(upward(other, t), upward(t, other)) < kOneCut) {
        t = other;
      }
    }
    wanted.insert(t);
    t_of[vertex] = t;
  };
  for (std::size_t k = 0; k < rim.edges.size(); ++k) {
    want(shape.edges[rim.edges[k]].from, at[3 * k]);
    want(shape.edges[rim.edges[k]].to, at[3 * k + 1]);
  }
  const std::vector<double> cuts = cuts_between(curve.shape, wanted, edge_);
  for (std::size_t k = 0; k < rim.edges.size(); ++k) {
    const ExactEdge& edge = shape.edges[rim.edges[k]];
    const double from = t_of.at(edge.from);
    const double to = t_of.at(edge.to);
    const double way = edge.from == edge.to ? 0.5 : upward(from, to);
    solids_[s].on_rim[rim.edges[k]] = {&rim, number, index_of(cuts, from),
                                       index_of(cuts, to),
                                       upward(from, at[3 * k + 2]) < way};
  }
  cut_counts_[number] = cuts.size();
  cuts_[number] = cuts;
}

void SolidStart::add_rim_edge(std::size_t s, int e,
                              const std::vector<int>& rim) {
  const OnRim& on = solids_[s].on_rim[e];
  const ExactEdge& edge = solids_[s].shape->edges[e];
  const std::size_t count = rim.size();
  if (count != cut_counts_.at(on.curve)) {
    throw InvalidInput(fmt::format(
        "curve '{}' is also a side of another solid, which cuts it otherwise; "
        "name one of them only",
        on.rim->curve));
  }
  std::vector<int>& ids = solids_[s].ids[e];
  ids = {rim[on.from]};
  std::size_t k = on.from;
  do {
    k = (k + (on.up ? 1 : count - 1)) % count;
    ids.push_back(rim[k]);
  } while (k != on.to);
  solids_[s].vertex_ids[edge.from] = ids.front();
  solids_[s].vertex_ids[edge.to] = ids.back();
}

int SolidStart::pieces_of(const ExactEdge& edge) const {
  double least = 1.0;
  if (std::holds_alternative<ExactEllipse>(edge.curve)) {
    least =
        std::ceil(kLeastPieces * (edge.last - edge.first) / kWholeTurn - 1e-9);
  } else if (std::holds_alternative<ExactSpline>(edge.curve)) {
    least = edge.from == edge.to ? kLeastPieces : 3.0;
  }
  return static_cast<int>(
      std::max({least, std::round(length_of(edge) / edge_), 1.0}));
}

int SolidStart::vertex_of(std::size_t s, int e, bool last,
                          films::FilmComplex& complex) {
  const ExactEdge& edge = solids_[s].shape->edges[e];
  const int vertex = last ? edge.to : edge.from;
  int& id = solids_[s].vertex_ids[vertex];
  if (id < 0) {
    id = static_cast<int>(complex.mesh.points.size());
    complex.mesh.points.push_back(solids_[s].shape->vertices[vertex]);
    complex.vertices.push_back({films::VertexKind::OnEdge, solids_[s].edges[e],
                                last ? edge.last : edge.first});
  }
  return id;
}

void SolidStart::add_edge(std::size_t s, int e, films::FilmComplex& complex) {
  const ExactEdge& edge = solids_[s].shape->edges[e];
  std::vector<int>& ids = solids_[s].ids[e];
  const std::vector<double> t = equal_pieces(edge, pieces_of(edge));
  ids.push_back(vertex_of(s, e, false, complex));
  for (std::size_t k = 1; k + 1 < t.size(); ++k) {
    ids.push_back(static_cast<int>(complex.mesh.points.size()));
    complex.mesh.points.push_back(point_on(edge.curve, t[k]));
    complex.vertices.push_back(
        {films::VertexKind::OnEdge, solids_[s].edges[e], t[k]});
  }
  ids.push_back(vertex_of(s, e, true, complex));
  for (std::size_t k = 1; k < ids.size(); ++k) {
    films::ComplexEdge mark;
    mark.a = ids[k - 1];
    mark.b = ids[k];
    mark.kind = films::VertexKind::OnEdge;
    mark.curve = solids_[s].edges[e];
    complex.edges.push_back(mark);
  }
}

void SolidStart::add_edges(const RimIds& rim, films::FilmComplex& complex) {
  for (std::size_t s = 0; s < solids_.size(); ++s) {
    const std::shared_ptr<const ExactShape>& shape = solids_[s].shape;
    std::set<int> used;  // by faces that are there
    for (const films::CapSpec& cap : system_.caps) {
      if (cap.solid != static_cast<int>(s)) {
        continue;
      }
      for (const auto& loop : shape->faces[cap.face].loops) {
        for (const ExactUse& use : loop) {
          used.insert(use.edge);
        }
      }
    }
    for (const int e : used) {  // first the rims: they give vertices
      if (solids_[s].on_rim[e].rim != nullptr) {
        add_rim_edge(s, e, rim(solids_[s].on_rim[e].rim->curve));
      }
    }
    for (const int e : used) {
      if (solids_[s].on_rim[e].rim == nullptr) {
        solids_[s].edges[e] = static_cast<int>(complex.solid_edges.size());
        complex.solid_edges.push_back({shape, e, solids_[s].frame});
        add_edge(s, e, complex);
      }
    }
    for (const int e : used) {
      const std::vector<int>& ids = solids_[s].ids[e];
      for (std::size_t k = 1; k < ids.size(); ++k) {
        taken_.insert(edge_key(ids[k - 1], ids[k]));
      }
    }
  }
}

std::vector<SolidStart::FaceLoop> SolidStart::loops_of(
    const films::CapSpec& cap, const Points& points) const {
  const ExactFace& face = solids_[cap.solid].shape->faces[cap.face];
  std::vector<FaceLoop> loops;
  for (const auto& uses : face.loops) {
    FaceLoop& loop = loops.emplace_back();
    for (const ExactUse& use : uses) {
      std::vector<int> along = solids_[cap.solid].ids[use.edge];
      if (!use.forward) {
        std::reverse(along.begin(), along.end());
      }
      Vec2 near = use.start;
      for (std::size_t k = 0; k + 1 < along.size(); ++k) {
        near = place_on(face.surface, points[along[k]], near);
        loop.ids.push_back(along[k]);
        loop.places.push_back(near);
      }
    }
  }
  std::iter_swap(loops.begin(),
                 std::max_element(loops.begin(), loops.end(),
                                  [](const FaceLoop& a, const FaceLoop& b) {
                                    return area_of(a.places) <
                                           area_of(b.places);
                                  }));
  return loops;
}

void SolidStart::fill(const films::CapSpec& cap,
                      const std::vector<FaceLoop>& loops, int label,
                      films::FilmComplex& complex) {
  const int number = complex.surfaces[label].face;
  const ExactSurface& surface = complex.solid_faces[number].face().surface;
  std::vector<std::vector<Vec2>> places;
  std::vector<int> corner;
  for (const FaceLoop& loop : loops) {
    places.push_back(loop.places);
    corner.insert(corner.end(), loop.ids.begin(), loop.ids.end());
  }
  shift_loops(surface, places);
  const Unrolled unrolled(surface, places);
  std::vector<Points> rims;
  for (const std::vector<Vec2>& loop : places) {
    Points& rim = rims.emplace_back();
    for (const Vec2& place : loop) {
      rim.push_back(unrolled.to_plane(place));
    }
  }
  const double edge = std::min(edge_, unrolled.longest_edge());
  require_room(polygon_area_vector(rims[0]).norm(), edge);
  SurfaceMesh filling = fill_face(rims, edge, true, cap.name);
  cut_doubles(corner, taken_, filling);
  for (std::size_t k = corner.size(); k < filling.points.size(); ++k) {
    const Vec2 place = unrolled.from_plane(filling.points[k]);
    corner.push_back(static_cast<int>(complex.mesh.points.size()));
    complex.mesh.points.push_back(point_on(surface, place));
    complex.vertices.push_back({.kind = films::VertexKind::OnFace,
                                .curve = number,
                                .t = place[0],
                                .share = place[1]});
  }
  for (const Triangle& t : filling.facets) {
    complex.mesh.facets.push_back({corner[t[0]], corner[t[1]], corner[t[2]]});
    complex.mesh.facet_label.push_back(label);
  }
}

void SolidStart::add_face(const films::CapSpec& cap, int label,
                          films::FilmComplex& complex) {
  complex.surfaces[label].face = static_cast<int>(complex.solid_faces.size());
  complex.solid_faces.push_back(
      {solids_[cap.solid].shape, cap.face, solids_[cap.solid].frame});
  try {
    fill(cap, loops_of(cap, complex.mesh.points), label, complex);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("solid '{}': {}", cap.name, error.what()));
  }
}

}  // namespace meniscus::start
