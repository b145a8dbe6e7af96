/// The least thickness of a part, smooth, as a functional (functional.h).
#pragma once

#include <array>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"

namespace meniscus::functionals {

/// Faces of the outer surface, each with the one across the solid from it: the
/// one whose centre lies on the smallest ball that touches the face at its own
/// centre from within, of those that face the other way (normals more than 120
/// degrees apart). None next to edges, where every solid is thin: where a wall
/// beside (60 to 120 degrees) has a clearly smaller ball, and in the wedge of
/// an edge sharper than 60 degrees, down to 10; below that a wedge is a thin
/// wall.
struct ThicknessPairs {
  std::vector<std::array<int, 2>> faces;
  // Distances at the base design [length]. The least may be below 0, at a
  // feather edge whose two planes cross beside it.
  double least = 0.0;
  double median = 0.0;
};

/// 1 / smoothing of thickness_functional() that keeps its value within 5 % of
/// `pairs.least` below the least distance, of however many pairs [1/length]; of
/// a fiftieth of `pairs.median` where that is more, as at a feather edge.
double usual_sharpness(const ThicknessPairs& pairs);

/// Ask once, at a model's base design: the same pairs must count in every
/// design. Work grows with the square of the faces within a thickness of each
/// other. Throws InvalidInput where no face has one across from it.
ThicknessPairs thickness_pairs(const TetMesh& base);

/// Where a part is thinnest.
struct ThinPlace {
  double value = 0.0;         // the least distance of a pair [length]
  Vec3 place = Vec3::Zero();  // half way between the two
  double share = 0.0;         // of the pairs' area, what is below the limit
};

/// `pairs` of `mesh`, not none; distances as in thickness_functional().
ThinPlace thinnest_place(const TetMesh& mesh, const ThicknessPairs& pairs,
                         double limit);

/// -(1/k) ln sum exp(-k d) over the pairs [length], d = 2 e . n_b /
/// (1 - n_a . n_b) being the diameter of the ball that touches the first face's
/// plane at its centre and the second's plane, e from the first centre to the
/// second, both of the corners' triangles. Below the least d, by no more than
/// ln(pairs) / k; plates and wedges have it exactly, curved walls to second
/// order. `sharpness` k > 0 [1/length]. Throws InvalidInput for a sharpness
/// that is not positive.
element::Functional thickness_functional(
    const TetMesh& mesh, const ThicknessPairs& pairs, double sharpness,
    element::Derivatives derivatives = element::Derivatives::All);

}  // namespace meniscus::functionals
