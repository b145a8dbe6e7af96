#include "evolve/spines/spine_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/union_find.h"
#include "evolve/films/loft.h"
#include "evolve/spines/isosurface.h"

namespace meniscus::spines {

namespace {

constexpr double kNear = 0.5;   // of a rim's plane [radii]
constexpr double kCell = 0.5;   // of the lattice [radii]
constexpr double kBall = 1.2;   // about samples [radii]
constexpr double kWall = 1.0;   // about bores, at least [radii]
constexpr double kReach = 3.0;  // of what a rim cuts off [radii]
constexpr std::array<double, 5> kWidths = {1.0, 1.05, 1.1, 1.2, 1.3};

/// The middle of a rim and its vector area.
struct RimPlane {
  Vec3 middle;
  Vec3 normal = Vec3::Zero();  // unit
  double radius = 0.0;         // of a circle of its area

  explicit RimPlane(const Points& points) : middle(mean_of(points)) {
    const Vec3 area = polygon_area_vector(points);
    radius = std::sqrt(area.norm() / std::numbers::pi);
    normal = area.normalized();
  }
};

/// Whole turns of a loop around a line, positive about its unit `axis`.
int turns_about(const Vec3& at, const Vec3& axis, const Points& loop) {
  double angle = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const auto flat = [&](const Vec3& p) -> Vec3 {
      const Vec3 d = p - at;
      return d - axis.dot(d) * axis;
    };
    const Vec3 a = flat(loop[k]);
    const Vec3 b = flat(loop[(k + 1) % loop.size()]);
    angle += std::atan2(axis.dot(a.cross(b)), a.dot(b));
  }
  return static_cast<int>(std::lround(angle / (2.0 * std::numbers::pi)));
}

/// Seen along its plane's normal, is the place within the rim?
bool within(const RimPlane& plane, const Points& rim, const Vec3& at) {
  return turns_about(at, plane.normal, rim) > 0;
}

/// Where the liquid meets a rim: what a cut leaves of it is joined to the rim.
struct Cut {
  int rim = 0;
  Vec3 at = Vec3::Zero();  // the spine's end, or the rim's middle
  /// Of an end: unit, along the rim's normal, away from the liquid, which ends
  /// there. 0 at a bore.
  Vec3 out = Vec3::Zero();
  double radius = 0.0;
  int spine = -1;  // that ends there
  /// Of a rim of a bore: unit, towards the other rim, and where that is among
  /// the cuts. The film's border there turns once about it.
  Vec3 axis = Vec3::Zero();
  int other = -1;

  bool cuts(const Vec3& p, double before) const {
    return !out.isZero() && (p - at).dot(out) > -before &&
           (p - at).norm() < kReach * radius;
  }
};

struct SpineField {
  std::vector<films::Pole> poles;
  std::vector<double> tension;
  std::vector<int> spine;
  std::vector<Ball> walls;  // of bores, wet

  double level(const Vec3& x) const {
    double sum = -1.0;
    for (std::size_t k = 0; k < poles.size(); ++k) {
      sum += level_at(poles[k], tension[k], x);
    }
    double wall = 0.0;
    for (const Ball& ball : walls) {
      const double near =
          1.0 - (x - ball.at).squaredNorm() / (ball.radius * ball.radius);
      wall = std::max(wall, near);
    }
    return sum + wall * wall;
  }

  /// True where the liquid is that spine's more than all others'.
  bool is_of(int one, const Vec3& x) const {
    double more = 0.0;
    for (std::size_t k = 0; k < poles.size(); ++k) {
      const double part = level_at(poles[k], tension[k], x);
      more += spine[k] == one ? part : -part;
    }
    return more > 0.0;
  }
};

/// The cylinder of a bore, from rim to rim and on as far as the liquid about it
/// swells: what passes over the bore at a distance is left alone.
class BoreCut {
 public:
  BoreCut(const Points& low, const Points& high, const SpineField& field,
          double step)
      : low_(low), high_(high), low_plane_(low), high_plane_(high) {
    axis_ = (high_plane_.middle - low_plane_.middle).normalized();
    widen(field);
    before_ = swell(low_, low_plane_, -axis_, field, step);
    after_ = swell(high_, high_plane_, axis_, field, step);
  }

  bool cuts(const Vec3& p) const {
    const double along = (p - low_plane_.middle).dot(axis_);
    const Vec3 on_axis = low_plane_.middle + along * axis_;
    const Vec3 narrowed = on_axis + (p - on_axis) / width_;
    return along > -before_ && (p - high_plane_.middle).dot(axis_) < after_ &&
           within(low_plane_, low_, narrowed) &&
           within(high_plane_, high_, narrowed);
  }

  /// Balls over the cut's side that do not stand out beyond its rims by more
  /// than half their radius.
  std::vector<Ball> wall(double radius) const {
    std::vector<Ball> result;
    const double height = (high_plane_.middle - low_plane_.middle).norm();
    const double first = 0.5 * std::min(radius, height);
    const double step = 0.5 * radius;
    const int rows =
        1 + static_cast<int>(std::ceil((height - 2.0 * first) / step));
    for (std::size_t k = 0; k < low_.size(); ++k) {
      const Vec3& a = low_[k];
      const Vec3 side = low_[(k + 1) % low_.size()] - a;
      const int pieces = 1 + static_cast<int>(side.norm() / step);
      for (int i = 0; i < pieces; ++i) {
        const Vec3 p = a + side * i / pieces - low_plane_.middle;
        const Vec3 across = width_ * (p - axis_.dot(p) * axis_);
        for (int j = 0; j < rows; ++j) {
          const double along =
              first + (height - 2.0 * first) * j / std::max(1, rows - 1);
          result.push_back(
              {low_plane_.middle + across + along * axis_, radius});
        }
      }
    }
    return result;
  }

 private:
  /// Where the liquid halfway through is wider than the bore, a cut as wide as
  /// the bore would miss it and leave the two rims joined there.
  void widen(const SpineField& field) {
    const Vec3 middle = 0.5 * (low_plane_.middle + high_plane_.middle);
    for (const double width : kWidths) {
      const bool wet =
          std::all_of(low_.begin(), low_.end(), [&](const Vec3& p) {
            const Vec3 d = p - low_plane_.middle;
            return field.level(middle + width * (d - axis_.dot(d) * axis_)) >
                   0.0;
          });
      if (wet) {
        width_ = width;
        return;
      }
    }
  }

  /// How far beyond a rim there is liquid over its points or its middle.
  static double swell(const Points& rim, const RimPlane& plane, const Vec3& out,
                      const SpineField& field, double step) {
    const double most = kReach * plane.radius;
    double far = 0.0;
    const auto wet = [&](const Vec3& x) {
      return field.level(x + far * out) > 0.0;
    };
    while (far < most &&
           (wet(plane.middle) || std::any_of(rim.begin(), rim.end(), wet))) {
      far += step;
    }
    return far + step;
  }

  Points low_, high_;
  RimPlane low_plane_, high_plane_;
  Vec3 axis_;
  double width_ = 1.0;  // of the cut, over that of the bore
  double before_ = 0.0;
  double after_ = 0.0;
};

/// Closed walks along the border, in its direction. Throws InvalidInput where
/// they touch.
std::vector<std::vector<int>> border_loops(const SurfaceMesh& mesh,
                                           const std::string& film) {
  std::map<Edge, int> uses;
  for (const Triangle& t : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      uses[{t[k], t[(k + 1) % 3]}] += 1;
    }
  }
  std::map<int, int> next;
  for (const auto& [edge, count] : uses) {
    if (uses.find({edge[1], edge[0]}) == uses.end() &&
        !next.emplace(edge[0], edge[1]).second) {
      const Vec3& p = mesh.points[edge[0]];
      throw InvalidInput(fmt::format(
          "film '{}': the arms of its spines touch a rim together at ({:.6g}, "
          "{:.6g}, {:.6g}); move them apart or join them before the rim",
          film, p.x(), p.y(), p.z()));
    }
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    int at = next.begin()->first;
    for (auto found = next.find(at); found != next.end();
         found = next.find(at)) {
      loop.push_back(at);
      at = found->second;
      next.erase(found);
    }
  }
  return loops;
}

/// What facets join to one piece.
UnionFind pieces_of(const SurfaceMesh& mesh) {
  UnionFind pieces(mesh.points.size());
  for (const Triangle& t : mesh.facets) {
    pieces.join(t[0], t[1]);
    pieces.join(t[0], t[2]);
  }
  return pieces;
}

/// Throws InvalidInput for a piece without a rim beside another. The rims'
/// points are the first `on_rims`.
void require_one_piece(const SurfaceMesh& mesh, int on_rims,
                       const std::string& film) {
  UnionFind pieces = pieces_of(mesh);
  std::set<int> held;
  for (int v = 0; v < on_rims; ++v) {
    held.insert(pieces.root(v));
  }
  for (const Triangle& t : mesh.facets) {
    if (!held.empty() && held.count(pieces.root(t[0])) == 0) {
      const Vec3& p = mesh.points[t[0]];
      throw InvalidInput(fmt::format(
          "film '{}': the liquid of its spines near ({:.6g}, {:.6g}, {:.6g}) "
          "hangs together with no rim; let its spine meet another, or end "
          "within a rim",
          film, p.x(), p.y(), p.z()));
    }
  }
}

/// What the spines of a film make at its rims.
struct SpineSite {
  SpineField field;
  std::vector<Ball> balls;  // about the spines
  std::vector<Cut> cuts;    // one per rim
  std::vector<BoreCut> bores;
  double thinnest = std::numeric_limits<double>::infinity();
  double thickest = 0.0;

  bool is_left_out(const Vec3& x, double before) const {
    return std::any_of(cuts.begin(), cuts.end(),
                       [&](const Cut& cut) {
                         return cut.cuts(x, before) &&
                                field.is_of(cut.spine, x);
                       }) ||
           std::any_of(bores.begin(), bores.end(),
                       [&](const BoreCut& cut) { return cut.cuts(x); });
  }

  void add_spine(const films::SpineSpec& spine,
                 const std::vector<SpineRim>& rims, int number) {
    const std::array<int, 2> at = rims_at_ends(spine, rims);
    const films::SpineSampling sampling =
        sample_spine(spine, 0, {at[0] >= 0, at[1] >= 0});
    const std::vector<films::Pole> poles = poles_of(sampling, spine);
    for (std::size_t k = 0; k < poles.size(); ++k) {
      field.poles.push_back(poles[k]);
      field.tension.push_back(spine.tension);
      field.spine.push_back(number);
      if (sampling.samples[k].beyond == 0.0) {
        balls.push_back(
            {poles[k].at, kBall / kCore * std::sqrt(poles[k].core2)});
      }
    }
    const std::size_t last = spine.points.size() - 1;
    for (int side = 0; side < 2; ++side) {
      if (at[side] < 0) {
        continue;
      }
      const std::size_t end = side == 0 ? 0 : last;
      const Vec3 way =
          spine.points[end] - spine.points[side == 0 ? 1 : last - 1];
      const Vec3 normal = RimPlane(rims[at[side]].points).normal;
      cuts.push_back({at[side], spine.points[end],
                      way.dot(normal) > 0.0 ? normal : Vec3(-normal),
                      spine.radii[end], number});
    }
    const auto [thin, thick] =
        std::minmax_element(spine.radii.begin(), spine.radii.end());
    thinnest = std::min(thinnest, *thin);
    thickest = std::max(thickest, *thick);
  }

  /// Liquid that is thinner about a bore than the lattice can see would leave
  /// its two rims joined there.
  void add_wall(const BoreCut& bore) {
    for (const Ball& ball : bore.wall(kWall * thinnest)) {
      field.walls.push_back(ball);
      balls.push_back(ball);
    }
  }

  void add_bores(const std::vector<SpineRim>& rims) {
    for (std::size_t k = 0; k < rims.size(); ++k) {
      if (rims[k].bore <= static_cast<int>(k)) {
        continue;
      }
      const std::array<int, 2> ends = {static_cast<int>(k), rims[k].bore};
      for (int side = 0; side < 2; ++side) {
        const RimPlane plane(rims[ends[side]].points);
        const RimPlane opposite(rims[ends[1 - side]].points);
        cuts.push_back({.rim = ends[side],
                        .at = plane.middle,
                        .radius = plane.radius,
                        .axis = (opposite.middle - plane.middle).normalized(),
                        .other = static_cast<int>(cuts.size()) + 1 - 2 * side});
      }
      bores.emplace_back(rims[ends[0]].points, rims[ends[1]].points, field,
                         kCell * thinnest);
      add_wall(bores.back());
    }
  }
};

void require_one_cut_each(const SpineSite& site,
                          const std::vector<SpineRim>& rims,
                          const std::string& film) {
  for (std::size_t k = 0; k < rims.size(); ++k) {
    const auto count = std::count_if(
        site.cuts.begin(), site.cuts.end(),
        [&](const Cut& c) { return c.rim == static_cast<int>(k); });
    if (count != 1) {
      throw InvalidInput(fmt::format(
          "film '{}': {} its curve '{}'; let one spine end within it, less "
          "than half its radius from its plane, or make it the rim of a bore "
          "by a solid of kind ring",
          film,
          count == 0 ? std::string("no spine ends at")
                     : fmt::format("{} spines end at", count),
          rims[k].curve));
    }
  }
}

SurfaceMesh level_set(const SpineSite& site, const std::string& film) {
  const double cell = kCell * site.thinnest;
  try {
    return isosurface(
        [&](const Vec3& x) { return site.field.level(x); }, site.balls, cell,
        [&](const Vec3& x) { return site.is_left_out(x, 0.5 * cell); });
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format(
        "film '{}': radii of its spines run from {:.4g} to {:.4g}, and its "
        "first facets are as fine everywhere as the thinnest arm asks: {}",
        film, site.thinnest, site.thickest, error.what()));
  }
}

/// The cut that a loop of the level set's border is at. Throws InvalidInput
/// where there is none near.
std::size_t nearest_cut(const std::vector<Cut>& cuts, const Vec3& middle,
                        const std::string& film) {
  const auto nearest = std::min_element(
      cuts.begin(), cuts.end(), [&](const Cut& a, const Cut& b) {
        return (a.at - middle).norm() < (b.at - middle).norm();
      });
  if (nearest == cuts.end() ||
      (nearest->at - middle).norm() > kReach * nearest->radius) {
    throw InvalidInput(fmt::format(
        "film '{}': the arms of its spines do not close near ({:.6g}, {:.6g}, "
        "{:.6g}); arms that are thin beside others, or that meet a rim from "
        "the side, need a point more",
        film, middle.x(), middle.y(), middle.z()));
  }
  return static_cast<std::size_t>(nearest - cuts.begin());
}

Points points_of(const std::vector<int>& loop, const Points& points) {
  Points result;
  for (const int v : loop) {
    result.push_back(points[v]);
  }
  return result;
}

double length_of_loop(const Points& loop) {
  double length = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    length += (loop[(k + 1) % loop.size()] - loop[k]).norm();
  }
  return length;
}

/// The cut whose rim a loop may be joined to: of a bore the rim about whose
/// axis it turns; none where it does not turn about the bore.
std::optional<std::size_t> cut_of_loop(const std::vector<Cut>& cuts,
                                       const Points& loop,
                                       const std::string& film) {
  const std::size_t nearest = nearest_cut(cuts, mean_of(loop), film);
  const Cut& cut = cuts[nearest];
  if (cut.other < 0) {
    return nearest;
  }
  switch (turns_about(cut.at, cut.axis, loop)) {
    case 1:
      return nearest;
    case -1:
      return static_cast<std::size_t>(cut.other);
    default:
      return std::nullopt;
  }
}

/// Whether both turn the same way about the cut; nothing where one does not.
std::optional<bool> turn_alike(const Cut& cut, const Points& loop,
                               const Points& rim) {
  const Vec3& axis = cut.other < 0 ? cut.out : cut.axis;
  const int turns =
      turns_about(cut.at, axis, loop) * turns_about(cut.at, axis, rim);
  return turns == 0 ? std::nullopt : std::optional(turns > 0);
}

/// Per cut the longest loop there, which is joined to the rim; others are holes
/// where the cut pierces an arm beside it. Throws InvalidInput for a cut
/// without one.
std::vector<int> longest_at_cuts(const std::vector<Cut>& cuts,
                                 const std::vector<SpineRim>& rims,
                                 const Points& points,
                                 const std::vector<std::vector<int>>& loops,
                                 const std::string& film) {
  std::vector<int> result(cuts.size(), -1);
  std::vector<double> length(cuts.size(), 0.0);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const Points loop = points_of(loops[k], points);
    const std::optional<std::size_t> cut = cut_of_loop(cuts, loop, film);
    const double own = length_of_loop(loop);
    if (cut && own > length[*cut]) {
      length[*cut] = own;
      result[*cut] = static_cast<int>(k);
    }
  }
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    if (result[k] < 0) {
      throw InvalidInput(
          fmt::format("film '{}': its spines' liquid does not reach curve '{}'",
                      film, rims[cuts[k].rim].curve));
    }
  }
  return result;
}

/// Per vertex: of a piece that cuts part from all that they join to rims?
std::vector<char> pieces_left_over(const SurfaceMesh& level,
                                   const std::vector<std::vector<int>>& loops,
                                   const std::vector<int>& joined) {
  UnionFind pieces = pieces_of(level);
  std::set<int> cut_off;
  for (const std::vector<int>& loop : loops) {
    cut_off.insert(pieces.root(loop[0]));
  }
  for (const int loop : joined) {
    cut_off.erase(pieces.root(loops[loop][0]));
  }
  std::vector<char> result(level.points.size(), 0);
  for (std::size_t v = 0; v < result.size(); ++v) {
    result[v] = cut_off.count(pieces.root(static_cast<int>(v))) != 0 ? 1 : 0;
  }
  return result;
}

/// Facets from the loop of the level set to a new vertex in its middle.
void close_loop(const std::vector<int>& loop, const std::vector<int>& number,
                SurfaceMesh& mesh) {
  const auto middle = static_cast<int>(mesh.points.size());
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < loop.size(); ++k) {
    sum += mesh.points[number[loop[k]]];
    mesh.facets.push_back(
        {number[loop[(k + 1) % loop.size()]], number[loop[k]], middle});
  }
  mesh.points.push_back(sum / static_cast<double>(loop.size()));
}

}  // namespace

std::array<int, 2> rims_at_ends(const films::SpineSpec& spine,
                                const std::vector<SpineRim>& rims) {
  std::array<int, 2> result = {-1, -1};
  for (int side = 0; side < 2 && !spine.points.empty() && !is_closed(spine);
       ++side) {
    const Vec3& end = side == 0 ? spine.points.front() : spine.points.back();
    const double radius = side == 0 ? spine.radii.front() : spine.radii.back();
    for (std::size_t k = 0; k < rims.size(); ++k) {
      const RimPlane plane(rims[k].points);
      if (rims[k].bore < 0 &&
          std::abs((end - plane.middle).dot(plane.normal)) < kNear * radius &&
          within(plane, rims[k].points, end)) {
        result[side] = static_cast<int>(k);
      }
    }
  }
  return result;
}

SurfaceMesh spine_start(const std::vector<films::SpineSpec>& spines,
                        const std::vector<SpineRim>& rims,
                        const std::string& film) {
  SpineSite site;
  for (std::size_t k = 0; k < spines.size(); ++k) {
    site.add_spine(spines[k], rims, static_cast<int>(k));
  }
  site.add_bores(rims);
  require_one_cut_each(site, rims, film);
  const SurfaceMesh level = level_set(site, film);
  const std::vector<std::vector<int>> loops = border_loops(level, film);
  const std::vector<int> longest =
      longest_at_cuts(site.cuts, rims, level.points, loops, film);
  const std::vector<char> left_over = pieces_left_over(level, loops, longest);
  // The rims' points first, then those of the level set.
  SurfaceMesh result;
  result.labels = {film};
  std::vector<int> first;
  for (const SpineRim& rim : rims) {
    first.push_back(static_cast<int>(result.points.size()));
    result.points.insert(result.points.end(), rim.points.begin(),
                         rim.points.end());
  }
  const auto on_rims = static_cast<int>(result.points.size());
  std::vector<int> number(level.points.size(), -1);
  for (std::size_t v = 0; v < level.points.size(); ++v) {
    if (left_over[v] == 0) {
      number[v] = static_cast<int>(result.points.size());
      result.points.push_back(level.points[v]);
    }
  }
  for (const Triangle& t : level.facets) {
    if (left_over[t[0]] == 0) {
      result.facets.push_back({number[t[0]], number[t[1]], number[t[2]]});
    }
  }
  for (std::size_t k = 0; k < site.cuts.size(); ++k) {
    const int rim = site.cuts[k].rim;
    const std::vector<int>& loop = loops[longest[k]];
    const auto count = static_cast<int>(loop.size());
    const Points border = points_of(loop, level.points);
    for (Triangle t :
         films::loft_band(border, rims[rim].points,
                          turn_alike(site.cuts[k], border, rims[rim].points))) {
      for (int& v : t) {
        v = v < count ? number[loop[v]] : first[rim] + v - count;
      }
      // The band runs along the loop as the facets there do: the other way.
      result.facets.push_back({t[0], t[2], t[1]});
    }
  }
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (std::find(longest.begin(), longest.end(), static_cast<int>(k)) ==
            longest.end() &&
        left_over[loops[k][0]] == 0) {
      close_loop(loops[k], number, result);
    }
  }
  result.facet_label.assign(result.facets.size(), 0);
  require_one_piece(result, on_rims, film);
  return result;
}

}  // namespace meniscus::spines
