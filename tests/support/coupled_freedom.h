/// Rigid pins eliminated by hand: the displacements of a small mesh as columns.
#pragma once

#include <array>

#include "fea/loads/loads.h"
#include "tests/support/parts.h"

namespace meniscus::parts {

/// Columns: the displacements that supports and pins leave, and what they
/// enforce.
struct CoupledFreedom {
  Eigen::MatrixXd columns;
  VectorX enforced;
};

inline CoupledFreedom coupled_freedom(const TetMesh& mesh,
                                      const loads::LoadCase& load_case) {
  const auto size = static_cast<Eigen::Index>(3 * mesh.nodes.size());
  std::vector<char> held(static_cast<std::size_t>(size), 0);
  CoupledFreedom freedom{Eigen::MatrixXd(size, 0), VectorX::Zero(size)};
  const auto add = [&](const VectorX& column) {
    freedom.columns.conservativeResize(Eigen::NoChange,
                                       freedom.columns.cols() + 1);
    freedom.columns.rightCols(1) = column;
  };
  for (const loads::Support& support : load_case.supports) {
    const std::array<bool, 3> fix = {support.fix_x, support.fix_y,
                                     support.fix_z};
    for (const int node : loads::surface_weights(mesh, support.surface).nodes) {
      for (int k = 0; k < 3; ++k) {
        if (fix[k]) {
          held[static_cast<std::size_t>(3 * node + k)] = 1;
          freedom.enforced[3 * node + k] =
              loads::value_of(support.displacement)[k];
        }
      }
    }
  }
  for (const loads::RigidPin& pin : load_case.pins) {
    const std::vector<int> nodes =
        loads::surface_weights(mesh, pin.surfaces).nodes;
    for (int k = 0; k < 6; ++k) {
      VectorX motion = VectorX::Zero(size);
      for (const int node : nodes) {
        const Vec3 axis = Vec3::Unit(k % 3);
        motion.segment<3>(3L * node) =
            k < 3 ? axis : axis.cross(mesh.nodes[node] - pin.point).eval();
        for (int c = 0; c < 3; ++c) {
          held[static_cast<std::size_t>(3 * node + c)] = 1;
        }
      }
      if (k < 3 ? pin.fix[k] : pin.fix_rotation[k - 3]) {
        freedom.enforced += (k < 3 ? loads::value_of(pin.displacement)[k]
                                   : loads::value_of(pin.rotation)[k - 3]) *
                            motion;
      } else {
        add(motion);
      }
    }
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    if (held[static_cast<std::size_t>(i)] == 0) {
      add(VectorX::Unit(size, i));
    }
  }
  return freedom;
}

}  // namespace meniscus::parts
