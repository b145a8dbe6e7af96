#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "evolve/walls/facet_probe.h"
#include "evolve/walls/wall_offset.h"

namespace meniscus::walls {

namespace {

// Part of the way to the centre of curvature that a side may go.
constexpr double kFocalPart = 0.9;
constexpr double kGapPart = 0.5;
// A ball as large as the osculating one, within this, is the film's own bend.
constexpr double kOwnBend = 1.15;
// Relative to the ball: how far a bend of the film may leave it (a square
// corner does by 0.29), and below which sine the ends are opposite.
constexpr double kOffBall = 0.35;
constexpr double kOpposite = 0.2;
constexpr int kWaysRound = 8;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct Room {
  double value = kUnlimited;
  WallLimit limit = WallLimit::None;
};

/// Limits of the thickness at single places of a sheet.
class Limits {
 public:
  Limits(const Sheet& sheet, WallSide side, const SurfaceMesh* others)
      : part_(shares(side)),
        all_(with(sheet.film, others)),
        probe_(all_.points, all_.facets),
        far_(bounding_diagonal(sheet.film.points)) {}

  // Moving along the normal is limited by bends towards it, k < 0.
  Room bend(const Jet& jet) const {
    const double value = std::min(bend_limit(-jet.k2, part_.front),
                                  bend_limit(jet.k1, part_.back));
    return {value,
            std::isfinite(value) ? WallLimit::Curvature : WallLimit::None};
  }

  // Only below `most`. One-sided walls need both sides' gaps: another part may
  // have its own wall on the side that faces this one.
  Room gap(const Vec3& p, const Jet& jet, const FacetProbe::Home& home,
           double most) const {
    const double front =
        gap_limit(p, jet.normal, -jet.k2, part_.front, home, most);
    const double back = gap_limit(p, -jet.normal, jet.k1, part_.back, home,
                                  std::min(most, front));
    const double value = std::min(front, back);
    return {value, std::isfinite(value) ? WallLimit::Gap : WallLimit::None};
  }

 private:
  static double bend_limit(double curvature, double share) {
    return curvature > 0.0 && share > 0.0 ? kFocalPart / (share * curvature)
                                          : kUnlimited;
  }

  double gap_limit(const Vec3& p, const Vec3& towards, double curvature,
                   double share, const FacetProbe::Home& home,
                   double most) const {
    const double osculating =
        curvature > 0.0 ? 1.0 / (kOwnBend * curvature) : far_;
    const double largest = std::min({far_, osculating, most});
    const FacetProbe::Ball ball =
        probe_.tangent_ball(p, towards, largest, home);
    if (ball.facet < 0) {
      return kUnlimited;
    }
    if (is_own_bend(p, towards, ball)) {
      return share > 0.0 ? kFocalPart * ball.radius / share : kUnlimited;
    }
    return kGapPart * 2.0 * ball.radius;
  }

  // Does the film follow the ball's surface from p to where it touches? Then
  // it is the inside of a bend or a tube and not another part of the film.
  bool is_own_bend(const Vec3& p, const Vec3& towards,
                   const FacetProbe::Ball& ball) const {
    const Vec3 center = p + ball.radius * towards;
    const Vec3 end = (ball.touch - center) / ball.radius;
    const double angle = std::acos(std::clamp(-towards.dot(end), -1.0, 1.0));
    Vec3 along = end + towards * -towards.dot(end);
    if (along.norm() > kOpposite) {
      return follows(center, -towards, along.normalized(), ball.radius, angle);
    }
    // Touched opposite p: any half circle may be the film's way round.
    const Vec3 x = towards.unitOrthogonal();
    const Vec3 y = towards.cross(x);
    for (int i = 0; i < kWaysRound; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / kWaysRound;
      along = std::cos(turn) * x + std::sin(turn) * y;
      if (follows(center, -towards, along, ball.radius, angle)) {
        return true;
      }
    }
    return false;
  }

  bool follows(const Vec3& center, const Vec3& from, const Vec3& along,
               double radius, double angle) const {
    for (const double part : {0.25, 0.5, 0.75}) {
      const Vec3 q = center + radius * (std::cos(part * angle) * from +
                                        std::sin(part * angle) * along);
      if (probe_.nearest(q, kOffBall * radius).facet < 0) {
        return false;
      }
    }
    return true;
  }

  static SurfaceMesh with(const SurfaceMesh& film, const SurfaceMesh* others) {
    SurfaceMesh all{.points = film.points, .facets = film.facets};
    if (others != nullptr) {
      const auto first = static_cast<int>(all.points.size());
      all.points.insert(all.points.end(), others->points.begin(),
                        others->points.end());
      for (const Triangle& t : others->facets) {
        all.facets.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
    return all;
  }

  WallShares part_;
  SurfaceMesh all_;
  FacetProbe probe_;
  double far_;
};

std::string describe(const SafeThickness& safe, const Sheet& sheet, int facet) {
  if (safe.limit == WallLimit::None) {
    return "nothing limits the wall's thickness";
  }
  return fmt::format(
      "the wall may be {:.6g} thick at most near ({:.6g}, {:.6g}, {:.6g}) of "
      "\"{}\", where {}; asked there: {:.6g}{}",
      safe.value, safe.place.x(), safe.place.y(), safe.place.z(),
      sheet.film.labels[sheet.film.facet_label[facet]],
      safe.limit == WallLimit::Curvature
          ? "the film's curvature turns a thicker side inside out"
          : "a thicker wall comes too near to another part of the film",
      safe.asked,
      safe.asked < safe.value
          ? ""
          : "; make the wall thinner there, or the film wider");
}

}  // namespace

SafeThickness safe_thickness(const Sheet& sheet, const std::vector<Jet>& jets,
                             const std::vector<double>& asked, WallSide side,
                             const SafeOptions& options) {
  const Limits limits(sheet, side, options.others);
  const bool all = options.at_each != nullptr;
  if (all) {
    options.at_each->assign(jets.size(), kUnlimited);
  }
  const auto note = [&](int v, const Room& room) {
    if (all) {
      double& at = (*options.at_each)[v];
      at = std::min(at, room.value);
    }
  };
  // What counts is the least ratio of room to the thickness asked for: it names
  // the place where the wall fails first.
  SafeThickness safe;
  double least = kUnlimited;
  int where = 0;
  const auto consider = [&](const Room& room, const Vec3& p, double wanted,
                            int v, int facet) {
    if (room.value / wanted < least) {
      least = room.value / wanted;
      safe = {room.value, wanted, room.limit, sheet.origin[v], p, {}};
      where = facet;
    }
  };
  const auto count = static_cast<int>(jets.size());
  const Points& x = sheet.film.points;
  // Bends: a side turns inside out at the centres of curvature, |s k| = 1.
  // These are cheap, and bound the search for gaps.
  for (int v = 0; v < count; ++v) {
    const Room room = limits.bend(jets[v]);
    note(v, room);
    consider(room, x[v], asked[v], v, sheet.facet_list[sheet.facet_start[v]]);
  }
  // Gaps: the largest ball that touches the film at the vertex, for vertices
  // with a normal.
  for (int v = 0; v < count; ++v) {
    if (sheet.on_crease[v] == 0) {
      const Room room = limits.gap(x[v], jets[v], {.vertex = v},
                                   all ? kUnlimited : least * asked[v]);
      note(v, room);
      consider(room, x[v], asked[v], v, sheet.facet_list[sheet.facet_start[v]]);
    }
  }
  // Beside creases facet centres stand for the vertices, which have no normal.
  for (int f = 0; f < static_cast<int>(sheet.film.facets.size()); ++f) {
    const Triangle& t = sheet.film.facets[f];
    if (std::any_of(t.begin(), t.end(),
                    [&](int v) { return sheet.on_crease[v] != 0; })) {
      const Vec3 center = (x[t[0]] + x[t[1]] + x[t[2]]) / 3.0;
      const double wanted = (asked[t[0]] + asked[t[1]] + asked[t[2]]) / 3.0;
      const Jet flat = {sheet.facet_normal[f], 0.0, 0.0};
      const Room room = limits.gap(center, flat, {.facet = f},
                                   all ? kUnlimited : least * wanted);
      for (const int v : t) {
        note(v, room);
      }
      consider(room, center, wanted, t[0], f);
    }
  }
  safe.message = describe(safe, sheet, where);
  return safe;
}

}  // namespace meniscus::walls
