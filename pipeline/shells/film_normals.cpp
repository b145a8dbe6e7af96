#include "pipeline/shells/film_normals.h"

#include <array>

#include <Eigen/Geometry>

namespace meniscus::shells {

namespace {

using NodesOfFacet = std::array<int, 6>;

/// Natural coordinates of a facet's nodes.
constexpr std::array<std::array<double, 2>, 6> kPlaces = {
    {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}}};

/// Of the facet at one of its nodes, as long as the tangents' product.
Vec3 normal_at(const Points& nodes, const NodesOfFacet& facet, std::size_t at) {
  const auto [s, t] = kPlaces[at];
  const double r = 1.0 - s - t;
  const std::array<double, 6> by_s = {1.0 - 4.0 * r, 4.0 * s - 1.0, 0.0,
                                      4.0 * (r - s), 4.0 * t,       -4.0 * t};
  const std::array<double, 6> by_t = {1.0 - 4.0 * r, 0.0,     4.0 * t - 1.0,
                                      -4.0 * s,      4.0 * s, 4.0 * (r - t)};
  Vec3 along_s = Vec3::Zero();
  Vec3 along_t = Vec3::Zero();
  for (std::size_t i = 0; i < facet.size(); ++i) {
    along_s += by_s[i] * nodes[facet[i]];
    along_t += by_t[i] * nodes[facet[i]];
  }
  return along_s.cross(along_t);
}

}  // namespace

std::map<int, Vec3> film_normals(const ShellPart& part, int label) {
  std::map<int, Vec3> normals;
  for (std::size_t f = 0; f < part.mesh.facets.size(); ++f) {
    if (part.skin.face_label[f] != label) {
      continue;
    }
    const NodesOfFacet& facet = part.mesh.facets[f];
    for (std::size_t i = 0; i < facet.size(); ++i) {
      normals.emplace(facet[i], Vec3::Zero()).first->second +=
          normal_at(part.mesh.nodes, facet, i);
    }
  }
  for (auto& [node, normal] : normals) {
    normal.normalize();
  }
  return normals;
}

}  // namespace meniscus::shells
