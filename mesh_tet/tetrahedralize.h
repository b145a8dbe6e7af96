/// Closed labelled bodies in, four-node tetrahedra out, the surface kept
/// vertex for vertex (node i is surface point i, face f is facet f). TetGen
/// 1.5 runs in a child process with a time and a memory limit, because it ends
/// its process on some inputs (docs/decisions).
#pragma once

#include <functional>
#include <optional>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "core/geometry/surface_mesh.h"
#include "core/geometry/tet_mesh.h"
#include "core/monitor.h"
#include "mesh_tet/tet_quality.h"

namespace meniscus::mesh_tet {

/// Largest volume of an element over that of the regular tetrahedron of the
/// target edge, edge^3 / (6 sqrt 2). Elements stay below the bound, on the
/// average at less than half of it; 2.1 makes the average the regular one.
inline constexpr double kVolumeFactor = 2.1;

/// Target edge [length] at a place, positive and finite; asked at 15 places an
/// element, so that a feature between them may be missed.
using EdgeAtPlace = std::function<double(const Vec3&)>;

struct TetrahedralizeOptions {
  std::optional<double> edge =
      std::nullopt;                 // target edge inside [length], positive;
                                    // automatic: the surface's mean edge
  EdgeAtPlace size = {};            // target edge by place, at most `edge`; the
                                    // surface keeps its own
  Points inside = {};               // nodes to have inside the bodies, away
                                    // from the surface [length]
  double radius_edge_ratio = 1.4;   // TetGen's quality bound, at least 1
  double min_dihedral_deg = 15.0;   // TetGen's aim, 0 to 18; not reached
                                    // where the surface does not allow it
  double improve_below_deg = 10.0;  // inner nodes around elements with smaller
                                    // dihedral angles are moved to enlarge them
  QualityBounds bounds = {};        // meshes that break them are refused
  double time_limit = 300.0;        // of the child [s]
  double memory_limit = 8e9;        // of the child [byte]
  Monitor* monitor = nullptr;       // may stop it: Interrupted
};

struct Tetrahedralization {
  TetMesh mesh;  // order 1, regions, faces and labels as the surface's
  TetQuality quality;
  std::optional<Failure> failure;  // then the mesh is empty
  std::vector<Finding> findings;   // what is wrong with the surface
  double seconds = 0.0;            // all of it
  double tetgen_seconds = 0.0;     // of the child
};

/// Fills the bodies of `surface`, which may share facets; what no body claims
/// inside is a cavity. Elements have their body's number as region. Bad
/// surfaces give SurfaceInvalid, all that goes wrong in TetGen or with its mesh
/// MeshingFailed. Throws InvalidInput for options out of range, IoError when
/// the helper is missing, Interrupted when the monitor asks to stop. Same
/// input, same bits. Thread safe.
Tetrahedralization tetrahedralize(const SurfaceMesh& surface,
                                  const TetrahedralizeOptions& options = {});

/// The elements of `mesh`, made by tetrahedralize from `surface`, split until
/// they have the least edge [length] that `node_edge` asks for at their corners
/// (positive, one per node of `mesh`): for adaptive refinement. The surface
/// keeps its own size. Same errors and failures.
Tetrahedralization refine_tets(const SurfaceMesh& surface, const TetMesh& mesh,
                               const std::vector<double>& node_edge,
                               const TetrahedralizeOptions& options = {});

}  // namespace meniscus::mesh_tet
