/// What the picture helper reads from a run's VTK files.
#pragma once

#include <string>
#include <vector>

#include "core/surface_mesh.h"

namespace meniscus {

/// A labelled surface and, for a part, what its nodes carry (else empty).
struct PictureSurface {
  SurfaceMesh mesh;
  Points displacement;            // [length]
  std::vector<double> von_mises;  // [pressure]
  std::string length_unit;        // of the displacement; may be empty
  std::string stress_unit;
};

/// Throws InvalidInput, naming the file, when it cannot be read or lacks the
/// cell data `surface`.
PictureSurface load_surface(const std::string& path);

/// Corners of a .vtu's tetrahedra, four- or ten-node. Throws InvalidInput.
struct PictureTets {
  Points nodes;
  std::vector<std::array<int, 4>> corners;
};
PictureTets load_tets(const std::string& path);

/// The facets left of a mesh of which the half nearer to `eye` was taken away
/// (whole elements): label 0 are outer faces, label 1 the faces laid open.
SurfaceMesh cut_open(const PictureTets& tets, const Vec3& normal);

/// Edges where two surfaces meet or a surface ends.
std::vector<Edge> rim_edges(const SurfaceMesh& mesh);

}  // namespace meniscus
