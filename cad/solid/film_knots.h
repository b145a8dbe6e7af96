/// Internal to film_faces: the knots of a film's patches.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "cad/solid/cut_film.h"
#include "cad/solid/direction_classes.h"
#include "cad/solid/fit_patch.h"
#include "cad/solid/patch_knots.h"

namespace meniscus::solid {

/// What a film's faces keep, as far as shorter spans help.
struct FaceLimits {
  double span = 0.0;  // longest between knots [length]
  double off = 0.0;   // farthest of the smooth film from its faces [length]
  double gap = 0.0;   // of the faces' boundaries from rims [length]
};

/// A film that has been cut, and the solid's rims, built, that its own are.
struct FilmOnRims {
  const CutFilm& cut;
  const std::vector<int>& rims;  // of the film: of the solid
  const std::vector<RimEdges>& solid_rims;

  const RimEdges& rim(int k) const { return solid_rims[rims[k]]; }
  RimSide side(const FilmPatch& patch, int side) const;
};

/// Length of a chain of vertices.
double length_of(const FilmMesh& mesh, const std::vector<int>& chain);

/// Opposite sides of a patch share their knots, and so do patches on the two
/// sides of a line: a class of directions runs through the film.
class FilmKnots {
 public:
  FilmKnots(const FilmOnRims& film, const FaceLimits& limits);

  /// Along a (0) or b (1) of a patch, and along a line.
  const std::vector<double>& of_patch(std::size_t patch, int along) const {
    return patch_knots_[patch][along];
  }
  const std::vector<double>& of_line(std::size_t line) const {
    return line_knots_[line];
  }
  /// Those of each class of directions.
  using Classes = std::map<int, std::vector<double>>;
  const Classes& classes() const { return knots_; }
  void restore(const Classes& knots);
  /// Halves the spans in which patches leave the film by more than `times` the
  /// limit (infinite: nowhere), or a rim by more than its own. False where
  /// there are none.
  bool halve(const std::vector<FittedPatch>& patches, const Brep& brep,
             double times);

 private:
  void set_classes();
  void set_knots();
  void spread_knots();
  void mark(int patch, int side, std::size_t span);
  void mark_misses(int patch, const FittedPatch& fitted, double times);
  void mark_gaps(int patch, int side, const Brep& brep);

  FilmOnRims film_;
  FaceLimits limits_;
  DirectionClasses directions_;
  Classes knots_;
  std::map<int, LongSpans> long_;  // per class
  std::vector<std::array<std::vector<double>, 2>> patch_knots_;
  std::vector<std::vector<double>> line_knots_;
};

}  // namespace meniscus::solid
