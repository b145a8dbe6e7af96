#include "cad/solid/fit_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include "core/error.h"
#include "core/geometry/harmonic.h"
#include "core/geometry/plane_points.h"

namespace meniscus::solid {

namespace {

constexpr int kSamplesPerSpan = 4;  // in each direction
constexpr int kNormalsPerSpan = 4;
// Beside 1 per point of the film: third differences of poles, and how far the
// row of poles next to a side leaves the tangent plane there.
constexpr double kNormalWeight = 300.0;

/// `per_span` parameters in each knot span, evenly.
std::vector<double> samples_of(const std::vector<double>& knots, int per_span) {
  std::vector<double> result;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    for (int i = 0; i < per_span && knots[k + 1] > knots[k]; ++i) {
      result.push_back(knots[k] +
                       (knots[k + 1] - knots[k]) * (i + 0.5) / per_span);
    }
  }
  return result;
}

/// (a, b) of every vertex of the patch.
Eigen::MatrixXd parameters(const FilmMesh& mesh, const FilmPatch& patch,
                           const PatchSides& sides) {
  HarmonicProblem problem{mesh.points, mesh.facets, patch.facets, {}, {}};
  problem.fixed.assign(mesh.points.size(), 0);
  problem.values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.points.size()), 2);
  for (int side = 0; side < 4; ++side) {
    for (std::size_t k = 0; k < patch.chains[side].size(); ++k) {
      const int v = patch.chains[side][k];
      const double t = sides.at[side][k];
      problem.fixed[v] = 1;
      problem.values.row(v) = side == 0   ? Vec2(t, 0.0)
                              : side == 1 ? Vec2(1.0, t)
                              : side == 2 ? Vec2(t, 1.0)
                                          : Vec2(0.0, t);
    }
  }
  return harmonic(problem);
}

struct FilmSample {
  Vec2 at;
  Vec3 point;
  Vec3 normal;
};

/// Points of the film over a grid of parameters.
std::vector<FilmSample> sample_film(const FilmMesh& mesh,
                                    const FilmPatch& patch,
                                    const Eigen::MatrixXd& at,
                                    const std::vector<double>& grid_a,
                                    const std::vector<double>& grid_b) {
  std::vector<FilmSample> samples;
  std::vector<char> done(grid_a.size() * grid_b.size(), 0);
  const auto range = [](const std::vector<double>& grid, double low,
                        double high) {
    return std::pair{
        std::lower_bound(grid.begin(), grid.end(), low) - grid.begin(),
        std::upper_bound(grid.begin(), grid.end(), high) - grid.begin()};
  };
  // The map is one to one (Tutte 1963), so each place of the grid lies in one
  // facet of the parameter domain; a flat one covers none.
  for (const int f : patch.facets) {
    const Triangle& t = mesh.facets[f];
    const Vec2 p = at.row(t[0]);
    const Vec2 q = at.row(t[1]);
    const Vec2 r = at.row(t[2]);
    const Vec2 u = q - p;
    const Vec2 v = r - p;
    const double area = cross2(u, v);
    if (!(area > 0.0)) {
      continue;
    }
    const Vec2 low = p.cwiseMin(q).cwiseMin(r);
    const Vec2 high = p.cwiseMax(q).cwiseMax(r);
    const auto rows = range(grid_a, low[0], high[0]);
    const auto columns = range(grid_b, low[1], high[1]);
    for (auto i = rows.first; i < rows.second; ++i) {
      for (auto j = columns.first; j < columns.second; ++j) {
        // Barycentric coordinates by Cramer's rule; places on shared sides
        // count once, hence the margin and the marks.
        const Vec2 d = Vec2(grid_a[i], grid_b[j]) - p;
        const double beta = cross2(d, v) / area;
        const double gamma = cross2(u, d) / area;
        char& seen = done[i * grid_b.size() + j];
        if (seen != 0 || beta < -1e-9 || gamma < -1e-9 ||
            beta + gamma > 1.0 + 1e-9) {
          continue;
        }
        seen = 1;
        const Vec3 corners(1.0 - beta - gamma, beta, gamma);
        const Vec3 normal = corners[0] * mesh.normals[t[0]] +
                            corners[1] * mesh.normals[t[1]] +
                            corners[2] * mesh.normals[t[2]];
        samples.push_back({{grid_a[i], grid_b[j]},
                           smooth_point(mesh, f, corners),
                           normal.normalized()});
      }
    }
  }
  return samples;
}

/// Least squares for the inner poles, three unknowns each.
class PoleSystem {
 public:
  PoleSystem(SplineSurface& surface, int rows, int columns)
      : surface_(surface), rows_(rows), columns_(columns) {}

  /// importance^2 |sum weights pole - target|^2 for each coordinate.
  void add_point(const std::vector<std::pair<int, double>>& terms,
                 const Vec3& target, double importance) {
    for (int k = 0; k < 3; ++k) {
      double right = target[k];
      for (const auto& [pole, weight] : terms) {
        add(pole, k, weight * importance, right, weight);
      }
      finish(right * importance);
    }
  }
  /// importance^2 (normal . sum weights pole)^2.
  void add_normal(const std::vector<std::pair<int, double>>& terms,
                  const Vec3& normal, double importance) {
    double right = 0.0;
    for (const auto& [pole, weight] : terms) {
      for (int k = 0; k < 3; ++k) {
        add(pole, k, weight * normal[k] * importance, right,
            weight * normal[k]);
      }
    }
    finish(right * importance);
  }
  void solve() {
    const int inner = (rows_ - 2) * (columns_ - 2);
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(
        static_cast<int>(right_.size()), 3 * inner);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SparseMatrix<double> normal = matrix.transpose() * matrix;
    const VectorX right =
        matrix.transpose() *
        Eigen::Map<const VectorX>(right_.data(),
                                  static_cast<Eigen::Index>(right_.size()));
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
    if (factor.info() != Eigen::Success) {
      throw MeshError("a patch of the film has no least-squares surface");
    }
    const VectorX solution = factor.solve(right);
    for (int i = 1; i + 1 < rows_; ++i) {
      for (int j = 1; j + 1 < columns_; ++j) {
        const int unknown = (i - 1) * (columns_ - 2) + j - 1;
        surface_.poles[i * columns_ + j] = solution.segment<3>(3 * unknown);
      }
    }
  }

 private:
  void add(int pole, int k, double entry, double& right, double weight) {
    const int i = pole / columns_;
    const int j = pole % columns_;
    if (i == 0 || j == 0 || i + 1 == rows_ || j + 1 == columns_) {
      right -= weight * surface_.poles[pole][k];
      return;
    }
    const int unknown = (i - 1) * (columns_ - 2) + j - 1;
    entries_.emplace_back(static_cast<int>(right_.size()), 3 * unknown + k,
                          entry);
  }
  void finish(double right) { right_.push_back(right); }

  SplineSurface& surface_;
  int rows_;
  int columns_;
  std::vector<Eigen::Triplet<double>> entries_;
  std::vector<double> right_;
};

using Terms = std::vector<std::pair<int, double>>;

void add_third_differences(PoleSystem& system, int rows, int columns) {
  const double importance = std::sqrt(kThirdDifferenceWeight);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int pole = i * columns + j;
      for (const int step : {1, columns}) {
        if ((step == 1 ? j + 3 < columns : i + 3 < rows)) {
          system.add_point({{pole, -1.0},
                            {pole + step, 3.0},
                            {pole + 2 * step, -3.0},
                            {pole + 3 * step, 1.0}},
                           Vec3::Zero(), importance);
        }
      }
    }
  }
}

/// Rows that lay the surface along a side into the planes of its normals.
void add_normals(PoleSystem& system, const PatchSides& sides, int side,
                 int rows, int columns) {
  const SplineCurve& curve = sides.curves[side];
  const double first = sides.free_end[side][0] ? curve.knots[4] : 0.0;
  const double last =
      sides.free_end[side][1] ? curve.knots[curve.knots.size() - 5] : 1.0;
  for (const double t : samples_of(curve.knots, kNormalsPerSpan)) {
    if (t < first || t > last) {
      continue;
    }
    const Vec3 tangent = slope_of(curve, t).normalized();
    Vec3 normal = point_of(sides.normals[side], t);
    normal = (normal - normal.dot(tangent) * tangent).normalized();
    const SplineBasis basis = spline_basis(curve.knots, t);
    Terms terms;
    for (int r = 0; r < 4; ++r) {
      const int along = basis.first + r;
      const int last_row = rows - 1;
      const int last_column = columns - 1;
      const int outer = side == 0   ? along * columns
                        : side == 1 ? last_row * columns + along
                        : side == 2 ? along * columns + last_column
                                    : along;
      const int inward = side == 0   ? 1
                         : side == 1 ? -columns
                         : side == 2 ? -1
                                     : columns;
      terms.emplace_back(outer + inward, basis.value[r]);
      terms.emplace_back(outer, -basis.value[r]);
    }
    system.add_normal(terms, normal, kNormalWeight);
  }
}

}  // namespace

double folded_share(const FittedPatch& patch) {
  const auto folded =
      std::count_if(patch.misses.begin(), patch.misses.end(),
                    [](const PatchMiss& miss) { return std::isinf(miss.off); });
  return folded == 0 ? 0.0
                     : static_cast<double>(folded) /
                           static_cast<double>(patch.misses.size());
}

FittedPatch fit_patch(const FilmMesh& mesh, const FilmPatch& patch,
                      const PatchSides& sides) {
  FittedPatch fitted;
  SplineSurface& surface = fitted.surface;
  // The outer poles are those of the four sides: the boundary is exact.
  surface.knots_a = sides.curves[0].knots;
  surface.knots_b = sides.curves[1].knots;
  const int rows = static_cast<int>(sides.curves[0].poles.size());
  const int columns = static_cast<int>(sides.curves[1].poles.size());
  surface.poles.assign(static_cast<std::size_t>(rows) * columns, Vec3::Zero());
  for (int i = 0; i < rows; ++i) {
    surface.poles[i * columns] = sides.curves[0].poles[i];
    surface.poles[i * columns + columns - 1] = sides.curves[2].poles[i];
  }
  for (int j = 0; j < columns; ++j) {
    surface.poles[j] = sides.curves[3].poles[j];
    surface.poles[(rows - 1) * columns + j] = sides.curves[1].poles[j];
  }
  // Places (a, b) of vertices: harmonic, with those of the sides given.
  const Eigen::MatrixXd at = parameters(mesh, patch, sides);
  // Distance to points of the film: rows of tensor product basis values.
  PoleSystem system(surface, rows, columns);
  const std::vector<FilmSample> samples =
      sample_film(mesh, patch, at, samples_of(surface.knots_a, kSamplesPerSpan),
                  samples_of(surface.knots_b, kSamplesPerSpan));
  for (const FilmSample& sample : samples) {
    const SplineBasis a = spline_basis(surface.knots_a, sample.at[0]);
    const SplineBasis b = spline_basis(surface.knots_b, sample.at[1]);
    Terms terms;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        terms.emplace_back((a.first + i) * columns + b.first + j,
                           a.value[i] * b.value[j]);
      }
    }
    system.add_point(terms, sample.point, 1.0);
  }
  // A little smoothing where points are few, and the common normals of
  // neighbours along the sides (n . (P_1 - P_0) = 0, weighed by K).
  add_third_differences(system, rows, columns);
  for (int side = 0; side < 4; ++side) {
    if (!sides.normals[side].poles.empty()) {
      add_normals(system, sides, side, rows, columns);
    }
  }
  // Normal equations for the inner poles.
  system.solve();
  for (const FilmSample& sample : samples) {
    const SurfaceJet jet = jet_of(surface, sample.at);
    const bool folded = jet.by_a.cross(jet.by_b).dot(sample.normal) <= 0.0;
    fitted.misses.push_back(
        {sample.at,
         folded ? std::numeric_limits<double>::infinity()
                : std::abs((jet.point - sample.point).dot(sample.normal)),
         sample.normal});
  }
  std::vector<char> seen(mesh.points.size(), 0);
  for (const int f : patch.facets) {
    for (const int v : mesh.facets[f]) {
      if (seen[v] == 0) {
        seen[v] = 1;
        fitted.vertices.push_back(v);
        fitted.at.emplace_back(at.row(v));
      }
    }
  }
  return fitted;
}

}  // namespace meniscus::solid
