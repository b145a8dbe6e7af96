#include "evolve/start/close_rims.h"

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/geometry/plane_points.h"
#include "evolve/curves/curve.h"
#include "evolve/curves/curve_shape.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr int kMostHalvings = 3;

using Polygon = std::vector<Vec2>;

/// Of two polygons, or of one with itself.
bool polygons_cross(const Polygon& p, const Polygon& q) {
  const bool same = &p == &q;
  const Eigen::AlignedBox2d all = box_of(q);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2& a = p[i];
    const Vec2& b = p[(i + 1) % p.size()];
    if (!box_of({a, b}).intersects(all)) {
      continue;
    }
    for (std::size_t j = same ? i + 1 : 0; j < q.size(); ++j) {
      if (segment_crossing(a, b, q[j], q[(j + 1) % q.size()])) {
        return true;
      }
    }
  }
  return false;
}

/// Sides of curves with corners may be those of other faces, which cut them as
/// they do.
bool is_smooth(const curves::Curve& curve) {
  return curves::curve_shape::part_count(curve.shape) == 1;
}

/// The curves by which one surface is bounded, as polygons in its plane.
class Outline {
 public:
  Outline(films::FilmSystem& system, const std::vector<std::string>& names,
          double edge)
      : edge_(edge) {
    for (const std::string& name : names) {
      const auto found =
          std::find_if(system.curves.begin(), system.curves.end(),
                       [&](const curves::Curve& c) { return c.name == name; });
      if (found != system.curves.end()) {
        curves_.push_back(&*found);
        sides_.push_back(sides_of(*found, 1.0));
      }
    }
  }

  /// Halves the pieces of curves whose chords cross; leaves them where that
  /// does not help.
  void refine() {
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      for (std::size_t j = i; j < curves_.size(); ++j) {
        if (is_smooth(*curves_[i]) && is_smooth(*curves_[j])) {
          refine(i, j);
        }
      }
    }
  }

 private:
  Points sides_of(const curves::Curve& curve, double share) const {
    return curves::points_at(
        curve.shape,
        curves::sample_parameters(curve.shape, share * curve.fineness * edge_));
  }

  Polygon flat(const Points& points) {
    if (!has_plane_) {
      const Vec3 normal = polygon_area_vector(sides_.front()).normalized();
      u_ = normal.unitOrthogonal();
      v_ = normal.cross(u_);
      has_plane_ = true;
    }
    Polygon result;
    for (const Vec3& p : points) {
      result.emplace_back(u_.dot(p), v_.dot(p));
    }
    return result;
  }

  bool cross(const Points& a, const Points& b) {
    const Polygon first = flat(a);
    if (&a == &b) {
      return polygons_cross(first, first);
    }
    return polygons_cross(first, flat(b));
  }

  void refine(std::size_t i, std::size_t j) {
    if (!cross(sides_[i], sides_[j])) {
      return;
    }
    double share = 1.0;
    for (int k = 0; k < kMostHalvings; ++k) {
      share *= 0.5;
      const Points a = sides_of(*curves_[i], share);
      const Points b = i == j ? a : sides_of(*curves_[j], share);
      if (!(i == j ? cross(a, a) : cross(a, b))) {
        sides_[i] = a;
        sides_[j] = b;
        curves_[i]->fineness *= share;
        curves_[j]->fineness *= i == j ? 1.0 : share;
        return;
      }
    }
  }

  double edge_;
  std::vector<curves::Curve*> curves_;
  std::vector<Points> sides_;
  bool has_plane_ = false;
  Vec3 u_ = Vec3::UnitX();
  Vec3 v_ = Vec3::UnitY();
};

}  // namespace

films::FilmSystem with_rims_apart(films::FilmSystem system, double edge) {
  if (!(edge > 0.0)) {
    return system;  // who samples the curves refuses it
  }
  for (const films::FilmSpec& film : system.films) {
    if (film.kind == films::FilmKind::Disk) {
      Outline(system, film.curves, edge).refine();
    }
  }
  for (const films::CapSpec& cap : system.caps) {
    if (!cap.more.empty()) {
      Outline(system, cap.curves(), edge).refine();
    }
  }
  return system;
}

}  // namespace meniscus::start
