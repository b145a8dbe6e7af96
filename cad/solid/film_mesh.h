/// One film as a triangle mesh with unit normals at its vertices, and the
/// smooth surface between them.
#pragma once

#include <map>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::solid {

struct FilmMesh {
  Points points;                 // [length]
  Points normals;                // unit, one per vertex, out of the body
  std::vector<Triangle> facets;  // counter-clockwise seen from outside
  // Middles of edges on curved rims, less those of smooth_point() without
  // them; lower vertex first.
  std::map<Edge, Vec3> bulges;
};

/// Facets by their directed edges.
std::map<Edge, int> facets_by_edge(const std::vector<Triangle>& facets);

/// Flips edges whose facets lie back to back (by more than 60 degrees) where
/// the film gets flatter: beside a corner of its rim facets can hang over the
/// rim.
void flip_folds(FilmMesh& mesh);

/// Normals by a least-squares quadric through each vertex and its two rings of
/// neighbours: second order, at rims too.
void set_normals(FilmMesh& mesh);

/// The point of a facet with corner weights `at` (sum 1), on the film: halfway
/// from the flat facet to the weighted mean of its projections on the corners'
/// tangent planes (Boubekeur, Alexa 2008), which is exact on quadrics' graphs
/// to third order.
Vec3 smooth_point(const FilmMesh& mesh, int facet, const Vec3& at);

/// The same on the edge from a to b at share t, without bulge.
Vec3 smooth_edge_point(const FilmMesh& mesh, int a, int b, double t);
Vec3 mixed_normal(const FilmMesh& mesh, int a, int b, double t);

/// Per label, the volume between the smooth film and
/// its flat facets, positive outside of these [length^3]; 0 for the labels that
/// are `flat` (one char each). Second order in the edge length.
std::vector<double> bulge_volumes(const SurfaceMesh& mesh,
                                  const std::vector<char>& flat);

/// Boundary loops of some of the facets: vertices in the facets' direction, so
/// that the film is on the left. In order of their lowest vertex, which begins
/// each. Throws MeshError where more than two boundary edges meet.
std::vector<std::vector<int>> boundary_loops(
    const std::vector<Triangle>& facets, const Points& points);

}  // namespace meniscus::solid
