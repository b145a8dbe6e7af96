#include "evolve/start/wetted_faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/start/cap_faces.h"

namespace meniscus::start {

namespace {

constexpr double kInPlane = 1e-9;  // of the rim's size

Expression over_place(const std::string& text) {
  return Expression::parse(text, {"x", "y", "z"});
}

/// factor (m x r), whose integral along a loop of a plane across m is twice the
/// factor x the area within.
films::VectorField area_field(const Vec3& m, double factor) {
  const Vec3 v = factor * m;
  return {over_place(fmt::format("({:.17g})*z-({:.17g})*y", v.y(), v.z())),
          over_place(fmt::format("({:.17g})*x-({:.17g})*z", v.z(), v.x())),
          over_place(fmt::format("({:.17g})*y-({:.17g})*x", v.x(), v.y()))};
}

Vec3 unit_normal(const films::CapSpec& cap) {
  const double length = cap.wall->normal.norm();
  if (!(length > 0.0) || !std::isfinite(length) || !cap.wall->at.allFinite()) {
    throw InvalidInput(fmt::format(
        "the wall of '{}' needs a point and a normal that is not 0", cap.name));
  }
  return cap.wall->normal / length;
}

/// Puts a rim onto the wall that it lies on but for rounding.
void require_on_wall(const films::CapSpec& cap, const std::string& curve,
                     const std::vector<int>& rim, Points& points) {
  const Vec3 n = unit_normal(cap);
  Points loop;
  loop.reserve(rim.size());
  for (const int v : rim) {
    loop.push_back(points[v]);
  }
  const double reach = kInPlane * bounding_diagonal(loop);
  for (const int v : rim) {
    const double off = n.dot(points[v] - cap.wall->at);
    if (!(std::abs(off) <= reach)) {
      throw InvalidInput(fmt::format(
          "curve '{}' is {:.3g} off the wall of '{}' at ({:.6g}, {:.6g}, "
          "{:.6g}); films that slide on it begin on curves in its plane",
          curve, off, cap.name, points[v].x(), points[v].y(), points[v].z()));
    }
    points[v] -= off * n;
  }
}

/// Of each edge of the surface's facets the way that one of them runs, where
/// only one has it.
std::set<Edge> open_runs(const SurfaceMesh& mesh, int label) {
  std::set<Edge> runs;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] != label) {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      if (runs.erase(Edge{b, a}) == 0) {
        runs.insert(Edge{a, b});
      }
    }
  }
  return runs;
}

Vec3 area_vector(const SurfaceMesh& mesh, int label) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      const Triangle& t = mesh.facets[f];
      const Vec3& a = mesh.points[t[0]];
      sum += 0.5 * (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
    }
  }
  return sum;
}

/// Nothing else may hold the rim, and one film ends there.
void require_one_film(const films::FilmSystem& system,
                      const films::CapSpec& cap, const std::string& curve) {
  const auto names = [&](const auto& list) {
    return std::find(list.begin(), list.end(), curve) != list.end();
  };
  const auto films = std::count_if(
      system.films.begin(), system.films.end(),
      [&](const films::FilmSpec& film) { return names(film.curves); });
  const auto caps =
      std::count_if(system.caps.begin(), system.caps.end(),
                    [&](const films::CapSpec& c) { return names(c.curves()); });
  if (films != 1 || caps != 1) {
    throw InvalidInput(fmt::format(
        "{} films and {} solids end at curve '{}', on which a film slides on "
        "the wall of '{}'; it needs one film and no other solid",
        films, caps, curve, cap.name));
  }
}

/// The rims of one wetted surface as closed loops, in the direction of its
/// facets, from their marked edges.
std::vector<std::vector<int>> loops_of(const films::FilmComplex& complex,
                                       int set) {
  std::map<int, int> next;
  for (const films::ComplexEdge& edge : complex.edges) {
    if (edge.constraints == set) {
      next[edge.a] = edge.b;
    }
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      loop.push_back(at->first);
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  return loops;
}

}  // namespace

Expression plane_formula(const films::PlaneWall& wall) {
  const Vec3 n = wall.normal.normalized();
  return over_place(fmt::format("({:.17g})*x+({:.17g})*y+({:.17g})*z-({:.17g})",
                                n.x(), n.y(), n.z(), n.dot(wall.at)));
}

void slide_on_wall(const films::FilmSystem& system, const films::CapSpec& cap,
                   int label, const std::vector<std::vector<int>>& rims,
                   films::FilmComplex& complex) {
  Vec3 n = unit_normal(cap);
  const std::vector<std::string> curves = cap.curves();
  for (std::size_t k = 0; k < rims.size(); ++k) {
    require_one_film(system, cap, curves[k]);
    require_on_wall(cap, curves[k], rims[k], complex.mesh.points);
  }
  if (area_vector(complex.mesh, label).dot(n) < 0.0) {
    n = -n;
  }
  const auto set = static_cast<int>(complex.constraint_sets.size());
  complex.constraint_sets.push_back(
      {static_cast<int>(complex.level_sets.size())});
  complex.level_sets.push_back({cap.name, plane_formula(*cap.wall)});
  films::ComplexSurface& face = complex.surfaces[label];
  face.wetted = n;
  face.tension = cap.wall->tension;
  face.constraints = set;
  for (const Edge& run : open_runs(complex.mesh, label)) {
    films::ComplexEdge mark;
    mark.a = run[0];
    mark.b = run[1];
    mark.constraints = set;
    complex.edges.push_back(mark);
  }
  for (const std::vector<int>& rim : rims) {
    for (const int v : rim) {
      complex.vertices[v] = {.kind = films::VertexKind::Free,
                             .constraints = set};
    }
  }
}

bool has_wetted_faces(const films::FilmComplex& complex) {
  return std::any_of(complex.surfaces.begin(), complex.surfaces.end(),
                     [](const films::ComplexSurface& surface) {
                       return surface.wetted.has_value();
                     });
}

films::FilmComplex open_wetted_faces(const films::FilmComplex& complex) {
  films::FilmComplex result = complex;
  if (!has_wetted_faces(complex)) {
    return result;
  }
  SurfaceMesh& mesh = result.mesh;
  mesh.facets.clear();
  mesh.facet_label.clear();
  std::vector<int> number(complex.vertices.size(), -1);
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const int label = complex.mesh.facet_label[f];
    if (!complex.surfaces[label].wetted) {
      mesh.facets.push_back(complex.mesh.facets[f]);
      mesh.facet_label.push_back(label);
      for (const int v : mesh.facets.back()) {
        number[v] = 0;
      }
    }
  }
  // Vertices that other facets have keep their order.
  mesh.points.clear();
  result.vertices.clear();
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) {
      number[v] = static_cast<int>(mesh.points.size());
      mesh.points.push_back(complex.mesh.points[v]);
      result.vertices.push_back(complex.vertices[v]);
    }
  }
  for (Triangle& t : mesh.facets) {
    for (int& v : t) {
      v = number[v];
    }
  }
  for (films::ComplexEdge& edge : result.edges) {
    edge.a = number[edge.a];
    edge.b = number[edge.b];
  }
  // The face's area A is half the integral of m x r along its rim, its cone
  // (m . r) A / 3. Films run along the rim the other way.
  for (const films::ComplexSurface& face : complex.surfaces) {
    if (!face.wetted) {
      continue;
    }
    const auto first = static_cast<int>(result.integrals.size());
    const auto edges = static_cast<int>(result.integral_sets.size());
    double off = 0.0;
    for (films::ComplexEdge& edge : result.edges) {
      if (edge.constraints == face.constraints) {
        edge.integrals = edges;
        off = face.wetted->dot(mesh.points[edge.a]);
      }
    }
    result.integrals.push_back({face.name + " energy",
                                films::LineIntegral::Role::Energy,
                                area_field(*face.wetted, 0.5 * face.tension)});
    result.integrals.push_back({face.name + " content",
                                films::LineIntegral::Role::Content,
                                area_field(*face.wetted, -off / 6.0)});
    result.integral_sets.push_back({first, first + 1});
  }
  return result;
}

void close_wetted_faces(films::FilmComplex& complex, double edge) {
  SurfaceMesh& mesh = complex.mesh;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    const films::ComplexSurface& face = complex.surfaces[s];
    if (!face.wetted) {
      continue;
    }
    const std::vector<std::vector<int>> loops =
        loops_of(complex, face.constraints);
    std::vector<Points> places;
    for (const std::vector<int>& loop : loops) {
      Points& of_loop = places.emplace_back();
      for (const int v : loop) {
        of_loop.push_back(mesh.points[v]);
      }
    }
    for (const std::vector<int>& part : faces_with_holes(places)) {
      std::vector<int> ids;
      std::vector<Points> bounds;
      for (const int k : part) {
        bounds.push_back(places[k]);
        ids.insert(ids.end(), loops[k].begin(), loops[k].end());
      }
      const SurfaceMesh filling = fill_face(bounds, edge, false, face.name);
      for (std::size_t i = ids.size(); i < filling.points.size(); ++i) {
        ids.push_back(static_cast<int>(mesh.points.size()));
        mesh.points.push_back(filling.points[i]);
        complex.vertices.push_back({films::VertexKind::InCap});
      }
      for (const Triangle& t : filling.facets) {
        mesh.facets.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
        mesh.facet_label.push_back(static_cast<int>(s));
      }
    }
  }
  for (films::ComplexEdge& mark : complex.edges) {
    mark.integrals = -1;
  }
  complex.integrals.clear();
  complex.integral_sets.clear();
}

}  // namespace meniscus::start
