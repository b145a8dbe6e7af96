#include "fea/element/point_stress.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"
#include "fea/element/tet_element.h"
#include "fea/element/tet_shape.h"

namespace meniscus::element {

namespace {

/// Takes out what `change` degrees of free expansion do not stress.
void relieve(const ElasticLaw& law, double change, Stress& stress) {
  for (int k = 0; k < 6; ++k) {
    stress[k] -= law.heat_stress[k] * change;
  }
}

template <int Nodes>
void element_points(const TetMesh& mesh, int e, const ElasticLaw& law,
                    const VectorX& u, const VectorX& temperature_change,
                    PointStress& out) {
  static const auto kShapes = [] {
    std::array<std::array<double, Nodes>, kTetPoints<Nodes>> shapes;
    for (int q = 0; q < kTetPoints<Nodes>; ++q) {
      shapes[q] = tet_shapes<Nodes>(rule_point<Nodes>(q));
    }
    return shapes;
  }();
  const auto ids = mesh.element(e);
  std::array<Vec3, Nodes> x;
  std::array<Vec3, Nodes> du;  // relative to one node: no rigid shift
  for (int a = 0; a < Nodes; ++a) {
    x[a] = mesh.nodes[ids[a]];
    du[a] = u.segment<3>(3L * ids[a]) - u.segment<3>(3L * ids[0]);
  }
  // Physical gradients of the shape functions and weights |det J| w.
  TetGradients<Nodes> g;
  tet_gradients<Nodes>(x, g);
  for (int q = 0; q < kTetPoints<Nodes>; ++q) {
    // Displacement gradient H = sum u_a grad N_a^T at the point.
    Mat3 H = Mat3::Zero();
    for (int a = 1; a < Nodes; ++a) {
      H.noalias() += du[a] * g.gradient[q][a].transpose();
    }
    Vec3 position = Vec3::Zero();
    for (int a = 0; a < Nodes; ++a) {
      position += kShapes[q][a] * x[a];
    }
    // sigma = C (eps - alpha dT), dT by the same shape functions.
    const std::size_t at = out.index(e, q);
    out.stress[at] = stress_of_gradient(H, law);
    if (temperature_change.size() != 0) {
      double change = 0.0;
      for (int a = 0; a < Nodes; ++a) {
        change += kShapes[q][a] * temperature_change[ids[a]];
      }
      relieve(law, change, out.stress[at]);
    }
    out.position[at] = position;
    out.volume[at] = g.volume[q];
  }
}

}  // namespace

PointStress point_stress(const TetMesh& mesh,
                         const std::vector<Material>& materials,
                         const VectorX& displacement,
                         const VectorX& temperature_change) {
  check_materials(mesh, materials);
  if (displacement.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(fmt::format("stress: {} displacements for {} nodes",
                                   displacement.size(), mesh.nodes.size()));
  }
  if (temperature_change.size() != 0 &&
      temperature_change.size() !=
          static_cast<Eigen::Index>(mesh.nodes.size())) {
    throw InvalidInput(fmt::format("stress: {} temperatures for {} nodes",
                                   temperature_change.size(),
                                   mesh.nodes.size()));
  }
  const std::vector<ElasticLaw> laws = elastic_laws(materials);
  const int count = mesh.element_count();
  PointStress out;
  out.points_per_element = mesh.order == 1 ? kTetPoints<4> : kTetPoints<10>;
  const std::size_t points = out.index(count);
  out.stress.resize(points);
  out.position.resize(points);
  out.volume.resize(points);
#pragma omp parallel for schedule(static)
  for (int e = 0; e < count; ++e) {
    const ElasticLaw& law = laws[mesh.element_region[e]];
    if (mesh.order == 1) {
      element_points<4>(mesh, e, law, displacement, temperature_change, out);
    } else {
      element_points<10>(mesh, e, law, displacement, temperature_change, out);
    }
  }
  return out;
}

}  // namespace meniscus::element
