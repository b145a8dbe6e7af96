#include "fea/place_functionals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/load_checks.h"

namespace meniscus {

namespace {

/// Of faces that no other element stands before, ascending.
std::vector<int> outer_nodes(const TetMesh& mesh) {
  std::vector<int> nodes;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_front.empty() || mesh.face_front[f] < 0) {
      const auto ids = mesh.face(f);
      nodes.insert(nodes.end(), ids.begin(), ids.end());
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

Functional intrusion_functional(const TetMesh& mesh, const SlopedField& level,
                                double sharpness, Derivatives derivatives) {
  const LoadCase place{.name = "response"};
  const std::string what = "the level set of a region";
  const std::vector<int> nodes = outer_nodes(mesh);
  if (!(sharpness > 0.0) || !std::isfinite(sharpness) || nodes.empty()) {
    throw InvalidInput(fmt::format(
        "intrusion: sharpness {} over {} nodes of the surface; both must be "
        "above 0",
        sharpness, nodes.size()));
  }
  std::vector<double> values;
  values.reserve(nodes.size());
  for (const int i : nodes) {
    values.push_back(field_value(level.value, mesh.nodes[i], place, what));
  }
  const double largest = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (double& value : values) {
    value = std::exp(sharpness * (value - largest));
    sum += value;
  }
  Functional result{.value = largest + std::log(sum) / sharpness};
  if (derivatives == Derivatives::All) {
    require_slope(level.slope, place, what);
    result.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      result.by_nodes[nodes[k]] =
          values[k] / sum *
          field_value(level.slope, mesh.nodes[nodes[k]], place, what);
    }
  }
  return result;
}

}  // namespace meniscus
