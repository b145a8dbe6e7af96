#include "report/render/surface_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "core/math/dense.h"

namespace meniscus::render {

namespace {

const Vec3& corner(const SurfaceMesh& mesh, int facet, std::size_t k) {
  return mesh.points[static_cast<std::size_t>(
      mesh.facets[static_cast<std::size_t>(facet)][k])];
}

/// Moller and Trumbore's test; nothing where the ray misses.
double crossing(const SurfaceMesh& mesh, int facet, const Vec3& from,
                const Vec3& along) {
  constexpr double kNone = -1.0;
  const Vec3& a = corner(mesh, facet, 0);
  const Vec3 ab = corner(mesh, facet, 1) - a;
  const Vec3 ac = corner(mesh, facet, 2) - a;
  const Vec3 p = along.cross(ac);
  const double det = ab.dot(p);
  if (det == 0.0) {
    return kNone;
  }
  const Vec3 t = from - a;
  const double u = t.dot(p) / det;
  const Vec3 q = t.cross(ab);
  const double v = along.dot(q) / det;
  return u < 0.0 || v < 0.0 || u + v > 1.0 ? kNone : ac.dot(q) / det;
}

}  // namespace

Vec3 facet_middle(const SurfaceMesh& mesh, int facet) {
  return (corner(mesh, facet, 0) + corner(mesh, facet, 1) +
          corner(mesh, facet, 2)) /
         3.0;
}

SurfacePatch surface_patch(const SurfaceMesh& mesh, const std::string& name) {
  SurfacePatch patch;
  const int label = mesh.label_of(name);
  double area = 0.0;
  Vec3 sum = Vec3::Zero();
  Mat3 spread = Mat3::Zero();
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    const Vec3 n = area_vector2(mesh, f);
    const double size = n.norm();
    if (label < 0 || mesh.facet_label[static_cast<std::size_t>(f)] != label ||
        !(size > 0.0)) {
      continue;
    }
    patch.facets.push_back(f);
    patch.centre += size * facet_middle(mesh, f);
    sum += n;
    spread += n * n.transpose() / size;
    area += size;
  }
  if (!patch.found()) {
    return patch;
  }
  patch.centre /= area;
  patch.flatness = sum.norm() / area;
  if (sum.norm() > 0.0) {
    patch.normal = sum.normalized();
  }
  const SymmetricEigen<3> eigen = symmetric_eigen(spread);
  patch.axis = eigen.vectors.col(0);  // least of its normals
  for (const int f : patch.facets) {
    const Vec3 d = facet_middle(mesh, f) - patch.centre;
    patch.reach = std::max(patch.reach, std::abs(patch.axis.dot(d)));
    patch.radius += area_vector2(mesh, f).norm() * d.norm() / area;
  }
  return patch;
}

Anchor anchor_of(const SurfacePatch& patch, const Vec3& to_eye) {
  if (!patch.is_round()) {
    return {patch.centre, patch.normal};
  }
  const Vec3 out =
      patch.axis.dot(to_eye) < 0.0 ? Vec3(-patch.axis) : Vec3(patch.axis);
  return {patch.centre + patch.reach * out, out};
}

std::vector<double> crossings(const SurfaceMesh& mesh, const Vec3& from,
                              const Vec3& along) {
  std::vector<double> found;
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    const double at = crossing(mesh, f, from, along);
    if (at > 0.0) {
      found.push_back(at);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

namespace {

/// Along `along` from `at`, beyond all of the part.
ArrowPlace beyond_part(const SurfaceMesh& mesh, const Vec3& at,
                       const Vec3& along, double length, double gap) {
  const std::vector<double> hits = crossings(mesh, at, along);
  const double beyond = hits.empty() ? 0.0 : hits.back();
  const Vec3 start = at + (beyond + gap) * along;
  return {start, start + length * along};
}

}  // namespace

ArrowPlace place_free_arrow(const SurfaceMesh& mesh, const Vec3& at,
                            const Vec3& along, const Vec3& to_eye,
                            double length, double gap) {
  // From within the part a ray crosses its surface an odd number of times.
  const auto is_free = [&](const Vec3& from, const Vec3& towards) {
    const std::vector<double> hits = crossings(mesh, from, towards);
    return hits.size() % 2 == 0 && (hits.empty() || hits.front() >= length);
  };
  const auto is_seen = [&](const Vec3& from, const Vec3& towards) {
    return std::ranges::all_of(std::array{0.0, 0.5, 1.0}, [&](double part) {
      return crossings(mesh, from + part * length * towards, to_eye).empty();
    });
  };
  constexpr int kFarthest = 12;  // half lengths
  std::optional<ArrowPlace> hidden;
  for (int k = 0; k <= kFarthest; ++k) {
    for (const Vec3& towards : {along, Vec3(-along)}) {
      const Vec3 near = at + 0.5 * k * length * towards;
      if (!is_free(near, towards)) {
        continue;
      }
      const Vec3 far = near + length * towards;
      const ArrowPlace place = towards.dot(along) > 0.0 ? ArrowPlace{near, far}
                                                        : ArrowPlace{far, near};
      if (is_seen(near, towards)) {
        return place;
      }
      hidden = hidden ? hidden : place;
    }
  }
  return hidden.value_or(beyond_part(mesh, at, along, length, gap));
}

ArrowPlace place_arrow(const SurfaceMesh& mesh, const Anchor& anchor,
                       const Vec3& along, double length, double gap) {
  const auto is_free = [&](const Vec3& from, const Vec3& to) {
    const std::vector<double> hits =
        crossings(mesh, from, (to - from).normalized());
    return hits.empty() || hits.front() >= (to - from).norm();
  };
  const bool presses = along.dot(anchor.out) < -0.05;
  const Vec3 root = anchor.at + 2.0 * gap * anchor.out;
  const Vec3 tip =
      presses ? Vec3(anchor.at - gap * along) : Vec3(root + length * along);
  const Vec3 tail = tip - length * along;
  if (presses ? is_free(tip, tail) : is_free(root, tip)) {
    return {tail, tip};
  }
  return beyond_part(mesh, anchor.at, along, length, gap);
}

std::vector<int> spread_facets(const SurfaceMesh& mesh,
                               const SurfacePatch& patch, double spacing,
                               std::size_t most) {
  std::vector<int> chosen;
  std::vector<double> gap(patch.facets.size(),
                          std::numeric_limits<double>::infinity());
  // From the middle, then always the farthest of those chosen.
  std::size_t next = 0;
  for (std::size_t k = 1; k < patch.facets.size(); ++k) {
    if ((facet_middle(mesh, patch.facets[k]) - patch.centre).norm() <
        (facet_middle(mesh, patch.facets[next]) - patch.centre).norm()) {
      next = k;
    }
  }
  while (chosen.size() < most && next < patch.facets.size()) {
    chosen.push_back(patch.facets[next]);
    const Vec3 at = facet_middle(mesh, patch.facets[next]);
    double farthest = spacing;
    next = patch.facets.size();
    for (std::size_t k = 0; k < gap.size(); ++k) {
      gap[k] =
          std::min(gap[k], (facet_middle(mesh, patch.facets[k]) - at).norm());
      if (gap[k] > farthest) {
        farthest = gap[k];
        next = k;
      }
    }
  }
  return chosen;
}

}  // namespace meniscus::render
