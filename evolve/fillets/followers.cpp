#include "evolve/fillets/followers.h"

#include <algorithm>
#include <limits>

#include <Eigen/Core>

#include "evolve/fillets/section.h"

namespace meniscus::fillets {

namespace {

constexpr double kOffBand = 0.3;  // of a band's length: another part's point
constexpr double kBesides = 1.1;  // of a band's length: looked at
constexpr int kSearchSteps = 30;

/// A point's place between two neighbouring sections.
struct Place {
  int profile = 0;  // between this one and the next
  double part = 0.0;
  double s = 0.0;
  double off = 0.0;  // its distance from there
};

class Sections {
 public:
  Sections(const Points& x, bool of_a, const FilletBands& bands)
      : length_(of_a ? bands.length_a : bands.length_b) {
    for (const Profile& profile : bands.profiles) {
      const auto& nodes = of_a ? profile.a : profile.b;
      sections_.push_back({{x[profile.point], at_mean(nodes[0], x),
                            at_mean(nodes[1], x), at_mean(nodes[2], x)},
                           length_});
    }
  }

  double length() const { return length_; }
  int count() const { return static_cast<int>(sections_.size()); }

  /// The section that begins nearest to a point; -1: none within the band.
  int nearest(const Vec3& p) const {
    int nearest = -1;
    double least = kBesides * length_;
    for (int k = 0; k < count(); ++k) {
      const double distance = (sections_[k].nodes[0] - p).norm();
      if (distance < least) {
        least = distance;
        nearest = k;
      }
    }
    return nearest;
  }

  /// By Gauss and Newton from the nearest section on.
  Place place_of(const Vec3& p, int nearest) const {
    Place best{.off = std::numeric_limits<double>::infinity()};
    Place at{.profile = nearest,
             .part = 0.5,
             .s = (p - sections_[nearest].nodes[0]).norm()};
    for (int k = 0; k < kSearchSteps; ++k) {
      const Section<double>& from = sections_[at.profile];
      const Section<double>& to = sections_[(at.profile + 1) % count()];
      const Vec3 here = from.at(at.s);
      const Vec3 there = to.at(at.s);
      const Vec3 gap = p - (1.0 - at.part) * here - at.part * there;
      at.off = gap.norm();
      if (at.off < best.off) {
        best = at;
      }
      const Vec3 by_s =
          (1.0 - at.part) * from.slope(at.s) + at.part * to.slope(at.s);
      const Vec3 by_part = there - here;
      const double mixed = by_s.dot(by_part);
      const double area2 =
          by_s.squaredNorm() * by_part.squaredNorm() - mixed * mixed;
      at.s += (by_part.squaredNorm() * by_s - mixed * by_part).dot(gap) / area2;
      turn(at,
           at.part +
               (by_s.squaredNorm() * by_part - mixed * by_s).dot(gap) / area2);
    }
    return best;
  }

 private:
  /// To `part`, on the next pair of sections where it is not of this one.
  void turn(Place& at, double part) const {
    if (part < 0.0) {
      at.profile = (at.profile + count() - 1) % count();
      part = std::max(0.0, part + 1.0);
    } else if (part > 1.0) {
      at.profile = (at.profile + 1) % count();
      part = std::min(1.0, part - 1.0);
    }
    at.part = part;
  }

  double length_;
  std::vector<Section<double>> sections_;
};

}  // namespace

void add_followers(const LabelledFacets& facets, bool of_a,
                   FilletBands& bands) {
  const Points& x = facets.mesh().points;
  const Sections sections(x, of_a, bands);
  for (const int v : facets.inner_points()) {
    const int nearest = sections.nearest(x[v]);
    if (nearest < 0) {
      continue;
    }
    const Place at = sections.place_of(x[v], nearest);
    if (!(at.off < kOffBand * sections.length()) || !(at.s > 0.0) ||
        !(at.s < sections.length())) {
      continue;
    }
    const int next = (at.profile + 1) % sections.count();
    bands.profiles[at.profile].followers.push_back(
        {v, of_a, at.s, 1.0 - at.part});
    bands.profiles[next].followers.push_back({v, of_a, at.s, at.part});
  }
}

}  // namespace meniscus::fillets
