#include "evolve/settle/neck.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "core/geometry/box_tree.h"
#include "core/heed_stop.h"
#include "core/math/union_find.h"
#include "core/parallel_for.h"

namespace meniscus::settle {

namespace {

constexpr double kFacing = 0.7;  // cosine between line and facet normal
constexpr int kNearLine = 2;     // edges from a line, rim or junction
constexpr int kCorner = 3;       // edges along the films
constexpr int kParts = 16;       // of a range of unknowns
constexpr int kFirstPart = 64;   // unknowns

/// What lines of sight meet first. Not FacetTree's rays: a facet is met a
/// little beyond its sides too, and who is passed over is the caller's say.
class SightLines {
 public:
  SightLines(const std::vector<Triangle>& facets, const Points& points)
      : facets_(facets), points_(points), tree_(items(facets, points)) {}

  /// Nearest hit of origin + t direction with 0 < t < limit on a facet that
  /// accept(facet) admits; returns the facet or -1, and t in `limit`.
  template <typename Accept>
  int first_hit(const Vec3& origin, const Vec3& direction, double& limit,
                const Accept& accept) const {
    int best = -1;
    const std::vector<BoxTree::Node>& nodes = tree_.nodes();
    if (nodes.empty()) {
      return best;
    }
    // No infinity, so that a line in a box's own plane gives 0 and not NaN.
    const Vec3 inverse = direction.unaryExpr([](double d) {
      return 1.0 / (std::abs(d) > 1e-200 ? d : std::copysign(1e-200, d));
    });
    std::array<int, 64> stack{};
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const int id = stack[--top];
      const BoxTree::Node& node = nodes[id];
      if (!box_hit(node.bounds, origin, inverse, limit)) {
        continue;
      }
      if (node.is_leaf()) {
        for (int k = node.first; k < node.last; ++k) {
          const int f = tree_.items()[k].id;
          const double t = hit(f, origin, direction);
          if (t > 0.0 && t < limit && accept(f)) {
            limit = t;
            best = f;
          }
        }
      } else {
        // The near half last, so that it comes off the stack first.
        const bool forward = direction[node.axis] > 0.0;
        stack[top++] = forward ? node.second_child : id + 1;
        stack[top++] = forward ? id + 1 : node.second_child;
      }
    }
    return best;
  }

 private:
  static std::vector<BoxTree::Item> items(const std::vector<Triangle>& facets,
                                          const Points& points) {
    auto result = facet_items(facets, points);
    for (BoxTree::Item& item : result) {
      item.center /= 3.0;
    }
    return result;
  }

  static bool box_hit(const AxisBox& box, const Vec3& origin,
                      const Vec3& inverse, double limit) {
    double enter = 0.0;
    double leave = limit;
    for (int k = 0; k < 3; ++k) {
      const double a = (box.low[k] - origin[k]) * inverse[k];
      const double b = (box.high[k] - origin[k]) * inverse[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * (1.0 + 1e-12);
  }

  /// Moeller and Trumbore (1997); negative for a miss.
  double hit(int facet, const Vec3& origin, const Vec3& direction) const {
    const Triangle& t = facets_[facet];
    const Vec3& a = points_[t[0]];
    const Vec3 e1 = points_[t[1]] - a;
    const Vec3 e2 = points_[t[2]] - a;
    const Vec3 p = direction.cross(e2);
    const double det = e1.dot(p);
    if (det == 0.0) {
      return -1.0;
    }
    constexpr double kEdge = 1e-9;  // so that no line slips between facets
    const Vec3 s = origin - a;
    const double u = s.dot(p) / det;
    const Vec3 q = s.cross(e1);
    const double v = direction.dot(q) / det;
    if (!(u >= -kEdge && v >= -kEdge && u + v <= 1.0 + kEdge)) {
      return -1.0;
    }
    return e2.dot(q) / det;
  }

  const std::vector<Triangle>& facets_;
  const Points& points_;
  BoxTree tree_;
};

/// Do two facets look into one chamber? Films without a body share the outside.
bool share_body(const energy::FilmEnergy& energy, int f, int g) {
  bool any = false;
  for (int b = 0; b < energy.bodies(); ++b) {
    const bool of_f = energy.side(f, b) != 0;
    const bool of_g = energy.side(g, b) != 0;
    if (of_f && of_g) {
      return true;
    }
    any = any || of_f || of_g;
  }
  return !any;
}

/// Where an unknown's vertex looks from: along which sides of its normal a
/// body lies (bit 1 against the normal, bit 2 along it; both for a film
/// without a body), and one of its film's facets.
struct Outlook {
  int sides = 0;
  int facet = -1;
};

std::vector<Outlook> outlooks(const energy::FilmEnergy& energy,
                              std::size_t point_count) {
  std::vector<Outlook> of_vertex(point_count);
  for (int f = 0; f < static_cast<int>(energy.facets().size()); ++f) {
    if (!energy.is_liquid(f)) {
      continue;
    }
    int sides = 0;
    for (int b = 0; b < energy.bodies(); ++b) {
      const double side = energy.side(f, b) * energy.space().turn(f);
      sides |= side > 0 ? 1 : (side < 0 ? 2 : 0);
    }
    for (const int v : energy.facets()[f]) {
      of_vertex[v].sides |= sides != 0 ? sides : 3;
      of_vertex[v].facet = f;
    }
  }
  std::vector<Outlook> result;
  for (const int v : energy.vertices()) {
    result.push_back(of_vertex[v]);
  }
  return result;
}

/// Vertices near a line, rim or junction: films that meet there come near to
/// each other without being a neck.
std::vector<char> near_lines(const energy::FilmEnergy& energy,
                             std::size_t count) {
  std::vector<char> near(count, 0);
  for (std::size_t f = 0; f < energy.facets().size(); ++f) {
    for (const int v : energy.facets()[f]) {
      if (energy.is_liquid(static_cast<int>(f)) &&
          (energy.space().rank(v) != 1 ||
           energy.space().line_ends(v)[0] >= 0)) {
        near[v] = 1;
      }
    }
  }
  for (int ring = 0; ring < kNearLine; ++ring) {
    std::vector<char> next = near;
    for (const Triangle& t : energy.facets()) {
      if (near[t[0]] + near[t[1]] + near[t[2]] > 0) {
        next[t[0]] = next[t[1]] = next[t[2]] = 1;
      }
    }
    near = std::move(next);
  }
  return near;
}

/// The facets at each point.
struct FacetsAround {
  std::vector<int> start;  // by point
  std::vector<int> facet;

  FacetsAround(const std::vector<Triangle>& facets, std::size_t points)
      : start(points + 1, 0), facet(3 * facets.size()) {
    for (const Triangle& t : facets) {
      for (const int v : t) {
        ++start[v + 1];
      }
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<int> next(start.begin(), start.end() - 1);
    for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
      for (const int v : facets[f]) {
        facet[next[v]++] = f;
      }
    }
  }
};

/// Which facets are a few edges away from a vertex: across a corner, not
/// across a neck. Of one thread.
class Corners {
 public:
  Corners(const std::vector<Triangle>& facets, const FacetsAround& around)
      : facets_(facets), around_(around), mark_(around.start.size(), -1) {}

  bool has(int v, int facet) {
    if (v != centre_) {
      gather(v);
    }
    const Triangle& t = facets_[facet];
    return mark_[t[0]] == v || mark_[t[1]] == v || mark_[t[2]] == v;
  }

 private:
  // Ring by ring; `mark_` is the centre that a vertex was last found from.
  void gather(int v) {
    centre_ = v;
    mark_[v] = v;
    found_ = {v};
    std::size_t first = 0;
    for (int ring = 0; ring < kCorner; ++ring) {
      const std::size_t last = found_.size();
      for (; first < last; ++first) {
        const int at = found_[first];
        for (int k = around_.start[at]; k < around_.start[at + 1]; ++k) {
          for (const int u : facets_[around_.facet[k]]) {
            if (mark_[u] != v) {
              mark_[u] = v;
              found_.push_back(u);
            }
          }
        }
      }
    }
  }

  const std::vector<Triangle>& facets_;
  const FacetsAround& around_;
  std::vector<int> mark_;
  int centre_ = -1;
  std::vector<int> found_;
};

/// A number per point that is the same for points of films that hang together.
std::vector<int> joined_films(const energy::FilmEnergy& energy,
                              std::size_t count) {
  UnionFind films(count);
  for (std::size_t f = 0; f < energy.facets().size(); ++f) {
    const Triangle& t = energy.facets()[f];
    for (int k = 1; energy.is_liquid(static_cast<int>(f)) && k < 3; ++k) {
      films.join(t[0], t[k]);
    }
  }
  return films.roots();
}

/// A line across a body, from an unknown's vertex to a facet.
struct Across {
  double length = std::numeric_limits<double>::infinity();
  int unknown = -1;
  Vec3 direction = Vec3::Zero();
  int facet = -1;
};

/// The search for the shortest line; shortest_of() may run in many threads.
class NeckSearch {
 public:
  NeckSearch(const energy::FilmEnergy& energy, const Points& points)
      : energy_(energy),
        points_(points),
        lines_(energy.facets(), points),
        normals_(energy.space().directions(points)),
        looks_(outlooks(energy, points.size())),
        near_(near_lines(energy, points.size())),
        film_(joined_films(energy, points.size())),
        around_(energy.facets(), points.size()) {}

  int facet_of(int unknown) const { return looks_[unknown].facet; }

  /// The shortest from the unknowns first to last - 1 that is shorter than
  /// `bound`, of equal ones the first; else `bound` itself.
  Across shortest_of(int first, int last, const Across& bound) const {
    Corners corners(energy_.facets(), around_);
    Across best = bound;
    for (int i = first; i < last; ++i) {
      const int v = energy_.vertices()[i];
      for (const int bit : {1, 2}) {
        if ((looks_[i].sides & bit) == 0 || normals_[i].isZero() ||
            energy_.space().rank(v) != 1) {
          continue;
        }
        look(i, bit == 1 ? Vec3(-normals_[i]) : normals_[i], corners, best);
      }
    }
    return best;
  }

 private:
  void look(int i, const Vec3& direction, Corners& corners,
            Across& best) const {
    const std::vector<Triangle>& facets = energy_.facets();
    const int v = energy_.vertices()[i];
    // What counts: facets of the same body, not about the vertex itself, and
    // no corner of the film at a rim or line.
    const auto accept = [&](int f) {
      const Triangle& t = facets[f];
      const bool corner = near_[v] != 0 &&
                          near_[t[0]] + near_[t[1]] + near_[t[2]] > 0 &&
                          corners.has(v, f);
      return t[0] != v && t[1] != v && t[2] != v && !corner &&
             share_body(energy_, f, looks_[i].facet);
    };
    // Only hits nearer than the least so far matter, which bounds the search.
    double length = best.length;
    const int f = lines_.first_hit(points_[v], direction, length, accept);
    if (f < 0 || !energy_.is_liquid(f) || film_[facets[f][0]] != film_[v]) {
      return;
    }
    const Triangle& t = facets[f];
    // A neck lies between sides that face each other; grazing hits are none.
    const Vec3 normal = (points_[t[1]] - points_[t[0]])
                            .cross(points_[t[2]] - points_[t[0]])
                            .normalized();
    if (std::abs(normal.dot(direction)) > kFacing) {
      best = {length, i, direction, f};
    }
  }

  const energy::FilmEnergy& energy_;
  const Points& points_;
  SightLines lines_;
  Points normals_;
  std::vector<Outlook> looks_;
  std::vector<char> near_;
  std::vector<int> film_;
  FacetsAround around_;
};

}  // namespace

Neck narrowest_neck(const energy::FilmEnergy& energy, const Points& points,
                    const std::vector<int>& facet_label) {
  const NeckSearch search(energy, points);
  // A ray from every smooth film vertex along the inward normal, or both ways
  // where the film encloses nothing. In threads by parts of a range; what is
  // found bounds the next, four times as long: as in one walk, whatever the
  // threads.
  Across best;
  int part = kFirstPart;
  for (int first = 0; first < energy.unknowns(); part *= 4) {
    heed_stop("film");
    const int last = static_cast<int>(std::min<std::int64_t>(
        energy.unknowns(), first + std::int64_t{kParts} * part));
    std::array<Across, kParts> found;
    parallel_for(kParts, [&](std::ptrdiff_t k) {
      const auto from = static_cast<int>(first + k * part);
      found[k] = search.shortest_of(from, std::min(last, from + part), best);
    });
    for (const Across& line : found) {
      best = line.length < best.length ? line : best;
    }
    first = last;
  }
  Neck neck;
  if (best.unknown >= 0) {
    neck.width = best.length;
    neck.position = points[energy.vertices()[best.unknown]] +
                    0.5 * best.length * best.direction;
    neck.surface = facet_label[search.facet_of(best.unknown)];
    neck.opposite = facet_label[best.facet];
  }
  return neck;
}

}  // namespace meniscus::settle
