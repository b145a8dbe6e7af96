#include "mesh_tet/tetrahedralize.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/geometry/mesh_checks.h"
#include "core/heed_stop.h"
#include "core/timer.h"
#include "mesh_tet/improve_tets.h"
#include "mesh_tet/surface_fit.h"
#include "mesh_tet/tet_boundary.h"
#include "mesh_tet/tetgen_fill.h"

namespace meniscus::mesh_tet {

namespace {

/// The mesh has the surface's volume up to rounding; more is a wrong mesh.
constexpr double kVolumeTolerance = 1e-9;

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

std::string check_volumes(const TetMesh& mesh, const SurfaceFit& fit) {
  std::vector<double> volumes(fit.volumes.size(), 0.0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double v = corner_volume(mesh, e);
    if (!(v > 0.0)) {
      return fmt::format("element {} has no volume", e);
    }
    volumes[mesh.element_region[e]] += v;
  }
  for (std::size_t b = 0; b < volumes.size(); ++b) {
    const double off = volumes[b] - fit.volumes[b];
    if (!(std::abs(off) <= kVolumeTolerance * fit.volume)) {
      return fmt::format("body {} has volume {:.12g}, its surface {:.12g}", b,
                         volumes[b], fit.volumes[b]);
    }
  }
  return {};
}

bool is_poor(const TetQuality& quality, const TetrahedralizeOptions& options) {
  return quality.min_dihedral_deg < options.improve_below_deg ||
         find_breach(quality, options.bounds);
}

/// The mesh from TetGen's answer, its worst elements mended, checked as it is
/// then; returns why it is none, or nothing.
std::string find_fault(const SurfaceMesh& surface, const Frame& frame,
                       const TetgenOutput& output, const SurfaceFit& fit,
                       const TetrahedralizeOptions& options,
                       Tetrahedralization& result) {
  TetMesh& mesh = result.mesh;
  if (output.elements.empty()) {
    return "it has no elements";
  }
  std::string fault = take_elements(output, mesh);
  if (fault.empty()) {
    fault = take_nodes(surface, frame, output, mesh);
  }
  // Improving takes for granted that elements fill space once.
  if (fault.empty()) {
    fault = attach_surface(surface, mesh);
  }
  if (!fault.empty()) {
    return fault;
  }
  result.quality = tet_quality(mesh);
  if (is_poor(result.quality, options)) {
    improve_tets(mesh, static_cast<int>(surface.points.size()),
                 {.below_deg = std::max(options.improve_below_deg,
                                        options.bounds.min_dihedral_deg)});
    result.quality = tet_quality(mesh);
    fault = attach_surface(surface, mesh);
  }
  return fault.empty() ? check_volumes(mesh, fit) : fault;
}

std::optional<Failure> find_surface_fault(const SurfaceMesh& surface,
                                          std::vector<Finding>& findings) {
  if (surface.facets.empty() ||
      surface.facet_label.size() != surface.facets.size()) {
    return surface_failure(
        fmt::format("the surface has {} facets and {} facet labels",
                    surface.facets.size(), surface.facet_label.size()));
  }
  findings = check_surface(surface);
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

/// The mesh in `result` from what TetGen returned.
std::optional<Failure> take(const SurfaceMesh& surface, const SurfaceFit& fit,
                            const Frame& frame, const TetgenOutput& output,
                            const TetrahedralizeOptions& options,
                            Tetrahedralization& result) {
  if (output.failure) {
    return meshing_failure(*output.failure);
  }
  const std::string fault =
      find_fault(surface, frame, output, fit, options, result);
  if (!fault.empty()) {
    return meshing_failure(fmt::format(
        "TetGen's mesh cannot be used: {}; try another element edge", fault));
  }
  const auto breach = find_breach(result.quality, options.bounds);
  if (!breach) {
    return std::nullopt;
  }
  return meshing_failure(fmt::format(
      "the best mesh has {} ({}); remesh the surface more evenly there, or "
      "change the element edge",
      breach->what, place_of(result.mesh, breach->element)));
}

std::optional<Failure> run(const SurfaceMesh& surface,
                           const TetrahedralizeOptions& options,
                           Tetrahedralization& result) {
  if (auto failure = find_surface_fault(surface, result.findings)) {
    return failure;
  }
  const SurfaceFit fit = fit_surface(surface);
  if (!fit.problem.empty()) {
    return surface_failure(fit.problem);
  }
  for (std::size_t b = 0; b < fit.volumes.size(); ++b) {
    if (!(fit.volume > 0.0) || !(fit.volumes[b] >= 0.0)) {
      return surface_failure(
          fmt::format("body {} encloses the volume {:.6g}, which cannot be "
                      "filled; are its facets inside out?",
                      b, fit.volumes[b]));
    }
  }
  const Frame frame(surface.points,
                    options.edge.value_or(mean_edge_length(surface)));
  const Timer timer;
  const TetgenOutput output = fill_surface(surface, fit, frame, options);
  result.tetgen_seconds = timer.seconds();
  return take(surface, fit, frame, output, options, result);
}

std::optional<Failure> refine(const SurfaceMesh& surface, const TetMesh& mesh,
                              const std::vector<double>& node_edge,
                              const TetrahedralizeOptions& options,
                              Tetrahedralization& result) {
  std::vector<double> edge;
  edge.reserve(static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    double& least = edge.emplace_back(node_edge[mesh.element(e)[0]]);
    for (const int node : mesh.element(e)) {
      least = std::min(least, node_edge[node]);
    }
  }
  const Frame frame(surface.points, mean_edge_length(surface));
  const Timer timer;
  const TetgenOutput output =
      split_elements(surface, frame, mesh, edge, options);
  result.tetgen_seconds = timer.seconds();
  return take(surface, fit_surface(surface), frame, output, options, result);
}

/// Runs `work` on a result; clears the mesh when it fails.
template <class Work>
Tetrahedralization timed(const TetrahedralizeOptions& options, Work work) {
  check(options);
  const Heeding heeding(options.monitor);
  const Timer timer;
  Tetrahedralization result;
  if (options.monitor != nullptr) {
    throw_if_stopped(*options.monitor, "mesh");
  }
  result.failure = work(result);
  if (result.failure) {
    result.mesh = {};
    result.quality = {};
  }
  result.seconds = timer.seconds();
  return result;
}

}  // namespace

Tetrahedralization tetrahedralize(const SurfaceMesh& surface,
                                  const TetrahedralizeOptions& options) {
  return timed(options, [&](Tetrahedralization& result) {
    return run(surface, options, result);
  });
}

Tetrahedralization refine_tets(const SurfaceMesh& surface, const TetMesh& mesh,
                               const std::vector<double>& node_edge,
                               const TetrahedralizeOptions& options) {
  const auto good = [](double edge) {
    return std::isfinite(edge) && edge > 0.0;
  };
  if (mesh.order != 1 || mesh.faces.size() != 3 * surface.facets.size() ||
      node_edge.size() != mesh.nodes.size() ||
      !std::all_of(node_edge.begin(), node_edge.end(), good)) {
    throw InvalidInput(fmt::format(
        "refine_tets: needs the four-node mesh of its surface and a positive "
        "edge per node; found order {}, {} faces for {} facets, {} edges for "
        "{} nodes",
        mesh.order, mesh.face_count(), surface.facets.size(), node_edge.size(),
        mesh.nodes.size()));
  }
  return timed(options, [&](Tetrahedralization& result) {
    return refine(surface, mesh, node_edge, options, result);
  });
}

}  // namespace meniscus::mesh_tet
