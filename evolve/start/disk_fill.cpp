#include "evolve/start/disk_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/plane_points.h"
#include "core/heed_stop.h"
#include "evolve/films/loft.h"
#include "evolve/groom/surface_editor.h"

namespace meniscus::start {

namespace {

/// The rim's points in its plane, counter-clockwise.
std::vector<Vec2> flattened(const Points& points, const Points& rim) {
  const Vec3 normal = polygon_area_vector(rim).normalized();
  const Vec3 u = normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  std::vector<Vec2> flat;
  flat.reserve(points.size());
  for (const Vec3& p : points) {
    flat.emplace_back(u.dot(p - rim[0]), v.dot(p - rim[0]));
  }
  return flat;
}

constexpr double kOnLine = 1e-13;  // x the squared extent

// Cuts the best-shaped ear first; ears' shapes are kept and only the two
// neighbours of a cut are looked at again. The ring may visit a point twice:
// where a bridge to a hole begins and ends.
class EarClipper {
 public:
  EarClipper(const Points& points, const std::vector<Vec2>& flat,
             std::vector<int> ring)
      : points_(points), flat_(flat), ring_(std::move(ring)) {
    on_line_ = kOnLine * box_of(flat_).diagonal().squaredNorm();
    const int n = static_cast<int>(ring_.size());
    for (int i = 0; i < n; ++i) {
      next_.push_back((i + 1) % n);
      previous_.push_back((i + n - 1) % n);
    }
    shape_.resize(n);
    for (int i = 0; i < n; ++i) {
      shape_[i] = shape(i);
    }
  }

  std::vector<Triangle> run() {
    std::vector<Triangle> facets;
    std::vector<char> gone(ring_.size(), 0);
    for (std::size_t left = ring_.size(); left > 2; --left) {
      heed_stop("film");
      int best = -1;
      for (std::size_t i = 0; i < ring_.size(); ++i) {
        if (gone[i] == 0 && (best < 0 || shape_[i] > shape_[best])) {
          best = static_cast<int>(i);
        }
      }
      if (!(shape_[best] > 0.0) && left > 3) {
        const Vec3 p = crossing();
        throw MeshError(fmt::format(
            "seen along the normal of its plane, a closed curve crosses itself "
            "or another near ({:.6g}, {:.6g}, {:.6g}) and cannot be filled",
            p.x(), p.y(), p.z()));
      }
      facets.push_back(
          {ring_[previous_[best]], ring_[best], ring_[next_[best]]});
      gone[best] = 1;
      const int a = previous_[best];
      const int b = next_[best];
      next_[a] = b;
      previous_[b] = a;
      shape_[a] = shape(a);
      shape_[b] = shape(b);
    }
    return facets;
  }

 private:
  /// Where sides of the ring cross; else the corner that is nearest to a side
  /// of others, which it touches.
  Vec3 crossing() const {
    const auto at = [&](std::size_t i) { return ring_[i % ring_.size()]; };
    double nearest = std::numeric_limits<double>::infinity();
    int touching = ring_[0];
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const int a = at(i);
      const int b = at(i + 1);
      for (std::size_t j = 0; j < ring_.size(); ++j) {
        const int c = at(j);
        if (c == a || c == b) {
          continue;
        }
        if (const auto share = segment_crossing(flat_[a], flat_[b], flat_[c],
                                                flat_[at(j + 1)])) {
          return points_[a] + *share * (points_[b] - points_[a]);
        }
        const double off = distance_to_segment(flat_[c], flat_[a], flat_[b]);
        if (off < nearest) {
          nearest = off;
          touching = c;
        }
      }
    }
    return points_[touching];
  }

  // Smallest angle of the ear at i; 0 when it is none.
  double shape(int i) const {
    const int a = previous_[i];
    const int b = next_[i];
    const Vec2& pa = flat_[ring_[a]];
    const Vec2& pi = flat_[ring_[i]];
    const Vec2& pb = flat_[ring_[b]];
    if (!(cross2(pi - pa, pb - pi) > on_line_)) {
      return 0.0;
    }
    for (int v = next_[b]; v != a; v = next_[v]) {
      if (ring_[v] == ring_[a] || ring_[v] == ring_[i] ||
          ring_[v] == ring_[b]) {
        continue;
      }
      const Vec2& p = flat_[ring_[v]];
      // Points on the ear's sides count: what is left must not be a line.
      if (cross2(pi - pa, p - pa) >= -on_line_ &&
          cross2(pb - pi, p - pi) >= -on_line_ &&
          cross2(pa - pb, p - pb) >= -on_line_) {
        return 0.0;
      }
    }
    return films::smallest_angle(points_[ring_[a]], points_[ring_[i]],
                                 points_[ring_[b]]);
  }

  const Points& points_;
  const std::vector<Vec2>& flat_;
  std::vector<int> ring_;  // ids of points, in order around
  std::vector<int> next_;
  std::vector<int> previous_;
  std::vector<double> shape_;
  double on_line_ = 0.0;  // cross products of points in line, but for rounding
};

/// Joins holes to the ring around them by bridges that go there and back.
class HoleBridges {
 public:
  HoleBridges(const std::vector<Vec2>& flat, std::vector<int> ring,
              std::vector<std::vector<int>> holes)
      : flat_(flat), ring_(std::move(ring)), holes_(std::move(holes)) {}

  std::vector<int> run() {
    while (!holes_.empty()) {
      join(shortest());
    }
    return std::move(ring_);
  }

 private:
  struct Bridge {
    double length = 0.0;
    std::size_t from = 0;  // place in the ring
    std::size_t hole = 0;
    std::size_t to = 0;  // place in the hole
  };

  /// The shortest segment from ring to hole that meets neither.
  Bridge shortest() const {
    std::vector<Bridge> all;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      for (std::size_t h = 0; h < holes_.size(); ++h) {
        for (std::size_t j = 0; j < holes_[h].size(); ++j) {
          const double length = (flat_[holes_[h][j]] - flat_[ring_[i]]).norm();
          all.push_back({length, i, h, j});
        }
      }
    }
    std::stable_sort(
        all.begin(), all.end(),
        [](const Bridge& a, const Bridge& b) { return a.length < b.length; });
    for (const Bridge& bridge : all) {
      const int a = ring_[bridge.from];
      const int b = holes_[bridge.hole][bridge.to];
      bool clear =
          leaves_inwards(bridge.from, flat_[b]) && !crosses(a, b, ring_);
      for (const std::vector<int>& hole : holes_) {
        clear = clear && !crosses(a, b, hole);
      }
      if (clear) {
        return bridge;
      }
    }
    throw MeshError("a hole is not inside the curve around it");
  }

  /// Between the sides of the ring at place i.
  bool leaves_inwards(std::size_t i, const Vec2& to) const {
    const Vec2& at = flat_[ring_[i]];
    const Vec2 in = at - flat_[ring_[(i + ring_.size() - 1) % ring_.size()]];
    const Vec2 out = flat_[ring_[(i + 1) % ring_.size()]] - at;
    const Vec2 way = to - at;
    const bool left_of_in = cross2(in, way) > 0.0;
    const bool left_of_out = cross2(out, way) > 0.0;
    return cross2(in, out) > 0.0 ? left_of_in && left_of_out
                                 : left_of_in || left_of_out;
  }

  bool crosses(int a, int b, const std::vector<int>& loop) const {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const int c = loop[k];
      const int d = loop[(k + 1) % loop.size()];
      if (c == a || c == b || d == a || d == b) {
        continue;
      }
      const auto [of_second, of_first] =
          segment_sides(flat_[a], flat_[b], flat_[c], flat_[d]);
      if (of_second <= 0.0 && of_first <= 0.0) {
        return true;
      }
    }
    return false;
  }

  void join(const Bridge& bridge) {
    std::vector<int> hole = std::move(holes_[bridge.hole]);
    holes_.erase(holes_.begin() + static_cast<std::ptrdiff_t>(bridge.hole));
    std::rotate(hole.begin(),
                hole.begin() + static_cast<std::ptrdiff_t>(bridge.to),
                hole.end());
    hole.push_back(hole.front());
    hole.push_back(ring_[bridge.from]);
    ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(bridge.from) + 1,
                 hole.begin(), hole.end());
  }

  const std::vector<Vec2>& flat_;
  std::vector<int> ring_;
  std::vector<std::vector<int>> holes_;  // clockwise
};

constexpr int kPasses = 8;

double mean_piece(const Points& rim) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    sum += (rim[(i + 1) % rim.size()] - rim[i]).norm();
  }
  return sum / static_cast<double>(rim.size());
}

SurfaceMesh remeshed(const Points& points, std::vector<Triangle> facets,
                     const groom::EdgeTarget& target) {
  films::FilmComplex disk;
  disk.mesh.points = points;
  disk.mesh.facets = std::move(facets);
  disk.mesh.facet_label.assign(disk.mesh.facets.size(), 0);
  disk.surfaces.resize(1);
  disk.vertices.assign(points.size(), {.kind = films::VertexKind::Fixed});
  groom::SurfaceEditor editor(std::move(disk));
  groom::make_isotropic(editor, target, kPasses);
  return std::move(editor).finish().mesh;
}

}  // namespace

SurfaceMesh fill_disk(const Points& rim, double edge,
                      const std::function<double(const Vec3&)>& edge_field) {
  return fill_disk(rim, {}, edge, edge_field);
}

SurfaceMesh fill_disk(const Points& rim, const std::vector<Points>& holes,
                      double edge,
                      const std::function<double(const Vec3&)>& edge_field) {
  const Vec3 normal = polygon_area_vector(rim);
  Points points = rim;
  std::vector<int> ring(rim.size());
  std::iota(ring.begin(), ring.end(), 0);
  std::vector<std::vector<int>> loops;
  double piece = mean_piece(rim);
  for (const Points& hole : holes) {
    std::vector<int>& loop = loops.emplace_back(hole.size());
    std::iota(loop.begin(), loop.end(), static_cast<int>(points.size()));
    if (polygon_area_vector(hole).dot(normal) > 0.0) {
      std::reverse(loop.begin(), loop.end());
    }
    points.insert(points.end(), hole.begin(), hole.end());
    piece = std::max(piece, mean_piece(hole));
  }
  const std::vector<Vec2> flat = flattened(points, rim);
  ring = HoleBridges(flat, std::move(ring), std::move(loops)).run();
  // Where the curve is cut finer than asked, the inside follows it.
  return remeshed(points, EarClipper(points, flat, std::move(ring)).run(),
                  {.edge = std::min(edge, piece), .field = edge_field});
}

SurfaceMesh fill_ring(const Points& outer, const Points& inner, double edge) {
  Points rims = outer;
  rims.insert(rims.end(), inner.begin(), inner.end());
  return remeshed(
      rims, films::loft_band(outer, inner),
      {.edge = std::min({edge, mean_piece(outer), mean_piece(inner)})});
}

}  // namespace meniscus::start
