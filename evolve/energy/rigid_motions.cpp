// Floating parts of FilmEnergy and the motions that change nothing.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/union_find.h"
#include "evolve/energy/energy.h"
#include "evolve/energy/facet_terms.h"

namespace meniscus::energy {

namespace {

/// Turning a spheroid about its own axis changes nothing.
Eigen::Matrix3d resistance_of(const films::DropShape& shape) {
  constexpr double kRound = 1e-9;  // a sphere, but for rounding
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const films::Spheroid& part : shape) {
    if (std::abs(part.along - part.across) > kRound * part.across) {
      const Vec3 axis = part.axis.normalized();
      sum += Eigen::Matrix3d::Identity() - axis * axis.transpose();
    }
  }
  return sum;
}

}  // namespace

void FilmEnergy::find_floating(const films::FilmComplex& complex) {
  floating_.assign(unknowns(), -1);
  if (resisted_) {
    return;
  }
  const int points = static_cast<int>(complex.mesh.points.size());
  std::vector<char> held(points, 0);
  for (int v = 0; v < points; ++v) {
    held[v] = complex.vertices[v].kind != films::VertexKind::Free ||
              (space_.rank(v) == 0 && space_.vertex_count() > v);
  }
  // The inside of a face that films wet goes where its rim slides.
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for (const int v : facets_[f]) {
      if (complex.surfaces[label_[f]].wetted &&
          complex.vertices[v].kind == films::VertexKind::InCap) {
        held[v] = 0;
      }
    }
  }
  UnionFind parts(complex.mesh.points.size());
  for (const Triangle& t : facets_) {
    for (int k = 1; k < 3; ++k) {
      parts.join(t[0], t[k]);
    }
  }
  for (int v = 0; v < points; ++v) {
    if (held[v] != 0) {
      held[parts.root(v)] = 1;
    }
  }
  std::vector<int> number(points, -1);
  for (int i = 0; i < unknowns(); ++i) {
    const int root = parts.root(vertices()[i]);
    if (held[root] == 0) {
      if (number[root] < 0) {
        number[root] = floating_count_++;
      }
      floating_[i] = number[root];
    }
  }
  turn_resistance_.assign(floating_count_, Eigen::Matrix3d::Zero());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const int part = number[parts.root(facets_[f][0])];
    if (part >= 0) {
      turn_resistance_[part] +=
          resistance_of(complex.surfaces[label_[f]].drop_shape);
    }
  }
}

Eigen::MatrixXd FilmEnergy::rigid_motions(const Points& points,
                                          const Points& directions,
                                          const VectorX& metric) const {
  constexpr double kFree = 1e-9;     // of a wall's resistance
  constexpr double kVisible = 1e-2;  // of a motion that moves the film
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const int n = unknowns();
  std::vector<VectorX> columns;
  for (int part = 0; part < floating_count_; ++part) {
    Vec3 center = Vec3::Zero();
    double weight = 0.0;
    for (int i = 0; i < n; ++i) {
      if (floating_[i] == part) {
        center += metric[i] * points[vertices()[i]];
        weight += metric[i];
      }
    }
    center /= std::max(weight, 1e-300);
    double size2 = 0.0;
    for (int i = 0; i < n; ++i) {
      if (floating_[i] == part) {
        size2 += metric[i] * (points[vertices()[i]] - center).squaredNorm();
      }
    }
    const double size = std::sqrt(size2 / std::max(weight, 1e-300));
    // What resists: walls that the part slides on, and gravity.
    Eigen::Matrix<double, 6, 6> resists = Eigen::Matrix<double, 6, 6>::Zero();
    const auto add = [&](const Vec3& at, const Vec3& normal) {
      Vector6 row;
      row << normal, (at - center).cross(normal) / size;
      resists += row * row.transpose();
    };
    for (std::size_t k = 0; k < space_.walled().size(); ++k) {
      const int v = space_.walled()[k];
      if (space_.rank(v) > 0 && floating_[space_.first(v)] == part) {
        const Eigen::MatrixX3d rows =
            space_.wall_normals(static_cast<int>(k), points[v]);
        for (Eigen::Index r = 0; r < rows.rows(); ++r) {
          add(points[v], rows.row(r).normalized());
        }
      }
    }
    if (!gravity_.isZero(0.0)) {
      const Vec3 g = gravity_.normalized();
      const Eigen::Matrix3d across =
          Eigen::Matrix3d::Identity() - g * g.transpose();
      resists.topLeftCorner<3, 3>() += g * g.transpose();
      resists.bottomRightCorner<3, 3>() += across;
    }
    resists.bottomRightCorner<3, 3>() += turn_resistance_[part];
    const auto eigen = symmetric_eigen(resists);
    const double most = std::max(1.0, eigen.values[5]);
    Eigen::MatrixXd found(n, 0);
    for (int m = 0; m < 6; ++m) {
      if (eigen.values[m] > kFree * most) {
        break;
      }
      const Vector6 motion = eigen.vectors.col(m);
      VectorX column = VectorX::Zero(n);
      for (int i = 0; i < n; ++i) {
        if (floating_[i] == part) {
          const Vec3 arm = points[vertices()[i]] - center;
          const Vec3 move =
              motion.head<3>() + Vec3(motion.tail<3>()).cross(arm) / size;
          column[i] = move.dot(directions[i]);
        }
      }
      found.conservativeResize(n, found.cols() + 1);
      found.rightCols<1>() = column;
    }
    if (found.cols() == 0) {
      continue;
    }
    // Motions that leave the film where it is (a sphere's rotations) are out.
    const Eigen::MatrixXd gram =
        found.transpose() * metric.asDiagonal() * found / weight;
    const auto seen = symmetric_eigen(gram);
    for (Eigen::Index m = 0; m < gram.cols(); ++m) {
      if (seen.values[m] > kVisible) {
        columns.push_back(metric.cwiseProduct(found * seen.vectors.col(m)));
      }
    }
  }
  Eigen::MatrixXd result(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    result.col(static_cast<Eigen::Index>(c)) = columns[c];
  }
  return result;
}

}  // namespace meniscus::energy
