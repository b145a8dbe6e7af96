#include "fea/stress.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/elastic_law.h"
#include "fea/tet_element.h"

namespace meniscus {

namespace {

using Stress = std::array<double, 6>;

template <int Nodes>
std::array<Vec3, Nodes> element_nodes(const TetMesh& mesh, int e) {
  std::array<Vec3, Nodes> x;
  const auto ids = mesh.element(e);
  for (int a = 0; a < Nodes; ++a) {
    x[a] = mesh.nodes[ids[a]];
  }
  return x;
}

Stress stress_of(const Mat3& H, const ElasticLaw& law) {
  const Mat3 s = law.stress(H);
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
}

/// Stresses at the corners and the volume of one element.
struct CornerStress {
  std::array<Stress, 4> corner;
  double volume = 0.0;
};

template <int Nodes>
CornerStress corner_stress(const TetMesh& mesh, int e, const ElasticLaw& m,
                           const VectorX& u) {
  TetGradients<Nodes> g;
  tet_gradients<Nodes>(element_nodes<Nodes>(mesh, e), g);
  const auto ids = mesh.element(e);
  CornerStress result;
  std::array<Stress, kTetPoints<Nodes>> point;
  for (int q = 0; q < kTetPoints<Nodes>; ++q) {
    Mat3 H = Mat3::Zero();
    for (int a = 1; a < Nodes; ++a) {
      const Vec3 du = u.segment<3>(3L * ids[a]) - u.segment<3>(3L * ids[0]);
      H.noalias() += du * g.gradient[q][a].transpose();
    }
    point[q] = stress_of(H, m);
    result.volume += g.volume[q];
  }
  if constexpr (Nodes == 4) {
    result.corner.fill(point[0]);
  } else {
    for (int k = 0; k < 6; ++k) {
      const double sum = point[0][k] + point[1][k] + point[2][k] + point[3][k];
      for (int c = 0; c < 4; ++c) {
        result.corner[c][k] =
            (point[c][k] - kTetRuleLow * sum) / (kTetRuleHigh - kTetRuleLow);
      }
    }
  }
  return result;
}

/// Adds an element's stresses, times its volume, to its nodes.
void spread(const TetMesh& mesh, int e, const CornerStress& s,
            std::vector<Stress>& nodal, std::vector<double>& weight) {
  const auto ids = mesh.element(e);
  for (int a = 0; a < mesh.nodes_per_element(); ++a) {
    weight[ids[a]] += s.volume;
    const int from = a < 4 ? a : kTetEdges[a - 4][0];
    const int to = a < 4 ? a : kTetEdges[a - 4][1];
    for (int k = 0; k < 6; ++k) {
      nodal[ids[a]][k] +=
          s.volume * 0.5 * (s.corner[from][k] + s.corner[to][k]);
    }
  }
}

double element_volume(const TetMesh& mesh, int e) {
  return mesh.order == 1 ? corner_volume(mesh, e)
                         : quadratic_volume(element_nodes<10>(mesh, e));
}

}  // namespace

double von_mises(const Stress& s) {
  const double a = s[0] - s[1];
  const double b = s[1] - s[2];
  const double c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) +
                   3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

StressField recover_stress(const TetMesh& mesh,
                           const std::vector<Material>& materials,
                           const VectorX& displacement) {
  check_materials(mesh, materials);
  if (displacement.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(fmt::format("stress: {} displacements for {} nodes",
                                   displacement.size(), mesh.nodes.size()));
  }
  const std::vector<ElasticLaw> laws = elastic_laws(materials);
  const int count = mesh.element_count();
  std::vector<CornerStress> elements(count);
#pragma omp parallel for schedule(static)
  for (int e = 0; e < count; ++e) {
    const ElasticLaw& m = laws[mesh.element_region[e]];
    elements[e] = mesh.order == 1 ? corner_stress<4>(mesh, e, m, displacement)
                                  : corner_stress<10>(mesh, e, m, displacement);
  }
  StressField field;
  field.nodal.assign(mesh.nodes.size(), Stress{});
  field.von_mises.assign(mesh.nodes.size(), 0.0);
  std::vector<double> weight(mesh.nodes.size(), 0.0);
  for (int e = 0; e < count; ++e) {
    spread(mesh, e, elements[e], field.nodal, weight);
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (weight[i] != 0.0) {
      for (double& s : field.nodal[i]) {
        s /= weight[i];
      }
    }
    field.von_mises[i] = von_mises(field.nodal[i]);
    if (field.von_mises[i] > field.max_von_mises) {
      field.max_von_mises = field.von_mises[i];
      field.max_node = static_cast<int>(i);
    }
  }
  return field;
}

double mesh_volume(const TetMesh& mesh) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    volume += element_volume(mesh, e);
  }
  return volume;
}

double mesh_mass(const TetMesh& mesh, const std::vector<Material>& materials) {
  check_materials(mesh, materials);
  double mass = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    mass += materials[mesh.element_region[e]].density * element_volume(mesh, e);
  }
  return mass;
}

}  // namespace meniscus
