/// A force and a moment carried by surfaces together.
#pragma once

#include <string>

#include "fea/loads/loads.h"

namespace meniscus::loads {

/// Of the surfaces' nodes with their weights.
struct RemoteMoments {
  double area = 0.0;
  Vec3 centre = Vec3::Zero();
  Mat3 inverse = Mat3::Zero();  // of sum w (|d|^2 I - d d^T) [1/length^4]
};

/// Throws InvalidInput where the nodes lie on a line and can carry no moment.
RemoteMoments remote_moments(const TetMesh& mesh, const SurfaceWeights& weights,
                             const Surfaces& surfaces);

/// Nodal forces f_i = w_i (a + b x (x_i - c)), w the surfaces' weights and c
/// their centre: of all with the given force and moment the least in
/// sum |f_i|^2 / w_i. One per node of `weights` [force]. Throws as
/// remote_moments().
Points remote_forces(const TetMesh& mesh, const SurfaceWeights& weights,
                     const RemoteLoad& load);

}  // namespace meniscus::loads
