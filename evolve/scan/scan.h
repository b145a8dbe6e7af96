/// A scanned surface, and how far films are from it.
#pragma once

#include <vector>

#include "core/geometry/facet_tree.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/frozen/film_gradient.h"

namespace meniscus::scan {

/// The nearest place of a scan.
struct ScanPlace {
  double distance = 0.0;          // [length], above 0 in front of the facets
  Vec3 direction = Vec3::Zero();  // its derivative by the place, a unit vector
  Vec3 on_scan = Vec3::Zero();
};

/// Triangles of any kind: noisy, open, in pieces; it need not be closed or
/// manifold. The sign of distances is that of the facets' normals.
class Scan {
 public:
  /// Throws MeshError for no facets, and for corners out of range or not
  /// finite.
  explicit Scan(SurfaceMesh surface);
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  ScanPlace nearest(const Vec3& place) const;
  const SurfaceMesh& surface() const { return surface_; }

 private:
  SurfaceMesh surface_;
  Points normals_;  // per point, weighted by area, not of unit length
  FacetTree tree_;
  double rounding_;  // what is nearer lies on the scan [length]
};

/// Distances of the vertices of films (rims included) to a scan.
struct ScanDistances {
  std::vector<int> vertices;  // of the film's mesh, increasing
  VectorX values;             // [length], one per vertex
  Points directions;          // their derivatives by the vertices
};

/// `labels`: the films, of the mesh's labels.
ScanDistances distances_to(const Scan& scan, const SurfaceMesh& film,
                           const std::vector<int>& labels);

/// What is told of many distances, without their signs.
enum class ScanMeasure {
  Rms,   // root of the mean square, smooth
  Mean,  // smooth but where a vertex lies on the scan
  P95,   // 95 % are not above it
  Largest,
};

/// A measure of `distances` (not none), with its derivatives by the film's
/// `vertices` points at fixed nearest places: exact, for the nearest place
/// moves across the distance. P95 and Largest are one vertex's distance.
frozen::FilmResponse measure(const ScanDistances& distances,
                             ScanMeasure measure, std::size_t vertices);

}  // namespace meniscus::scan
