/// Which facets of several bodies bound material, and on which side.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// Regions of material: per body its number from 0 in the bodies' order, or -1
/// for a void.
std::vector<int> regions_of(const std::vector<BodySpec>& bodies);

/// Facets of the oriented complex, any level of it, as the mesher wants them:
/// out of the region behind, facets without material on either side left out,
/// facet_bodies set to regions. With a single body that has all surfaces, or is
/// a void, the mesh stays as it is. `mesh.points` may be empty.
void keep_solids(const FilmComplex& complex, const std::vector<int>& regions,
                 SurfaceMesh& mesh);

/// Of facets that went through keep_solids those with material on one side:
/// closed surfaces for files.
void drop_interfaces(SurfaceMesh& mesh);

/// Renumbers the facets' corners without those that no facet uses; `corner`
/// keeps the others' entries.
void drop_unused(SurfaceMesh& mesh, std::vector<int>& corner);

}  // namespace meniscus::films
