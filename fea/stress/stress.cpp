#include "fea/stress/stress.h"

#include <algorithm>

#include "fea/element/node_elements.h"
#include "fea/element/tet_element.h"
#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

namespace {

/// Stresses at the four corners of an element: its own everywhere for four
/// nodes, linearly from the four points for ten.
std::array<element::Stress, 4> corner_stresses(
    const element::PointStress& points, int e) {
  std::array<element::Stress, 4> corner;
  const element::Stress* point = &points.stress[points.index(e)];
  if (points.points_per_element == 1) {
    corner.fill(point[0]);
    return corner;
  }
  for (int k = 0; k < 6; ++k) {
    const double sum = point[0][k] + point[1][k] + point[2][k] + point[3][k];
    for (int c = 0; c < 4; ++c) {
      corner[c][k] = (point[c][k] - element::kTetRuleLow * sum) /
                     (element::kTetRuleHigh - element::kTetRuleLow);
    }
  }
  return corner;
}

/// The mean of what the elements around `node` say, weighted by volume.
element::Stress mean_at(
    const TetMesh& mesh, const element::PointStress& points,
    const std::vector<std::array<element::Stress, 4>>& corners,
    const element::NodeElements& around, int node) {
  element::Stress sum{};
  double weight = 0.0;
  for (const int e : around.of(node)) {
    const auto ids = mesh.element(e);
    const int a =
        static_cast<int>(std::find(ids.begin(), ids.end(), node) - ids.begin());
    const element::Stress& from = corners[e][a < 4 ? a : kTetEdges[a - 4][0]];
    const element::Stress& to = corners[e][a < 4 ? a : kTetEdges[a - 4][1]];
    double volume = 0.0;
    for (int q = 0; q < points.points_per_element; ++q) {
      volume += points.volume[points.index(e, q)];
    }
    weight += volume;
    for (int k = 0; k < 6; ++k) {
      sum[k] += volume * 0.5 * (from[k] + to[k]);
    }
  }
  if (weight != 0.0) {
    for (double& s : sum) {
      s /= weight;
    }
  }
  return sum;
}

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

void find_peak(const TetMesh& mesh, const std::vector<char>& excluded,
               StressField& field) {
  field.max_von_mises = 0.0;
  field.max_node = 0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (excluded[e] != 0) {
      continue;
    }
    for (const int i : mesh.element(e)) {
      const double s = field.von_mises[i];
      if (s > field.max_von_mises ||
          (s == field.max_von_mises && i < field.max_node)) {
        field.max_von_mises = s;
        field.max_node = i;
      }
    }
  }
}

StressField average_stress(const TetMesh& mesh,
                           const element::PointStress& points) {
  const int elements = mesh.element_count();
  const int nodes = static_cast<int>(mesh.nodes.size());
  const int width = mesh.nodes_per_element();
  const element::NodeElements around =
      element::node_elements(mesh.elements, width, width, nodes);
  std::vector<std::array<element::Stress, 4>> corners(elements);
  StressField field;
  field.nodal.resize(mesh.nodes.size());
#pragma omp parallel for schedule(static)
  for (int e = 0; e < elements; ++e) {
    corners[e] = corner_stresses(points, e);
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < nodes; ++i) {
    field.nodal[i] = mean_at(mesh, points, corners, around, i);
  }
  find_peak(field);
  return field;
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
