/// Films on the report page: the settled one with its curvature, those of
/// earlier designs, and what was wrong with a surface.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/types.h"

namespace meniscus::page {

/// Mean curvature H = (k1 + k2) / 2 at each vertex [1/length], positive for a
/// sphere with outward normals: half the cotangent Laplacian of the position
/// against the normal, over the mixed area of the vertex (Meyer, Desbrun,
/// Schroeder, Barr, Discrete differential-geometry operators, 2003). NaN where
/// the facets around do not close: on rims.
std::vector<double> mean_curvature(const Points& points,
                                   const std::vector<Triangle>& facets);

/// film.vtp: nodes, triangles, labels, names, `solid` (per name: a cap or
/// plate), `mean_curvature` of the liquid films. `solids`: names of surfaces
/// that are no films. Throws InvalidInput for a damaged file.
nlohmann::ordered_json page_film(const std::filesystem::path& path,
                                 const std::vector<std::string>& solids);

/// A film of the design's history.
struct PageFrame {
  int evaluation = 0;
  std::string file;  // relative to the folder
};

/// The list in FOLDER/frames.pvd; empty when there is none. Throws
/// InvalidInput for one that names files outside of the folder.
std::vector<PageFrame> page_frames(const std::filesystem::path& folder);

/// Nodes of each frame with its `place` in the list, and a `surface`
/// (triangles, labels, names) where it has not that of the frame before; at
/// most about `bytes` of text, evenly chosen with first and last among them.
nlohmann::ordered_json frames_json(const std::filesystem::path& folder,
                                   const std::vector<PageFrame>& frames,
                                   double bytes);

/// findings.vtp: messages, places, triangles at fault, and the surface beside
/// it (unfilled_surface.vtp) where that is there.
nlohmann::ordered_json page_findings(const std::filesystem::path& folder);

}  // namespace meniscus::page
