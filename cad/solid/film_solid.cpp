#include "cad/solid/film_solid.h"

#include <algorithm>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "cad/solid/film_faces.h"
#include "cad/solid/measure_solid.h"
#include "cad/solid/mesh_parts.h"
#include "cad/solid/solid_rims.h"
#include "cad/solid/turned_face.h"
#include "core/error.h"
#include "core/geometry/facet_tree.h"

namespace meniscus::solid {

namespace {

constexpr double kSpanInEdges = 2.0;   // longest knot span
constexpr double kOffInEdges = 0.02;   // of the film from its faces, if spans
                                       // can keep it
constexpr double kMostGap = 1e-5;      // of the diagonal, the same at edges
constexpr double kMergeInEdges = 0.1;  // corners on a rim that become one
constexpr double kCorner = 1.0;        // between facets of sharp films [rad]
constexpr double kPlanar = 1e-6;       // of the diagonal

/// What a plane leaves of its edges, which may be a little off it.
void measure_plane(const BrepFace& face, const PlaneSurface& plane,
                   Brep& brep) {
  constexpr int kSamples = 100;
  for (const std::vector<BrepUse>& loop : face.loops) {
    for (const BrepUse& use : loop) {
      BrepEdge& edge = brep.edges[use.edge];
      for (int k = 0; k <= kSamples; ++k) {
        const Vec3 p = point_of(
            edge.curve, edge.first + (edge.last - edge.first) * k / kSamples);
        edge.gap =
            std::max(edge.gap, std::abs(plane.normal.dot(p - plane.point)));
      }
    }
  }
}

class SolidBuilder {
 public:
  explicit SolidBuilder(const FilmSolidInput& input)
      : input_(input), mesh_(input.mesh), rims_(input.mesh, input.rims) {}
  FilmSolid build();

 private:
  struct Cap {
    std::string name;
    std::vector<int> facets;
    std::vector<SolidLoop> loops;
    PlaneSurface plane;
  };

  bool is_cap(int label) const;
  bool ends_at(int facet, int other, const Edge& edge) const;
  void add_film(const std::string& name, const std::vector<int>& facets);
  bool add_simple(const std::string& name, const std::vector<int>& facets,
                  const FilmMesh& mesh, const std::vector<FilmRim>& rims,
                  const std::vector<SolidLoop>& loops);
  void add_cap(const std::string& name, const std::vector<int>& facets);
  BrepFace face_of(const Cap& cap, const std::vector<RimEdges>& rims) const;
  std::vector<RimEdges> build_rims(Brep& brep) const;

  const FilmSolidInput& input_;
  const SurfaceMesh& mesh_;
  SolidRims rims_;
  std::vector<FilmPiece> films_;
  std::vector<TurnedFilm> turned_;
  std::vector<Cap> caps_;
  FilmSolidReport report_;
};

void SolidBuilder::add_film(const std::string& name,
                            const std::vector<int>& facets) {
  // The film as a mesh of its own, with normals of least-squares quadrics.
  FilmMesh mesh;
  std::map<int, int> local;
  std::vector<int> global;
  for (const int f : facets) {
    Triangle t{};
    for (int k = 0; k < 3; ++k) {
      const int v = mesh_.facets[f][k];
      const auto [at, fresh] = local.emplace(v, static_cast<int>(local.size()));
      if (fresh) {
        mesh.points.push_back(mesh_.points[v]);
        global.push_back(v);
      }
      t[k] = at->second;
    }
    mesh.facets.push_back(t);
  }
  flip_folds(mesh);
  set_normals(mesh);
  FilmPiece film;
  film.name = name;
  film.facets = facets;
  // Its boundary loops lie on rims' curves.
  std::vector<FilmRim> rims;
  std::vector<SolidLoop> loops;
  for (const std::vector<int>& loop :
       boundary_loops(mesh.facets, mesh.points)) {
    std::vector<int> whole;
    whole.reserve(loop.size());
    for (const int v : loop) {
      whole.push_back(global[v]);
    }
    loops.push_back(rims_.loop_of(whole));
    const SolidLoop& on = loops.back();
    film.rims.push_back(on.rim);
    FilmRim rim{&rims_.curve(on.rim), {}, on.places};
    for (const int v : on.vertices) {
      rim.loop.push_back(local.at(v));
    }
    rims.push_back(std::move(rim));
  }
  // A plane, cylinder or sphere is exact as one face; else four-sided patches.
  if (add_simple(name, facets, mesh, rims, loops)) {
    return;
  }
  try {
    film.cut = cut_film(std::move(mesh), rims);
  } catch (const MeshError& error) {
    throw MeshError(
        fmt::format("film '{}': {}; a finer edge may help, or a faceted file",
                    name, error.what()));
  }
  films_.push_back(std::move(film));
}

/// True for a film that needs no patches.
bool SolidBuilder::add_simple(const std::string& name,
                              const std::vector<int>& facets,
                              const FilmMesh& mesh,
                              const std::vector<FilmRim>& rims,
                              const std::vector<SolidLoop>& loops) {
  const std::optional<SimpleFilm> shape = simple_film(mesh, rims, input_.edge);
  if (!shape) {
    return false;
  }
  const bool has_radius =
      std::holds_alternative<CylinderSurface>(shape->surface) ||
      std::holds_alternative<SphereSurface>(shape->surface);
  report_.simple.push_back({name, name_of(*shape), has_radius, shape->off});
  if (const auto* plane = std::get_if<PlaneSurface>(&shape->surface)) {
    report_.film_to_solid = std::max(report_.film_to_solid, shape->off);
    caps_.push_back({name, facets, loops, *plane});
  } else {
    const bool ball = std::holds_alternative<SphereSurface>(shape->surface);
    const bool cone = std::holds_alternative<ConeSurface>(shape->surface);
    (ball ? report_.spheres : cone ? report_.cones : report_.cylinders) += 1;
    std::vector<int> on;
    on.reserve(loops.size());
    for (const SolidLoop& loop : loops) {
      on.push_back(loop.rim);
    }
    turned_.push_back({name, *shape, std::move(on), mesh});
  }
  return true;
}

void SolidBuilder::add_cap(const std::string& name,
                           const std::vector<int>& facets) {
  Cap cap{name, facets, {}, {}};
  std::vector<Triangle> corners;
  corners.reserve(facets.size());
  Vec3 normal = Vec3::Zero();
  for (const int f : facets) {
    corners.push_back(mesh_.facets[f]);
    normal += area_vector2(mesh_, f);
  }
  normal.normalize();
  const double tolerance = kPlanar * bounding_diagonal(mesh_.points);
  for (const Triangle& t : corners) {
    for (const int v : t) {
      const double off =
          normal.dot(mesh_.points[v] - mesh_.points[corners[0][0]]);
      if (std::abs(off) > tolerance) {
        throw InvalidInput(
            fmt::format("cap '{}' is not flat: vertex {} is {:g} off its plane",
                        name, v, off));
      }
    }
  }
  cap.plane = {mesh_.points[corners[0][0]], normal};
  for (const std::vector<int>& loop : boundary_loops(corners, mesh_.points)) {
    cap.loops.push_back(rims_.loop_of(loop));
  }
  caps_.push_back(std::move(cap));
}

BrepFace SolidBuilder::face_of(const Cap& cap,
                               const std::vector<RimEdges>& rims) const {
  const Vec3& normal = cap.plane.normal;
  BrepFace face{cap.name, cap.plane, {}};
  std::vector<std::pair<double, std::vector<BrepUse>>> loops;
  for (const SolidLoop& loop : cap.loops) {
    const std::vector<int>& v = loop.vertices;
    const Vec3& p = mesh_.points[v[0]];
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < v.size(); ++i) {
      area += (mesh_.points[v[i]] - p).cross(mesh_.points[v[i + 1]] - p);
    }
    std::vector<BrepUse> uses;
    for (const RimEdges::Step& step :
         rims[loop.rim].between(0.0, 0.0, loop.growing)) {
      uses.push_back({step.edge, step.forward});
    }
    loops.emplace_back(-area.dot(normal), std::move(uses));
  }
  std::stable_sort(
      loops.begin(), loops.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& loop : loops) {
    face.loops.push_back(std::move(loop.second));
  }
  return face;
}

/// With the vertices that the films' faces want; only those that are used.
std::vector<RimEdges> SolidBuilder::build_rims(Brep& brep) const {
  std::set<int> used;
  for (const FilmPiece& film : films_) {
    used.insert(film.rims.begin(), film.rims.end());
  }
  for (const TurnedFilm& film : turned_) {
    used.insert(film.rims.begin(), film.rims.end());
  }
  for (const Cap& cap : caps_) {
    for (const SolidLoop& loop : cap.loops) {
      used.insert(loop.rim);
    }
  }
  std::vector<RimEdges> rims = rims_.edges(used);
  for (const FilmPiece& film : films_) {
    want_corners(film, rims);
  }
  for (const TurnedFilm& film : turned_) {
    want_seam(film, rims);
  }
  for (const int r : used) {
    rims[r].build(kMergeInEdges * input_.edge, brep, rims_.same());
  }
  return rims;
}

/// True where a face ends at another of its name.
bool SolidBuilder::ends_at(int facet, int other, const Edge& edge) const {
  const int label = mesh_.facet_label[facet];
  if (!is_cap(label)) {
    return std::count(input_.sharp.begin(), input_.sharp.end(),
                      mesh_.labels[label]) > 0 &&
           angle_between(mesh_, facet, other) > kCorner;
  }
  const auto& creased = input_.creased;
  return rims_.on_shared_side(edge) ||
         (std::count(creased.begin(), creased.end(), mesh_.labels[label]) > 0 &&
          is_crease(mesh_, facet, other));
}

bool SolidBuilder::is_cap(int label) const {
  return std::count(input_.caps.begin(), input_.caps.end(),
                    mesh_.labels[label]) > 0;
}

FilmSolid SolidBuilder::build() {
  // Plane faces of one name may meet.
  const auto ends = [this](int f, int g, const Edge& edge) {
    if (!ends_at(f, g, edge)) {
      return false;
    }
    if (is_cap(mesh_.facet_label[f])) {
      rims_.add_crease(edge);
    }
    return true;
  };
  const std::vector<std::vector<int>> parts = connected_parts(mesh_, ends);
  rims_.set_faces(parts);
  for (const std::vector<int>& part : parts) {
    const int label = mesh_.facet_label[part[0]];
    const std::string& name = mesh_.labels[label];
    if (std::count(input_.exact.begin(), input_.exact.end(), name) > 0) {
      continue;
    }
    if (is_cap(label)) {
      add_cap(name, part);
    } else {
      add_film(name, part);
    }
  }
  FilmSolid solid;
  const std::vector<RimEdges> rims = build_rims(solid.brep);
  for (const Cap& cap : caps_) {
    solid.brep.faces.push_back(face_of(cap, rims));
    measure_plane(solid.brep.faces.back(), cap.plane, solid.brep);
  }
  report_.planes = static_cast<int>(caps_.size());
  for (const TurnedFilm& film : turned_) {
    add_turned_face(film, rims, solid.brep);
    measure_turned(film, report_);
  }
  const FaceLimits limits{kSpanInEdges * input_.edge, kOffInEdges * input_.edge,
                          kMostGap * bounding_diagonal(mesh_.points)};
  for (const FilmPiece& film : films_) {
    const FilmFaces faces = add_faces(film, rims, limits, solid.brep);
    report_.patches += static_cast<int>(faces.patches.size());
    measure_film(film, faces, FacetTree(mesh_, film.facets), input_.edge,
                 report_);
  }
  for (const BrepEdge& e : solid.brep.edges) {
    report_.gap = std::max(report_.gap, e.gap);
  }
  solid.report = std::move(report_);
  return solid;
}

}  // namespace

FilmSolid film_solid(const FilmSolidInput& input) {
  return SolidBuilder(input).build();
}

Brep faceted_solid(const SurfaceMesh& mesh) {
  Brep brep;
  brep.vertices = mesh.points;
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  for (const Edge& e : edges) {
    const Vec3 way = mesh.points[e[1]] - mesh.points[e[0]];
    brep.edges.push_back({e[0], e[1],
                          StraightLine{mesh.points[e[0]], way.normalized()},
                          0.0, way.norm()});
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Triangle& t = mesh.facets[f];
    std::vector<BrepUse> loop;
    loop.reserve(3);
    for (int k = 0; k < 3; ++k) {
      loop.push_back({facet_edges[f][k], edges[facet_edges[f][k]][0] == t[k]});
    }
    const Vec3 normal = area_vector2(mesh, static_cast<int>(f)).normalized();
    brep.faces.push_back({mesh.labels[mesh.facet_label[f]],
                          PlaneSurface{mesh.points[t[0]], normal},
                          {std::move(loop)}});
  }
  return brep;
}

}  // namespace meniscus::solid
