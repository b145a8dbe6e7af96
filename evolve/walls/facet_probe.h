/// Nearest point on a facet set and the largest ball that fits beside it: what
/// measuring a wall and the room around a film needs.
#pragma once

#include <limits>
#include <vector>

#include "core/geometry/box_tree.h"

namespace meniscus::walls {

/// Its questions are not FacetTree's: they come with a bound or a ball, which
/// the planes of facets cut short. O(n log n) to build, about O(log n) a
/// question. Points and facets must outlive it unchanged.
class FacetProbe {
 public:
  FacetProbe(const Points& points, const std::vector<Triangle>& facets);

  struct Hit {
    int facet = -1;  // -1: no facets
    Vec3 point = Vec3::Zero();
    double distance = std::numeric_limits<double>::infinity();  // [length]
  };
  /// The point of the facets that is nearest to `p`, if nearer than `bound`;
  /// else facet -1 at that distance. A tight bound saves most of the work.
  Hit nearest(const Vec3& p,
              double bound = std::numeric_limits<double>::infinity()) const;

  struct Ball {
    int facet = -1;  // touched; -1: nothing in the way
    Vec3 touch = Vec3::Zero();
    double radius = std::numeric_limits<double>::infinity();  // [length]
  };
  struct Home {
    int vertex = -1;  // with all facets there
    int facet = -1;
  };
  /// The largest ball of at most radius `limit` with its centre on the ray
  /// from `p` along the unit vector `normal`, touching `p`, that holds no
  /// point q of the facets seen from p within kCone of `normal`: the medial
  /// ball (Ma, Bae & Choi 2012) without the film's own neighbourhood. The
  /// radius is within kSlack of the exact one, never below it. `home`: where p
  /// lies, which is passed over.
  Ball tangent_ball(const Vec3& p, const Vec3& normal, double limit,
                    const Home& home) const;

  static constexpr double kCone = 0.5;    // cosine: 60 degrees
  static constexpr double kSlack = 0.01;  // relative

 private:
  Vec3 nearest_on(int facet, const Vec3& p) const;
  bool shrink(int facet, const Vec3& p, const Vec3& normal, const Vec3& q,
              Ball& ball) const;
  void shrink(int facet, const Vec3& p, const Vec3& normal, double limit,
              Ball& ball) const;

  const Points& points_;
  const std::vector<Triangle>& facets_;
  BoxTree tree_;
  struct Plane {
    Vec3 normal = Vec3::Zero();  // unit; 0 for a facet without area
    double offset = 0.0;
  };
  std::vector<Plane> planes_;  // of the facets in the tree's order
};

}  // namespace meniscus::walls
