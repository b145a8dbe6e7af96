/// A surface of several bodies as one closed surface each, for files that know
/// no shared facets.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::io {

/// Facets out of each body, by label, then in the mesh's order: those behind
/// which it is as they are, those in front of which it is turned around.
struct BodyFacets {
  struct Group {
    int label = 0;
    std::vector<Triangle> facets;  // point ids of the whole mesh
  };
  std::vector<Group> groups;  // labels without facets are left out
};
std::vector<BodyFacets> facets_by_body(const SurfaceMesh& mesh);

/// names[body], or "body_N" counted from 1 where there is none.
std::string body_name(const std::vector<std::string>& names, std::size_t body);

/// Throws InvalidInput, "cannot write 'PATH': ...", for a surface without
/// facets, a facet that names no point, a coordinate that is not finite or at
/// least `limit`.
void check_for_file(const SurfaceMesh& mesh, const std::filesystem::path& path,
                    double limit);

}  // namespace meniscus::io
