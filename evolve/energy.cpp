#include "evolve/energy.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/facet_terms.h"

namespace meniscus {

namespace {

FacetFrame frame_of(const Points& points, const Triangle& t,
                    const Vec3& origin) {
  return {points[t[0]] - origin, points[t[1]] - origin, points[t[2]] - origin};
}

/// Volumes are sums of cones to this point, which keeps the cones small.
Vec3 local_origin(const Points& points) {
  return points.empty() ? Vec3::Zero() : points.front();
}

int root_of(std::vector<int>& parent, int i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

}  // namespace

FilmTargets targets_of(const FilmComplex& complex) {
  FilmTargets targets;
  for (const ComplexSurface& surface : complex.surfaces) {
    targets.tension.push_back(surface.liquid ? surface.tension : 0.0);
  }
  targets.bodies = complex.bodies;
  return targets;
}

FilmEnergy::FilmEnergy(const FilmComplex& complex)
    : facets_(complex.mesh.facets),
      label_(complex.mesh.facet_label),
      body_count_(static_cast<int>(complex.bodies.size())) {
  const int points = static_cast<int>(complex.mesh.points.size());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for (const int v : facets_[f]) {
      if (v < 0 || v >= points) {
        throw MeshError(fmt::format(
            "facet {} of the film names vertex {}, but there are {}", f, v,
            points));
      }
    }
    liquid_.push_back(complex.surfaces[label_[f]].liquid ? 1 : 0);
    std::vector<int> sides(body_count_, 0);
    for (int b = 0; b < body_count_; ++b) {
      for (const BodySide& side : complex.bodies[b].sides) {
        if (side.surface == label_[f]) {
          sides[b] = side.sign;
        }
      }
    }
    side_.push_back(std::move(sides));
  }
  std::vector<int> unknown_of(points, -1);
  for (int v = 0; v < points; ++v) {
    if (complex.vertices[v].kind == VertexKind::Free) {
      unknown_of[v] = static_cast<int>(vertex_.size());
      vertex_.push_back(v);
    }
  }
  corner_start_.push_back(0);
  for (const Triangle& t : facets_) {
    for (int k = 0; k < 3; ++k) {
      if (unknown_of[t[k]] >= 0) {
        corners_.push_back({k, unknown_of[t[k]]});
      }
    }
    corner_start_.push_back(static_cast<int>(corners_.size()));
  }
  find_floating(complex);
  build_pattern();
}

void FilmEnergy::find_floating(const FilmComplex& complex) {
  const int points = static_cast<int>(complex.mesh.points.size());
  std::vector<int> parent(points);
  std::iota(parent.begin(), parent.end(), 0);
  for (const Triangle& t : facets_) {
    for (int k = 1; k < 3; ++k) {
      parent[root_of(parent, t[k])] = root_of(parent, t[0]);
    }
  }
  std::vector<char> held(points, 0);
  for (int v = 0; v < points; ++v) {
    if (complex.vertices[v].kind != VertexKind::Free) {
      held[root_of(parent, v)] = 1;
    }
  }
  std::vector<int> number(points, -1);
  for (const int v : vertex_) {
    const int root = root_of(parent, v);
    if (held[root] != 0) {
      floating_.push_back(-1);
      continue;
    }
    if (number[root] < 0) {
      number[root] = floating_count_++;
    }
    floating_.push_back(number[root]);
  }
}

void FilmEnergy::build_pattern() {
  const int n = unknowns();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(n) + 6 * facets_.size());
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 0.0);
  }
  const auto for_pairs = [&](std::size_t f, const auto& visit) {
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      for (int j = corner_start_[f]; j <= i; ++j) {
        const int a = corners_[i].unknown;
        const int b = corners_[j].unknown;
        visit(std::max(a, b), std::min(a, b));
      }
    }
  };
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] != 0) {
      for_pairs(f, [&](int a, int b) { entries.emplace_back(a, b, 0.0); });
    }
  }
  pattern_.resize(n, n);
  pattern_.setFromTriplets(entries.begin(), entries.end());
  pattern_.makeCompressed();
  slot_start_.push_back(0);
  const int* outer = pattern_.outerIndexPtr();
  const int* inner = pattern_.innerIndexPtr();
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] != 0) {
      for_pairs(f, [&](int a, int b) {
        const int* at =
            std::lower_bound(inner + outer[b], inner + outer[b + 1], a);
        slots_.push_back(static_cast<int>(at - inner));
      });
    }
    slot_start_.push_back(static_cast<int>(slots_.size()));
  }
  if (n > 0) {
    order_ = nested_dissection(pattern_);
  }
}

double FilmEnergy::value(const Points& points,
                         const std::vector<double>& tension) const {
  double sum = 0.0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] != 0) {
      const Triangle& t = facets_[f];
      const Vec3& a = points[t[0]];
      sum += tension[label_[f]] *
             (points[t[1]] - a).cross(points[t[2]] - a).norm();
    }
  }
  return 0.5 * sum;
}

double FilmEnergy::area(const Points& points) const {
  int most = -1;
  for (const int label : label_) {
    most = std::max(most, label);
  }
  return value(points, std::vector<double>(most + 1, 1.0));
}

VectorX FilmEnergy::volumes(const Points& points) const {
  VectorX sum = VectorX::Zero(body_count_);
  const Vec3 origin = local_origin(points);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Triangle& t = facets_[f];
    const Vec3 a = points[t[0]] - origin;
    const double cone =
        a.dot((points[t[1]] - origin).cross(points[t[2]] - origin)) / 6.0;
    for (int b = 0; b < body_count_; ++b) {
      sum[b] += side_[f][b] * cone;
    }
  }
  return sum;
}

Eigen::MatrixX3d FilmEnergy::gradient(
    const Points& points, const std::vector<double>& tension) const {
  Eigen::MatrixX3d sum = Eigen::MatrixX3d::Zero(unknowns(), 3);
  const Vec3 origin = local_origin(points);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] == 0) {
      continue;
    }
    const FacetFrame frame = frame_of(points, facets_[f], origin);
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      sum.row(corners_[i].unknown) +=
          tension[label_[f]] * frame.area_gradient(corners_[i].corner);
    }
  }
  return sum;
}

Eigen::MatrixX3d FilmEnergy::volume_gradient(const Points& points,
                                             int body) const {
  Eigen::MatrixX3d sum = Eigen::MatrixX3d::Zero(unknowns(), 3);
  const Vec3 origin = local_origin(points);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (side_[f][body] == 0) {
      continue;
    }
    const FacetFrame frame = frame_of(points, facets_[f], origin);
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      sum.row(corners_[i].unknown) +=
          side_[f][body] * frame.volume_gradient(corners_[i].corner);
    }
  }
  return sum;
}

void FilmEnergy::hessian(const Points& points, const Points& directions,
                         const std::vector<double>& tension,
                         const VectorX& pressure, SparseMatrix& out) const {
  double* values = out.valuePtr();
  std::fill(values, values + out.nonZeros(), 0.0);
  const Vec3 origin = local_origin(points);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] == 0) {
      continue;
    }
    const FacetFrame frame = frame_of(points, facets_[f], origin);
    const double t = tension[label_[f]];
    double p = 0.0;
    for (int b = 0; b < body_count_; ++b) {
      p += side_[f][b] * pressure[b];
    }
    int slot = slot_start_[f];
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      const int a = corners_[i].corner;
      const Vec3& v = directions[corners_[i].unknown];
      for (int j = corner_start_[f]; j <= i; ++j) {
        const int b = corners_[j].corner;
        const Vec3& w = directions[corners_[j].unknown];
        values[slots_[slot++]] += t * frame.area_hessian(a, v, b, w) -
                                  p * frame.volume_hessian(a, v, b, w);
      }
    }
  }
}

Points FilmEnergy::normals(const Points& points) const {
  Points sum(unknowns(), Vec3::Zero());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3& a = points[t[0]];
    const Vec3 area2 = (points[t[1]] - a).cross(points[t[2]] - a);
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      sum[corners_[i].unknown] += area2;
    }
  }
  for (Vec3& normal : sum) {
    const double length = normal.norm();
    if (length > 0.0) {
      normal /= length;
    }
  }
  return sum;
}

VectorX FilmEnergy::lumped_area(const Points& points) const {
  VectorX sum = VectorX::Zero(unknowns());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] == 0) {
      continue;
    }
    const Triangle& t = facets_[f];
    const Vec3& a = points[t[0]];
    const double area2 = (points[t[1]] - a).cross(points[t[2]] - a).norm();
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      sum[corners_[i].unknown] += area2 / 6.0;
    }
  }
  return sum;
}

double FilmEnergy::smallest_cosine(const Points& points,
                                   const Points& directions, int* facet) const {
  double least = 1.0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] == 0 || corner_start_[f] == corner_start_[f + 1]) {
      continue;
    }
    Vec3 mean = Vec3::Zero();
    for (int i = corner_start_[f]; i < corner_start_[f + 1]; ++i) {
      mean += directions[corners_[i].unknown];
    }
    const Triangle& t = facets_[f];
    const Vec3& a = points[t[0]];
    const Vec3 area2 = (points[t[1]] - a).cross(points[t[2]] - a);
    const double size = area2.norm() * mean.norm();
    const double cosine = size > 0.0 ? area2.dot(mean) / size : -1.0;
    if (!(cosine >= least)) {  // not finite counts as folded
      least = std::isfinite(cosine) ? cosine : -1.0;
      if (facet != nullptr) {
        *facet = static_cast<int>(f);
      }
    }
  }
  return least;
}

double FilmEnergy::mean_edge(const Points& points) const {
  double sum = 0.0;
  long count = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (liquid_[f] != 0) {
      for (int k = 0; k < 3; ++k) {
        sum += (points[facets_[f][(k + 1) % 3]] - points[facets_[f][k]]).norm();
      }
      count += 3;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

Points FilmEnergy::moved(const Points& points, const Points& directions,
                         const VectorX& heights) const {
  Points result = points;
  for (int i = 0; i < unknowns(); ++i) {
    result[vertex_[i]] += heights[i] * directions[i];
  }
  return result;
}

}  // namespace meniscus
