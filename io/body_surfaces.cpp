#include "io/body_surfaces.h"

#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::io {

std::vector<BodyFacets> facets_by_body(const SurfaceMesh& mesh) {
  const auto bodies = static_cast<std::size_t>(body_count(mesh));
  std::vector<BodyFacets> result(bodies);
  for (BodyFacets& body : result) {
    for (std::size_t k = 0; k < mesh.labels.size(); ++k) {
      body.groups.push_back({static_cast<int>(k), {}});
    }
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int side = 0; side < 2; ++side) {
      const int body = body_of_side(mesh, 2 * static_cast<int>(f) + side);
      if (body < 0) {
        continue;
      }
      Triangle facet = mesh.facets[f];
      if (side == 1) {
        std::swap(facet[1], facet[2]);
      }
      result[static_cast<std::size_t>(body)]
          .groups[static_cast<std::size_t>(mesh.facet_label[f])]
          .facets.push_back(facet);
    }
  }
  for (BodyFacets& body : result) {
    std::erase_if(body.groups, [](const auto& g) { return g.facets.empty(); });
  }
  return result;
}

std::string body_name(const std::vector<std::string>& names, std::size_t body) {
  return body < names.size() && !names[body].empty()
             ? names[body]
             : fmt::format("body_{}", body + 1);
}

void check_for_file(const SurfaceMesh& mesh, const std::filesystem::path& path,
                    double limit) {
  if (mesh.facets.empty()) {
    throw InvalidInput(
        fmt::format("cannot write '{}': the surface is empty", path.string()));
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int id : mesh.facets[f]) {
      if (id < 0 || id >= static_cast<int>(mesh.points.size())) {
        throw InvalidInput(
            fmt::format("cannot write '{}': facet {} names point {} of {}",
                        path.string(), f, id, mesh.points.size()));
      }
      const Vec3& p = mesh.points[static_cast<std::size_t>(id)];
      if (!(p.cwiseAbs().maxCoeff() < limit)) {
        throw InvalidInput(fmt::format(
            "cannot write '{}': point {} of facet {} is at ({}, {}, {}), which "
            "the format cannot hold",
            path.string(), id, f, p.x(), p.y(), p.z()));
      }
    }
  }
}

}  // namespace meniscus::io
