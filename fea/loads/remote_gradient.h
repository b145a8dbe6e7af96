/// The derivatives of what a remote load (remote_load.h) does.
#pragma once

#include "core/geometry/tet_mesh.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

/// Of v . f, f the nodal forces of a remote load and v (3 per node) held.
struct RemoteGradient {
  double value = 0.0;
  Vec3 by_point = Vec3::Zero();
  Vec3 by_force = Vec3::Zero();
  Vec3 by_moment = Vec3::Zero();  // the surface's rigid rotation under v
};

/// `gradient`: that by node positions is added to it, if it is not null.
/// Throws InvalidInput as remote_forces().
RemoteGradient remote_gradient(const TetMesh& mesh, const RemoteLoad& load,
                               const VectorX& v, Points* gradient);

}  // namespace meniscus::loads
