#include "fea/functionals/place_functionals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/loads/load_checks.h"

namespace meniscus::functionals {

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

const char* const kWhat = "the level set of a region";

loads::LoadCase response_place() { return {.name = "response"}; }

/// How much each outer node counts: of sum 1.
struct Shares {
  std::vector<int> nodes;
  std::vector<double> share;
  double value = 0.0;
};

Shares shares_of(const TetMesh& mesh, const loads::NumberOfPlace& level,
                 double sharpness) {
  const loads::LoadCase place = response_place();
  Shares result{.nodes = outer_nodes(mesh), .share = {}};
  if (!(sharpness > 0.0) || !std::isfinite(sharpness) || result.nodes.empty()) {
    throw InvalidInput(fmt::format(
        "intrusion: sharpness {} over {} nodes of the surface; both must be "
        "above 0",
        sharpness, result.nodes.size()));
  }
  result.share.reserve(result.nodes.size());
  for (const int i : result.nodes) {
    result.share.push_back(
        loads::field_value(level, mesh.nodes[i], place, kWhat));
  }
  const double largest =
      *std::max_element(result.share.begin(), result.share.end());
  double sum = 0.0;
  for (double& value : result.share) {
    value = std::exp(sharpness * (value - largest));
    sum += value;
  }
  for (double& value : result.share) {
    value /= sum;
  }
  result.value = largest + std::log(sum) / sharpness;
  return result;
}

}  // namespace

element::Functional intrusion_functional(const TetMesh& mesh,
                                         const loads::SlopedField& level,
                                         double sharpness,
                                         element::Derivatives derivatives) {
  const Shares shares = shares_of(mesh, level.value, sharpness);
  element::Functional result{.value = shares.value};
  if (derivatives == element::Derivatives::All) {
    const loads::LoadCase place = response_place();
    loads::require_slope(level.slope, place, kWhat);
    result.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
    for (std::size_t k = 0; k < shares.nodes.size(); ++k) {
      const int node = shares.nodes[k];
      result.by_nodes[node] =
          shares.share[k] *
          loads::field_value(level.slope, mesh.nodes[node], place, kWhat);
    }
  }
  return result;
}

double intrusion_rate(const TetMesh& mesh, const loads::NumberOfPlace& level,
                      const loads::NumberOfPlace& rate, double sharpness) {
  const Shares shares = shares_of(mesh, level, sharpness);
  const loads::LoadCase place = response_place();
  double sum = 0.0;
  for (std::size_t k = 0; k < shares.nodes.size(); ++k) {
    sum += shares.share[k] *
           loads::field_value(rate, mesh.nodes[shares.nodes[k]], place, kWhat);
  }
  return sum;
}

}  // namespace meniscus::functionals
