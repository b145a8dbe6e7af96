#include "evolve/disk_fill.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/loft.h"
#include "evolve/surface_editor.h"

namespace meniscus {

namespace {

using Vec2 = Eigen::Vector2d;

double cross2(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Cuts the best-shaped ear first; ears' shapes are kept and only the two
// neighbours of a cut are looked at again.
class EarClipper {
 public:
  explicit EarClipper(const Points& rim) : rim_(rim) {
    const int n = static_cast<int>(rim.size());
    const Vec3 normal = polygon_area_vector(rim).normalized();
    const Vec3 u = normal.unitOrthogonal();
    const Vec3 v = normal.cross(u);
    for (int i = 0; i < n; ++i) {
      flat_.emplace_back(u.dot(rim[i] - rim[0]), v.dot(rim[i] - rim[0]));
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
    std::vector<char> gone(rim_.size(), 0);
    for (std::size_t left = rim_.size(); left > 2; --left) {
      int best = -1;
      for (std::size_t i = 0; i < rim_.size(); ++i) {
        if (gone[i] == 0 && (best < 0 || shape_[i] > shape_[best])) {
          best = static_cast<int>(i);
        }
      }
      if (!(shape_[best] > 0.0) && left > 3) {
        const Vec3& p = rim_[best];
        throw MeshError(fmt::format(
            "a closed curve crosses itself near ({:.6g}, {:.6g}, {:.6g}) and "
            "cannot be filled",
            p.x(), p.y(), p.z()));
      }
      facets.push_back({previous_[best], best, next_[best]});
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
  // Smallest angle of the ear at i; 0 when it is none.
  double shape(int i) const {
    const int a = previous_[i];
    const int b = next_[i];
    const Vec2& pa = flat_[a];
    const Vec2& pi = flat_[i];
    const Vec2& pb = flat_[b];
    if (!(cross2(pi - pa, pb - pi) > 0.0)) {
      return 0.0;
    }
    for (int v = next_[b]; v != a; v = next_[v]) {
      const Vec2& p = flat_[v];
      if (cross2(pi - pa, p - pa) >= 0.0 && cross2(pb - pi, p - pi) >= 0.0 &&
          cross2(pa - pb, p - pb) >= 0.0) {
        return 0.0;
      }
    }
    return smallest_angle(rim_[a], rim_[i], rim_[b]);
  }

  const Points& rim_;
  std::vector<Vec2> flat_;
  std::vector<int> next_;
  std::vector<int> previous_;
  std::vector<double> shape_;
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
                     const EdgeTarget& target) {
  FilmComplex disk;
  disk.mesh.points = points;
  disk.mesh.facets = std::move(facets);
  disk.mesh.facet_label.assign(disk.mesh.facets.size(), 0);
  disk.surfaces.resize(1);
  disk.vertices.assign(points.size(), {.kind = VertexKind::Fixed});
  SurfaceEditor editor(std::move(disk));
  make_isotropic(editor, target, kPasses);
  return std::move(editor).finish().mesh;
}

}  // namespace

Vec3 polygon_area_vector(const Points& rim) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < rim.size(); ++i) {
    sum += (rim[i] - rim[0]).cross(rim[i + 1] - rim[0]);
  }
  return 0.5 * sum;
}

SurfaceMesh fill_disk(const Points& rim, double edge,
                      const std::function<double(const Vec3&)>& edge_field) {
  // Where the curve is cut finer than asked, the inside follows it.
  return remeshed(
      rim, EarClipper(rim).run(),
      {.edge = std::min(edge, mean_piece(rim)), .field = edge_field});
}

SurfaceMesh fill_ring(const Points& outer, const Points& inner, double edge) {
  Points rims = outer;
  rims.insert(rims.end(), inner.begin(), inner.end());
  return remeshed(
      rims, loft_band(outer, inner),
      {.edge = std::min({edge, mean_piece(outer), mean_piece(inner)})});
}

}  // namespace meniscus
