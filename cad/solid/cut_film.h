/// A film cut into four-sided patches. Two rims: a tube, cut by seams along
/// its length. More: one tube to each rim, to the line where the harmonic
/// measures of two rims are alike; those lines meet in threes at nodes, from
/// each of which a seam runs down each of its tubes. One rim: of four corners
/// the film as it is, else a square in the middle and a patch between each of
/// its sides and the rim. None: as a cube's sides.
#pragma once

#include <array>
#include <vector>

#include "cad/solid/film_mesh.h"
#include "cad/solid/rim_curve.h"

namespace meniscus::solid {

/// One of a film's boundary loops and the curve that it lies on.
struct FilmRim {
  const RimCurve* curve = nullptr;
  std::vector<int> loop;          // vertices, film on the left
  std::vector<double> positions;  // one each: place on the curve
};

/// Sides: 0 bottom (along a), 1 right (along b), 2 top (along a), 3 left (along
/// b); a x b points out of the body. Each lies on a rim or on a line.
struct FilmPatch {
  std::vector<int> facets;
  std::array<std::vector<int>, 4> chains;    // vertices along growing a or b
  std::array<int, 4> rims{-1, -1, -1, -1};   // of the film; -1: a line
  std::array<int, 4> lines{-1, -1, -1, -1};  // into CutFilm::lines; -1: a rim
  std::array<bool, 4> reversed{};            // runs against that line
};

struct CutFilm {
  FilmMesh mesh;
  std::vector<int> rim_of;           // per vertex: rim, -1
  std::vector<double> rim_position;  // per vertex on a rim
  std::vector<FilmPatch> patches;
  std::vector<std::vector<int>> lines;  // between patches: seams and others
};

/// Throws MeshError for a film that has no such cut: rims whose measures do not
/// come to meet, one rim of a film that is no disk, none of a film that does
/// not see all of itself from its middle.
CutFilm cut_film(FilmMesh mesh, const std::vector<FilmRim>& rims);

}  // namespace meniscus::solid
