#include "evolve/start/wetted_faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/math/dense.h"
#include "evolve/energy/film_space.h"
#include "evolve/start/face_loops.h"

namespace meniscus::start {

namespace {

constexpr double kInPlane = 1e-9;  // of the rim's size

Expression over_place(const std::string& text) {
  return Expression::parse(text, {"x", "y", "z"});
}

/// factor (m x (r - from)), whose integral along a loop of a plane across m is
/// twice the factor x the area within.
films::VectorField area_field(const Vec3& m, const Vec3& from, double factor) {
  const Vec3 v = factor * m;
  const Vec3 rest = -v.cross(from);
  const auto part = [&](const char* text, double a, double b, double c) {
    const std::string moved = c != 0.0 ? fmt::format("+({:.17g})", c) : "";
    return over_place(fmt::format(fmt::runtime(text), a, b) + moved);
  };
  return {part("({:.17g})*z-({:.17g})*y", v.y(), v.z(), rest.x()),
          part("({:.17g})*x-({:.17g})*z", v.z(), v.x(), rest.y()),
          part("({:.17g})*y-({:.17g})*x", v.x(), v.y(), rest.z())};
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

/// A wetted face as a plane: through a point of its level set.
FacePlane plane_of(const films::FilmComplex& complex,
                   const films::ComplexSurface& face) {
  const films::LevelSet& level =
      complex.level_sets[complex.constraint_sets[face.constraints].front()];
  const double value = energy::value_at(level.formula, Vec3::Zero());
  const Vec3 n = energy::jet_at(level.formula, Vec3::Zero()).gradient;
  return {-value / n.squaredNorm() * n, *face.wetted, face.constraints};
}

/// Marked edges by their ends, of those that lie in a constraint set's walls.
std::set<Edge> edges_within(const films::FilmComplex& complex, int set) {
  const int level = complex.constraint_sets[set].front();
  std::set<Edge> result;
  for (const films::ComplexEdge& mark : complex.edges) {
    if (mark.constraints < 0) {
      continue;
    }
    const std::vector<int>& levels = complex.constraint_sets[mark.constraints];
    if (std::find(levels.begin(), levels.end(), level) != levels.end()) {
      result.insert(edge_key(mark.a, mark.b));
    }
  }
  return result;
}

/// Where a wetted face's boundary runs, in the direction of its facets: along
/// marked edges against its body's other facets.
std::map<int, int> boundary_of(const films::FilmComplex& complex, int surface) {
  std::map<int, int> next;
  const auto body =
      std::find_if(complex.bodies.begin(), complex.bodies.end(),
                   [&](const films::ComplexBody& b) {
                     return std::any_of(b.sides.begin(), b.sides.end(),
                                        [&](const films::BodySide& side) {
                                          return side.surface == surface;
                                        });
                   });
  if (body == complex.bodies.end()) {
    return next;
  }
  std::vector<int> sign(complex.surfaces.size(), 0);
  for (const films::BodySide& side : body->sides) {
    sign[side.surface] = complex.surfaces[side.surface].wetted ? 0 : side.sign;
    if (side.surface == surface && side.sign < 0) {
      throw InvalidInput(fmt::format("the face '{}' turns into its body",
                                     complex.surfaces[surface].name));
    }
  }
  const std::set<Edge> edges =
      edges_within(complex, complex.surfaces[surface].constraints);
  std::map<Edge, int> runs;  // out of the body, those both ways taken away
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const Triangle& t = complex.mesh.facets[f];
    const int side = sign[complex.mesh.facet_label[f]];
    for (int k = 0; k < 3 && side != 0; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      if (edges.count(edge_key(a, b)) > 0) {
        runs[edge_key(a, b)] += (a < b) == (side > 0) ? 1 : -1;
      }
    }
  }
  for (const auto& [run, count] : runs) {
    if (count != 0) {
      next[run[count > 0 ? 1 : 0]] = run[count > 0 ? 0 : 1];
    }
  }
  return next;
}

/// Where line integrals begin: on the planes of all faces that meet this one
/// along a seam, which then add nothing to them.
Vec3 middle_of(const films::FilmComplex& complex,
               const films::ComplexSurface& face) {
  const int own = complex.constraint_sets[face.constraints].front();
  std::set<int> others;
  for (const std::vector<int>& set : complex.constraint_sets) {
    if (std::find(set.begin(), set.end(), own) != set.end()) {
      others.insert(set.begin(), set.end());
    }
  }
  others.erase(own);
  if (others.empty()) {
    return Vec3::Zero();
  }
  Eigen::MatrixX3d normals(static_cast<Eigen::Index>(others.size()), 3);
  VectorX offs(normals.rows());
  Eigen::Index row = 0;
  for (const int level : others) {
    const Expression& formula = complex.level_sets[level].formula;
    normals.row(row) = energy::jet_at(formula, Vec3::Zero()).gradient;
    offs[row++] = -energy::value_at(formula, Vec3::Zero());
  }
  const Vec3 middle = least_norm(normals, offs);
  const double off = (normals * middle - offs).cwiseAbs().maxCoeff();
  if (!(off <= kInPlane * (1.0 + offs.cwiseAbs().maxCoeff()))) {
    throw InvalidInput(fmt::format(
        "'{}' meets walls that have no point in common; draw the whole",
        face.name));
  }
  return middle;
}

/// The level set of a cap's wall as a constraint set: planes that cut have one
/// for all the faces in them.
int wall_set(const films::CapSpec& cap, films::FilmComplex& complex) {
  const Expression formula = plane_formula(*cap.wall);
  for (std::size_t s = 0; cap.wall->cuts && s < complex.constraint_sets.size();
       ++s) {
    const std::vector<int>& set = complex.constraint_sets[s];
    if (set.size() == 1 &&
        complex.level_sets[set[0]].formula.text() == formula.text()) {
      return static_cast<int>(s);
    }
  }
  complex.constraint_sets.push_back(
      {static_cast<int>(complex.level_sets.size())});
  complex.level_sets.push_back({cap.name, formula});
  return static_cast<int>(complex.constraint_sets.size()) - 1;
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
  const int set = wall_set(cap, complex);
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
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const int label = complex.mesh.facet_label[f];
    if (!complex.surfaces[label].wetted) {
      mesh.facets.push_back(complex.mesh.facets[f]);
      mesh.facet_label.push_back(label);
    }
  }
  drop_unused(result);
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
    const Vec3 from = middle_of(complex, face);
    result.integrals.push_back(
        {face.name + " energy", films::LineIntegral::Role::Energy,
         area_field(*face.wetted, from, 0.5 * face.tension)});
    result.integrals.push_back({face.name + " content",
                                films::LineIntegral::Role::Content,
                                area_field(*face.wetted, from, -off / 6.0)});
    result.integral_sets.push_back({first, first + 1});
  }
  return result;
}

void close_wetted_faces(films::FilmComplex& complex, double edge) {
  std::vector<FacePlane> planes;
  for (const films::ComplexSurface& face : complex.surfaces) {
    if (face.wetted &&
        std::none_of(planes.begin(), planes.end(), [&](const FacePlane& p) {
          return p.set == face.constraints;
        })) {
      planes.push_back(plane_of(complex, face));
    }
  }
  FaceSeams seams(complex, planes, edge);
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    const films::ComplexSurface& face = complex.surfaces[s];
    if (face.wetted) {
      const auto label = static_cast<int>(s);
      fill_loops(seams.loops(plane_of(complex, face),
                             boundary_of(complex, label), face.name),
                 edge, false, label, complex);
    }
  }
  for (films::ComplexEdge& mark : complex.edges) {
    mark.integrals = -1;
  }
  complex.integrals.clear();
  complex.integral_sets.clear();
}

}  // namespace meniscus::start
