#include "evolve/walls/wall_fillet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"
#include "evolve/walls/facet_probe.h"
#include "evolve/walls/wall_slide.h"

namespace meniscus::walls {

namespace {

constexpr double kOpen = 0.05;     // sine of a sector, cosine of its half:
                                   // less is convex
constexpr double kRoomUsed = 0.9;  // of half a sheet's width
constexpr double kFacing = -0.25;  // cosine: ends of a sheet are opposite
constexpr double kLongest = 20.0;  // of (offset + radius): reach
constexpr double kReach = 3.0;     // of the longest slide

/// One side of a sheet at a junction: plane and direction into the sheet.
struct SideFrame {
  Vec3 normal = Vec3::Zero();  // sum of the facets' unit normals
  Vec3 inward = Vec3::Zero();
  double offset = 0.0;  // from the film, mean [length]
  double fillet = 0.0;  // largest [length]
  int count = 0;
};

/// Wall point, sheet, side of the sheet.
using SideKey = std::tuple<int, int, int>;

struct SideAt {
  int facet = 0;
  int side = 0;  // 0: the facet's front
};

/// An edge of a junction and one sector about it, seen from one of its sheets.
struct SectorEdge {
  Edge film = {};
  Edge point = {};
  int other_sheet = 0;
  int other_side = 0;
};

class Fillets {
 public:
  explicit Fillets(const FilletInput& input)
      : in_(input), x_(input.films.mesh.points) {}

  Points find() {
    moves_.assign(in_.topology.points.size(), Vec3::Zero());
    find_edges();
    find_sectors();
    fit_fillets();
    const auto sheets = static_cast<int>(in_.sheets.offset.size());
    for (int sheet = 0; sheet < sheets; ++sheet) {
      for (const int side : {0, 1}) {
        round_sheet(sheet, side);
      }
    }
    round_junctions();
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
  int point_of(int f, int side, int v) const {
    const int k = corner_of(f, v);
    return side == 0 ? facet(f).front[k] : facet(f).back[k];
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
    return (side == 0 ? part.front : part.back) * asked(f, v);
  }
  double fillet_of(int f, int v) const {
    return spec_of(f).fillet.value_or(0.5 * asked(f, v));
  }

  void find_edges() {
    for (const auto& [edge, facets] : facets_about_edges(in_.topology.facets)) {
      if (is_junction(in_.topology.facets, facets)) {
        edges_.emplace_back(edge, facets);
      }
    }
  }

  void find_sectors() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto& [edge, facets] = edges_[e];
      std::map<Edge, std::vector<SideAt>> sides;  // by the points at both ends
      for (const int f : facets) {
        for (const int side : {0, 1}) {
          const Edge points = {point_of(f, side, edge[0]),
                               point_of(f, side, edge[1])};
          sides[points].push_back({f, side});
          add_frames(f, side, edge);
        }
      }
      for (const auto& [points, pair] : sides) {
        for (std::size_t i = 0; i < 2 && pair.size() == 2; ++i) {
          const SideAt& own = pair[i];
          const SideAt& other = pair[1 - i];
          sectors_[{in_.sheets.of[own.facet], sheet_side(own.facet, own.side)}]
              .push_back({edge, points, in_.sheets.of[other.facet],
                          sheet_side(other.facet, other.side)});
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
      SideFrame& frame = frames_[{point_of(f, side, v), in_.sheets.of[f],
                                  sheet_side(f, side)}];
      frame.normal += side == 0 ? normal : Vec3(-normal);
      frame.inward += inward.normalized();
      frame.offset += offset_of(f, side, v);
      frame.fillet = std::max(frame.fillet, fillet_of(f, v));
      ++frame.count;
    }
  }

  /// Where the arc lies between two sides, in the plane across the line.
  struct Arc {
    Vec3 along = Vec3::UnitX();  // the line, unit
    Vec3 normal = Vec3::Zero();  // of the own side, unit
    Vec3 inward = Vec3::Zero();  // across both, into the own sheet, unit
    Vec3 center = Vec3::Zero();  // from the line
    double offset = 0.0;         // of the own side
    double radius = 0.0;
    double angle = 0.0;   // half of the arc's
    double begins = 0.0;  // where it touches the own side, from the line
    // The line's point over the own side, where that of a thicker sheet is in
    // front of it: from there the own side comes down on a ramp of 45 degrees.
    double excess = 0.0;

    double length() const { return radius * angle; }
    /// How far points at the line slide to be in the middle of the arc.
    double slide() const { return std::max(begins - length(), 0.0); }
    /// From where on the side is as it was.
    double ends() const { return std::max(begins, slide() + excess); }

    /// From the own side to the arc or ramp, where that runs at `way` from the
    /// line.
    Vec3 lift(double way) const {
      if (radius == 0.0) {
        return std::max(excess - std::max(way - slide(), 0.0), 0.0) * normal;
      }
      const double l = std::max(way - begins + length(), 0.0);
      if (l >= length()) {
        return Vec3::Zero();
      }
      const double turn = angle * (1.0 - l / length());
      const Vec3 on_arc =
          center - radius * (std::cos(turn) * normal + std::sin(turn) * inward);
      return on_arc - (begins - length() + l) * inward - offset * normal;
    }
  };

  SideFrame frame_at(const Edge& points, int sheet, int side,
                     double part) const {
    const SideFrame& a = frames_.at({points[0], sheet, side});
    const SideFrame& b = frames_.at({points[1], sheet, side});
    const auto mean = [&](const auto& x, const auto& y) {
      return (1.0 - part) * x / a.count + part * y / b.count;
    };
    return {.normal = mean(a.normal, b.normal),
            .inward = mean(a.inward, b.inward),
            .offset = mean(a.offset, b.offset),
            .fillet = (1.0 - part) * a.fillet + part * b.fillet};
  }

  Arc arc_at(const SectorEdge& edge, int sheet, int side, double part) const {
    const SideFrame own = frame_at(edge.point, sheet, side, part);
    const SideFrame other =
        frame_at(edge.point, edge.other_sheet, edge.other_side, part);
    Arc arc;
    arc.along = (x_[edge.film[1]] - x_[edge.film[0]]).normalized();
    const auto across = [&](const Vec3& n) {
      return Vec3((n - arc.along * arc.along.dot(n)).normalized());
    };
    arc.normal = across(own.normal);
    arc.inward = across(own.inward);
    arc.inward =
        (arc.inward - arc.normal * arc.normal.dot(arc.inward)).normalized();
    const Vec3 facing = across(other.normal);
    arc.offset = own.offset;
    arc.angle = 0.5 * std::acos(std::clamp(arc.normal.dot(facing), -1.0, 1.0));
    // The other sheet lies behind the own side where the sector is convex.
    if (arc.normal.dot(across(other.inward)) > kOpen) {
      arc.radius = std::max(own.fillet, other.fillet);
    }
    const auto corner = [&](double more) {
      return offset_corner(
          {{arc.normal, own.offset + more}, {facing, other.offset + more}});
    };
    const OffsetCorner ball = corner(arc.radius);
    arc.center = ball.point;
    if (ball.on[0] == 0 || ball.on[1] == 0) {
      arc.radius = 0.0;
      arc.center = corner(0.0).point;
    }
    const double most =
        kLongest * std::max(own.offset, other.offset) + kLongest * arc.radius;
    arc.begins = std::min(arc.center.dot(arc.inward), most);
    arc.excess = arc.center.dot(arc.normal) - arc.offset - arc.radius;
    return arc;
  }

  // Points of the side slide along it until the line's own are in the middle
  // of the arc, and those that the arc is over are lifted onto it.
  void round_sheet(int sheet, int side) {
    const auto found = sectors_.find({sheet, side});
    if (found == sectors_.end()) {
      return;
    }
    const std::vector<SectorEdge>& edges = found->second;
    const OffsetSheet& own = in_.sheets.offset[sheet];
    const Points& film = own.sheet.film.points;
    const SlideInput input = slide_input(edges, own.sheet, sheet, side);
    const Slides slides = slide(input);
    const FacetProbe probe(film, own.sheet.film.facets);
    const std::vector<int> point_at = points_of(sheet, side);
    for (std::size_t v = 0; v < film.size(); ++v) {
      if (point_at[v] < 0 || slides.way[v] >= input.reach) {
        continue;
      }
      const Place to = place_on(own, side, probe, film[v] + slides.by[v]);
      moves_[point_at[v]] += to.offset + lift_at(edges, sheet, side, to.film) -
                             (side == 0 ? own.sides.front : own.sides.back)[v];
    }
  }

  SlideInput slide_input(const std::vector<SectorEdge>& edges, const Sheet& own,
                         int sheet, int side) const {
    struct Held {
      Mat3 matrix = Mat3::Zero();
      Vec3 right = Vec3::Zero();
    };
    std::map<int, Held> held;  // per film vertex
    double reach = 0.0;
    for (const SectorEdge& edge : edges) {
      for (const int end : {0, 1}) {
        const Arc arc = arc_at(edge, sheet, side, end);
        Held& at = held[edge.film[end]];
        at.matrix += arc.inward * arc.inward.transpose();
        at.right += arc.inward * arc.slide();
        reach = std::max({reach, kReach * arc.slide(), arc.ends()});
      }
    }
    SlideInput input{.sheet = own,
                     .held = std::vector<char>(own.origin.size(), 0),
                     .slides = Points(own.origin.size(), Vec3::Zero()),
                     .reach = reach};
    for (std::size_t v = 0; v < own.origin.size(); ++v) {
      const auto at = held.find(own.origin[v]);
      if (at != held.end()) {
        input.held[v] = 1;
        input.slides[v] = mitre_inverse(at->second.matrix) * at->second.right;
      }
    }
    return input;
  }

  // Per point of the sheet: the wall's over it; -1 on junctions.
  std::vector<int> points_of(int sheet, int side) const {
    const std::vector<int>& origin = in_.sheets.offset[sheet].sheet.origin;
    std::map<int, int> points;  // by film vertex
    for (int f = 0; f < static_cast<int>(in_.topology.facets.size()); ++f) {
      for (const int v : facet(f).film) {
        if (in_.sheets.of[f] == sheet && in_.topology.junction[v] == 0) {
          points[v] = point_of(f, sheet_side(f, side), v);
        }
      }
    }
    std::vector<int> result(origin.size(), -1);
    for (std::size_t v = 0; v < origin.size(); ++v) {
      const auto at = points.find(origin[v]);
      result[v] = at == points.end() ? -1 : at->second;
    }
    return result;
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

  Vec3 lift_at(const std::vector<SectorEdge>& edges, int sheet, int side,
               const Vec3& p) const {
    double least = std::numeric_limits<double>::infinity();
    const SectorEdge* nearest = nullptr;
    double part = 0.0;
    for (const SectorEdge& edge : edges) {
      const Vec3& a = x_[edge.film[0]];
      const Vec3 way = x_[edge.film[1]] - a;
      const double at =
          std::clamp(way.dot(p - a) / way.squaredNorm(), 0.0, 1.0);
      const double squared = (p - a - at * way).squaredNorm();
      if (squared < least) {
        least = squared;
        nearest = &edge;
        part = at;
      }
    }
    return arc_at(*nearest, sheet, side, part).lift(std::sqrt(least));
  }

  // --- room -----------------------------------------------------------------
  /// Half of the way over the sheet from `p`, in the direction `inward`, to
  /// where it ends opposite: the radius of the largest disk that touches p.
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
      if (facing.dot(inward) > kFacing) {
        continue;
      }
      for (const Vec3& q : {x[a], x[b], Vec3(0.5 * (x[a] + x[b]))}) {
        const double ahead = (q - p).dot(inward);
        if (ahead > 0.0) {
          least = std::min(least, (q - p).squaredNorm() / (2.0 * ahead));
        }
      }
    }
    return least;
  }

  // Of one sector the sheets have one fillet, the largest that is asked for,
  // and no larger than all of them have room for.
  void fit_fillets() {
    std::map<int, std::vector<std::pair<SideKey, SideFrame*>>> at;
    for (auto& [key, frame] : frames_) {
      at[std::get<0>(key)].emplace_back(key, &frame);
    }
    for (const auto& [point, frames] : at) {
      std::vector<OffsetPlane> planes;
      double radius = 0.0;
      for (const auto& [key, frame] : frames) {
        planes.push_back(
            {frame->normal.normalized(), frame->offset / frame->count});
        radius = std::max(radius, frame->fillet);
      }
      const Vec3 sharp = offset_corner(planes).point;
      for (OffsetPlane& plane : planes) {
        plane.offset += radius;
      }
      const Vec3 ball = offset_corner(planes).point;
      double part = 1.0;
      for (const auto& [key, frame] : frames) {
        const Vec3 inward = frame->inward.normalized();
        const double grows = (ball - sharp).dot(inward);
        if (grows > 0.0) {
          const double has =
              kRoomUsed * room(in_.sheets.offset[std::get<1>(key)].sheet,
                               x_[in_.topology.points[point].vertex], inward);
          part = std::min(part, (has - sharp.dot(inward)) / grows);
        }
      }
      for (const auto& [key, frame] : frames) {
        frame->fillet = radius * std::max(part, 0.0);
      }
    }
  }

  // On the line itself: from the mitre to the middle of the arc.
  void round_junctions() {
    struct Corner {
      std::vector<OffsetPlane> planes;
      Points inward;
      double fillet = 0.0;
    };
    std::map<int, Corner> corners;
    for (const auto& [key, frame] : frames_) {
      Corner& corner = corners[std::get<0>(key)];
      corner.planes.push_back(
          {frame.normal.normalized(), frame.offset / frame.count});
      corner.inward.push_back(frame.inward.normalized());
      corner.fillet = std::max(corner.fillet, frame.fillet);
    }
    for (auto& [point, corner] : corners) {
      const Vec3 sharp = offset_corner(corner.planes).point;
      for (OffsetPlane& plane : corner.planes) {
        plane.offset += corner.fillet;
      }
      const OffsetCorner ball = offset_corner(corner.planes);
      Vec3 normals = Vec3::Zero();
      for (std::size_t i = 0; i < corner.planes.size(); ++i) {
        normals += static_cast<double>(ball.on[i]) * corner.planes[i].normal;
      }
      const Vec3 out = (ball.inverse * normals).normalized();
      const bool open =
          std::any_of(corner.inward.begin(), corner.inward.end(),
                      [&](const Vec3& u) { return u.dot(out) < kOpen; });
      if (!open) {
        moves_[point] += ball.point - corner.fillet * out - sharp;
      }
    }
  }

  const FilletInput& in_;
  const Points& x_;
  Points moves_;
  std::vector<std::pair<Edge, std::vector<int>>> edges_;
  std::map<SideKey, SideFrame> frames_;
  std::map<std::pair<int, int>, std::vector<SectorEdge>> sectors_;
};

}  // namespace

Points fillet_moves(const FilletInput& input) { return Fillets(input).find(); }

}  // namespace meniscus::walls
