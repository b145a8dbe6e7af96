/// Walls: a film without junctions made solid by thickness.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/geometry/mesh_checks.h"
#include "core/geometry/surface_mesh.h"
#include "core/math/expression.h"

namespace meniscus::walls {

/// Where the wall's material lies. Outside is where the facet normals point.
enum class WallSide {
  Both,    // half of the thickness on either side of the film
  Inside,  // all of it against the normals; the film is the front, unmoved
  Outside  // all of it along the normals; the film is the back, unmoved
};

/// A curve that holds the film: names the rim strips along it.
struct WallRim {
  std::string name;
  std::vector<int> vertices;  // of the film given
  std::vector<double> t;      // of the curve, one per vertex; may be left out
};

struct ThickenOptions {
  /// Number, or expression of x, y, z at the film; above 0 at every vertex and
  /// linear between them [length].
  Expression thickness;
  WallSide side = WallSide::Both;
  std::vector<WallRim> rims;
  /// Corrections of the offsets by the thickness measured end when no sample
  /// is further off than this (relative), when they gain little, or after
  /// max_corrections.
  double accuracy = 0.02;
  int max_corrections = 8;
};

/// Which film vertex a wall point comes from and how far across the wall it
/// is: 1 on the front, 0 on the back, between them inside a rim strip.
struct WallTrace {
  int vertex = -1;
  double across = 1.0;
};

enum class WallLimit {
  None,       // nothing limits the thickness
  Curvature,  // an offset side reaches the centre of curvature
  Gap         // walls come near each other
};

/// Thickness measured from a point of one side to the nearest of the other.
struct MeasuredThickness {
  double value = 0.0;         // [length]
  double asked = 0.0;         // there [length]
  Vec3 place = Vec3::Zero();  // on the wall
};

/// Where the film bears the least thickness in proportion to what was asked.
struct SafeThickness {
  double value = std::numeric_limits<double>::infinity();  // [length]
  double asked = 0.0;                                      // there [length]
  WallLimit limit = WallLimit::None;
  int vertex = -1;            // of the film given; -1: no limit
  Vec3 place = Vec3::Zero();  // on the film
  std::string message;        // value, reason, place, what to try
};

struct ThickWall {
  /// Watertight and outward. Points: all film vertices moved to the front, in
  /// the film's order, then all on the back, then those inside rim strips; of
  /// a one-sided wall the unmoved side has the film's own coordinates, bit for
  /// bit. Facets: the front as in the film, the back turned, the rims.
  /// Labels, for each film label F in order: "F" the front, to which the
  /// film's normals point and which so carries its loads whatever the side;
  /// then "F/back" for each; then for rims "F/rim:NAME" along a named curve
  /// and "F/rim:K" elsewhere, K counting from 1 the closed rims without names
  /// by their lowest vertex.
  SurfaceMesh surface;
  std::vector<WallTrace> trace;  // per point of surface
  /// Per facet 1 where it closes the end of a line where films meet; empty: no
  /// films meet.
  std::vector<char> cap;
  double volume = 0.0;         // of the wall [length^3]
  MeasuredThickness thinnest;  // relative to what was asked; samples are
  MeasuredThickness thickest;  // vertices, edge midpoints, facet centres
  SafeThickness safe;
  int corrections = 0;
  /// What check_surface finds; empty when the wall can be meshed. A thickness
  /// beyond the safe one is an answer with findings, not an error.
  std::vector<Finding> findings;
};

/// Makes the wall of `film`: one or several labels, manifold with or without
/// rim, consistently oriented; closed films become shells with a void.
///
/// Every vertex moves along the normal of a fitted jet (jet_fit.h), on a
/// crease along the mitre, by the distance that has the neighbouring facets'
/// planes at the thickness in the least-squares sense; distances are then
/// corrected by the thickness measured. Safe is, with k the principal
/// curvature in question, t < 1.8 / |k| for Both and t < 0.9 / k where k bends
/// a one-sided wall's material together; and t below half the gap to other
/// parts of the film, measured by tangent balls (facet_probe.h), unless the gap
/// is a tube's own inside, which the curvature governs.
///
/// Throws InvalidInput for a thickness that is not finite or not above 0,
/// naming the vertex, for bad options, and what make_sheet() (sheet.h) throws.
ThickWall thicken(const SurfaceMesh& film, const ThickenOptions& options);

}  // namespace meniscus::walls
