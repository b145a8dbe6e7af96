/// How TetGen is asked to fill a surface: units, switches, passes.
#pragma once

#include <string>
#include <vector>

#include "mesh_tet/surface_fit.h"
#include "mesh_tet/tetgen_child.h"
#include "mesh_tet/tetrahedralize.h"

namespace meniscus::mesh_tet {

/// Maps the surface to an edge of about 1 around the origin, by a power of
/// two: TetGen's absolute constants then suit any unit of length.
struct Frame {
  Vec3 center;
  double scale;

  Frame(const Points& points, double edge);
  Vec3 into(const Vec3& p) const { return scale * (p - center); }
  Vec3 back(const Vec3& p) const { return p / scale + center; }
  Points into(const Points& points) const;
};

/// Volume of the regular tetrahedron of that edge.
double regular_volume(double edge);

/// TetGen's working memory and time beyond this would exceed any limit.
inline constexpr double kMostElements = 2e8;

/// TetGen's switches for the first filling of `surface`.
std::string fill_switches(const SurfaceMesh& surface, const Frame& frame,
                          const TetrahedralizeOptions& options);

/// Fills `surface`, then splits elements where options.size asks for it. In
/// the frame's coordinates, as TetGen returns it. Throws InvalidInput for a
/// size that is not positive, and what run_tetgen throws.
TetgenOutput fill_surface(const SurfaceMesh& surface, const SurfaceFit& fit,
                          const Frame& frame,
                          const TetrahedralizeOptions& options);

/// Splits the elements of `mesh`, which fills `surface`, where they are larger
/// than the regular one of their `edge` [length], one each.
TetgenOutput split_elements(const SurfaceMesh& surface, const Frame& frame,
                            const TetMesh& mesh,
                            const std::vector<double>& edge,
                            const TetrahedralizeOptions& options);

}  // namespace meniscus::mesh_tet
