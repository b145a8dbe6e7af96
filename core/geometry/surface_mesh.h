/// Triangle surfaces as plain arrays: the only thing that crosses from films
/// to meshing, export and pictures. Facets are counter-clockwise seen from
/// outside the body they enclose (outward normals).
#pragma once

#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus {

/// The bodies on the two sides of a facet; -1: none, outside or in a cavity.
struct FacetBodies {
  int behind = 0;  // the facet's normal points out of it; never -1
  int front = -1;  // other than the one behind
};

struct SurfaceMesh {
  Points points;                    // [length]
  std::vector<Triangle> facets;     // point ids
  std::vector<int> facet_label;     // one per facet: index into labels
  std::vector<std::string> labels;  // surface names ("skin", "left_pad")
  std::vector<FacetBodies> facet_bodies = {};  // one per facet; empty: body 0
                                               // behind each, none in front

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

/// The body on a side: 2 f behind facet f, 2 f + 1 in front of it. Bodies may
/// share facets, edges and points.
int body_of_side(const SurfaceMesh& mesh, int side);

/// Number of bodies: the largest number of one, plus 1.
int body_count(const SurfaceMesh& mesh);

/// Twice the facet's area times its unit normal: (b - a) x (c - a).
Vec3 area_vector2(const SurfaceMesh& mesh, int facet);

/// Newell's area vector of a closed polygon: its area times its normal,
/// counter-clockwise seen from the tip; of the shadow when not planar.
Vec3 polygon_area_vector(const Points& rim);

/// The mean of some points; there must be one.
Vec3 mean_of(const Points& points);

/// Sum of facet areas [length^2]; of one label when `label` is not negative.
double surface_area(const SurfaceMesh& mesh, int label = -1);

/// Signed volume enclosed by closed, outward bodies, all together [length^3].
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
