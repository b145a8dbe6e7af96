/// A four-sided patch of a film as one bicubic B-spline surface.
#pragma once

#include <array>
#include <vector>

#include "cad/solid/cut_film.h"
#include "cad/solid/spline.h"

namespace meniscus::solid {

struct PatchSides {
  // Bottom, right, top, left, along growing a or b; opposite ones have the
  // same knots, and ends meet exactly.
  std::array<SplineCurve, 4> curves;
  // The film's normal along the side, by its parameter; no poles: free.
  std::array<SplineCurve, 4> normals;
  // First and last end of the side: the film has no tangent plane there, and
  // the span is free.
  std::array<std::array<bool, 2>, 4> free_end{};
  // Parameters of the chains' vertices.
  std::array<std::vector<double>, 4> at;
};

/// How far the surface is off a point of the smooth film.
struct PatchMiss {
  Vec2 at;
  double off = 0.0;             // [length]
  Vec3 normal = Vec3::UnitZ();  // the film's there
};

struct FittedPatch {
  SplineSurface surface;
  std::vector<int> vertices;  // of the film, in this patch
  std::vector<Vec2> at;       // their parameters (a, b), about
  std::vector<PatchMiss> misses;
};

/// The share of the film's points at which the surface is seen from behind.
double folded_share(const FittedPatch& patch);

/// Parameters are harmonic on the patch with the sides' as given; poles are
/// the least-squares ones over points of the smooth film, the sides' exactly
/// the curves', and the surface tangent to the sides' normals as nearly as the
/// poles allow, so that patches that share a side meet without a crease.
FittedPatch fit_patch(const FilmMesh& mesh, const FilmPatch& patch,
                      const PatchSides& sides);

}  // namespace meniscus::solid
