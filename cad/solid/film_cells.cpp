#include "cad/solid/film_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/harmonic.h"
#include "core/math/dense.h"

namespace meniscus::solid {

namespace {

constexpr double kSquare = 0.45;  // half its side, in a disk of radius 1
constexpr int kSeams = 4;
constexpr double kTightTurn = 0.6;  // of an arc that is a corner [rad]
// Of more than four corners four count that are about as sharp as a
// rectangle's, where all others are blunter.
constexpr double kSquareTurn = 1.0;
constexpr double kBlunter = 0.8;
constexpr double kSlender = 1.6;  // a square has 1.27, a strip of 3:1 1.7
constexpr double kEighth = std::numbers::pi / 4.0;

/// Vertices less edges plus facets: 1 for a disk, 2 for a sphere.
int characteristic(const FilmMesh& mesh) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  return static_cast<int>(mesh.points.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(mesh.facets.size());
}

/// Shares of the loop's length at its vertices.
std::vector<double> shares_of(const FilmMesh& mesh,
                              const std::vector<int>& loop) {
  std::vector<double> shares{0.0};
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const int next = loop[(k + 1) % loop.size()];
    shares.push_back(shares.back() +
                     (mesh.points[next] - mesh.points[loop[k]]).norm());
  }
  for (double& share : shares) {
    share /= shares.back() > 0.0 ? shares.back() : 1.0;
  }
  return shares;
}

/// Places on the curve where a seam should end: corners, middles of tight arcs.
std::vector<double> corner_places(const RimCurve& curve) {
  std::vector<double> places = curve.corners();
  for (int k = 0; k < curve.piece_count(); ++k) {
    if (curve.piece_count() > 1 && curve.turning(k) > kTightTurn) {
      places.push_back(0.5 * (curve.start_of(k) + curve.start_of(k + 1)));
    }
  }
  return places;
}

double around(double share) { return share - std::floor(share); }

/// Of many places the four that are most nearly a quarter apart.
std::vector<double> best_four(const std::vector<double>& places) {
  std::vector<double> best;
  double least = 0.0;
  for (const double first : places) {
    std::vector<double> four;
    double off = 0.0;
    for (int k = 0; k < kSeams; ++k) {
      const double wanted = first + static_cast<double>(k) / kSeams;
      const auto distance = [&](double s) {
        return std::abs(s - wanted - std::round(s - wanted));
      };
      four.push_back(*std::min_element(
          places.begin(), places.end(),
          [&](double s, double t) { return distance(s) < distance(t); }));
      off += distance(four.back());
    }
    std::sort(four.begin(), four.end());
    const bool distinct =
        std::adjacent_find(four.begin(), four.end()) == four.end();
    if (distinct && (best.empty() || off < least)) {
      best = four;
      least = off;
    }
  }
  return best.empty() ? std::vector<double>{places[0]} : best;
}

/// Shares of the loop where seams end, four, rising.
std::vector<double> seam_shares(const SplitFilm& split,
                                const std::vector<int>& loop,
                                const std::vector<double>& shares) {
  const RimCurve& curve = *(*split.rims)[0].curve;
  // A place on the curve is moved to the nearest vertex of the loop.
  const auto share_of = [&](double place) {
    std::size_t nearest = 0;
    double least = curve.length();
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const double d = split.film.rim_position[loop[k]] - place;
      const double off =
          std::abs(d - curve.length() * std::round(d / curve.length()));
      if (off < least) {
        least = off;
        nearest = k;
      }
    }
    return shares[nearest];
  };
  // Seams end where the rim itself bends most, if anywhere.
  std::vector<double> seams;
  for (const double place : corner_places(curve)) {
    seams.push_back(share_of(place));
  }
  if (seams.empty()) {
    seams.push_back(share_of(0.0));
  }
  // Of more than four corners those count that divide the rim most evenly.
  std::sort(seams.begin(), seams.end());
  seams.erase(std::unique(seams.begin(), seams.end()), seams.end());
  if (seams.size() > kSeams) {
    seams = best_four(seams);
  }
  while (seams.size() < kSeams) {  // halve the longest way between two
    std::size_t longest = 0;
    double most = -1.0;
    for (std::size_t k = 0; k < seams.size(); ++k) {
      const double gap = k + 1 < seams.size() ? seams[k + 1] - seams[k]
                                              : seams[0] + 1.0 - seams[k];
      if (gap > most + 1e-12) {
        most = gap;
        longest = k;
      }
    }
    seams.push_back(around(seams[longest] + 0.5 * most));
    std::sort(seams.begin(), seams.end());
  }
  return seams;
}

/// Columns: the square, and the four sides that the map's point may be nearest
/// to.
Eigen::MatrixXd disk_measures(const SplitFilm& split) {
  const FilmMesh& mesh = split.film.mesh;
  const auto count = static_cast<Eigen::Index>(mesh.points.size());
  const std::vector<int> loop = boundary_loops(mesh.facets, mesh.points).at(0);
  const std::vector<double> shares = shares_of(mesh, loop);
  const std::vector<double> seams = seam_shares(split, loop, shares);
  HarmonicProblem problem{mesh.points, mesh.facets, {}, {}, {}};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    problem.facets.push_back(static_cast<int>(f));
  }
  problem.fixed.assign(mesh.points.size(), 0);
  problem.values = Eigen::MatrixXd::Zero(count, 2);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    // Seams are an eighth, three eighths... of a turn; between them by length.
    const auto after = std::upper_bound(seams.begin(), seams.end(), shares[k]);
    const int last =
        (static_cast<int>(after - seams.begin()) + kSeams - 1) % kSeams;
    const double way = around(seams[(last + 1) % kSeams] - seams[last]);
    const double angle =
        kEighth * (1.0 + 2.0 * (last + around(shares[k] - seams[last]) / way));
    problem.fixed[loop[k]] = 1;
    problem.values.row(loop[k]) << std::cos(angle), std::sin(angle);
  }
  const Eigen::MatrixXd at = harmonic(problem);
  Eigen::MatrixXd measures(count, kDiskCells);
  measures.col(0).setConstant(kSquare);
  measures.col(1) = at.col(0);
  measures.col(2) = at.col(1);
  measures.col(3) = -at.col(0);
  measures.col(4) = -at.col(1);
  return measures;
}

/// Columns: along the film's three long ways from its middle and against them.
Eigen::MatrixXd cube_measures(const FilmMesh& mesh) {
  // Centroid of the film, by area (twice it: only ratios count).
  Vec3 middle = Vec3::Zero();
  double area = 0.0;
  const auto area_of = [&](const Triangle& t) {
    const Vec3 u = mesh.points[t[1]] - mesh.points[t[0]];
    return u.cross(mesh.points[t[2]] - mesh.points[t[0]]).norm();
  };
  const auto center = [&](const Triangle& t) -> Vec3 {
    return (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3.0;
  };
  for (const Triangle& t : mesh.facets) {
    middle += area_of(t) * center(t);
    area += area_of(t);
  }
  middle /= area;
  // Second moments of area about it, and the sign of the solid angle under
  // which it sees each facet: one sign means a star-shaped film.
  Mat3 spread = Mat3::Zero();
  int positive = 0;
  for (const Triangle& t : mesh.facets) {
    const Vec3 d = center(t) - middle;
    spread += area_of(t) / area * d * d.transpose();
    const Vec3 a = mesh.points[t[0]] - middle;
    const Vec3 b = mesh.points[t[1]] - middle;
    const Vec3 c = mesh.points[t[2]] - middle;
    positive += a.dot(b.cross(c)) > 0.0 ? 1 : 0;
  }
  if (positive != 0 && positive != static_cast<int>(mesh.facets.size())) {
    throw MeshError(
        "a closed film is cut only where its middle sees all of it");
  }
  // Along the principal axes, each over its spread: the greatest of the six
  // signed places says to which side of the cube a point belongs.
  const auto axes = symmetric_eigen(spread);
  Eigen::MatrixXd measures(static_cast<Eigen::Index>(mesh.points.size()),
                           kClosedCells);
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis =
        axes.vectors.col(k) / std::sqrt(std::max(axes.values[k], 1e-12 * area));
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const double along = axis.dot(mesh.points[v] - middle);
      measures(static_cast<Eigen::Index>(v), 2 * k) = along;
      measures(static_cast<Eigen::Index>(v), 2 * k + 1) = -along;
    }
  }
  return measures;
}

/// Square of the length over the area, of a disk 1.
double slenderness(const RimCurve& curve) {
  constexpr int kPlaces = 400;
  Points around;
  for (int k = 0; k < kPlaces; ++k) {
    around.push_back(curve.point(curve.length() * k / kPlaces));
  }
  const double area = polygon_area_vector(around).norm();
  return area > 0.0
             ? curve.length() * curve.length() / (4.0 * std::numbers::pi * area)
             : std::numeric_limits<double>::infinity();
}

/// A way along a rim, from a place of it on.
struct RimWay {
  double from = 0.0;
  double length = 0.0;
};

/// Between a way against the rim's run and one along it, at the same shares.
double mean_width(const RimCurve& curve, const RimWay& back,
                  const RimWay& forth) {
  constexpr int kPlaces = 40;
  double sum = 0.0;
  for (int k = 0; k <= kPlaces; ++k) {
    const double share = static_cast<double>(k) / kPlaces;
    sum += (curve.point(back.from - share * back.length) -
            curve.point(forth.from + share * forth.length))
               .norm();
  }
  return sum / (kPlaces + 1);
}

/// Of an outline that is a bent strip, as an arch on two legs, the four corners
/// at its two ends, two of neighbouring corners each, between which its long
/// sides are nearest to each other. Empty where it is no strip.
std::vector<double> strip_corners(const RimCurve& curve) {
  std::vector<double> places;
  for (const double place : curve.corners()) {
    if (curve.corner_angle(curve.piece_at(place)) > kSharpTurn) {
      places.push_back(place);
    }
  }
  if (places.size() <= kSeams || slenderness(curve) < kSlender) {
    return {};
  }
  std::sort(places.begin(), places.end());
  const std::size_t n = places.size();
  const auto way = [&](std::size_t from, std::size_t to) {
    const double d = places[to % n] - places[from % n];
    return d > 0.0 ? d : d + curve.length();
  };
  double best = std::numeric_limits<double>::infinity();
  std::vector<double> result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n && j + 1 < i + n; ++j) {
      const double score = mean_width(curve, {places[i], way(j + 1, i)},
                                      {places[i + 1], way(i + 1, j)});
      if (score < best) {
        best = score;
        result = {places[i], places[i + 1], places[j], places[(j + 1) % n]};
      }
    }
  }
  return result;
}

/// Places of the corners of a four-sided patch's outline; empty for another.
std::vector<double> four_corners(const RimCurve& curve) {
  std::vector<double> places = curve.corners();
  const auto angle = [&](std::size_t k) {
    return curve.corner_angle(curve.piece_at(places[k]));
  };
  if (places.size() < kSeams || angle(kSeams - 1) <= kSharpTurn ||
      (places.size() > kSeams &&
       (angle(kSeams - 1) <= kSquareTurn ||
        angle(kSeams) > kBlunter * angle(kSeams - 1)))) {
    return strip_corners(curve);
  }
  places.resize(kSeams);
  return places;
}

/// A line from one of its ends on.
struct LineEnd {
  std::vector<int>* line = nullptr;
  bool from_back = false;
  int at(std::size_t k) const {
    return from_back ? (*line)[line->size() - 1 - k] : (*line)[k];
  }
  /// The first vertex at `distance` from the end; 0: the line is too short.
  std::size_t beyond(const Points& points, double distance) const {
    for (std::size_t k = 1; k + 1 < line->size(); ++k) {
      if ((points[at(k)] - points[at(0)]).norm() >= distance) {
        return k;
      }
    }
    return 0;
  }
};

double mean_edge(const FilmMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.facets) {
    sum += (mesh.points[t[1]] - mesh.points[t[0]]).norm();
  }
  return sum / static_cast<double>(mesh.facets.size());
}

}  // namespace

bool is_four_sided(const std::vector<FilmRim>& rims) {
  return rims.size() == 1 && !four_corners(*rims[0].curve).empty();
}

int rim_vertex(const SplitFilm& split, const std::vector<int>& loop,
               double place) {
  const RimCurve& curve = *(*split.rims)[split.film.rim_of[loop.front()]].curve;
  const auto off = [&](int v) {
    const double d = split.film.rim_position[v] - place;
    return std::abs(d - curve.length() * std::round(d / curve.length()));
  };
  return *std::min_element(loop.begin(), loop.end(),
                           [&](int v, int w) { return off(v) < off(w); });
}

FilmPatch whole_patch(const SplitFilm& split) {
  const std::vector<int> loop =
      boundary_loops(split.film.mesh.facets, split.film.mesh.points).at(0);
  std::vector<std::ptrdiff_t> at;
  for (const double place : four_corners(*(*split.rims)[0].curve)) {
    at.push_back(
        std::find(loop.begin(), loop.end(), rim_vertex(split, loop, place)) -
        loop.begin());
  }
  std::sort(at.begin(), at.end());
  if (std::adjacent_find(at.begin(), at.end()) != at.end()) {
    throw MeshError("a film has corners nearer to each other than its edges");
  }
  FilmPatch patch;
  patch.facets.resize(split.film.mesh.facets.size());
  std::iota(patch.facets.begin(), patch.facets.end(), 0);
  patch.rims.fill(0);
  for (int side = 0; side < 4; ++side) {
    const auto end = static_cast<std::size_t>(at[(side + 1) % 4]);
    for (auto k = static_cast<std::size_t>(at[side]); k != end;
         k = (k + 1) % loop.size()) {
      patch.chains[side].push_back(loop[k]);
    }
    patch.chains[side].push_back(loop[end]);
    if (side >= 2) {
      std::reverse(patch.chains[side].begin(), patch.chains[side].end());
    }
  }
  return patch;
}

void straighten_nodes(CutFilm& film) {
  Points& points = film.mesh.points;
  const double near = mean_edge(film.mesh);
  std::map<int, std::vector<LineEnd>> nodes;
  for (std::vector<int>& line : film.lines) {
    for (const bool back : {false, true}) {
      const int v = back ? line.back() : line.front();
      if (film.rim_of[v] < 0) {
        nodes[v].push_back({&line, back});
      }
    }
  }
  for (const auto& [node, ends] : nodes) {
    const Vec3& normal = film.mesh.normals[node];
    Mat3 matrix = normal * normal.transpose();
    Vec3 right = Vec3::Zero();
    bool long_enough = true;
    for (const LineEnd& end : ends) {
      const std::size_t first = end.beyond(points, near);
      const std::size_t second = end.beyond(points, 3.0 * near);
      long_enough = long_enough && first > 0 && second > first;
      if (long_enough) {
        const Vec3 p = points[end.at(first)];
        const Vec3 across =
            normal.cross(points[end.at(second)] - p).normalized();
        matrix += across * across.transpose();
        right += across * across.dot(p - points[node]);
      }
    }
    const Vec3 move = long_enough ? solve_lu(matrix, right) : Vec3::Zero();
    if (!long_enough || move.norm() > near) {
      continue;
    }
    points[node] += move;
    for (const LineEnd& end : ends) {
      const std::size_t count = end.beyond(points, near);
      const Vec3 way = points[end.at(count)] - points[node];
      for (std::size_t k = 1; k < count; ++k) {
        const double share =
            static_cast<double>(k) / static_cast<double>(count);
        points[end.at(k)] = points[node] + share * way;
      }
    }
  }
}

SplitFilm film_cells(FilmMesh mesh, const std::vector<FilmRim>& rims) {
  const int wanted = rims.empty() ? 2 : 1;
  const int found = characteristic(mesh);
  if (found != wanted) {
    throw MeshError(fmt::format("a film with {} is not {}: it has a handle",
                                rims.empty() ? "no rim" : "one rim",
                                rims.empty() ? "a bubble" : "a disk"));
  }
  SplitFilm split = refined_film(std::move(mesh), rims);
  if (is_four_sided(rims)) {
    return split;
  }
  split_by_greatest(split, rims.empty() ? cube_measures(split.film.mesh)
                                        : disk_measures(split));
  split.sector.assign(split.cell.size(), 0);
  return split;
}

}  // namespace meniscus::solid
