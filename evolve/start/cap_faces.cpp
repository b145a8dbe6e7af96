#include "evolve/start/cap_faces.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "core/memory.h"
#include "evolve/films/rim_grading.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr double kFlatness = 1e-9;  // of the rim's size
constexpr double kCoplanar = 1e-7;  // the same, of loops in one plane

/// How far the loop's worst point is off its plane, and which it is.
std::pair<double, std::size_t> off_plane(const Points& loop, const Vec3& normal,
                                         const Vec3& origin) {
  std::pair<double, std::size_t> worst(0.0, 0);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const double off = std::abs(normal.dot(loop[k] - origin));
    if (!(off <= worst.first)) {
      worst = {off, k};
    }
  }
  return worst;
}

/// By the winding of the loop around the point, both in one plane; points on
/// the loop are not within it.
bool is_within(const Vec3& point, const Points& loop, const Vec3& normal) {
  double angle = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3 a = loop[k] - point;
    const Vec3 b = loop[(k + 1) % loop.size()] - point;
    angle += std::atan2(normal.dot(a.cross(b)), a.dot(b));
  }
  constexpr double kAround = 1.9 * EIGEN_PI;
  return std::abs(angle) > kAround;
}

/// Does `inner` lie within `outer`, in its plane? Loops do not cross.
bool lies_within(const Points& inner, const Points& outer) {
  const Vec3 normal = polygon_area_vector(outer).normalized();
  return off_plane(inner, normal, outer[0]).first <=
             kCoplanar * bounding_diagonal(outer) &&
         is_within(inner[0], outer, normal);
}

/// The edge wanted at a place beside any of the loops; empty when none is cut
/// finer than `edge`.
std::function<double(const Vec3&)> graded_beside(
    const std::vector<Points>& loops, double edge) {
  std::vector<std::function<double(const Vec3&)>> fields;
  for (const Points& loop : loops) {
    if (auto field = films::graded_edge(loop, edge)) {
      fields.push_back(std::move(field));
    }
  }
  if (fields.empty()) {
    return {};
  }
  return [fields = std::move(fields), edge](const Vec3& place) {
    double least = edge;
    for (const auto& field : fields) {
      least = std::min(least, field(place));
    }
    return least;
  };
}

}  // namespace

void require_flat(const Points& rim, const std::string& cap,
                  const std::string& curve) {
  const auto [off, at] =
      off_plane(rim, polygon_area_vector(rim).normalized(), rim[0]);
  if (!(off <= kFlatness * bounding_diagonal(rim))) {
    const Vec3& p = rim[at];
    throw InvalidInput(fmt::format(
        "cap '{}': curve '{}' is not planar, ({:.6g}, {:.6g}, {:.6g}) is "
        "{:.3g} off its plane; use a film of kind disk or a planar curve",
        cap, curve, p.x(), p.y(), p.z(), off));
  }
}

std::vector<std::vector<int>> faces_with_holes(
    const std::vector<Points>& loops) {
  const auto count = static_cast<int>(loops.size());
  std::vector<std::vector<int>> around(loops.size());  // each loop's, if any
  for (int i = 0; i < count && count > 1; ++i) {
    for (int j = 0; j < count; ++j) {
      if (i != j && lies_within(loops[i], loops[j])) {
        around[i].push_back(j);
      }
    }
  }
  std::vector<std::vector<int>> faces;
  std::vector<int> face_of(loops.size(), -1);
  for (int i = 0; i < count; ++i) {
    if (around[i].size() % 2 == 0) {
      face_of[i] = static_cast<int>(faces.size());
      faces.push_back({i});
    }
  }
  for (int i = 0; i < count; ++i) {
    if (around[i].size() % 2 == 1) {
      // The innermost loop around it has one fewer around itself.
      for (const int j : around[i]) {
        if (around[j].size() + 1 == around[i].size()) {
          faces[face_of[j]].push_back(i);
        }
      }
    }
  }
  return faces;
}

void require_room(double area, double edge) {
  constexpr double kBytes = 1500.0;  // of a facet
  const double facets = area / (0.25 * std::sqrt(3.0) * edge * edge);
  const double held = available_memory() / kBytes;
  if (facets > held) {
    throw InvalidInput(fmt::format(
        "the caps take about {:.2g} facets at edges of {:.4g}, and memory "
        "holds {:.2g}; use longer edges, or look for a curve that is too "
        "large",
        facets, edge, held));
  }
}

SurfaceMesh fill_face(const std::vector<Points>& loops, double edge,
                      bool graded, const std::string& curve) {
  try {
    return fill_disk(loops[0], {loops.begin() + 1, loops.end()}, edge,
                     graded ? graded_beside(loops, edge)
                            : std::function<double(const Vec3&)>{});
  } catch (const MeshError& error) {
    throw InvalidInput(fmt::format("curve '{}': {}", curve, error.what()));
  }
}

}  // namespace meniscus::start
