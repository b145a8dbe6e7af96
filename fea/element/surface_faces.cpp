#include "fea/element/surface_faces.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

namespace meniscus::element {

int surface_label(const TetMesh& mesh, const std::string& surface) {
  const int label = mesh.label_of(surface);
  if (label < 0) {
    throw InvalidInput(
        fmt::format("the mesh has no surface '{}'; its surfaces are: {}",
                    surface, fmt::join(mesh.labels, ", ")));
  }
  if (std::find(mesh.face_label.begin(), mesh.face_label.end(), label) ==
      mesh.face_label.end()) {
    throw InvalidInput(fmt::format(
        "surface '{}' has no faces on the mesh: it has been lost or lies "
        "inside",
        surface));
  }
  return label;
}

std::vector<int> surface_nodes(const TetMesh& mesh, int label) {
  std::vector<int> nodes;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] == label) {
      const auto ids = mesh.face(f);
      nodes.insert(nodes.end(), ids.begin(), ids.end());
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace meniscus::element
