/// Which points and facets the walls of a film complex have: its films meet at
/// junctions or end at rims. No sizes: see wall_offset and
/// wall_model.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/surface_nodes.h"
#include "evolve/walls/thicken.h"
#include "evolve/walls/wall_planes.h"

namespace meniscus::walls {

/// A smooth curve or a side of a polygon, by which rims are called.
struct RimName {
  std::string curve;
  std::vector<std::string> films;  // that the curve holds
  bool holds = true;               // a film or a solid; else it is a name alone
  std::vector<int> vertices;       // all on it, ascending
};

/// Films with thickness, meshed coarsely; finer meshes are nested in that.
struct WallFilms {
  SurfaceMesh mesh;           // facets of walls only; every point of the film
  std::vector<int> wall;      // per label of mesh: its wall
  std::vector<int> region;    // per wall: the body that it is part of
  std::vector<double> asked;  // per wall: its usual thickness, sizes rims
  EdgeMiddles middles;        // of the nested refinements
  int levels = 0;             // how many of them
  std::vector<WallRim> rims;  // curves, with their own points
  std::vector<RimName> names;
  WallPlanes planes;  // on which the films slide, or walls end
};

/// A point of a wall.
struct WallPoint {
  /// A side's: the film vertex that it is offset from; -1: a blend.
  int vertex = -1;
  /// A blend's: points of sides with their weights, which sum to 1.
  std::vector<std::pair<int, double>> of;
};

/// One film facet of the finest mesh and the wall's facets over it, all three
/// in the film's order.
struct WallFacet {
  Triangle film = {};   // film vertices
  Triangle front = {};  // wall points on the side of the film's normal
  Triangle back = {};
  int label = 0;  // of the film
};

struct WallTopology {
  std::vector<WallPoint> points;  // of all levels
  std::vector<WallFacet> facets;  // of the finest
  /// Closed and outward; labels "F", then "F/back" for every film, then
  /// "F/rim:CURVE" (thicken.h) or in a plane "F/" and its name. Neither has
  /// coordinates; corners are wall points.
  SurfaceMesh coarse;
  SurfaceMesh fine;
  std::vector<char> cap;       // per facet of `fine`: of a junction's end
  EdgeMiddles middles;         // of wall points, all levels
  std::vector<char> junction;  // per film vertex: it is on a junction's line
};

/// Facets by the film edges that they have.
using FacetsAboutEdges = std::map<Edge, std::vector<int>>;
FacetsAboutEdges facets_about_edges(const std::vector<WallFacet>& facets);

/// Whether the facets `about` an edge end there: they are of two films, or
/// three and more.
bool is_junction(const std::vector<WallFacet>& facets,
                 const std::vector<int>& about);

/// Around every film vertex the sides of its facets fall into sectors: fans of
/// sides that follow each other about the edges there, one wall point each. Two
/// on a smooth film, a crease or a rim, one per pair of neighbours on a line
/// where three or more films meet, as many as chambers at a point. So the walls
/// are closed whatever meets where. Strips close the rims, and caps the ends of
/// junction lines on rims. `films.mesh.points`: where the order of films about
/// their lines is read. Throws MeshError for an edge of the mesh that has no
/// middle where levels ask for it.
WallTopology wall_topology(const WallFilms& films);

}  // namespace meniscus::walls
