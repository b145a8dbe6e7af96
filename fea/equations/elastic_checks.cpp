#include "fea/equations/elastic_checks.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/memory.h"

namespace meniscus::equations {

void check_arrays(const TetMesh& mesh) {
  const int n = static_cast<int>(mesh.nodes.size());
  if ((mesh.order != 1 && mesh.order != 2) || mesh.element_count() == 0 ||
      mesh.elements.size() % mesh.nodes_per_element() != 0) {
    throw InvalidInput(fmt::format(
        "elasticity: a mesh of order {} with {} element entries; four-node "
        "(order 1) or ten-node (order 2) tetrahedra are needed",
        mesh.order, mesh.elements.size()));
  }
  const auto bad = [n](int id) { return id < 0 || id >= n; };
  for (const auto* ids : {&mesh.elements, &mesh.faces}) {
    const auto at = std::find_if(ids->begin(), ids->end(), bad);
    if (at != ids->end()) {
      throw InvalidInput(fmt::format(
          "elasticity: the mesh has {} nodes, but {} {} names node {}", n,
          ids == &mesh.elements ? "element" : "face",
          (at - ids->begin()) / (ids == &mesh.elements
                                     ? mesh.nodes_per_element()
                                     : mesh.nodes_per_face()),
          *at));
    }
  }
  if (static_cast<int>(mesh.face_label.size()) != mesh.face_count()) {
    throw InvalidInput(fmt::format("elasticity: {} faces, but labels for {}",
                                   mesh.face_count(), mesh.face_label.size()));
  }
}

void check_memory(const TetMesh& mesh, SolverKind solver) {
  constexpr double kTenNodes = 2700.0;  // [byte/node]
  constexpr double kFourNodes = 1700.0;
  constexpr double kOwnShare = 400.0;
  const auto nodes = static_cast<double>(mesh.nodes.size());
  const double each = solver == SolverKind::Distributed ? kOwnShare
                      : mesh.order == 2                 ? kTenNodes
                                                        : kFourNodes;
  require_memory(each * nodes,
                 fmt::format("elasticity on {} elements with {} nodes",
                             mesh.element_count(), mesh.nodes.size()),
                 "longer edges (resolution.fea) need less: twice as long, an "
                 "eighth");
}

VectorX checked_forces(const TetMesh& mesh, const loads::LoadCase& load_case,
                       const std::vector<element::Material>& materials) {
  VectorX f = loads::nodal_forces(mesh, load_case, materials);
  if (!(f.norm() > 0.0) && !loads::enforces(load_case)) {
    throw InvalidInput(fmt::format(
        "load case '{}' has no load: give a force, a pressure, gravity or a "
        "temperature that is not 0, or enforce a displacement",
        load_case.name));
  }
  return f;
}

}  // namespace meniscus::equations
