#include "evolve/walls/wall_fillet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"
#include "evolve/walls/facet_probe.h"
#include "evolve/walls/fillet_arc.h"
#include "evolve/walls/wall_slide.h"

namespace meniscus::walls {

namespace {

constexpr double kOpen = 0.05;     // cosine of half a sector: less is convex
constexpr double kRoomUsed = 0.9;  // of a sheet's width
constexpr double kFacing = -0.25;  // cosine: lines are opposite
constexpr double kFacingOfRim = -0.9;   // the same of a line and a rim
constexpr double kReach = 3.0;          // of the longest slide
constexpr double kWaysAreLonger = 1.5;  // along edges than straight
constexpr double kAcross = 0.2;  // cosine of line and rims' plane: less is flat

/// One side of a fan of facets at a vertex: the wall points on that side and
/// behind it, the sheet.
struct SideKey {
  int point = 0;
  int behind = 0;
  int sheet = 0;
  auto operator<=>(const SideKey&) const = default;
};

struct SideFrame : LineSide {
  int vertex = 0;  // of the film
  int sheet = 0;
  int count = 0;  // of facets' edges summed up in normal, inward, offset
};

struct SideAt {
  int facet = 0;
  int side = 0;  // 0: the facet's front
};

/// An edge of a junction and one sector about it, seen from one of its sheets.
struct SectorEdge {
  Edge film = {};
  std::array<SideKey, 2> own = {};    // at its ends
  std::array<SideKey, 2> other = {};  // the facing side's
  double ends = 0.0;  // from where on the own side is as it was [length]
};

class Fillets {
 public:
  explicit Fillets(const FilletInput& input)
      : in_(input), x_(input.films.mesh.points) {}

  std::vector<std::vector<WallMove>> find() {
    moves_.resize(in_.topology.points.size());
    along_.resize(in_.topology.points.size());
    find_edges();
    find_sectors();
    fit_fillets();
    round_lines();
    slide_along_lines();
    const auto sheets = static_cast<int>(in_.sheets.offset.size());
    for (int sheet = 0; sheet < sheets; ++sheet) {
      for (const int side : {0, 1}) {
        round_sheet(sheet, side);
      }
    }
    return std::move(moves_);
  }

 private:
  const WallFacet& facet(int f) const { return in_.topology.facets[f]; }
  // The sheet's side that a facet's own is, and back.
  int sheet_side(int f, int side) const {
    return in_.sheets.flipped[f] != 0 ? 1 - side : side;
  }
  int corner_of(int f, int v) const {
    const Triangle& t = facet(f).film;
    return t[0] == v ? 0 : (t[1] == v ? 1 : 2);
  }
  SideKey key_of(int f, int side, int v) const {
    const int k = corner_of(f, v);
    const int front = facet(f).front[k];
    const int back = facet(f).back[k];
    return side == 0 ? SideKey{front, back, in_.sheets.of[f]}
                     : SideKey{back, front, in_.sheets.of[f]};
  }
  std::array<SideKey, 2> keys_of(const SideAt& at, const Edge& edge) const {
    return {key_of(at.facet, at.side, edge[0]),
            key_of(at.facet, at.side, edge[1])};
  }
  const WallSpec& spec_of(int f) const {
    return in_.walls[in_.films.wall[facet(f).label]];
  }
  double asked(int f, int v) const {
    return in_.asked(in_.films.wall[facet(f).label], v);
  }
  // How far a facet's side lies from the film.
  double offset_of(int f, int side, int v) const {
    const WallShares part = shares(spec_of(f).side);
    return (sheet_side(f, side) == 0 ? part.front : part.back) * asked(f, v);
  }
  double fillet_of(int f, int v) const {
    return spec_of(f).fillet.value_or(0.5 * asked(f, v));
  }

  // --- lines and their sectors --------------------------------------------
  void find_edges() {
    for (const auto& [edge, facets] : facets_about_edges(in_.topology.facets)) {
      if (is_junction(in_.topology.facets, facets)) {
        edges_.emplace_back(edge, facets);
        lines_.insert(edge);
      }
    }
  }

  void find_sectors() {
    for (const auto& [edge, facets] : edges_) {
      std::map<Edge, std::vector<SideAt>> sides;  // by the points at both ends
      for (const int f : facets) {
        for (const int side : {0, 1}) {
          sides[{key_of(f, side, edge[0]).point,
                 key_of(f, side, edge[1]).point}]
              .push_back({f, side});
          add_frames(f, side, edge);
        }
      }
      for (const auto& [points, pair] : sides) {
        for (std::size_t i = 0; i < 2 && pair.size() == 2; ++i) {
          const SideAt& own = pair[i];
          sectors_[{in_.sheets.of[own.facet], sheet_side(own.facet, own.side)}]
              .push_back(
                  {edge, keys_of(own, edge), keys_of(pair[1 - i], edge)});
        }
      }
    }
  }

  void add_frames(int f, int side, const Edge& edge) {
    const Triangle& t = facet(f).film;
    const Vec3 normal =
        (x_[t[1]] - x_[t[0]]).cross(x_[t[2]] - x_[t[0]]).normalized();
    const Vec3 along = (x_[edge[1]] - x_[edge[0]]).normalized();
    const int far = std::accumulate(t.begin(), t.end(), 0) - edge[0] - edge[1];
    Vec3 inward = x_[far] - x_[edge[0]];
    inward -= along * along.dot(inward);
    for (const int v : edge) {
      SideFrame& frame = frames_[key_of(f, side, v)];
      frame.vertex = v;
      frame.sheet = in_.sheets.of[f];
      frame.wall = frame.fillet_wall = in_.films.wall[facet(f).label];
      frame.normal += side == 0 ? normal : Vec3(-normal);
      frame.inward += inward.normalized();
      frame.offset += offset_of(f, side, v);
      frame.fillet = std::max(frame.fillet, fillet_of(f, v));
      ++frame.count;
    }
  }

  /// Where the sides meet, each `more` in front of itself.
  static OffsetCorner corner_between(const std::vector<SideFrame*>& frames,
                                     double more) {
    std::vector<OffsetPlane> planes;
    planes.reserve(frames.size());
    for (const SideFrame* frame : frames) {
      planes.push_back(
          {frame->normal.normalized(), frame->offset / frame->count + more});
    }
    return offset_corner(planes);
  }

  /// The sides that look into the sector of each wall point.
  std::map<int, std::vector<SideFrame*>> frames_of_points() {
    std::map<int, std::vector<SideFrame*>> result;
    for (auto& [key, frame] : frames_) {
      result[key.point].push_back(&frame);
    }
    return result;
  }

  // --- fillets that fit -----------------------------------------------------
  /// How far a slide may go over the sheet from `p`, in the direction
  /// `inward`: to what a disk that touches p reaches there, half of the way to
  /// another line, all of it to a rim.
  double room(const Sheet& sheet, const Vec3& p, const Vec3& inward) const {
    double least = std::numeric_limits<double>::infinity();
    const Points& x = sheet.film.points;
    for (std::size_t e = 0; e < sheet.edges.size(); ++e) {
      const auto [f, other] = sheet.edge_facets[e];
      if (other >= 0) {
        continue;
      }
      const auto [a, b] = sheet.edges[e];
      const Triangle& t = sheet.film.facets[f];
      const int far = std::accumulate(t.begin(), t.end(), 0) - a - b;
      const Vec3 along = (x[b] - x[a]).normalized();
      Vec3 facing = x[far] - x[a];
      facing = (facing - along * along.dot(facing)).normalized();
      const bool is_line =
          lines_.count(edge_key(sheet.origin[a], sheet.origin[b])) > 0;
      if (facing.dot(inward) > (is_line ? kFacing : kFacingOfRim)) {
        continue;
      }
      for (const Vec3& q : {x[a], x[b], Vec3(0.5 * (x[a] + x[b]))}) {
        const double ahead = (q - p).dot(inward);
        if (ahead > 0.0) {
          const double radius = (q - p).squaredNorm() / (2.0 * ahead);
          least = std::min(least, is_line ? radius : 2.0 * radius);
        }
      }
    }
    return kRoomUsed * least;
  }

  // The sides of one sector have one fillet, the largest that is asked for, and
  // no larger than all of them have room for.
  void fit_fillets() {
    for (const auto& [point, frames] : frames_of_points()) {
      double radius = 0.0;
      int wall = frames[0]->wall;
      for (const SideFrame* frame : frames) {
        if (frame->fillet > radius) {
          radius = frame->fillet;
          wall = frame->wall;
        }
      }
      const Vec3 sharp = corner_between(frames, 0.0).point;
      const Vec3 ball = corner_between(frames, radius).point;
      double part = 1.0;
      for (const SideFrame* frame : frames) {
        const Vec3 inward = frame->inward.normalized();
        const double grows = (ball - sharp).dot(inward);
        if (grows > 0.0) {
          const double has = room(in_.sheets.offset[frame->sheet].sheet,
                                  x_[frame->vertex], inward);
          part = std::min(part, (has - sharp.dot(inward)) / grows);
        }
      }
      for (SideFrame* frame : frames) {
        frame->fillet = radius * std::max(part, 0.0);
        frame->fillet_wall = wall;
      }
    }
  }

  // --- wall points of lines -------------------------------------------------
  /// Sides, of which `out` has some behind it: an edge, not a groove.
  static bool is_open(const std::vector<SideFrame*>& frames, const Vec3& out) {
    return std::any_of(frames.begin(), frames.end(),
                       [&](const SideFrame* frame) {
                         return frame->inward.normalized().dot(out) < kOpen;
                       });
  }

  /// Unit normals of the sides, one for all that meet each other in edges:
  /// around the edge of a column below a plate a ball rolls from side to side.
  static Points normals_across_edges(const std::vector<SideFrame*>& frames) {
    Points sums;
    std::vector<char> used(frames.size(), 0);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (used[i] != 0) {
        continue;
      }
      Vec3 sum = frames[i]->normal.normalized();
      for (std::size_t j = i + 1; j < frames.size(); ++j) {
        const auto behind = [&](std::size_t side, std::size_t other) {
          return frames[side]->inward.normalized().dot(
                     frames[other]->normal.normalized()) < -kOpen;
        };
        if (used[j] == 0 && behind(i, j) && behind(j, i)) {
          used[j] = 1;
          sum += frames[j]->normal.normalized();
        }
      }
      sums.push_back(sum.normalized());
    }
    return sums;
  }

  // From where the sides' planes meet to the middle of the arc.
  void round_lines() {
    for (const auto& [point, frames] : frames_of_points()) {
      const double fillet = frames[0]->fillet;
      const Vec3 sharp = corner_between(frames, 0.0).point;
      const OffsetCorner ball = corner_between(frames, fillet);
      Vec3 normals = Vec3::Zero();
      for (std::size_t i = 0; i < frames.size(); ++i) {
        normals +=
            static_cast<double>(ball.on[i]) * frames[i]->normal.normalized();
      }
      Vec3 out = (ball.inverse * normals).normalized();
      Vec3 center = ball.point - sharp;
      if (is_open(frames, out)) {
        std::vector<OffsetPlane> planes;
        for (const Vec3& normal : normals_across_edges(frames)) {
          planes.push_back({normal, fillet});
        }
        center = offset_corner(planes).point;
        out = center.normalized();
        if (planes.size() == frames.size() || planes.size() < 2 ||
            is_open(frames, out)) {
          continue;
        }
      }
      add_move({frames[0]->fillet_wall, center - fillet * out}, moves_[point]);
    }
  }

  /// Wall points of one sector along a line, from one end of it to the other.
  struct Strand {
    std::vector<int> points;
    std::vector<double> way;  // from the first, along the film's edges
  };

  // Where lines end, at others or on a rim, the wall point moves along them
  // too, ahead or out of a corner: so do the points behind it, to keep their
  // order and to leave no long edge.
  void slide_along_lines() {
    for (const Strand& strand : strands()) {
      const std::size_t last = strand.points.size() - 1;
      const std::map<int, double> first_end = ahead_of_end(strand, 0, 1);
      const std::map<int, double> last_end =
          ahead_of_end(strand, last, last - 1);
      const auto sum = [](const std::map<int, double>& parts) {
        double all = 0.0;
        for (const auto& [wall, by] : parts) {
          all += by;
        }
        return all;
      };
      const double s0 = sum(first_end);
      const double s1 = sum(last_end);
      const double length = strand.way.back();
      const bool is_short = kReach * (std::abs(s0) + std::abs(s1)) > length;
      std::vector<std::vector<WallMove>> offsets;  // before they slide
      for (const int p : strand.points) {
        offsets.push_back(moves_of(p));
      }
      for (std::size_t k = 1; k < last; ++k) {
        const double way = strand.way[k];
        const auto fade = [&](double slide, double from) {
          const double reach = is_short ? length : kReach * std::abs(slide);
          return slide != 0.0 ? std::max(1.0 - from / reach, 0.0) : 0.0;
        };
        const double f0 = fade(s0, way);
        const double f1 = fade(s1, length - way);
        if (f0 > 0.0 || f1 > 0.0) {
          slide_point(strand, k, offsets, way + f0 * s0 - f1 * s1,
                      [&](int wall) {
                        return f0 * part_of(first_end, wall) -
                               f1 * part_of(last_end, wall);
                      });
        }
      }
    }
  }

  static double part_of(const std::map<int, double>& parts, int wall) {
    const auto at = parts.find(wall);
    return at == parts.end() ? 0.0 : at->second;
  }

  std::vector<WallMove> moves_of(int point) const {
    std::vector<WallMove> all = in_.moves[point];
    for (const WallMove& move : moves_[point]) {
      add_move(move, all);
    }
    return all;
  }

  // To `way` along the strand; `share`: how much of that each wall makes.
  template <class Share>
  void slide_point(const Strand& strand, std::size_t k,
                   const std::vector<std::vector<WallMove>>& offsets,
                   double way, const Share& share) {
    const std::size_t last = strand.points.size() - 1;
    std::size_t i = 0;
    while (i + 2 <= last && strand.way[i + 1] < way) {
      ++i;
    }
    // Straight on beyond an end.
    const double place =
        (way - strand.way[i]) / (strand.way[i + 1] - strand.way[i]);
    const double part = std::clamp(place, 0.0, 1.0);
    const int point = strand.points[k];
    const Vec3 from = film_of(point);
    const Vec3 by = (1.0 - place) * film_of(strand.points[i]) +
                    place * film_of(strand.points[i + 1]) - from;
    const double slid = way - strand.way[k];
    std::set<int> walls;
    for (const auto* ends : {&offsets.front(), &offsets.back(), &offsets[k]}) {
      for (const WallMove& move : *ends) {
        walls.insert(move.wall);
      }
    }
    const int own = offsets[k].front().wall;
    for (const int wall : walls) {
      if (slid != 0.0 && share(wall) != 0.0) {
        const WallMove move = {wall_elsewhere(wall, own),
                               share(wall) / slid * by};
        add_move(move, along_[point]);
        add_move(move, moves_[point]);
      }
    }
    // The offset there; ends have another one, of more sides.
    const std::size_t a = std::clamp<std::size_t>(i, 1, last - 1);
    const std::size_t b = std::clamp<std::size_t>(i + 1, 1, last - 1);
    for (const WallMove& move : offsets[a]) {
      add_move({move.wall, (1.0 - part) * move.by}, moves_[point]);
    }
    for (const WallMove& move : offsets[b]) {
      add_move({move.wall, part * move.by}, moves_[point]);
    }
    for (const WallMove& move : offsets[k]) {
      add_move({move.wall, -move.by}, moves_[point]);
    }
  }

  const Vec3& film_of(int point) const {
    return x_[in_.topology.points[point].vertex];
  }

  /// By wall, how far the wall point at a strand's end is ahead along it. On a
  /// rim it is put into the plane of its films' rims first.
  std::map<int, double> ahead_of_end(const Strand& strand, std::size_t end,
                                     std::size_t next) {
    const int point = strand.points[end];
    const Vec3 along =
        (film_of(strand.points[next]) - film_of(point)).normalized();
    const auto rims = rims_.find(point);
    if (rims != rims_.end() && rims->second.size() == 2) {
      const Vec3 plane = rims->second[0].cross(rims->second[1]);
      if (std::abs(plane.dot(along)) > kAcross) {
        for (const WallMove& move : moves_of(point)) {
          const double by = -move.by.dot(plane) / along.dot(plane);
          add_move({move.wall, by * along}, moves_[point]);
          add_move({move.wall, by * along}, along_[point]);
        }
      }
    }
    std::map<int, double> ahead;
    for (const WallMove& move : moves_of(point)) {
      ahead[move.wall] += move.by.dot(along);
    }
    return ahead;
  }

  /// Lines that close without an end have none.
  std::vector<Strand> strands() {
    std::map<int, std::set<int>> next;
    for (const auto& [at, edges] : sectors_) {
      for (const SectorEdge& edge : edges) {
        next[edge.own[0].point].insert(edge.own[1].point);
        next[edge.own[1].point].insert(edge.own[0].point);
      }
    }
    find_rims();
    std::map<int, int> sides;
    for (const auto& [key, frame] : frames_) {
      ++sides[key.point];
    }
    const auto is_end = [&](int point) {
      return next.at(point).size() != 2 || sides.at(point) != 2;
    };
    std::vector<Strand> result;
    for (const auto& [point, others] : next) {
      for (const int other : is_end(point) ? others : std::set<int>()) {
        Strand strand{.points = {point, other}, .way = {}};
        while (!is_end(strand.points.back())) {
          const std::set<int>& ways = next.at(strand.points.back());
          const int before = strand.points[strand.points.size() - 2];
          strand.points.push_back(*ways.begin() == before ? *ways.rbegin()
                                                          : *ways.begin());
        }
        if (strand.points.back() < point || strand.points.size() < 3) {
          continue;  // from its other end, or without points between
        }
        strand.way = {0.0};
        for (std::size_t k = 1; k < strand.points.size(); ++k) {
          strand.way.push_back(
              strand.way.back() +
              (film_of(strand.points[k]) - film_of(strand.points[k - 1]))
                  .norm());
        }
        result.push_back(std::move(strand));
      }
    }
    return result;
  }

  // Per wall point at which a line ends on rims: these, one per side.
  void find_rims() {
    for (const auto& [edge, facets] : facets_about_edges(in_.topology.facets)) {
      if (facets.size() != 1) {
        continue;
      }
      for (const int end : {0, 1}) {
        for (const int side : {0, 1}) {
          const SideKey key = key_of(facets[0], side, edge[end]);
          if (frames_.count(key) > 0) {
            rims_[key.point].push_back(
                (x_[edge[1 - end]] - x_[edge[end]]).normalized());
          }
        }
      }
    }
  }

  // --- sides ----------------------------------------------------------------
  LineSide side_at(const std::array<SideKey, 2>& keys, double part) const {
    const SideFrame& a = frames_.at(keys[0]);
    const SideFrame& b = frames_.at(keys[1]);
    const auto mean = [&](const auto& x, const auto& y) {
      return (1.0 - part) * x / a.count + part * y / b.count;
    };
    LineSide side = part < 0.5 ? a : b;
    side.normal = mean(a.normal, b.normal);
    side.inward = mean(a.inward, b.inward);
    side.offset = mean(a.offset, b.offset);
    side.fillet = (1.0 - part) * a.fillet + part * b.fillet;
    return side;
  }

  FilletArc arc_at(const SectorEdge& edge, double part) const {
    return fillet_arc(x_[edge.film[1]] - x_[edge.film[0]],
                      side_at(edge.own, part), side_at(edge.other, part));
  }

  // Points of the side slide along it until the line's own are in the middle
  // of the arc, and those that the arc is over are lifted onto it.
  void round_sheet(int sheet, int side) {
    const auto found = sectors_.find({sheet, side});
    if (found == sectors_.end()) {
      return;
    }
    std::vector<SectorEdge>& edges = found->second;
    for (SectorEdge& edge : edges) {
      edge.ends = std::max(arc_at(edge, 0.0).ends(), arc_at(edge, 1.0).ends());
    }
    const int own_wall = frames_.at(edges.front().own[0]).wall;
    const OffsetSheet& own = in_.sheets.offset[sheet];
    const Points& film = own.sheet.film.points;
    const SlideInput input = slide_input(edges, sheet, side);
    const Slides slides = slide(input);
    const FacetProbe probe(film, own.sheet.film.facets);
    for (std::size_t v = 0; v < film.size(); ++v) {
      if (own.points[side][v] < 0 || input.held[v] != 0 ||
          in_.topology.junction[own.sheet.origin[v]] != 0 ||
          slides.way[v] >= input.reach) {
        continue;
      }
      std::vector<WallMove>& moves = moves_[own.points[side][v]];
      Vec3 all = Vec3::Zero();
      for (const auto& [wall, by] : slides.by) {
        add_move({wall, by[v]}, moves);
        all += by[v];
      }
      // What is left of the slide, the side being bent, is the own wall's.
      const Place to = place_on(own, side, probe, film[v] + all);
      const Vec3 slid =
          to.offset - (side == 0 ? own.sides.front : own.sides.back)[v];
      add_move({own_wall, slid - all}, moves);
      const WallMove lift = lift_at(edges, to.film);
      add_move({wall_elsewhere(lift.wall, own_wall), lift.by}, moves);
    }
  }

  // A wall whose thickness depends on the place moves points of no others.
  int wall_elsewhere(int wall, int own) const {
    const PlaceField& thickness = in_.walls[wall].thickness;
    const std::vector<int> names = thickness.formula.names_used();
    const bool is_uniform =
        thickness.shapes.empty() &&
        std::all_of(names.begin(), names.end(), [](int k) { return k > 2; });
    return is_uniform ? wall : own;
  }

  SlideInput slide_input(const std::vector<SectorEdge>& edges, int sheet,
                         int side) const {
    const OffsetSheet& own = in_.sheets.offset[sheet];
    struct Held {
      Mat3 matrix = Mat3::Zero();
      std::map<int, Vec3> right;  // by wall
    };
    const int own_wall = frames_.at(edges.front().own[0]).wall;
    std::map<SideKey, Held> held;
    double reach = 0.0;
    for (const SectorEdge& edge : edges) {
      for (const int end : {0, 1}) {
        const FilletArc arc = arc_at(edge, end);
        Held& at = held[edge.own[end]];
        at.matrix += arc.inward * arc.inward.transpose();
        for (const auto& [wall, by] : arc.parts) {
          at.right.try_emplace(wall_elsewhere(wall, own_wall), Vec3::Zero())
              .first->second += arc.inward * by;
        }
        reach = std::max(
            {reach, kReach * arc.slide(), kWaysAreLonger * arc.ends()});
      }
    }
    const std::size_t count = own.sheet.origin.size();
    SlideInput input{.sheet = own.sheet,
                     .held = std::vector<char>(count, 0),
                     .slides = {},
                     .reach = reach};
    const auto add = [&](int wall, std::size_t v, const Vec3& by) {
      input.slides
          .try_emplace(wall_elsewhere(wall, own_wall),
                       Points(count, Vec3::Zero()))
          .first->second[v] += by;
      input.reach = std::max(input.reach, kReach * by.norm());
    };
    for (std::size_t v = 0; v < count; ++v) {
      const SideKey key = {own.points[side][v], own.points[1 - side][v], sheet};
      const auto at = held.find(key);
      if (at == held.end()) {
        continue;
      }
      input.held[v] = 1;
      const Mat3 inverse = mitre_inverse(at->second.matrix);
      for (const auto& [wall, right] : at->second.right) {
        add(wall, v, inverse * right);
      }
      for (const WallMove& move : along_[key.point]) {
        add(move.wall, v, move.by);
      }
    }
    return input;
  }

  /// A place on the sheet, and the side over it.
  struct Place {
    Vec3 film = Vec3::Zero();
    Vec3 offset = Vec3::Zero();
  };

  static Place place_on(const OffsetSheet& own, int side,
                        const FacetProbe& probe, const Vec3& p) {
    const FacetProbe::Hit hit = probe.nearest(p);
    const Triangle& t = own.sheet.film.facets[hit.facet];
    const Points& film = own.sheet.film.points;
    const Points& offset = side == 0 ? own.sides.front : own.sides.back;
    const Vec3 area = (film[t[1]] - film[t[0]]).cross(film[t[2]] - film[t[0]]);
    Place place{.film = hit.point};
    for (int k = 0; k < 3; ++k) {
      const Vec3& a = film[t[(k + 1) % 3]];
      const Vec3& b = film[t[(k + 2) % 3]];
      const double weight = (a - hit.point).cross(b - hit.point).dot(area);
      place.offset += weight / area.squaredNorm() * offset[t[k]];
    }
    return place;
  }

  /// Of all lines near `p` the one that lifts it most.
  WallMove lift_at(const std::vector<SectorEdge>& edges, const Vec3& p) const {
    WallMove most;
    for (const SectorEdge& edge : edges) {
      const Vec3& a = x_[edge.film[0]];
      const Vec3 way = x_[edge.film[1]] - a;
      const double part =
          std::clamp(way.dot(p - a) / way.squaredNorm(), 0.0, 1.0);
      const double distance = (p - a - part * way).norm();
      if (distance >= edge.ends) {
        continue;
      }
      const FilletArc arc = arc_at(edge, part);
      const Vec3 lift = arc.lift(distance);
      if (lift.squaredNorm() > most.by.squaredNorm()) {
        most = {arc.lift_wall, lift};
      }
    }
    return most;
  }

  const FilletInput& in_;
  const Points& x_;
  std::vector<std::vector<WallMove>> moves_;
  std::vector<std::vector<WallMove>> along_;  // of these, along lines
  std::vector<std::pair<Edge, std::vector<int>>> edges_;
  std::set<Edge> lines_;
  std::map<SideKey, SideFrame> frames_;
  std::map<int, Points> rims_;
  std::map<std::pair<int, int>, std::vector<SectorEdge>> sectors_;
};

}  // namespace

std::vector<std::vector<WallMove>> fillet_moves(const FilletInput& input) {
  return Fillets(input).find();
}

}  // namespace meniscus::walls
