/// One pass over the integration points of all elements that adds up
/// derivatives by node positions and nodal values: every gradient of an
/// integral over the solid (docs/theory.md, section on exact gradients).
#pragma once

#include <algorithm>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/sweep_element.h"

namespace meniscus::element {

/// work(point, flux) for every point of every element, side by side; it must
/// not throw. Nodes add their elements in the elements' order, whatever the
/// number of threads.
template <int Nodes, std::size_t Fields, std::size_t Outputs, class Work>
void sweep_elements(const TetMesh& mesh, const TetRule<Nodes>& rule,
                    const SweepTargets<Fields, Outputs>& targets,
                    const Work& work) {
  constexpr int kBlock = 4096;  // bounds the memory
  const int count = mesh.element_count();
  std::vector<element_sweep::Local<Nodes, Outputs>> local(
      std::min(kBlock, count));
  for (int first = 0; first < count; first += kBlock) {
    const int last = std::min(first + kBlock, count);
#pragma omp parallel for schedule(static)
    for (int e = first; e < last; ++e) {
      element_sweep::add_element(mesh, rule, targets, e, work,
                                 local[e - first]);
    }
    for (int e = first; e < last; ++e) {
      const auto ids = mesh.element(e);
      const auto& from = local[e - first];
      for (int a = 0; a < Nodes; ++a) {
        for (std::size_t k = 0; k < Outputs; ++k) {
          targets.outputs[k]->template segment<3>(3L * ids[a]) +=
              from[k].col(a).template head<3>();
        }
        if constexpr (Outputs > 0) {
          if (targets.scalar != nullptr) {
            (*targets.scalar)[ids[a]] += from[0](3, a);
          }
        }
      }
    }
  }
}

/// By the stiffness rule.
template <std::size_t Fields, std::size_t Outputs, class Work>
void sweep_stiffness_points(const TetMesh& mesh,
                            const SweepTargets<Fields, Outputs>& targets,
                            const Work& work) {
  if (mesh.order == 1) {
    sweep_elements(mesh, stiffness_rule<4>(), targets, work);
  } else {
    sweep_elements(mesh, stiffness_rule<10>(), targets, work);
  }
}

/// 3 zeros for each node of the mesh.
inline VectorX nodal_zeros(const TetMesh& mesh) {
  return VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
}

/// One vector per node of 3 numbers per node.
inline Points as_points(const VectorX& v) {
  Points points(static_cast<std::size_t>(v.size() / 3));
  flat(points) = v;
  return points;
}

}  // namespace meniscus::element
