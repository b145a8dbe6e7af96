#include "evolve/fillets/fillet_bands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/fillets/followers.h"

namespace meniscus::fillets {

namespace {

constexpr double kReach = 3.0;        // of the ball's farthest touch: the bands
constexpr double kLeastTouch = 0.25;  // of the radius: surfaces may turn apart
constexpr double kLeastReach = 1.2;   // the same, least
constexpr double kOfWhole = 0.9;      // of a surface that a band may take
constexpr double kOfHalf = 0.45;      // where another fillet begins at its end
constexpr double kLeastApart = 0.3;   // of sections at their ends, by the curve
constexpr double kCorner = 0.35;      // turn between edges of a curve [rad]

std::string place_text(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

/// Two surfaces that meet along a curve.
struct Sides {
  int a = -1;  // labels
  int b = -1;
};

class Bands {
 public:
  Bands(const SurfaceMesh& surface, const films::FilmSystem& system,
        const std::vector<std::vector<int>>& rims, std::size_t which)
      : surface_(surface),
        x_(surface.points),
        system_(system),
        rims_(rims),
        which_(which),
        spec_(system.fillets[which]) {}

  FilletBands freeze() {
    result_.name = spec_.name;
    result_.curve = spec_.curve;
    if (spec_.radius == 0.0) {
      return std::move(result_);  // sharp
    }
    find_sides();
    order_curve();
    const LabelledFacets a(surface_, sides_.a);
    const LabelledFacets b(surface_, sides_.b);
    find_normals(a, b);
    find_lengths(a, b);
    add_sections(a, b);
    add_followers(a, true, result_);
    add_followers(b, false, result_);
    return std::move(result_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InvalidInput(fmt::format("fillet '{}': {}", spec_.name, what));
  }
  bool is_film(int label) const {
    return std::any_of(system_.films.begin(), system_.films.end(),
                       [&](const films::FilmSpec& film) {
                         return film.name == surface_.labels[label];
                       });
  }

  /// Edges of the curve: there facets of different labels meet.
  void find_sides() {
    const std::set<int> on(rims_[which_].begin(), rims_[which_].end());
    std::map<Edge, std::vector<int>> users;
    for (std::size_t f = 0; f < surface_.facets.size(); ++f) {
      const Triangle& t = surface_.facets[f];
      for (int k = 0; k < 3; ++k) {
        const int v = t[k];
        const int w = t[(k + 1) % 3];
        if (on.count(v) != 0 && on.count(w) != 0) {
          users[edge_key(v, w)].push_back(static_cast<int>(f));
        }
      }
    }
    for (const auto& [edge, facets] : users) {
      std::set<int> labels;
      for (const int f : facets) {
        labels.insert(surface_.facet_label[f]);
      }
      if (facets.size() == 2 && labels.size() == 1) {
        continue;  // across a narrow surface
      }
      if (facets.size() != 2) {
        refuse(fmt::format(
            "{} surfaces with material meet on curve '{}' at {}; a fillet is "
            "between two",
            facets.size(), spec_.curve, place_text(x_[edge[0]])));
      }
      add_edge(edge, *labels.begin(), *labels.rbegin());
    }
    if (next_.empty()) {
      refuse(fmt::format("on curve '{}' no two surfaces with material meet",
                         spec_.curve));
    }
  }

  void add_edge(const Edge& edge, int first, int second) {
    Sides sides{first, second};
    if (!is_film(sides.a)) {
      std::swap(sides.a, sides.b);
    }
    if (!is_film(sides.a)) {
      refuse(fmt::format(
          "on curve '{}' no film ends, but the solid faces '{}' and '{}'; "
          "films are rounded, edges of solids are not",
          spec_.curve, surface_.labels[first], surface_.labels[second]));
    }
    if (sides_.a < 0) {
      sides_ = sides;
      result_.share = is_film(sides.b) ? 0.5 : 0.0;
    } else if (sides_.a != sides.a || sides_.b != sides.b) {
      refuse(fmt::format(
          "curve '{}' borders '{}' and '{}', and at {} '{}' and '{}'; a fillet "
          "needs one surface on each side all around",
          spec_.curve, surface_.labels[sides_.a], surface_.labels[sides_.b],
          place_text(x_[edge[0]]), surface_.labels[sides.a],
          surface_.labels[sides.b]));
    }
    next_[edge[0]].push_back(edge[1]);
    next_[edge[1]].push_back(edge[0]);
  }

  void order_curve() {
    const int first = next_.begin()->first;
    int last = -1;
    int v = first;
    do {
      const std::vector<int>& next = next_.at(v);
      if (next.size() != 2) {
        refuse(fmt::format("curve '{}' is not closed at {}", spec_.curve,
                           place_text(x_[v])));
      }
      result_.profiles.push_back({.point = v});
      const int other = next[0] == last ? next[1] : next[0];
      last = v;
      v = other;
    } while (v != first);
    std::vector<Profile>& profiles = result_.profiles;
    for (std::size_t k = 0; k < profiles.size(); ++k) {
      profiles[k].after = profiles[(k + 1) % profiles.size()].point;
      profiles[(k + 1) % profiles.size()].before = profiles[k].point;
    }
    for (const Profile& profile : profiles) {
      const Vec3 in = (x_[profile.point] - x_[profile.before]).normalized();
      const Vec3 out = (x_[profile.after] - x_[profile.point]).normalized();
      if (std::acos(std::clamp(in.dot(out), -1.0, 1.0)) > kCorner) {
        refuse(fmt::format(
            "curve '{}' has a corner at {}; a fillet needs a smooth curve: "
            "round its corners",
            spec_.curve, place_text(x_[profile.point])));
      }
    }
  }

  Vec3 along(const Profile& profile) const {
    return (x_[profile.after] - x_[profile.before]).normalized();
  }

  Walk walk(const LabelledFacets& facets, const Profile& profile,
            double most) const {
    std::optional<Walk> walk =
        walk_section(facets, profile.point, along(profile), most);
    if (!walk) {
      refuse(fmt::format(
          "'{}' has no facet across curve '{}' at {}",
          surface_.labels[surface_.facet_label[facets.about(profile.point)[0]]],
          spec_.curve, place_text(x_[profile.point])));
    }
    return std::move(*walk);
  }

  /// Into a side, across the curve.
  Vec3 inward(const LabelledFacets& facets, const Profile& profile) const {
    const Walk first = walk(facets, profile, 0.0);
    const Walk some = walk(facets, profile, 2.0 * first.length());
    return (at_mean(some.points.back(), x_) - x_[profile.point]).normalized();
  }

  void find_normals(const LabelledFacets& a, const LabelledFacets& b) {
    const Profile& profile = result_.profiles[0];
    const auto out = [&](const LabelledFacets& facets) {
      Vec3 normal = Vec3::Zero();
      for (const int f : facets.about(profile.point)) {
        normal += area_vector2(surface_, f);
      }
      const Vec3 own = along(profile).cross(inward(facets, profile));
      return own.dot(normal) > 0.0 ? 1.0 : -1.0;
    };
    result_.out_a = out(a);
    result_.out_b = out(b);
  }

  /// How far from the curve the ball touches two planes there.
  double touch(const LabelledFacets& a, const LabelledFacets& b,
               const Profile& profile) const {
    const double opening =
        std::clamp(inward(a, profile).dot(inward(b, profile)), -1.0, 1.0);
    return spec_.radius * std::sqrt((1.0 + opening) / (1.0 - opening));
  }

  void find_lengths(const LabelledFacets& a, const LabelledFacets& b) {
    double touch_most = kLeastTouch * spec_.radius;
    Vec3 where = Vec3::Zero();
    for (const Profile& profile : result_.profiles) {
      const double at = touch(a, b, profile);
      if (!(at <= touch_most)) {
        touch_most = at;
        where = x_[profile.point];
      }
    }
    const double size = bounding_diagonal(x_);
    if (!(kLeastTouch * spec_.radius < size)) {
      refuse(fmt::format(
          "radius {:.4g} has no room in a part of size {:.4g}; make it smaller",
          spec_.radius, size));
    }
    if (!(touch_most < size)) {
      refuse(fmt::format(
          "no ball of radius {:.4g} fits between '{}' and '{}' at {}: there "
          "they nearly lie on each other; open the angle between them, or "
          "leave the fillet out",
          spec_.radius, surface_.labels[sides_.a], surface_.labels[sides_.b],
          place_text(where)));
    }
    result_.length_a = band_length(a, sides_.a, touch_most);
    result_.length_b = band_length(b, sides_.b, touch_most);
  }

  /// A length of sections, and what keeps them from being longer.
  struct Room {
    double length = 0.0;
    Vec3 where = Vec3::Zero();
  };

  /// As far as the surface goes everywhere, at most kReach x the touch.
  double band_length(const LabelledFacets& facets, int label,
                     double touch) const {
    Room room{.length = kReach * touch};
    for (const Profile& profile : result_.profiles) {
      const Walk way = walk(facets, profile, kReach * touch / kOfHalf);
      const double length =
          way.length() * (ends_at_fillet(way.end) ? kOfHalf : kOfWhole);
      if (way.ended() && length < room.length) {
        room = {length, x_[profile.point]};
      }
    }
    keep_from_crossing(facets, room);
    if (room.length < kLeastReach * touch) {
      refuse(fmt::format(
          "radius {:.4g} does not fit on '{}' at {} of curve '{}': it has room "
          "for {:.3g} there; make the radius smaller or the surface wider",
          spec_.radius, surface_.labels[label], place_text(room.where),
          spec_.curve, spec_.radius * room.length / (kLeastReach * touch)));
    }
    return room.length;
  }

  /// Inside a bend of the curve sections run together.
  void keep_from_crossing(const LabelledFacets& facets, Room& room) const {
    Points ends;
    for (const Profile& profile : result_.profiles) {
      ends.push_back(
          at_mean(walk(facets, profile, room.length).at(room.length), x_));
    }
    const double whole = room.length;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const Profile& profile = result_.profiles[k];
      const Vec3 apart = x_[profile.after] - x_[profile.point];
      const double left = (ends[(k + 1) % ends.size()] - ends[k]).dot(apart) /
                          apart.squaredNorm();
      const double length = whole * (1.0 - kLeastApart) / (1.0 - left);
      if (left < kLeastApart && length < room.length) {
        room = {length, x_[profile.point]};
      }
    }
  }

  bool ends_at_fillet(const Edge& end) const {
    return std::any_of(rims_.begin(), rims_.end(), [&](const auto& rim) {
      return std::find(rim.begin(), rim.end(), end[0]) != rim.end() &&
             std::find(rim.begin(), rim.end(), end[1]) != rim.end();
    });
  }

  void add_sections(const LabelledFacets& a, const LabelledFacets& b) {
    for (Profile& profile : result_.profiles) {
      const Walk way_a = walk(a, profile, result_.length_a);
      const Walk way_b = walk(b, profile, result_.length_b);
      for (int k = 0; k < 3; ++k) {
        const double part = (k + 1) / 3.0;
        profile.a[k] = way_a.at(part * result_.length_a);
        profile.b[k] = way_b.at(part * result_.length_b);
      }
    }
  }

  const SurfaceMesh& surface_;
  const Points& x_;
  const films::FilmSystem& system_;
  const std::vector<std::vector<int>>& rims_;
  std::size_t which_;
  const films::FilletSpec& spec_;
  Sides sides_;
  std::map<int, std::vector<int>> next_;  // neighbours on the curve
  FilletBands result_;
};

}  // namespace

FilletBands freeze_bands(const SurfaceMesh& surface,
                         const films::FilmSystem& system,
                         const std::vector<std::vector<int>>& rims,
                         std::size_t which) {
  return Bands(surface, system, rims, which).freeze();
}

}  // namespace meniscus::fillets
