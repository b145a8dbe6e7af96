/// Building and remeshing a film complex. All deterministic.
#pragma once

#include <functional>
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

/// Isotropic remeshing of the films towards an edge length: split above 4/3,
/// collapse below 4/5, flip towards Delaunay, vertex averaging along the film.
/// Triple lines and liquid marked edges stay lines with their films and marks,
/// remeshed along themselves; walls and curves are kept to; rims, solid
/// surfaces, refine = false and the points where lines meet are not touched
/// (evolve/surface_editor.h says when). Volumes change slightly; settle again
/// afterwards. Throws InvalidInput for a length that is not above 0.
struct RemeshOptions {
  double edge = 0.0;  // [length], > 0
  int passes = 5;
  /// Length wanted at a place [length -> length], > 0; replaces `edge`. Should
  /// change by less than about half its value within its value.
  std::function<double(const Vec3&)> edge_field = {};
};
void remesh_films(FilmComplex& complex, const RemeshOptions& options);

/// Flips edges of the films where that increases the smallest angle
/// (equiangulation). Returns the number of flips.
enum class FlipRule {
  KeepShape,  // never where the film's shape would change much
  AnglesOnly  // wherever the angles ask for it, as Surface Evolver's `u` does
};
int equiangulate(FilmComplex& complex, FlipRule rule = FlipRule::KeepShape);

/// One step of vertex averaging: liquid vertices move to the area-weighted
/// centre of their facets, along the film only; on lines to the middle of
/// their neighbours, along the line only.
void average_vertices(FilmComplex& complex);

/// Nested refinement: every facet into four, by the middles of its edges.
/// Vertices on marked edges and rims are born as the mark says: on curves at
/// the middle parameter, on walls on their level sets, others at the edge's
/// middle; the two halves of a marked edge follow each other in its place,
/// direction kept. Edges with refine = false and those of surfaces with
/// refine = false stay whole, and facets beside them become three or two.
///
/// Multigrid hierarchies rely on the numbering: old vertices come first and
/// keep their numbers, one new vertex per halved edge follows in the order of
/// list_edges (`parents`: the edge's ends); when no edge stays whole, facet f =
/// (0, 1, 2) has the children 4f .. 4f + 3, which are (0, 01, 20),
/// (01, 1, 12), (20, 12, 2) and (01, 12, 20). Linear in time: 245,760 facets
/// in about 0.1 s.
struct Refinement {
  FilmComplex complex;
  std::vector<Edge> parents;  // one per new vertex
};
Refinement refine(const FilmComplex& complex);

/// Throws MeshError, naming ids, unless every invariant of a complex holds:
/// indices, labels and kinds consistent, no facet twice, vertices on their
/// curves and level sets, marks once per edge, edges with one facet marked or
/// on a curve, two facets of one surface running opposite ways, and each
/// body's facets using every edge as often each way (but for marked edges on
/// walls or above columns, where the rest is integrals), outward.
void check_complex(const FilmComplex& complex);

}  // namespace meniscus
