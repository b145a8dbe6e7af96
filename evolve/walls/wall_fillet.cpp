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
#include "core/math/union_find.h"
#include "evolve/walls/wall_offset.h"

namespace meniscus::walls {

namespace {

constexpr double kOpen = 0.05;     // cosine of half the sector: less is convex
constexpr double kLongest = 20.0;  // of (half thickness + radius): reach
constexpr double kReach = 2.0;     // of where the arc begins

/// One side of a sheet at a junction: plane and direction into the sheet.
struct SideFrame {
  Vec3 normal = Vec3::Zero();  // sum of the facets' unit normals
  Vec3 inward = Vec3::Zero();
  double half = 0.0;    // thickness, mean [length]
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
  int line = 0;
};

class Fillets {
 public:
  explicit Fillets(const FilletInput& input)
      : in_(input), x_(input.films.mesh.points) {}

  Points find() {
    moves_.assign(in_.topology.points.size(), Vec3::Zero());
    find_edges();
    number_lines();
    find_sectors();
    for (int sheet = 0; sheet < in_.sheets.count; ++sheet) {
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
  double half_of(int f, int v) const {
    return 0.5 * in_.asked(in_.films.wall[facet(f).label], v);
  }
  double fillet_of(int f, int v) const {
    const WallSpec& wall = in_.walls[in_.films.wall[facet(f).label]];
    return wall.fillet.value_or(half_of(f, v));
  }

  void find_edges() {
    std::map<Edge, std::vector<int>> users;
    for (int f = 0; f < static_cast<int>(in_.topology.facets.size()); ++f) {
      const Triangle& t = facet(f).film;
      for (int k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        if (in_.topology.junction[a] != 0 && in_.topology.junction[b] != 0) {
          users[edge_key(a, b)].push_back(f);
        }
      }
    }
    for (const auto& [edge, facets] : users) {
      if (facets.size() > 2) {
        edges_.emplace_back(edge, facets);
      }
    }
  }

  // Edges in a row, up to where lines meet or end.
  void number_lines() {
    std::map<int, std::vector<int>> at;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      for (const int v : edges_[e].first) {
        at[v].push_back(static_cast<int>(e));
      }
    }
    UnionFind lines(edges_.size());
    for (const auto& [v, edges] : at) {
      if (edges.size() == 2) {
        lines.join(edges[0], edges[1]);
      }
    }
    line_ = lines.roots();
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
                          sheet_side(other.facet, other.side), line_[e]});
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
      frame.half += half_of(f, v);
      frame.fillet = std::max(frame.fillet, fillet_of(f, v));
      ++frame.count;
    }
  }

  /// Where the arc lies between two sides, in the plane across the line.
  struct Arc {
    Vec3 normal = Vec3::Zero();  // of the own side
    Vec3 center = Vec3::Zero();  // from the line
    double half = 0.0;
    double radius = 0.0;
    double angle = 0.0;  // half of the arc's
  };

  SideFrame frame_at(const Edge& points, int sheet, int side,
                     double part) const {
    const SideFrame& a = frames_.at({points[0], sheet, side});
    const SideFrame& b = frames_.at({points[1], sheet, side});
    SideFrame result;
    result.normal =
        (1.0 - part) * a.normal / a.count + part * b.normal / b.count;
    result.half = (1.0 - part) * a.half / a.count + part * b.half / b.count;
    result.fillet = (1.0 - part) * a.fillet + part * b.fillet;
    return result;
  }

  Arc arc_at(const SectorEdge& edge, int sheet, int side, double part) const {
    const Vec3 along = (x_[edge.film[1]] - x_[edge.film[0]]).normalized();
    const SideFrame own = frame_at(edge.point, sheet, side, part);
    const SideFrame other =
        frame_at(edge.point, edge.other_sheet, edge.other_side, part);
    const auto across = [&](const Vec3& n) {
      return Vec3((n - along * along.dot(n)).normalized());
    };
    Arc arc;
    arc.normal = across(own.normal);
    const Vec3 facing = across(other.normal);
    arc.half = own.half;
    arc.radius = std::max(own.fillet, other.fillet);
    const Mat3 matrix =
        arc.normal * arc.normal.transpose() + facing * facing.transpose();
    arc.center = mitre_inverse(matrix) * (arc.normal * (own.half + arc.radius) +
                                          facing * (other.half + arc.radius));
    arc.angle = 0.5 * std::acos(std::clamp(arc.normal.dot(facing), -1.0, 1.0));
    return arc;
  }

  // What a point at `way` from the line moves by, in addition to its offset.
  static Vec3 round(const Arc& arc, const Vec3& along, const Vec3& way) {
    Vec3 u = way - arc.normal * arc.normal.dot(way);
    u = (u - along * along.dot(u)).normalized();
    const double begins = arc.center.dot(u);
    const double size = arc.half + arc.radius;
    const double reach = std::min(kReach * begins, kLongest * size);
    const double s = way.norm();
    if (!(begins > kOpen * size) || s >= reach || reach <= begins) {
      return Vec3::Zero();
    }
    const double length = arc.radius * arc.angle;
    const double l = s * (length + reach - begins) / reach;
    const Vec3 plain = s * u + arc.half * arc.normal;
    if (l >= length) {
      return arc.center - arc.radius * arc.normal + (l - length) * u - plain;
    }
    const double turn = arc.angle * (1.0 - l / length);
    return arc.center -
           arc.radius * (std::cos(turn) * arc.normal + std::sin(turn) * u) -
           plain;
  }

  void round_sheet(int sheet, int side) {
    const auto found = sectors_.find({sheet, side});
    if (found == sectors_.end()) {
      return;
    }
    std::map<int, int> points;  // wall point by film vertex
    for (int f = 0; f < static_cast<int>(in_.topology.facets.size()); ++f) {
      if (in_.sheets.of[f] != sheet) {
        continue;
      }
      for (const int v : facet(f).film) {
        if (in_.topology.junction[v] == 0) {
          points[v] = point_of(f, sheet_side(f, side), v);
        }
      }
    }
    for (const auto& [v, point] : points) {
      moves_[point] += moved_by(v, found->second, sheet, side);
    }
  }

  Vec3 moved_by(int v, const std::vector<SectorEdge>& edges, int sheet,
                int side) const {
    struct Near {
      double distance = std::numeric_limits<double>::infinity();
      const SectorEdge* edge = nullptr;
      double part = 0.0;
    };
    std::map<int, Near> nearest;  // per line
    for (const SectorEdge& edge : edges) {
      const Vec3& a = x_[edge.film[0]];
      const Vec3 way = x_[edge.film[1]] - a;
      const double part =
          std::clamp(way.dot(x_[v] - a) / way.squaredNorm(), 0.0, 1.0);
      const double distance = (x_[v] - a - part * way).norm();
      Near& near = nearest[edge.line];
      if (distance < near.distance) {
        near = {distance, &edge, part};
      }
    }
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (const auto& [line, near] : nearest) {
      const SectorEdge& edge = *near.edge;
      const Vec3& a = x_[edge.film[0]];
      const Vec3 along = x_[edge.film[1]] - a;
      const Vec3 way = x_[v] - a - near.part * along;
      const double weight = std::pow(near.distance, -4.0);
      sum += weight * round(arc_at(edge, sheet, side, near.part),
                            along.normalized(), way);
      weights += weight;
    }
    return sum / weights;
  }

  // On the line itself: from the mitre to the middle of the arc.
  void round_junctions() {
    struct Corner {
      Mat3 matrix = Mat3::Zero();
      Vec3 normals = Vec3::Zero();
      Points inward;
      double fillet = 0.0;
    };
    std::map<int, Corner> corners;
    for (const auto& [key, frame] : frames_) {
      Corner& corner = corners[std::get<0>(key)];
      const Vec3 n = frame.normal.normalized();
      corner.matrix += n * n.transpose();
      corner.normals += n;
      corner.inward.push_back(frame.inward.normalized());
      corner.fillet = std::max(corner.fillet, frame.fillet);
    }
    for (const auto& [point, corner] : corners) {
      const Mat3 inverse = mitre_inverse(corner.matrix);
      const Vec3 out = (inverse * corner.normals).normalized();
      const bool open =
          std::any_of(corner.inward.begin(), corner.inward.end(),
                      [&](const Vec3& u) { return u.dot(out) < kOpen; });
      if (open || corner.fillet == 0.0) {
        continue;
      }
      const Vec3 to_center = inverse * corner.normals * corner.fillet;
      moves_[point] += to_center - corner.fillet * out;
    }
  }

  const FilletInput& in_;
  const Points& x_;
  Points moves_;
  std::vector<std::pair<Edge, std::vector<int>>> edges_;
  std::vector<int> line_;
  std::map<SideKey, SideFrame> frames_;
  std::map<std::pair<int, int>, std::vector<SectorEdge>> sectors_;
};

}  // namespace

Points fillet_moves(const FilletInput& input) { return Fillets(input).find(); }

}  // namespace meniscus::walls
