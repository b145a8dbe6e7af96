#include "evolve/walls/jet_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/math/dense.h"

namespace meniscus::walls {

namespace {

constexpr int kCubicPoints = 14;
constexpr int kQuadraticPoints = 5;
constexpr int kMaxRings = 3;
// A point whose normal is further off cannot be part of the same graph z(x, y);
// a fitted normal further off than that is no fit.
constexpr double kSameGraph = 0.3;
constexpr double kTrust = 0.8;

// Sum of facet normals weighted by sin(angle) / (product of the two edges),
// which is exact on a sphere.
Vec3 max_normal(const Sheet& sheet, int v) {
  Vec3 sum = Vec3::Zero();
  for (int k = sheet.facet_start[v]; k < sheet.facet_start[v + 1]; ++k) {
    const Triangle& t = sheet.film.facets[sheet.facet_list[k]];
    const int at = t[0] == v ? 0 : (t[1] == v ? 1 : 2);
    const Vec3 a = sheet.film.points[t[(at + 1) % 3]] - sheet.film.points[v];
    const Vec3 b = sheet.film.points[t[(at + 2) % 3]] - sheet.film.points[v];
    sum += a.cross(b) / (a.squaredNorm() * b.squaredNorm());
  }
  const double length = sum.norm();
  return length > 0.0
             ? Vec3(sum / length)
             : sheet.facet_normal[sheet.facet_list[sheet.facet_start[v]]];
}

class Fitter {
 public:
  explicit Fitter(const Sheet& sheet) : sheet_(sheet) {
    const auto count = static_cast<int>(sheet.film.points.size());
    normals_.resize(count);
    for (int v = 0; v < count; ++v) {
      normals_[v] = max_normal(sheet, v);
    }
    mark_.assign(count, -1);
  }

  Jet fit(int v) {
    Jet jet;
    jet.normal = normals_[v];
    if (sheet_.on_crease[v] != 0) {
      return jet;
    }
    gather(v);
    if (static_cast<int>(ring_.size()) < kQuadraticPoints) {
      return jet;
    }
    solve(v, jet);
    return jet;
  }

 private:
  // Whole rings until a cubic has enough points; creases end them.
  void gather(int v) {
    ring_.clear();
    mark_[v] = v;
    std::vector<int>& front = front_;
    front.assign(1, v);
    const auto enough = static_cast<std::size_t>(kCubicPoints);
    for (int r = 0; r < kMaxRings && ring_.size() < enough; ++r) {
      next_.clear();
      for (const int a : front) {
        for (int k = sheet_.edge_start[a]; k < sheet_.edge_start[a + 1]; ++k) {
          const Edge& e = sheet_.edges[sheet_.edge_list[k]];
          const int b = e[0] == a ? e[1] : e[0];
          if (mark_[b] == v) {
            continue;
          }
          mark_[b] = v;
          if (sheet_.on_crease[b] != 0) {
            ring_.push_back(b);
          } else if (normals_[b].dot(normals_[v]) > kSameGraph) {
            ring_.push_back(b);
            next_.push_back(b);
          }
        }
      }
      front.swap(next_);
    }
  }

  void solve(int v, Jet& jet) const {
    const Vec3& z = normals_[v];
    const Vec3 x = z.unitOrthogonal();
    const Vec3 y = z.cross(x);
    const auto rows = static_cast<int>(ring_.size());
    const int columns = rows >= kCubicPoints ? 9 : 5;
    double size = 0.0;
    for (const int b : ring_) {
      size += (sheet_.film.points[b] - sheet_.film.points[v]).norm() / rows;
    }
    Eigen::MatrixXd a(rows, columns);
    VectorX height(rows);
    for (int i = 0; i < rows; ++i) {
      const Vec3 d =
          (sheet_.film.points[ring_[i]] - sheet_.film.points[v]) / size;
      const double px = d.dot(x);
      const double py = d.dot(y);
      a.row(i).head<5>() << px, py, 0.5 * px * px, px * py, 0.5 * py * py;
      if (columns == 9) {
        a.row(i).tail<4>() << px * px * px, px * px * py, px * py * py,
            py * py * py;
      }
      height[i] = d.dot(z);
      const double weight = 1.0 / std::max(d.norm(), 1e-3);
      a.row(i) *= weight;
      height[i] *= weight;
    }
    const VectorX c = least_norm(a, height);
    const double stretch = std::sqrt(1.0 + c[0] * c[0] + c[1] * c[1]);
    if (!c.allFinite() || 1.0 / stretch < kTrust) {
      return;
    }
    jet.normal = (z - c[0] * x - c[1] * y) / stretch;
    // First and second fundamental form of the graph at the vertex; H and K.
    const double e = 1.0 + c[0] * c[0];
    const double f = c[0] * c[1];
    const double g = 1.0 + c[1] * c[1];
    const double det = e * g - f * f;
    const double scale = 1.0 / (size * stretch);
    const double mean =
        -0.5 * scale * (c[2] * g - 2.0 * c[3] * f + c[4] * e) / det;
    const double gauss = scale * scale * (c[2] * c[4] - c[3] * c[3]) / det;
    const double root = std::sqrt(std::max(0.0, mean * mean - gauss));
    jet.k1 = mean + root;
    jet.k2 = mean - root;
  }

  const Sheet& sheet_;
  Points normals_;
  std::vector<int> mark_;  // per vertex: the vertex whose rings it is in
  std::vector<int> ring_;
  std::vector<int> front_;
  std::vector<int> next_;
};

}  // namespace

std::vector<Jet> fit_jets(const Sheet& sheet) {
  Fitter fitter(sheet);
  std::vector<Jet> jets;
  jets.reserve(sheet.film.points.size());
  for (int v = 0; v < static_cast<int>(sheet.film.points.size()); ++v) {
    jets.push_back(fitter.fit(v));
  }
  return jets;
}

}  // namespace meniscus::walls
