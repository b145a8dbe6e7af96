#include "fea/stress/stress.h"

#include "fea/element/tet_element.h"
#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

namespace {

template <int Nodes>
std::array<Vec3, Nodes> element_nodes(const TetMesh& mesh, int e) {
  std::array<Vec3, Nodes> x;
  const auto ids = mesh.element(e);
  for (int a = 0; a < Nodes; ++a) {
    x[a] = mesh.nodes[ids[a]];
  }
  return x;
}

double element_volume(const TetMesh& mesh, int e) {
  return mesh.order == 1
             ? corner_volume(mesh, e)
             : element::quadratic_volume(element_nodes<10>(mesh, e));
}

}  // namespace

void find_peak(StressField& field) {
  const int count = static_cast<int>(field.nodal.size());
  field.von_mises.resize(field.nodal.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    field.von_mises[i] = element::von_mises(field.nodal[i]);
  }
  field.max_von_mises = 0.0;
  field.max_node = 0;
  for (int i = 0; i < count; ++i) {
    if (field.von_mises[i] > field.max_von_mises) {
      field.max_von_mises = field.von_mises[i];
      field.max_node = i;
    }
  }
}

StressField recover_stress(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const VectorX& displacement,
                           const VectorX& temperature_change) {
  return nodal_stress(
      mesh, recover_by_patches(
                mesh, element::point_stress(mesh, materials, displacement,
                                            temperature_change)));
}

double mesh_volume(const TetMesh& mesh) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    volume += element_volume(mesh, e);
  }
  return volume;
}

double mesh_mass(const TetMesh& mesh,
                 const std::vector<element::Material>& materials) {
  element::check_materials(mesh, materials);
  double mass = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    mass += materials[mesh.element_region[e]].density * element_volume(mesh, e);
  }
  return mass;
}

}  // namespace meniscus::stress
