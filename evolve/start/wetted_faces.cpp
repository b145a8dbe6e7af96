#include "evolve/start/wetted_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/math/dense.h"
#include "evolve/energy/film_space.h"
#include "evolve/start/bent_fill.h"
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

using Texts = std::array<std::string, 3>;

/// x - c by its coordinates.
Texts from_point(const Vec3& c) {
  return {fmt::format("(x-({:.17g}))", c.x()),
          fmt::format("(y-({:.17g}))", c.y()),
          fmt::format("(z-({:.17g}))", c.z())};
}

std::string along(const Vec3& d, const Texts& r) {
  return fmt::format("(({:.17g})*{}+({:.17g})*{}+({:.17g})*{})", d.x(), r[0],
                     d.y(), r[1], d.z(), r[2]);
}

Texts crossed(const Vec3& d, const Texts& r) {
  const auto part = [&](int j, int k) {
    return fmt::format("(({:.17g})*{}-({:.17g})*{})", d[j], r[k], d[k], r[j]);
  };
  return {part(1, 2), part(2, 0), part(0, 1)};
}

/// scale x way + rest.
films::VectorField field_of(const Texts& way, const std::string& scale,
                            const Texts& rest) {
  const auto part = [&](int k) {
    return over_place(fmt::format("{}*{}+{}", scale, way[k], rest[k]));
  };
  return {part(0), part(1), part(2)};
}

/// What a line integral adds beside a wall's own: by x (r - from), twice the
/// cone of a part in `by` to the origin, `from` being beside the rims for the
/// sake of digits: it adds nothing along loops.
struct Rest {
  Vec3 by = Vec3::Zero();
  Vec3 from = Vec3::Zero();

  Texts texts() const { return crossed(by, from_point(from)); }
};

/// factor u x (r - c) / (|r - c| (|r - c| + u . (r - c))): along a loop on a
/// sphere about c the factor x the solid angle around u. By q = r - c - R u,
/// which is small where the sphere is large beside its face.
films::VectorField angle_field(const Vec3& u, const films::BentWall& sphere,
                               double factor, const Rest& rest) {
  const Texts q = from_point(sphere.at + sphere.radius * u);
  const std::string up = along(u, q);
  const std::string size =
      fmt::format("sqrt(({0})^2+({1})^2+({2})^2+({3:.17g})*(2*{4}+({3:.17g})))",
                  q[0], q[1], q[2], sphere.radius, up);
  const std::string scale = fmt::format("({:.17g})/({}*({}+{}+({:.17g})))",
                                        factor, size, size, up, sphere.radius);
  return field_of(crossed(u, q), scale, rest.texts());
}

/// Around an axis d through c, with z along it and t the angle about it:
/// (first z + third z^3) d x r - (q1 z + q2 z^2 + q3 z^3) dt, beside as above.
struct AxisForm {
  double moment = 0.0;  // of z d x r
  std::array<double, 3> turn = {0.0, 0.0, 0.0};
};
films::VectorField axis_field(const films::BentWall& wall, const AxisForm& form,
                              const Rest& rest) {
  const Texts r = from_point(wall.at);
  const std::string z = along(wall.axis, r);
  const std::string across =
      fmt::format("(({0})^2+({1})^2+({2})^2-({3})^2)", r[0], r[1], r[2], z);
  const std::string scale = fmt::format(
      "(({:.17g})*{}-(({:.17g})*{}+({:.17g})*({})^2+({:.17g})*({})^3)/{})",
      form.moment, z, form.turn[0], z, form.turn[1], z, form.turn[2], z,
      across);
  return field_of(crossed(wall.axis, r), scale, rest.texts());
}

Vec3 mean_place(const std::vector<Points>& rims) {
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  for (const Points& rim : rims) {
    sum = std::accumulate(rim.begin(), rim.end(), sum);
    count += rim.size();
  }
  return sum / static_cast<double>(count);
}

/// The bent wall of a cap, its origin beside its rims.
std::optional<films::BentWall> wall_beside(const films::CapSpec& cap,
                                           const std::vector<Points>& rims) {
  std::optional<films::BentWall> result = cap.wall->bent();
  if (result) {
    result = films::with_origin_beside(*result, mean_place(rims));
  }
  return result;
}

/// Along the rim of a face the integrals of its energy per area and of what it
/// bounds with the films' cones to the origin.
struct RimFields {
  films::VectorField energy;   // in the direction of its facets
  films::VectorField content;  // against it, as its body's films run
};

RimFields rim_fields(const films::WettedWall& face, double tension,
                     const std::vector<Points>& rims) {
  const films::BentWall& wall = *face.bent;
  const double r = wall.radius;
  const Rest none;
  // Cones to a point p of the wall's own, and p . F / 3 for the area vector F
  // of the rim's polygon.
  const Rest rest{-wall.at / 6.0, mean_place(rims)};
  switch (wall.kind) {
    case films::WallKind::Sphere: {
      const Vec3 pole = pole_of_face(wall, rims, face.side);
      return {angle_field(pole, wall, face.side * tension * r * r, none),
              angle_field(pole, wall, -r * r * r / 3.0, rest)};
    }
    case films::WallKind::Cone: {
      const double t = std::tan(wall.half_angle);
      const double c = std::cos(wall.half_angle);
      return {
          axis_field(wall,
                     {.turn = {0.0, face.side * tension * 0.5 * t / c, 0.0}},
                     none),
          axis_field(wall,
                     {.moment = -1.0 / 6.0, .turn = {0.0, 0.0, -t * t / 6.0}},
                     rest)};
    }
    default:
      return {
          axis_field(wall, {.turn = {face.side * tension * r, 0.0, 0.0}}, none),
          axis_field(wall,
                     {.moment = -1.0 / 6.0, .turn = {-0.5 * r * r, 0.0, 0.0}},
                     rest)};
  }
}

Vec3 unit_normal(const films::CapSpec& cap) {
  const double length = cap.wall->normal.norm();
  if (!(length > 0.0) || !std::isfinite(length) || !cap.wall->at.allFinite()) {
    throw InvalidInput(fmt::format(
        "the wall of '{}' needs a point and a normal that is not 0", cap.name));
  }
  return cap.wall->normal / length;
}

void require_size(const films::CapSpec& cap) {
  const films::FilmWall& wall = *cap.wall;
  const bool round = wall.kind == films::WallKind::Cylinder ||
                     wall.kind == films::WallKind::Sphere;
  if (round && !(wall.radius > 0.0 && std::isfinite(wall.radius))) {
    throw InvalidInput(
        fmt::format("the wall of '{}' needs a radius above 0, found {}",
                    cap.name, wall.radius));
  }
  if (wall.kind == films::WallKind::Cone &&
      !(wall.half_angle > 0.0 && wall.half_angle < 0.5 * EIGEN_PI)) {
    throw InvalidInput(fmt::format(
        "the cone of '{}' needs a half angle above 0 and below 90 deg, found "
        "{} rad",
        cap.name, wall.half_angle));
  }
}

/// Puts a rim onto the wall that it lies on but for rounding, or near which it
/// lies, of bent ones.
void require_on_wall(const films::CapSpec& cap, const std::string& curve,
                     const std::vector<int>& rim, Points& points) {
  Points loop;
  loop.reserve(rim.size());
  for (const int v : rim) {
    loop.push_back(points[v]);
  }
  const double reach = wall_reach(*cap.wall, bounding_diagonal(loop));
  const auto bent = wall_beside(cap, {loop});
  for (const int v : rim) {
    const double off = bent ? films::distance_outside(*bent, points[v])
                            : off_wall(*cap.wall, points[v]);
    if (!(std::abs(off) <= reach)) {
      throw InvalidInput(fmt::format(
          "curve '{}' is {:.3g} off the wall of '{}' at ({:.6g}, {:.6g}, "
          "{:.6g}); films that slide on it begin on curves that lie on it",
          curve, off, cap.name, points[v].x(), points[v].y(), points[v].z()));
    }
    if (bent) {
      points[v] = films::onto_wall(*bent, points[v]);
    } else {
      points[v] -= off * unit_normal(cap);
    }
  }
}

/// The flux of a bent wall's outward normal through its facets, above 0 where
/// they agree.
double outward_area(const SurfaceMesh& mesh, int label,
                    const films::BentWall& wall) {
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      const Triangle& t = mesh.facets[f];
      const Vec3& a = mesh.points[t[0]];
      const Vec3 middle = (a + mesh.points[t[1]] + mesh.points[t[2]]) / 3.0;
      const double size = 1e-3 * (mesh.points[t[1]] - a).norm();
      const Vec3 area =
          0.5 * (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
      const Vec3 step = size * area.normalized();
      sum += (films::distance_outside(wall, middle + step) -
              films::distance_outside(wall, middle)) /
             size * area.norm();
    }
  }
  return sum;
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
  const double value = value_at(level.formula, Vec3::Zero());
  const Vec3 n = jet_at(level.formula, Vec3::Zero()).gradient;
  return {-value / n.squaredNorm() * n, face.wetted->normal, face.constraints};
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

/// The loops that a boundary runs around.
std::vector<std::vector<int>> closed_loops(std::map<int, int> next,
                                           const std::string& face) {
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      loop.push_back(at->first);
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
      if (at == next.end() && to != loop.front()) {
        throw InvalidInput(
            fmt::format("the rim of '{}' on its wall is not closed", face));
      }
    }
  }
  return loops;
}

std::vector<Points> places_of(const std::vector<std::vector<int>>& loops,
                              const Points& points) {
  std::vector<Points> result;
  for (const std::vector<int>& loop : loops) {
    Points& places = result.emplace_back();
    for (const int v : loop) {
      places.push_back(points[v]);
    }
  }
  return result;
}

/// Planes that wetted faces lie in, each once.
std::vector<FacePlane> planes_of_faces(const films::FilmComplex& complex) {
  std::vector<FacePlane> planes;
  for (const films::ComplexSurface& face : complex.surfaces) {
    if (face.wetted && !face.wetted->bent &&
        std::none_of(planes.begin(), planes.end(), [&](const FacePlane& p) {
          return p.set == face.constraints;
        })) {
      planes.push_back(plane_of(complex, face));
    }
  }
  return planes;
}

/// The ends of a face's boundary where it is open.
Points open_ends(const films::FilmComplex& complex, int surface) {
  const std::map<int, int> next = boundary_of(complex, surface);
  std::set<int> reached;
  Points ends;
  for (const auto& [from, to] : next) {
    reached.insert(to);
    if (next.count(to) == 0) {
      ends.push_back(complex.mesh.points[to]);
    }
  }
  for (const auto& [from, to] : next) {
    if (reached.count(from) == 0) {
      ends.push_back(complex.mesh.points[from]);
    }
  }
  return ends;
}

/// Where line integrals along the faces in one plane begin: on the planes on
/// which their boundaries have open ends. The seams in these then add nothing,
/// and others do not move.
Vec3 middle_of(const films::FilmComplex& complex,
               const films::ComplexSurface& face) {
  Points ends;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    const films::ComplexSurface& other = complex.surfaces[s];
    if (other.wetted && other.constraints == face.constraints) {
      const Points more = open_ends(complex, static_cast<int>(s));
      ends.insert(ends.end(), more.begin(), more.end());
    }
  }
  const double reach = reach_of_planes(complex.mesh.points);
  std::vector<FacePlane> meets = planes_of_faces(complex);
  std::erase_if(meets, [&](const FacePlane& plane) {
    return plane.set == face.constraints ||
           std::none_of(ends.begin(), ends.end(), [&](const Vec3& end) {
             return std::abs(plane.normal.dot(end - plane.at)) <= reach;
           });
  });
  if (meets.empty()) {
    return Vec3::Zero();
  }
  const FacePlane own = plane_of(complex, face);
  if (std::any_of(meets.begin(), meets.end(), [&](const FacePlane& plane) {
        return std::abs(plane.normal.dot(own.normal)) > kInPlane;
      })) {
    meets.push_back(own);  // else across it, where it makes no difference
  }
  Eigen::MatrixX3d normals(static_cast<Eigen::Index>(meets.size()), 3);
  VectorX offs(normals.rows());
  Eigen::Index row = 0;
  for (const FacePlane& plane : meets) {
    normals.row(row) = plane.normal.transpose();
    offs[row++] = plane.normal.dot(plane.at);
  }
  const Vec3 middle = least_norm(normals, offs);
  const double off = (normals * middle - offs).cwiseAbs().maxCoeff();
  if (!(off <= kInPlane * (1.0 + offs.cwiseAbs().maxCoeff()))) {
    throw InvalidInput(fmt::format(
        "'{}' ends on planes that have no point in common; let its film end on "
        "planes that meet",
        face.name));
  }
  return middle;
}

/// What the line integrals of a face leave out of its body's volume: cones over
/// the parts beside seams that do not move.
double beside_lines(const films::FilmComplex& complex, int surface,
                    const Vec3& from) {
  const Vec3& n = complex.surfaces[surface].wetted->normal;
  double along = 0.0;  // twice the area
  double off = 0.0;
  for (const auto& [a, b] : boundary_of(complex, surface)) {
    const Vec3& p = complex.mesh.points[a];
    along += n.dot((p - from).cross(complex.mesh.points[b] - p));
    off = n.dot(p);
  }
  const double area = n.dot(area_vector(complex.mesh, surface));
  const double rest = area - 0.5 * along;
  return std::abs(rest) > kInPlane * std::abs(area) ? off / 3.0 * rest : 0.0;
}

/// Triangles on the bent wall between loops, in their direction.
SurfaceMesh filling_of(const films::BentWall& wall, const std::string& face,
                       const std::vector<Points>& loops, double side,
                       double edge) {
  try {
    return fill_bent_face(wall, loops, side, edge);
  } catch (const MeshError& error) {
    throw InvalidInput(
        fmt::format("the rim of '{}' on its wall: {}", face, error.what()));
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("'{}': {}", face, error.what()));
  }
}

/// New vertices come last.
void fill_on_wall(const std::vector<std::vector<int>>& loops, double edge,
                  int label, films::FilmComplex& complex) {
  const films::ComplexSurface& face = complex.surfaces[label];
  const SurfaceMesh filling = filling_of(*face.wetted->bent, face.name,
                                         places_of(loops, complex.mesh.points),
                                         face.wetted->side, edge);
  std::vector<int> ids;
  for (const std::vector<int>& loop : loops) {
    ids.insert(ids.end(), loop.begin(), loop.end());
  }
  add_filling(filling, std::move(ids), label, complex);
}

/// The level set of a cap's wall as a constraint set: planes that cut have one
/// for all the faces in them.
int wall_set(const films::CapSpec& cap,
             const std::optional<films::BentWall>& bent,
             films::FilmComplex& complex) {
  const Expression formula =
      bent ? films::wall_formula(*bent) : formula_of(*cap.wall);
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
  complex.level_sets.push_back(
      {.name = cap.name, .formula = formula, .bent = bent});
  return static_cast<int>(complex.constraint_sets.size()) - 1;
}

}  // namespace

Expression formula_of(const films::FilmWall& wall) {
  if (const auto bent = wall.bent()) {
    return films::wall_formula(*bent);
  }
  const Vec3 n = wall.normal.normalized();
  return over_place(fmt::format("({:.17g})*x+({:.17g})*y+({:.17g})*z-({:.17g})",
                                n.x(), n.y(), n.z(), n.dot(wall.at)));
}

void slide_on_wall(const films::FilmSystem& system, const films::CapSpec& cap,
                   int label, const std::vector<std::vector<int>>& rims,
                   films::FilmComplex& complex) {
  Vec3 n = unit_normal(cap);
  require_size(cap);
  const std::vector<std::string> curves = cap.curves();
  for (std::size_t k = 0; k < rims.size(); ++k) {
    require_one_film(system, cap, curves[k]);
    require_on_wall(cap, curves[k], rims[k], complex.mesh.points);
  }
  const bool of_body = std::any_of(system.bodies.begin(), system.bodies.end(),
                                   [&](const films::BodySpec& body) {
                                     return body.is_enclosed_by(cap.name);
                                   });
  if (of_body && area_vector(complex.mesh, label).dot(n) < 0.0) {
    n = -n;
  }
  const auto bent = wall_beside(cap, places_of(rims, complex.mesh.points));
  const int set = wall_set(cap, bent, complex);
  films::ComplexSurface& face = complex.surfaces[label];
  face.wetted = films::WettedWall{.normal = n, .bent = bent};
  if (face.wetted->bent) {
    face.wetted->side =
        outward_area(complex.mesh, label, *face.wetted->bent) < 0.0 ? -1.0
                                                                    : 1.0;
  }
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

double off_wall(const films::FilmWall& wall, const Vec3& place) {
  if (const auto bent = wall.bent()) {
    return films::distance_outside(*bent, place);
  }
  return wall.normal.normalized().dot(place - wall.at);
}

double wall_reach(const films::FilmWall& wall, double size) {
  constexpr double kNearBent = 0.15;
  return (wall.bent() ? kNearBent : kInPlane) * size;
}

SurfaceMesh fill_wetted_face(const films::CapSpec& cap,
                             std::vector<Points> rims, double edge) {
  require_size(cap);
  const std::vector<std::string> curves = cap.curves();
  for (std::size_t k = 0; k < rims.size(); ++k) {
    std::vector<int> all(rims[k].size());
    std::iota(all.begin(), all.end(), 0);
    require_on_wall(cap, curves[k], all, rims[k]);
  }
  return filling_of(*wall_beside(cap, rims), cap.name, rims, 0.0, edge);
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
  for (std::size_t k = 0; k < complex.surfaces.size(); ++k) {
    const films::ComplexSurface& face = complex.surfaces[k];
    const auto surface = static_cast<int>(k);
    if (!face.wetted) {
      continue;
    }
    const auto first = static_cast<int>(result.integrals.size());
    const auto edges = static_cast<int>(result.integral_sets.size());
    double off = 0.0;
    for (films::ComplexEdge& edge : result.edges) {
      if (edge.constraints == face.constraints) {
        edge.integrals = edges;
        off = face.wetted->normal.dot(mesh.points[edge.a]);
      }
    }
    RimFields fields;
    if (face.wetted->bent) {
      std::map<int, int> next;
      for (const films::ComplexEdge& mark : complex.edges) {
        if (mark.constraints == face.constraints) {
          next[mark.a] = mark.b;
        }
      }
      fields = rim_fields(
          *face.wetted, face.tension,
          places_of(closed_loops(next, face.name), complex.mesh.points));
    } else {
      const Vec3 from = middle_of(complex, face);
      const Vec3& n = face.wetted->normal;
      for (films::ComplexBody& body : result.bodies) {
        for (const films::BodySide& side : body.sides) {
          if (side.surface == surface) {
            body.volume_offset +=
                side.sign * beside_lines(complex, surface, from);
          }
        }
      }
      fields = {area_field(n, from, 0.5 * face.tension),
                area_field(n, from, -off / 6.0)};
    }
    result.integrals.push_back({face.name + " energy",
                                films::LineIntegral::Role::Energy,
                                std::move(fields.energy)});
    result.integrals.push_back({face.name + " content",
                                films::LineIntegral::Role::Content,
                                std::move(fields.content)});
    result.integral_sets.push_back({first, first + 1});
  }
  return result;
}

void close_wetted_faces(films::FilmComplex& complex, double edge) {
  FaceSeams seams(complex, planes_of_faces(complex), edge);
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    const films::ComplexSurface& face = complex.surfaces[s];
    const auto label = static_cast<int>(s);
    if (face.wetted && face.wetted->bent) {
      fill_on_wall(closed_loops(boundary_of(complex, label), face.name), edge,
                   label, complex);
    } else if (face.wetted) {
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
  for (films::ComplexBody& body : complex.bodies) {
    body.volume_offset = 0.0;
  }
}

}  // namespace meniscus::start
