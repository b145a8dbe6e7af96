/// Building and remeshing a film complex. All deterministic.
#pragma once

#include <vector>

#include "evolve/film_complex.h"

namespace meniscus {

/// The start complex: curves cut into edges of about `edge`, films as their
/// kind says, caps triangulated in their plane, facets oriented outward of the
/// bodies. Throws InvalidInput: unknown curve or surface, a cap on a curve
/// that is not planar, a branch curve that is off the convex hull (which one),
/// a body that its surfaces do not close (names the open edges' surfaces and
/// position), a surface that encloses nothing.
FilmComplex build_start(const FilmSystem& system, double edge);

/// Isotropic remeshing of the films towards `edge`: split above 4/3, collapse
/// below 4/5, flip towards valence six and Delaunay, vertex averaging along
/// the film. Rim vertices stay where they are; caps are not touched.
/// Volumes change slightly; settle again afterwards.
struct RemeshOptions {
  double edge = 0.0;  // [length], > 0
  int passes = 5;
};
void remesh_films(FilmComplex& complex, const RemeshOptions& options);

/// Flips edges of the films where that increases the smallest angle
/// (equiangulation). Returns the number of flips.
int equiangulate(FilmComplex& complex);

/// One step of vertex averaging: free vertices move to the area-weighted
/// centre of their facets, along the film only.
void average_vertices(FilmComplex& complex);

/// Nested 1:4 refinement: old vertices first with their numbers, then one per
/// edge (`parents`: the edge's ends). New rim vertices lie on their curve at
/// the middle parameter, others at the edge's midpoint.
struct Refinement {
  FilmComplex complex;
  std::vector<Edge> parents;  // one per new vertex
};
Refinement refine(const FilmComplex& complex);

/// Throws MeshError, naming ids, unless every invariant of a complex holds:
/// indices, labels and kinds consistent, rim vertices on their curve, films
/// manifold away from rims, each body closed and outward.
void check_complex(const FilmComplex& complex);

}  // namespace meniscus
