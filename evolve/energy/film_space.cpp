#include "evolve/energy/film_space.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/place_field.h"

namespace meniscus::energy {

namespace {

constexpr int kWallSteps = 40;
constexpr double kOnWall = 1e-14;  // of the coordinates' size
constexpr double kAcross = 0.7;    // cosine: a rim's motion to its normal
constexpr double kFarAlong = 1e6;  // radii of a cylinder: no film goes there

Vec3 any_normal(const Vec3& t) { return t.cross(line_axis(t)).normalized(); }

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// Number of directions left by `walls` level sets at a vertex with `lines`
/// edges that are not ordinary.
int rank_of(int lines, int walls) {
  const int normal = walls >= 2 ? 3 : lines == 0 ? 1 : lines == 2 ? 2 : 3;
  return std::max(0, normal - walls);
}

}  // namespace

FilmSpace::FilmSpace(const films::FilmComplex& complex, FilmMotion motion)
    : facets_(complex.mesh.facets),
      level_sets_(complex.level_sets),
      curves_(complex.curves) {
  const auto points = static_cast<int>(complex.mesh.points.size());
  film_.reserve(facets_.size());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for (const int v : facets_[f]) {
      if (v < 0 || v >= points) {
        throw MeshError(fmt::format(
            "facet {} of the film names vertex {}, but there are {}", f, v,
            points));
      }
    }
    film_.push_back(complex.surfaces[complex.mesh.facet_label[f]].liquid ? 1
                                                                         : 0);
  }
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(facets_, edges, facet_edges);
  std::vector<int> films(edges.size(), 0);
  std::vector<char> used(points, 0);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      films[facet_edges[f][k]] += film_[f];
      used[facets_[f][k]] = 1;
    }
  }
  std::vector<int> lines(points, 0);
  std::vector<Edge> ends(points, Edge{-1, -1});
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (films[e] == 0 || films[e] == 2) {
      continue;
    }
    for (int k = 0; k < 2; ++k) {
      const int v = edges[e][k];
      if (lines[v] < 2) {
        ends[v][lines[v]] = edges[e][1 - k];
      }
      ++lines[v];
    }
  }
  line_.assign(points, -1);
  first_.reserve(points + 1);
  for (int v = 0; v < points; ++v) {
    first_.push_back(unknowns());
    const films::ComplexVertex& vertex = complex.vertices[v];
    const bool slides = vertex.kind == films::VertexKind::Slides;
    if ((vertex.kind != films::VertexKind::Free && !slides) || used[v] == 0) {
      continue;
    }
    if (lines[v] == 2) {
      line_[v] = static_cast<int>(line_ends_.size());
      line_ends_.push_back(ends[v]);
    }
    Wall wall;
    if (slides) {
      wall.curve = vertex.curve;
      wall.t = vertex.t;
      static_cast<void>(curves::jet_at(curves_[wall.curve].shape, wall.t));
    } else if (vertex.constraints >= 0) {
      for (const int wall_set : complex.constraint_sets[vertex.constraints]) {
        if (vertex.held ||
            level_sets_[wall_set].side == films::LevelSet::Side::On) {
          wall.level_sets.push_back(wall_set);
        }
      }
    }
    const auto walls = static_cast<int>(wall.level_sets.size());
    const int rank = slides ? 1
                     : motion == FilmMotion::Anywhere
                         ? std::max(0, 3 - walls)
                         : rank_of(lines[v], walls);
    vertex_.insert(vertex_.end(), rank, v);
    if (slides || walls > 0) {
      wall_of_.resize(points, -1);
      wall_of_[v] = static_cast<int>(walls_.size());
      walls_.push_back(std::move(wall));
      walled_.push_back(v);
    }
  }
  first_.push_back(unknowns());
  orient(facet_edges, facets_, film_, static_cast<int>(edges.size()));
}

/// Spreads one orientation over facets that meet at ordinary edges.
void FilmSpace::orient(const std::vector<Triangle>& facet_edges,
                       const std::vector<Triangle>& facets,
                       const std::vector<char>& film, int edge_count) {
  const auto count = static_cast<int>(facets.size());
  // Which film facets meet at an edge; where more than two do, a line of the
  // film, orientation does not pass.
  std::vector<Edge> pair(edge_count, Edge{-1, -1});
  std::vector<char> many(edge_count, 0);
  for (int f = 0; f < count; ++f) {
    if (film[f] == 0) {
      continue;
    }
    for (const int e : facet_edges[f]) {
      if (pair[e][0] < 0) {
        pair[e][0] = f;
      } else if (pair[e][1] < 0) {
        pair[e][1] = f;
      } else {
        many[e] = 1;
      }
    }
  }
  const auto from = [&](int f, int e) {
    for (int k = 0; k < 3; ++k) {
      if (facet_edges[f][k] == e) {
        return facets[f][k];
      }
    }
    return -1;
  };
  // Neighbours agree when they run opposite ways along their edge. If all do,
  // the facets' own order serves.
  bool agree = true;
  for (int e = 0; e < edge_count && agree; ++e) {
    agree = many[e] != 0 || pair[e][1] < 0 ||
            from(pair[e][0], e) != from(pair[e][1], e);
  }
  if (agree) {
    return;
  }
  // Otherwise breadth first from a seed per connected part: a neighbour is
  // turned where it runs the same way. A one-sided part keeps a seam.
  turn_.assign(count, 0);
  std::vector<int> queue;
  for (int seed = 0; seed < count; ++seed) {
    if (turn_[seed] != 0) {
      continue;
    }
    turn_[seed] = 1;
    queue.assign(1, seed);
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const int f = queue[at];
      for (const int e : facet_edges[f]) {
        if (many[e] != 0 || pair[e][1] < 0 || film[f] == 0) {
          continue;
        }
        const int g = pair[e][0] == f ? pair[e][1] : pair[e][0];
        if (turn_[g] == 0) {
          const bool same = from(f, e) == from(g, e);
          turn_[g] = static_cast<signed char>(same ? -turn_[f] : turn_[f]);
          queue.push_back(g);
        }
      }
    }
  }
}

const Edge& FilmSpace::line_ends(int vertex) const {
  static const Edge kNone = {-1, -1};
  return line_[vertex] < 0 ? kNone : line_ends_[line_[vertex]];
}

Points FilmSpace::directions(const Points& points) const {
  // Twice the area vectors about each vertex: their sum points along the
  // area-weighted normal.
  Points sum(points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (film_[f] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3& a = points[t[0]];
    Vec3 area2 = (points[t[1]] - a).cross(points[t[2]] - a);
    if (!turn_.empty()) {
      area2 *= turn_[f];
    }
    for (const int v : t) {
      sum[v] += area2;
    }
  }
  Points result(vertex_.size());
  for (int v = 0; v < vertex_count(); ++v) {
    const int r = rank(v);
    if (r == 0) {
      continue;
    }
    const int at = first_[v];
    // The directions span the normal space of the film: the normal on a film,
    // two across the line on a line, all three at a junction; walls take away
    // what leaves them.
    if (!wall_of_.empty() && wall_of_[v] >= 0) {
      wall_directions(wall_of_[v], points, sum[v], result);
    } else if (r == 1) {
      result[at] = unit(sum[v]);
    } else if (r == 2) {
      const Edge& ends = line_ends(v);
      const Vec3 along = unit(points[ends[1]] - points[ends[0]]);
      if (along.isZero(0.0)) {
        result[at] = result[at + 1] = Vec3::Zero();
      } else {
        result[at] = any_normal(along);
        result[at + 1] = along.cross(result[at]);
      }
    } else {
      for (int k = 0; k < 3; ++k) {
        result[at + k] = Vec3::Unit(k);
      }
    }
  }
  return result;
}

void FilmSpace::wall_directions(int k, const Points& points, const Vec3& normal,
                                Points& result) const {
  const int v = walled_[k];
  const int at = first_[v];
  const Wall& wall = walls_[k];
  if (wall.curve >= 0) {
    result[at] =
        unit(curves::jet_at(curves_[wall.curve].shape, nearest(wall, points[v]))
                 .first);
    return;
  }
  const Eigen::MatrixX3d rows = wall_normals(k, points[v]);
  const Vec3 n = unit(rows.row(0));
  if (rows.rows() == 2) {
    result[at] = unit(n.cross(Vec3(rows.row(1))));
  } else if (rank(v) == 2) {
    result[at] = n.isZero(0.0) ? n : any_normal(n);
    result[at + 1] = n.cross(result[at]);
  } else {
    result[at] = unit(normal - normal.dot(n) * n);
    if (const Edge& ends = line_ends(v); ends[0] >= 0) {
      // Where the film lies flat on the wall, or films cancel.
      const Vec3 across = unit(n.cross(points[ends[1]] - points[ends[0]]));
      if (turns_across(result[at], across)) {
        result[at] = across;
      }
    }
  }
}

bool FilmSpace::turns_across(const Vec3& along, const Vec3& across) {
  return !(std::abs(along.dot(across)) > kAcross);
}

Points FilmSpace::moved(const Points& points, const Points& directions,
                        const VectorX& heights) const {
  Points result = points;
  for (int i = 0; i < unknowns(); ++i) {
    result[vertex_[i]] += heights[i] * directions[i];
  }
  for (std::size_t k = 0; k < walled_.size(); ++k) {
    Vec3& at = result[walled_[k]];
    at = on_walls(k, at, points[walled_[k]]);
  }
  return result;
}

bool FilmSpace::has_bent_walls() const {
  return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& wall) {
    return bent_wall(wall) != nullptr;
  });
}

const films::BentWall* FilmSpace::bent_wall(const Wall& wall) const {
  if (wall.curve >= 0 || wall.level_sets.size() != 1) {
    return nullptr;
  }
  const films::LevelSet& level = level_sets_[wall.level_sets[0]];
  return level.bent ? &*level.bent : nullptr;
}

FilmPaths FilmSpace::paths(const Points& points, const Points& directions,
                           const VectorX& heights) const {
  FilmPaths result{directions, {}, {}};
  if (!has_bent_walls()) {
    return result;
  }
  result.second.assign(directions.size(), Vec3::Zero());
  for (std::size_t k = 0; k < walled_.size(); ++k) {
    const int v = walled_[k];
    const films::BentWall* wall = bent_wall(walls_[k]);
    if (wall == nullptr || rank(v) != 1) {
      continue;
    }
    const int i = first_[v];
    const Vec3& n = directions[i];
    const Vec3 place = points[v] + heights[i] * n;
    const films::OntoWall onto = films::onto_wall_jet(*wall, place);
    result.first[i] = onto.slope * n;
    for (int c = 0; c < 3; ++c) {
      result.second[i][c] = n.dot(onto.bend[c] * n);
    }
    result.bent.push_back({i, v, n, *wall, place, onto});
  }
  return result;
}

void FilmSpace::project(Points& points) const {
  for (std::size_t k = 0; k < walled_.size(); ++k) {
    Vec3& at = points[walled_[k]];
    at = on_walls(k, at, at);
  }
}

Vec3 FilmSpace::on_walls(std::size_t k, const Vec3& at,
                         const Vec3& from) const {
  const Vec3 found = back_on(walls_[k], at);
  const films::BentWall* bent = bent_wall(walls_[k]);
  if (!found.allFinite() ||
      (bent != nullptr && bent->kind == films::WallKind::Cylinder &&
       !((found - bent->at).norm() < kFarAlong * bent->radius))) {
    throw OffWalls(off_walls(k, bent != nullptr ? from : at));
  }
  return found;
}

std::string FilmSpace::off_walls(std::size_t k, const Vec3& at) const {
  const std::string place =
      fmt::format("({:.6g}, {:.6g}, {:.6g})", at.x(), at.y(), at.z());
  if (bent_wall(walls_[k]) == nullptr) {
    return fmt::format(
        "vertex {} at {} cannot be put back on its wall; check the "
        "constraint's formula there",
        walled_[k], place);
  }
  return fmt::format(
      "the rim on the wall of '{}' runs off it from {}, over its axis, center "
      "or apex or far away; start on a curve nearer to where the film rests, "
      "or take shorter edges, another volume or contact angle",
      level_sets_[walls_[k].level_sets[0]].name, place);
}

Vec3 FilmSpace::back_on(const Wall& wall, Vec3 at) const {
  if (wall.curve >= 0) {
    return curves::point_at(curves_[wall.curve].shape, nearest(wall, at));
  }
  if (const films::BentWall* bent = bent_wall(wall); bent != nullptr) {
    return films::onto_wall(*bent, at);
  }
  const auto count = static_cast<Eigen::Index>(wall.level_sets.size());
  Eigen::MatrixX3d rows(count, 3);
  VectorX gap(count);
  for (int step = 0; step < kWallSteps; ++step) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const PlaceJet jet = jet_at(level_sets_[wall.level_sets[i]].formula, at);
      rows.row(i) = jet.gradient;
      gap[i] = jet.value;
    }
    const Vec3 move =
        count == 1
            ? Vec3(rows.row(0).transpose() * (gap[0] / rows.squaredNorm()))
            : Vec3(least_norm(rows, gap));
    at -= move;
    if (!(move.norm() > kOnWall * at.norm())) {
      break;
    }
  }
  return at;
}

double FilmSpace::nearest(const Wall& wall, const Vec3& at) const {
  const curves::CurveShape& shape = curves_[wall.curve].shape;
  double t = wall.t;
  for (int step = 0; step < kWallSteps; ++step) {
    const curves::CurveJet jet = curves::jet_at(shape, t);
    const Vec3 gap = jet.point - at;
    const double speed2 = jet.first.squaredNorm();
    const double bend = speed2 + gap.dot(jet.second);
    double move = gap.dot(jet.first) / (bend > 0.1 * speed2 ? bend : speed2);
    const double curl2 = jet.second.squaredNorm();
    if (curl2 > 0.0) {  // at most a quarter of a radian at a time
      const double most = 0.25 * std::sqrt(speed2 / curl2);
      move = std::clamp(move, -most, most);
    }
    t -= move;
    if (!(std::abs(move) > 1e-15 * (1.0 + std::abs(t)))) {
      break;
    }
  }
  return t;
}

double FilmSpace::parameter(int vertex, const Vec3& at) const {
  return nearest(walls_[wall_of_[vertex]], at);
}

Eigen::MatrixX3d FilmSpace::wall_normals(int k, const Vec3& at) const {
  const Wall& wall = walls_[k];
  if (wall.curve >= 0) {
    const Vec3 t = unit(
        curves::jet_at(curves_[wall.curve].shape, nearest(wall, at)).first);
    Eigen::MatrixX3d rows(2, 3);
    rows.row(0) = any_normal(t);
    rows.row(1) = t.cross(any_normal(t));
    return rows;
  }
  Eigen::MatrixX3d rows(static_cast<Eigen::Index>(wall.level_sets.size()), 3);
  for (std::size_t i = 0; i < wall.level_sets.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) =
        jet_at(level_sets_[wall.level_sets[i]].formula, at).gradient;
  }
  return rows;
}

Eigen::Matrix3d FilmSpace::wall_curvature(int k, const Vec3& at,
                                          const Vec3& gradient) const {
  const Wall& wall = walls_[k];
  if (wall.curve >= 0) {
    const curves::CurveJet jet =
        curves::jet_at(curves_[wall.curve].shape, nearest(wall, at));
    const double speed2 = jet.first.squaredNorm();
    const Vec3 t = jet.first / std::sqrt(speed2);
    // moved() goes back to the nearest point: only the normal part counts.
    const Vec3 bend = jet.second - jet.second.dot(t) * t;
    return gradient.dot(bend) / speed2 * t * t.transpose();
  }
  // With lambda the forces of the walls, d2E of the way along the walls is
  // that of E - sum lambda f.
  const Eigen::MatrixX3d rows = wall_normals(k, at);
  const VectorX lambda = least_norm(rows.transpose(), gradient);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < wall.level_sets.size(); ++i) {
    sum -= lambda[static_cast<Eigen::Index>(i)] *
           jet_at(level_sets_[wall.level_sets[i]].formula, at).hessian;
  }
  return sum;
}

}  // namespace meniscus::energy
