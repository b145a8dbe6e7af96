/// Triangle surfaces as plain arrays: the only thing that crosses from films
/// to meshing, export and pictures. Facets are counter-clockwise seen from
/// outside the body they enclose (outward normals).
#pragma once

#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus {

struct SurfaceMesh {
  Points points;                    // [length]
  std::vector<Triangle> facets;     // point ids
  std::vector<int> facet_label;     // one per facet: index into labels
  std::vector<std::string> labels;  // surface names ("skin", "left_pad")

  /// Index of `name` in labels, or -1.
  int label_of(const std::string& name) const;
};

/// A surface with one mid-side point per edge: six-node triangles. The facets
/// of `base` are the corners; `mid` need not lie on the straight edge.
struct QuadraticSurface {
  SurfaceMesh base;
  std::vector<Edge> edges;            // every edge once, first id < second id
  Points mid;                         // one per edge [length]
  std::vector<Triangle> facet_edges;  // per facet: edges (01), (12), (20)
};

/// Twice the facet's area times its unit normal: (b - a) x (c - a).
Vec3 area_vector2(const SurfaceMesh& mesh, int facet);

/// Sum of facet areas [length^2]; of one label when `label` is not negative.
double surface_area(const SurfaceMesh& mesh, int label = -1);

/// Signed volume enclosed by a closed, outward surface [length^3].
double enclosed_volume(const SurfaceMesh& mesh);

/// Every edge once, first id < second id, in order of first appearance; and
/// per facet the edges (01), (12), (20).
void list_edges(const std::vector<Triangle>& facets, std::vector<Edge>& edges,
                std::vector<Triangle>& facet_edges);

/// Mean edge length [length].
double mean_edge_length(const SurfaceMesh& mesh);

/// Length of the bounding box's diagonal [length]; 0 for no points.
double bounding_diagonal(const Points& points);

}  // namespace meniscus
