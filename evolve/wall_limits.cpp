#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "evolve/facet_probe.h"
#include "evolve/wall_offset.h"

namespace meniscus {

namespace {

// Part of the way to the centre of curvature that a side may go.
constexpr double kFocalPart = 0.9;
constexpr double kGapPart = 0.5;
// A ball as large as the osculating one, within this, is the film's own bend.
constexpr double kOwnBend = 1.15;

struct Room {
  double value = std::numeric_limits<double>::infinity();
  WallLimit limit = WallLimit::None;
};

/// Limits of the thickness at single places of a sheet.
class Limits {
 public:
  Limits(const Sheet& sheet, WallSide side)
      : part_(shares(side)),
        probe_(sheet.film.points, sheet.film.facets),
        far_(bounding_diagonal(sheet.film.points)) {}

  Room at(const Vec3& p, const Jet& jet) const {
    Room room;
    // Moving along the normal is limited by bends towards it, k < 0.
    const double ahead = std::max(0.0, -jet.k2);
    const double behind = std::max(0.0, jet.k1);
    lower(room, bend_limit(ahead, part_.front), WallLimit::Curvature);
    lower(room, bend_limit(behind, part_.back), WallLimit::Curvature);
    lower(room, gap_limit(p, jet.normal, ahead), WallLimit::Gap);
    lower(room, gap_limit(p, -jet.normal, behind), WallLimit::Gap);
    return room;
  }

 private:
  static void lower(Room& room, double value, WallLimit limit) {
    if (value < room.value) {
      room = {value, limit};
    }
  }

  static double bend_limit(double curvature, double share) {
    return curvature > 0.0 && share > 0.0
               ? kFocalPart / (share * curvature)
               : std::numeric_limits<double>::infinity();
  }

  // One-sided walls too need both sides' gaps: the other part has a wall of
  // its own, which may lie on the side that faces this one.
  double gap_limit(const Vec3& p, const Vec3& towards, double bend) const {
    const FacetProbe::Ball ball = probe_.tangent_ball(p, towards, far_);
    const bool own_bend = ball.radius * bend * kOwnBend >= 1.0;
    if (ball.facet < 0 || own_bend) {
      return std::numeric_limits<double>::infinity();
    }
    return kGapPart * 2.0 * ball.radius;
  }

  WallShares part_;
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
                             const std::vector<double>& asked, WallSide side) {
  const Limits limits(sheet, side);
  SafeThickness safe;
  double least = std::numeric_limits<double>::infinity();
  int where = 0;
  const auto consider = [&](const Vec3& p, const Jet& jet, double wanted, int v,
                            int facet) {
    const Room room = limits.at(p, jet);
    if (room.value / wanted < least) {
      least = room.value / wanted;
      safe = {room.value, wanted, room.limit, sheet.origin[v], p, {}};
      where = facet;
    }
  };
  for (int v = 0; v < static_cast<int>(jets.size()); ++v) {
    if (sheet.on_crease[v] == 0) {
      consider(sheet.film.points[v], jets[v], asked[v], v,
               sheet.facet_list[sheet.facet_start[v]]);
    }
  }
  // Beside creases facet centres stand for the vertices, which have no normal.
  for (int f = 0; f < static_cast<int>(sheet.film.facets.size()); ++f) {
    const auto& [a, b, c] = sheet.film.facets[f];
    if (sheet.on_crease[a] != 0 || sheet.on_crease[b] != 0 ||
        sheet.on_crease[c] != 0) {
      const Points& x = sheet.film.points;
      consider((x[a] + x[b] + x[c]) / 3.0, {sheet.facet_normal[f], 0.0, 0.0},
               (asked[a] + asked[b] + asked[c]) / 3.0, a, f);
    }
  }
  safe.message = describe(safe, sheet, where);
  return safe;
}

}  // namespace meniscus
