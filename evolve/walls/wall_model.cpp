#include "evolve/walls/wall_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/walls/rim_shape.h"
#include "evolve/walls/wall_films.h"
#include "evolve/walls/wall_offset.h"

namespace meniscus::walls {

namespace {

constexpr double kSpannedByEdges = 1e-4;  // of the largest eigenvalue
constexpr double kMostRise =
    0.08;  // of edges with bent sides: a tenth of a turn
// Walls with nodes half way across, of the edges there.
constexpr double kThinnestHalved = 0.5;
constexpr double kThickestHalved = 2.0;

std::vector<WallSpec> on_finest(const std::vector<WallSpec>& walls,
                                const WallTopology& topology,
                                const WallFilms& films) {
  SurfaceMesh finest;
  finest.points = films.mesh.points;
  finest.labels = films.mesh.labels;
  for (const WallFacet& facet : topology.facets) {
    finest.facets.push_back(facet.film);
    finest.facet_label.push_back(facet.label);
  }
  return on_films(walls, finest, films.wall, films.rims);
}

}  // namespace

WallModel WallModel::freeze(const frozen::FilmModel& film,
                            const films::FilmSystem& system,
                            const Points& points,
                            const std::vector<WallSpec>& walls,
                            SafePlaces places) {
  return {wall_films(film, system, points, walls), walls, places};
}

WallModel::WallModel(const WallFilms& films, std::vector<WallSpec> walls,
                     SafePlaces places)
    : given_(std::move(walls)),
      reference_film_(films.mesh.points),
      planes_(films.planes),
      topology_(wall_topology(films)),
      specs_(on_finest(given_, topology_, films)),
      reference_(wall_reference(topology_, films, specs_, places)) {
  std::vector<std::set<int>> vertices(specs_.size());
  for (std::size_t p = 0; p < reference_.moves.size(); ++p) {
    for (const WallMove& move : reference_.moves[p]) {
      vertices[move.wall].insert(topology_.points[p].vertex);
    }
  }
  for (const std::set<int>& of_wall : vertices) {
    vertices_of_.emplace_back(of_wall.begin(), of_wall.end());
  }
  freeze_moves();
  std::vector<int> corner;
  SurfaceMesh coarse = topology_.coarse;
  // Corners are numbered as the coarse facets name them.
  std::vector<int> id(topology_.points.size(), -1);
  for (Triangle& t : coarse.facets) {
    for (int& v : t) {
      if (id[v] < 0) {
        id[v] = static_cast<int>(corner.size());
        corner.push_back(v);
      }
      v = id[v];
    }
  }
  find_straight();
  nodes_ = surface_nodes(std::move(coarse), std::move(corner),
                         topology_.middles, straight_);
  report();
}

/// Middles of edges too long for what they bend around, as a fillet: elements
/// bent so far would fold at the next design.
void WallModel::find_straight() {
  const Points points = points_of(reference_film_, numbers(given_));
  straight_.assign(points.size(), 0);
  for (const auto& [edge, middle] : topology_.middles) {
    const Vec3& a = points[edge[0]];
    const Vec3& b = points[edge[1]];
    const Vec3 rise = points[middle] - 0.5 * (a + b);
    straight_[middle] = rise.norm() > kMostRise * (b - a).norm() ? 1 : 0;
  }
}

/// Every offset as a combination of the normals and edges at its vertex.
void WallModel::freeze_moves() {
  std::vector<Around> around(topology_.points.size());
  const Points& x = reference_film_;
  for (std::size_t f = 0; f < topology_.facets.size(); ++f) {
    const WallFacet& facet = topology_.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int next = facet.film[(k + 1) % 3];
      const int last = facet.film[(k + 2) % 3];
      const Vec3 a = x[next] - x[facet.film[k]];
      const Vec3 b = x[last] - x[facet.film[k]];
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      for (const bool front : {true, false}) {
        Around& here = around[front ? facet.front[k] : facet.back[k]];
        here.facets.emplace_back(static_cast<int>(f), angle);
        here.in_front.push_back(front ? 1 : 0);
        here.neighbours.insert({next, last});
      }
    }
  }
  const Points normals = unit_normals(x);
  follow_.resize(topology_.points.size());
  for (std::size_t p = 0; p < follow_.size(); ++p) {
    const int v = topology_.points[p].vertex;
    if (v >= 0) {
      follow_[p] = follow(around[p], v, normals, reference_.moves[p]);
    }
  }
}

WallModel::Follow WallModel::follow(const Around& around, int vertex,
                                    const Points& normals,
                                    const std::vector<WallMove>& moves) const {
  const Points& x = reference_film_;
  Mat3 by_normals = Mat3::Zero();
  for (const auto& [f, angle] : around.facets) {
    by_normals += angle * normals[f] * normals[f].transpose();
  }
  Mat3 by_edges = Mat3::Zero();
  for (const int v : around.neighbours) {
    const Vec3 edge = x[v] - x[vertex];
    by_edges += edge * edge.transpose();
  }
  const Mat3 normal_inverse = mitre_inverse(by_normals);
  const Mat3 edge_inverse = mitre_inverse(by_edges, kSpannedByEdges);
  Follow result;
  for (const WallMove& move : moves) {
    Vec3 rest = move.by;
    const Vec3 y = normal_inverse * move.by;
    for (const auto& [f, angle] : around.facets) {
      const double weight = angle * normals[f].dot(y);
      result.normals.push_back({f, move.wall, weight});
      rest -= weight * normals[f];
    }
    const Vec3 z = edge_inverse * rest;
    for (const int v : around.neighbours) {
      const double weight = (x[v] - x[vertex]).dot(z);
      result.edges.push_back({v, move.wall, weight});
      rest -= weight * (x[v] - x[vertex]);
    }
    result.rest.push_back({move.wall, rest});
  }
  result.along = planes_.along(vertex);
  for (std::size_t i = 0; result.along && i < around.facets.size(); ++i) {
    const auto& [f, angle] = around.facets[i];
    result.of_normal.push_back(
        {.at = f, .weight = around.in_front[i] != 0 ? angle : -angle});
  }
  return result;
}

Vec3 WallModel::offset(int point, const Points& film, const Points& normals,
                       const std::vector<VectorX>& ratio) const {
  const Follow& follow = follow_[point];
  const int v = topology_.points[point].vertex;
  Vec3 by = Vec3::Zero();
  for (const Share& share : follow.normals) {
    by += ratio[share.wall][v] * share.weight * normals[share.at];
  }
  for (const Share& share : follow.edges) {
    by += ratio[share.wall][v] * share.weight * (film[share.at] - film[v]);
  }
  for (const WallMove& rest : follow.rest) {
    by += ratio[rest.wall][v] * rest.by;
  }
  return by;
}

Vec3 WallModel::normal_sum(int point, const Points& normals) const {
  Vec3 sum = Vec3::Zero();
  for (const Share& share : follow_[point].of_normal) {
    sum += share.weight * normals[share.at];
  }
  return sum;
}

Points WallModel::unit_normals(const Points& film) const {
  Points normals;
  normals.reserve(topology_.facets.size());
  for (const WallFacet& facet : topology_.facets) {
    const auto& [a, b, c] = facet.film;
    normals.push_back(
        (film[b] - film[a]).cross(film[c] - film[a]).normalized());
  }
  return normals;
}

std::vector<VectorX> WallModel::numbers(
    const std::vector<WallSpec>& walls) const {
  std::vector<VectorX> result;
  for (std::size_t w = 0; w < given_.size(); ++w) {
    if (walls.size() != given_.size() ||
        !is_same_but_numbers(walls[w].thickness, given_[w].thickness) ||
        walls[w].name != given_[w].name) {
      throw InvalidInput("the design's walls are not those of its model");
    }
    result.push_back(walls[w].thickness.numbers);
  }
  return result;
}

std::vector<VectorX> WallModel::ratios(
    const std::vector<VectorX>& numbers) const {
  const auto count = static_cast<Eigen::Index>(reference_film_.size());
  std::vector<VectorX> result(specs_.size(), VectorX::Ones(count));
  for (std::size_t w = 0; w < specs_.size(); ++w) {
    const PlaceField& field = specs_[w].thickness;
    const Numbers now(numbers[w].data(),
                      static_cast<std::size_t>(numbers[w].size()));
    if (!field.has_numbers() || numbers[w] == field.numbers) {
      continue;
    }
    for (const int v : vertices_of_[w]) {
      const Vec3& at = reference_film_[v];
      result[w][v] =
          thickness_at(specs_[w], now, at) / value_at(field, field.own(), at);
    }
  }
  return result;
}

Points WallModel::points_of(const Points& film,
                            const std::vector<VectorX>& numbers) const {
  if (film.size() != reference_film_.size()) {
    throw InvalidInput(
        fmt::format("walls: a film of {} points is not that of "
                    "the model, which has {}",
                    film.size(), reference_film_.size()));
  }
  const std::vector<VectorX> ratio = ratios(numbers);
  const Points normals = unit_normals(film);
  Points result(topology_.points.size(), Vec3::Zero());
  for (std::size_t p = 0; p < result.size(); ++p) {
    const int v = topology_.points[p].vertex;
    if (v < 0) {
      continue;
    }
    const auto point = static_cast<int>(p);
    Vec3 by = offset(point, film, normals, ratio);
    if (const auto& along = follow_[p].along) {
      by = in_planes(*along, normal_sum(point, normals).normalized(), by);
    }
    result[p] = film[v] + by;
  }
  for (std::size_t p = 0; p < result.size(); ++p) {
    for (const auto& [q, weight] : topology_.points[p].of) {
      result[p] += weight * result[q];
    }
  }
  return result;
}

QuadraticSurface WallModel::surface(const Points& film,
                                    const std::vector<VectorX>& numbers) const {
  return nodes_.at(points_of(film, numbers));
}

SurfaceMesh WallModel::fine(const Points& film,
                            const std::vector<VectorX>& numbers) const {
  SurfaceMesh mesh = topology_.fine;
  mesh.points = points_of(film, numbers);
  return mesh;
}

void WallModel::split_facets(const std::vector<char>& marked) {
  nodes_ = meniscus::split_facets(nodes_, marked, topology_.middles, straight_);
}

WallGradient WallModel::transpose(const Points& film,
                                  const std::vector<VectorX>& numbers,
                                  const Points& by_corners,
                                  const Points& by_mid_sides) const {
  Points by =
      nodes_.transpose(by_corners, by_mid_sides, topology_.points.size());
  // Points that follow others pass their part on by the same weights.
  for (std::size_t p = 0; p < by.size(); ++p) {
    for (const auto& [q, weight] : topology_.points[p].of) {
      by[q] += weight * by[p];
    }
  }
  // Backwards through x + d with d = sum c_f n_f + sum b_j (x_j - x) + e, each
  // part times its wall's t / t0: to the normals, the film's points and the
  // ratios.
  const std::vector<VectorX> ratio = ratios(numbers);
  const Points normals = unit_normals(film);
  Points by_normals(normals.size(), Vec3::Zero());
  WallGradient result{.film = Points(film.size(), Vec3::Zero()),
                      .thickness = {}};
  std::vector<VectorX> by_ratio;
  by_ratio.reserve(ratio.size());
  for (const VectorX& of_wall : ratio) {
    by_ratio.push_back(VectorX::Zero(of_wall.size()));
  }
  for (std::size_t p = 0; p < by.size(); ++p) {
    const int v = topology_.points[p].vertex;
    if (v < 0) {
      continue;
    }
    result.film[v] += by[p];
    if (const auto& along = follow_[p].along) {
      const auto point = static_cast<int>(p);
      const Vec3 sum = normal_sum(point, normals);
      const Vec3 n = sum.normalized();
      const InPlanesGradient in = transpose_in_planes(
          *along, n, offset(point, film, normals, ratio), by[p]);
      const Vec3 by_sum = (in.normal - n * n.dot(in.normal)) / sum.norm();
      for (const Share& share : follow_[p].of_normal) {
        by_normals[share.at] += share.weight * by_sum;
      }
      by[p] = in.w;
    }
    for (const Share& share : follow_[p].normals) {
      by_normals[share.at] += ratio[share.wall][v] * share.weight * by[p];
      by_ratio[share.wall][v] += share.weight * normals[share.at].dot(by[p]);
    }
    for (const Share& share : follow_[p].edges) {
      const Vec3 part = ratio[share.wall][v] * share.weight * by[p];
      result.film[share.at] += part;
      result.film[v] -= part;
      by_ratio[share.wall][v] +=
          share.weight * (film[share.at] - film[v]).dot(by[p]);
    }
    for (const WallMove& rest : follow_[p].rest) {
      by_ratio[rest.wall][v] += rest.by.dot(by[p]);
    }
  }
  // The ratio is t / t0, hence dJ/dt = dJ/dratio / t0.
  for (std::size_t w = 0; w < specs_.size(); ++w) {
    const PlaceField& field = specs_[w].thickness;
    const Numbers now(numbers[w].data(),
                      static_cast<std::size_t>(numbers[w].size()));
    VectorX& by_numbers =
        result.thickness.emplace_back(VectorX::Zero(numbers[w].size()));
    for (const int v : vertices_of_[w]) {
      const Vec3& at = reference_film_[v];
      if (field.has_numbers() && by_ratio[w][v] != 0.0) {
        add_by_numbers(field, now, at,
                       by_ratio[w][v] / value_at(field, field.own(), at),
                       Vec3::Zero(), by_numbers);
      }
    }
  }
  // Unit normals depend on the film's points: dJ/da = (I - n n') dJ/dn / |a|.
  through_normals(film, normals, by_normals, result.film);
  return result;
}

// n = a / |a|, a = (x1 - x0) x (x2 - x0).
void WallModel::through_normals(const Points& film, const Points& normals,
                                const Points& by_normals,
                                Points& by_film) const {
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const auto& [a, b, c] = topology_.facets[f].film;
    const Vec3 u = film[b] - film[a];
    const Vec3 w = film[c] - film[a];
    const Vec3& n = normals[f];
    const Vec3 by_area =
        (by_normals[f] - n * n.dot(by_normals[f])) / u.cross(w).norm();
    const Vec3 by_u = w.cross(by_area);
    const Vec3 by_w = by_area.cross(u);
    by_film[b] += by_u;
    by_film[c] += by_w;
    by_film[a] -= by_u + by_w;
  }
}

Points WallModel::middles() const {
  const SurfaceMesh& mesh = nodes_.mesh;
  const Points points = points_of(reference_film_, numbers(given_));
  int sides = 0;  // of facets' labels, the rims' come after these
  for (const WallFacet& facet : topology_.facets) {
    sides = std::max(sides, 2 * (facet.label + 1));
  }
  struct Across {
    std::vector<int> corners;
    double edges = 0.0;  // length
    int count = 0;
    bool on_rim = false;
  };
  std::map<int, Across> across;  // by film vertex
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Triangle& t = mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int p = nodes_.corner[t[k]];
      const int v = topology_.points[p].vertex;
      if (v < 0) {
        continue;
      }
      Across& at = across[v];
      at.on_rim = at.on_rim || mesh.facet_label[f] >= sides;
      if (std::find(at.corners.begin(), at.corners.end(), p) ==
          at.corners.end()) {
        at.corners.push_back(p);
      }
      for (const int other : {t[(k + 1) % 3], t[(k + 2) % 3]}) {
        at.edges += (points[nodes_.corner[other]] - points[p]).norm();
        ++at.count;
      }
    }
  }
  Points result;
  for (const auto& [v, at] : across) {
    Vec3 middle = Vec3::Zero();
    for (const int p : at.corners) {
      middle += points[p] / static_cast<double>(at.corners.size());
    }
    double least = std::numeric_limits<double>::infinity();
    for (const int p : at.corners) {
      least = std::min(least, (points[p] - middle).norm());
    }
    const double part = 2.0 * least * at.count / at.edges;  // of the edge
    if (!at.on_rim && at.corners.size() > 1 && part > kThinnestHalved &&
        part < kThickestHalved) {
      result.push_back(middle);
    }
  }
  return result;
}

/// One closed wall per region, measured and checked.
void WallModel::report() {
  const SurfaceMesh all = fine(reference_film_, numbers(given_));
  std::vector<char> in_front(topology_.points.size(), 0);
  for (const WallFacet& facet : topology_.facets) {
    for (const int p : facet.front) {
      in_front[p] = 1;
    }
  }
  for (std::size_t r = 0; r < reference_.safe.size(); ++r) {
    ThickWall wall;
    std::vector<int> id(all.points.size(), -1);
    wall.surface.labels = all.labels;
    for (std::size_t f = 0; f < all.facets.size(); ++f) {
      if (!all.facet_bodies.empty() &&
          all.facet_bodies[f].behind != static_cast<int>(r)) {
        continue;
      }
      Triangle t = all.facets[f];
      for (int& v : t) {
        if (id[v] < 0) {
          id[v] = static_cast<int>(wall.surface.points.size());
          wall.surface.points.push_back(all.points[v]);
          wall.trace.push_back(
              {topology_.points[v].vertex, in_front[v] != 0 ? 1.0 : 0.0});
        }
        v = id[v];
      }
      wall.surface.facets.push_back(t);
      wall.surface.facet_label.push_back(all.facet_label[f]);
      wall.cap.push_back(topology_.cap[f]);
    }
    wall.volume = enclosed_volume(wall.surface);
    wall.thinnest = reference_.thinnest[r];
    wall.thickest = reference_.thickest[r];
    wall.safe = reference_.safe[r];
    wall.corrections = reference_.corrections[r];
    wall.findings = check_surface(wall.surface);
    walls_.push_back(std::move(wall));
  }
}

}  // namespace meniscus::walls
