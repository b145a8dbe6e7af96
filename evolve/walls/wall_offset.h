/// How far and where a sheet's vertices go to become a wall's two sides.
#pragma once

#include <array>
#include <vector>

#include "evolve/walls/jet_fit.h"
#include "evolve/walls/sheet.h"
#include "evolve/walls/thicken.h"
#include "evolve/walls/wall_ends.h"

namespace meniscus::walls {

/// What one wall's thickness moves a point by.
struct WallMove {
  int wall = 0;
  Vec3 by = Vec3::Zero();  // [length]
};

/// Adds it to the moves of its wall.
void add_move(const WallMove& move, std::vector<WallMove>& moves);

/// Parts of the thickness that lie in front of the film and behind it.
struct WallShares {
  double front = 0.5;
  double back = 0.5;
};
WallShares shares(WallSide side);

/// Inverse of sum w n n^T in the space that the normals n span clearly, with
/// eigenvalues above `spanned` times the largest, 0 across it: of planes
/// n . d = h the point d where they meet.
Mat3 mitre_inverse(const Mat3& matrix, double spanned = 0.05);

/// Per vertex the move for an offset by 1: the solution of n_f . d = 1 over
/// its facets, by corner angle in the least-squares sense; on a crease in the
/// space that the facets' normals span clearly, elsewhere with the part off the
/// jet's normal held back by weight (k t)^2: with t far below the edges the
/// facets' planes alone count, and a thick wall keeps to the normal, without
/// which its compressed side folds. Where the sheet slides the move is the one
/// in the plane that leaves the jet's tangent plane by 1.
std::vector<Vec3> offset_directions(const Sheet& sheet,
                                    const std::vector<Jet>& jets,
                                    const std::vector<double>& asked,
                                    const SheetEnds& ends = {});

struct OffsetSides {
  Points front;
  Points back;
  MeasuredThickness thinnest;
  MeasuredThickness thickest;
  int corrections = 0;
};

/// A plane n . d = h that an offset point keeps in front of.
struct OffsetPlane {
  Vec3 normal = Vec3::Zero();  // unit, or its part along planes
  double offset = 0.0;         // [length]
};

/// The point nearest to the film that no plane is behind.
struct OffsetCorner {
  Vec3 point = Vec3::Zero();
  Mat3 inverse = Mat3::Zero();  // point = sum inverse n h over planes it is in
  std::vector<char> on;         // per plane: the point is in it
};

/// min |d| with n . d >= h: where two or three planes meet, or in one of them
/// where that is in front of the others. Of planes without such a point the
/// least-squares one of all.
OffsetCorner offset_corner(const std::vector<OffsetPlane>& planes);

/// A film cut along its junctions, where it has one vertex for each fan of its
/// facets.
struct OffsetSheet {
  Sheet sheet;  // `origin`: film vertices
  OffsetSides sides;
  std::array<std::vector<int>, 2> points;  // the wall's, on front and back
};

/// Moves the sheet by `asked` (per vertex, [length]) and corrects the moves by
/// the thickness measured; the best state met is returned. A side that is
/// nearest where it ends in a plane is cut there: that is no thickness, and
/// moves in planes are not corrected.
OffsetSides offset_sides(const Sheet& sheet, const std::vector<Vec3>& direction,
                         const std::vector<double>& asked,
                         const ThickenOptions& options,
                         const SheetEnds& ends = {});

/// What else is in a wall's way, and whether all of it is wanted.
struct SafeOptions {
  const SurfaceMesh* others = nullptr;     // other films; may be null
  std::vector<double>* at_each = nullptr;  // receives the largest safe
                                           // thickness at every vertex; slower
};

/// See ThickWall::safe.
SafeThickness safe_thickness(const Sheet& sheet, const std::vector<Jet>& jets,
                             const std::vector<double>& asked, WallSide side,
                             const SafeOptions& options = {});

}  // namespace meniscus::walls
