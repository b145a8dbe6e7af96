#include "mesh_tet/tetrahedralize.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/mesh_checks.h"
#include "core/timer.h"
#include "mesh_tet/improve_tets.h"
#include "mesh_tet/surface_fit.h"
#include "mesh_tet/tet_boundary.h"
#include "mesh_tet/tetgen_child.h"

namespace meniscus {

namespace {

/// The mesh has the surface's volume up to rounding; more is a wrong mesh.
constexpr double kVolumeTolerance = 1e-9;

/// TetGen's working memory and time beyond this would exceed any limit.
constexpr double kMostElements = 2e8;

Failure surface_failure(const std::string& message) {
  return {FailureKind::SurfaceInvalid, message};
}

Failure meshing_failure(const std::string& message) {
  return {FailureKind::MeshingFailed, message};
}

void check(const TetrahedralizeOptions& options) {
  const auto require = [](bool good, const char* name, double value,
                          const char* bound) {
    if (!good) {
      throw InvalidInput(
          fmt::format("tetrahedralize: {} is {}, must be finite and {}", name,
                      value, bound));
    }
  };
  const auto positive = [&](const char* name, double value) {
    require(std::isfinite(value) && value > 0.0, name, value, "positive");
  };
  positive("edge", options.edge.value_or(1.0));
  positive("time_limit", options.time_limit);
  positive("memory_limit", options.memory_limit);
  require(options.min_dihedral_deg >= 0.0 && options.min_dihedral_deg <= 18.0,
          "min_dihedral_deg", options.min_dihedral_deg, "in 0 to 18");
  require(std::isfinite(options.radius_edge_ratio) &&
              options.radius_edge_ratio >= 1.0,
          "radius_edge_ratio", options.radius_edge_ratio, "at least 1");
}

/// Maps the surface to an edge of about 1 around the origin, by a power of
/// two: TetGen's absolute constants then suit any unit of length.
struct Frame {
  Vec3 center;
  double scale;

  Frame(const Points& points, double edge)
      : scale(std::exp2(-std::round(std::log2(edge)))) {
    Vec3 low = points.front();
    Vec3 high = points.front();
    for (const Vec3& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    center = 0.5 * low + 0.5 * high;
  }
  Vec3 into(const Vec3& p) const { return scale * (p - center); }
  Vec3 back(const Vec3& p) const { return p / scale + center; }
};

/// Elements from TetGen's, every volume positive. Its corners are ordered
/// the other way round.
std::string take_elements(const TetgenOutput& output, TetMesh& mesh) {
  mesh.elements = output.elements;
  for (std::size_t e = 0; e < mesh.elements.size(); e += 4) {
    int* ids = mesh.elements.data() + e;
    const auto volume = [&] {
      return tet_volume({output.nodes[ids[0]], output.nodes[ids[1]],
                         output.nodes[ids[2]], output.nodes[ids[3]]});
    };
    if (volume() < 0.0) {
      std::swap(ids[0], ids[1]);
    }
    if (!(volume() > 0.0)) {
      return fmt::format("element {} is flat", e / 4);
    }
  }
  mesh.element_region.assign(mesh.elements.size() / 4, 0);
  return {};
}

/// Surface points first and unchanged, inner nodes mapped back.
std::string take_nodes(const SurfaceMesh& surface, const Frame& frame,
                       const TetgenOutput& output, TetMesh& mesh) {
  const std::size_t count = surface.points.size();
  if (output.nodes.size() < count) {
    return fmt::format("only {} of the {} surface points are left",
                       output.nodes.size(), count);
  }
  for (std::size_t n = 0; n < count; ++n) {
    if (output.nodes[n] != frame.into(surface.points[n])) {
      return fmt::format("surface point {} was moved", n);
    }
  }
  mesh.nodes = surface.points;
  for (std::size_t n = count; n < output.nodes.size(); ++n) {
    mesh.nodes.push_back(frame.back(output.nodes[n]));
  }
  mesh.corner_count = static_cast<int>(mesh.nodes.size());
  return {};
}

std::string check_volume(const TetMesh& mesh, double expected) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double v = corner_volume(mesh, e);
    if (!(v > 0.0)) {
      return fmt::format("element {} has no volume", e);
    }
    volume += v;
  }
  if (!(std::abs(volume - expected) <= kVolumeTolerance * expected)) {
    return fmt::format("the mesh has volume {:.12g}, the surface {:.12g}",
                       volume, expected);
  }
  return {};
}

/// The mesh from TetGen's answer; returns why it is none, or nothing.
std::string find_fault(const SurfaceMesh& surface, const Frame& frame,
                       const TetgenOutput& output, double volume,
                       TetMesh& mesh) {
  if (output.elements.empty()) {
    return "it has no elements";
  }
  std::string fault = take_elements(output, mesh);
  if (fault.empty()) {
    fault = take_nodes(surface, frame, output, mesh);
  }
  if (fault.empty()) {
    fault = attach_surface(surface, mesh);
  }
  return fault.empty() ? check_volume(mesh, volume) : fault;
}

std::optional<Failure> find_surface_fault(const SurfaceMesh& surface) {
  if (surface.facets.empty() ||
      surface.facet_label.size() != surface.facets.size()) {
    return surface_failure(
        fmt::format("the surface has {} facets and {} facet labels",
                    surface.facets.size(), surface.facet_label.size()));
  }
  const std::vector<Finding> findings = check_surface(surface);
  if (!findings.empty()) {
    return surface_failure(summary(findings));
  }
  std::vector<char> used(surface.points.size(), 0);
  for (const Triangle& t : surface.facets) {
    for (const int p : t) {
      used[p] = 1;
    }
  }
  if (const auto unused = std::find(used.begin(), used.end(), 0);
      unused != used.end()) {
    return surface_failure(
        fmt::format("surface point {} belongs to no facet; drop it",
                    unused - used.begin()));
  }
  return std::nullopt;
}

/// TetGen's switches. Y: the surface stays. O9/7o/140: flips, smoothing and
/// new inner points against dihedral angles above 140 degrees, as far as
/// TetGen can.
std::string make_switches(const TetrahedralizeOptions& options,
                          double largest_volume) {
  return fmt::format("pYQq{:.6f}/{:.3f}a{:.12f}O9/7o/140",
                     options.radius_edge_ratio, options.min_dihedral_deg,
                     largest_volume);
}

TetgenOutput fill(const SurfaceMesh& surface, const SurfaceFit& fit,
                  const Frame& frame, const std::string& switches,
                  const TetrahedralizeOptions& options) {
  Points points;
  points.reserve(surface.points.size());
  for (const Vec3& p : surface.points) {
    points.push_back(frame.into(p));
  }
  TetgenInput input{&points, &surface.facets, {}, switches};
  for (const Vec3& p : fit.cavities) {
    input.holes.push_back(frame.into(p));
  }
  return run_tetgen(
      input, {options.time_limit, options.memory_limit, options.monitor});
}

/// Mends the worst elements; refuses a mesh that stays too poor.
std::optional<Failure> finish(const SurfaceMesh& surface,
                              const TetrahedralizeOptions& options,
                              TetMesh& mesh, TetQuality& quality) {
  quality = tet_quality(mesh);
  if (quality.min_dihedral_deg < options.improve_below_deg) {
    improve_tets(mesh, static_cast<int>(surface.points.size()),
                 {.below_deg = options.improve_below_deg});
    const std::string fault = attach_surface(surface, mesh);
    if (!fault.empty()) {
      throw MeshError(fmt::format("improving elements broke one: {}", fault));
    }
    quality = tet_quality(mesh);
  }
  if (quality.min_dihedral_deg >= kLeastDihedralDeg) {
    return std::nullopt;
  }
  const Vec3& at = mesh.nodes[mesh.element(quality.worst_element)[0]];
  return meshing_failure(fmt::format(
      "the best mesh has a dihedral angle of {:.3g} degrees near ({:.6g}, "
      "{:.6g}, {:.6g}), the least is {}; remesh the surface more evenly "
      "there, or change the element edge",
      quality.min_dihedral_deg, at.x(), at.y(), at.z(), kLeastDihedralDeg));
}

std::optional<Failure> run(const SurfaceMesh& surface,
                           const TetrahedralizeOptions& options,
                           Tetrahedralization& result) {
  if (auto failure = find_surface_fault(surface)) {
    return failure;
  }
  const SurfaceFit fit = fit_surface(surface);
  if (!fit.problem.empty()) {
    return surface_failure(fit.problem);
  }
  if (!(fit.volume > 0.0)) {
    return surface_failure(
        fmt::format("the surface encloses the volume {:.6g}, which cannot be "
                    "filled; are its facets inside out?",
                    fit.volume));
  }
  const double edge = options.edge.value_or(mean_edge_length(surface));
  const double bound =
      kVolumeFactor * edge * edge * edge / (6.0 * std::numbers::sqrt2);
  if (fit.volume / bound > kMostElements) {
    return meshing_failure(fmt::format(
        "elements of edge {:.6g} in a volume of {:.6g} would be more than "
        "{:.0e}; enlarge the edge",
        edge, fit.volume, kMostElements));
  }
  const Frame frame(surface.points, edge);
  const Timer timer;
  const TetgenOutput output =
      fill(surface, fit, frame,
           make_switches(options, bound * std::pow(frame.scale, 3)), options);
  result.tetgen_seconds = timer.seconds();
  if (output.failure) {
    return meshing_failure(*output.failure);
  }
  const std::string fault =
      find_fault(surface, frame, output, fit.volume, result.mesh);
  if (!fault.empty()) {
    return meshing_failure(fmt::format(
        "TetGen's mesh cannot be used: {}; try another element edge", fault));
  }
  return finish(surface, options, result.mesh, result.quality);
}

}  // namespace

Tetrahedralization tetrahedralize(const SurfaceMesh& surface,
                                  const TetrahedralizeOptions& options) {
  check(options);
  const Timer timer;
  Tetrahedralization result;
  if (options.monitor != nullptr) {
    throw_if_stopped(*options.monitor, "mesh");
  }
  result.failure = run(surface, options, result);
  if (result.failure) {
    result.mesh = {};
    result.quality = {};
  }
  result.seconds = timer.seconds();
  return result;
}

}  // namespace meniscus
