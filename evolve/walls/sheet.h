/// A film as a sheet: facets with two sides, without junctions.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::walls {

/// What every question about a sheet starts from. Lists by vertex are rows of
/// a compressed table: those of v are list[start[v]] .. list[start[v + 1]].
struct Sheet {
  SurfaceMesh film;         // every point used
  std::vector<int> origin;  // per point: its id in the film given
  Points facet_normal;      // unit
  std::vector<Edge> edges;
  std::vector<std::array<int, 2>> edge_facets;  // second -1: a rim
  std::vector<char> crease;                     // per edge, see kCreaseCosine
  std::vector<int> facet_start;                 // incident facets of a vertex
  std::vector<int> facet_list;
  std::vector<int> edge_start;  // incident edges of a vertex
  std::vector<int> edge_list;
  std::vector<char> on_crease;  // per vertex
};

/// Facets that meet at more than this angle are two smooth parts on a kink,
/// not one bent part: 50 degrees, so that a tube of eight facets is round.
inline constexpr double kCreaseCosine = 0.6427876096865394;

/// Throws InvalidInput for no facets, bad ids or labels, coordinates that are
/// not finite and facets without area; MeshError, naming surfaces and place,
/// for an edge of three or more facets (a junction), neighbours that run
/// opposite ways, and a vertex at which parts touch in one point only.
Sheet make_sheet(const SurfaceMesh& film);

}  // namespace meniscus::walls
