/// A film mesh as a CAD solid: films become B-spline patches, or the plane,
/// cylinder, cone or sphere that they are; caps planes, rims their exact
/// curves.
#pragma once

#include <string>
#include <vector>

#include "cad/solid/brep.h"
#include "cad/solid/rim_curve.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus::solid {

struct NamedRim {
  std::string name;
  RimCurve curve;
  std::vector<int> vertices;  // of the mesh, on it
};

struct FilmSolidInput {
  const SurfaceMesh& mesh;         // closed, outward
  std::vector<NamedRim> rims;      // loops on none get a spline through them
  std::vector<std::string> caps;   // labels of planar faces, which end at sides
                                   // that two rims share
  std::vector<std::string> exact;  // labels whose faces are Brep::exact's
  double edge = 0.0;               // the film's edge length [length]
  std::vector<std::string> creased = {};  // of these, those that end at creases
                                          // too: several planes
  std::vector<std::string> sharp = {};    // labels of films that end where
                                          // facets meet in a corner
};

/// A film that is a plane, cylinder, cone or sphere (cad/solid/simple_film.h).
struct SimpleFace {
  std::string film;
  std::string shape;        // "cylinder of radius 12"
  bool has_radius = false;  // told last, a length
  double off = 0.0;         // the farthest film vertex [length]
};

/// What was measured of the solid; lengths in the mesh's unit.
struct FilmSolidReport {
  int patches = 0;
  int planes = 0;
  int cylinders = 0;
  int cones = 0;
  int spheres = 0;
  double gap = 0.0;            // between the faces at an edge, the largest
  double film_to_solid = 0.0;  // farthest film vertex from its patch
  double solid_to_film = 0.0;  // farthest of samples of the patches from facets
  std::string off_film;        // where the larger of the two is
  Vec3 off_place = Vec3::Zero();
  double tangent_break = 0.0;  // between patches of one film, largest [degree]
  std::string break_film;      // where that is
  Vec3 break_place = Vec3::Zero();
  std::vector<SimpleFace> simple;
};

struct FilmSolid {
  Brep brep;
  FilmSolidReport report;
};

/// Throws MeshError where a film cannot be cut into patches (its name is in the
/// message), InvalidInput for a cap that is not planar.
FilmSolid film_solid(const FilmSolidInput& input);

/// Each facet a planar face, named by its label.
Brep faceted_solid(const SurfaceMesh& mesh);

}  // namespace meniscus::solid
