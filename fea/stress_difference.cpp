#include "fea/stress_difference.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/tet_shape.h"

namespace meniscus {

namespace {

constexpr int kPoints = 14;

template <int Nodes>
const std::array<std::array<double, Nodes>, kPoints>& rule_shapes() {
  static const auto kShapes = [] {
    std::array<std::array<double, Nodes>, kPoints> shapes;
    for (int q = 0; q < kPoints; ++q) {
      shapes[q] = tet_shapes<Nodes>(fine_tet_rule()[q].L);
    }
    return shapes;
  }();
  return kShapes;
}

}  // namespace

StressDifference::StressDifference(const TetMesh& mesh,
                                   const std::vector<Material>& materials,
                                   const VectorX& displacement,
                                   const RecoveredStress& recovered)
    : mesh_(mesh), u_(displacement), recovered_(recovered) {
  check_materials(mesh, materials);
  if (displacement.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size()) ||
      recovered.nodes.elements.size() != mesh.elements.size()) {
    throw InvalidInput(fmt::format(
        "error estimate: {} displacements and stresses of {} elements for a "
        "mesh of {} nodes and {} elements",
        displacement.size(),
        recovered.nodes.elements.size() / mesh.nodes_per_element(),
        mesh.nodes.size(), mesh.element_count()));
  }
  laws_ = elastic_laws(materials);
}

template <int Nodes>
PointDifferences StressDifference::differences(int e) const {
  const auto ids = mesh_.element(e);
  const auto copies = recovered_.nodes.element(e);
  const ElasticLaw& law = laws_[mesh_.element_region[e]];
  std::array<Vec3, Nodes> x;
  std::array<Vec3, Nodes> du;
  for (int a = 0; a < Nodes; ++a) {
    x[a] = mesh_.nodes[ids[a]];
    du[a] = u_.segment<3>(3L * ids[a]) - u_.segment<3>(3L * ids[0]);
  }
  PointDifferences out;
  for (int q = 0; q < kPoints; ++q) {
    const auto& [L, weight] = fine_tet_rule()[q];
    const GradientAt<Nodes> at = gradient_at<Nodes>(x, du, L);
    out.computed[q] = stress_of_gradient(at.gradient, law);
    out.volume[q] = weight * at.determinant / 6.0;
    Stress smooth{};
    for (int a = 0; a < Nodes; ++a) {
      const double N = rule_shapes<Nodes>()[q][a];
      const Stress& s = recovered_.value[copies[a]];
      for (int k = 0; k < 6; ++k) {
        smooth[k] += N * s[k];
      }
    }
    for (int k = 0; k < 6; ++k) {
      out.recovered_minus_computed[q][k] = smooth[k] - out.computed[q][k];
    }
  }
  return out;
}

PointDifferences StressDifference::of(int element) const {
  return mesh_.order == 1 ? differences<4>(element) : differences<10>(element);
}

}  // namespace meniscus
