#include "fea/stress/stress_difference.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/tet_shape.h"

namespace meniscus::stress {

namespace {

constexpr int kPoints = 14;

template <int Nodes>
const std::array<std::array<double, Nodes>, kPoints>& rule_shapes() {
  static const auto kShapes = [] {
    std::array<std::array<double, Nodes>, kPoints> shapes;
    for (int q = 0; q < kPoints; ++q) {
      shapes[q] = element::tet_shapes<Nodes>(element::fine_tet_rule()[q].L);
    }
    return shapes;
  }();
  return kShapes;
}

}  // namespace

StressDifference::StressDifference(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const StressedSolution& solution)
    : mesh_(mesh), solution_(solution) {
  element::check_materials(mesh, materials);
  const auto nodes = static_cast<Eigen::Index>(mesh.nodes.size());
  const Eigen::Index heated = solution.temperature_change.size();
  if (solution.displacement.size() != 3 * nodes ||
      solution.stress.nodes.elements.size() != mesh.elements.size() ||
      (heated != 0 && heated != nodes)) {
    throw InvalidInput(fmt::format(
        "error estimate: {} displacements, {} temperatures and stresses of {} "
        "elements for a mesh of {} nodes and {} elements",
        solution.displacement.size(), heated,
        solution.stress.nodes.elements.size() / mesh.nodes_per_element(), nodes,
        mesh.element_count()));
  }
  laws_ = element::elastic_laws(materials);
}

template <int Nodes>
PointDifferences StressDifference::differences(int e) const {
  const auto ids = mesh_.element(e);
  const auto copies = solution_.stress.nodes.element(e);
  const element::ElasticLaw& law = laws_[mesh_.element_region[e]];
  std::array<Vec3, Nodes> x;
  std::array<Vec3, Nodes> du;
  for (int a = 0; a < Nodes; ++a) {
    x[a] = mesh_.nodes[ids[a]];
    du[a] = solution_.displacement.segment<3>(3L * ids[a]) -
            solution_.displacement.segment<3>(3L * ids[0]);
  }
  PointDifferences out;
  for (int q = 0; q < kPoints; ++q) {
    const auto& [L, weight] = element::fine_tet_rule()[q];
    const element::GradientAt<Nodes> at = element::gradient_at<Nodes>(x, du, L);
    out.computed[q] = element::stress_of_gradient(at.gradient, law);
    out.volume[q] = weight * at.determinant / 6.0;
    element::Stress smooth{};
    double heat = 0.0;
    for (int a = 0; a < Nodes; ++a) {
      const double N = rule_shapes<Nodes>()[q][a];
      if (solution_.temperature_change.size() != 0) {
        heat += N * solution_.temperature_change[ids[a]];
      }
      const element::Stress& s = solution_.stress.value[copies[a]];
      for (int k = 0; k < 6; ++k) {
        smooth[k] += N * s[k];
      }
    }
    for (int k = 0; k < 6; ++k) {
      out.computed[q][k] -= heat * law.heat_stress[k];
      out.recovered_minus_computed[q][k] = smooth[k] - out.computed[q][k];
    }
  }
  return out;
}

PointDifferences StressDifference::of(int element) const {
  return mesh_.order == 1 ? differences<4>(element) : differences<10>(element);
}

}  // namespace meniscus::stress
