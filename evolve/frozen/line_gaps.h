/// How far apart the lines are at which films end: where lines run together, or
/// a film between them shrinks away, films join in another way, and no frozen
/// model goes on.
#pragma once

#include <string>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::frozen {

/// Where the films of a complex that lines bound are narrow, over what they
/// were in the reference.
struct NarrowFilm {
  enum class How { BetweenLines, AtItsRim, Whole };
  How how = How::Whole;
  double ratio = 1.0;  // of `width` and `usual`
  double width = 0.0;  // from a line to another or to the rim, of a film as a
                       // whole the root of its area [length]
  double usual = 0.0;  // of the reference [length]
  Vec3 place = Vec3::Zero();
  std::string film;
};

class LineGaps {
 public:
  explicit LineGaps(const films::FilmComplex& reference);

  /// The smallest ratio at `points`, the first of equals; infinite without
  /// lines. O(n^2) of the lines' vertices.
  NarrowFilm narrowest(const Points& points) const;

 private:
  struct Line {
    std::vector<int> vertices;  // no other line's
    bool moves = false;         // else a rim
  };
  struct Film {
    std::string name;
    std::vector<Triangle> facets;
    std::vector<Line> lines;  // at which it ends
    // Per vertex of its lines that move, in order, the way to the nearest of
    // its others; infinite where there is none.
    std::vector<double> usual;
    double usual_size = 0.0;  // root of its area
  };
  /// The nearest vertex of another of the film's lines.
  struct Nearest {
    double distance;
    int vertex;
    bool moves;
  };
  static Nearest nearest(const Film& film, std::size_t line, int vertex,
                         const Points& points);

  std::vector<Film> films_;  // with lines that move
};

}  // namespace meniscus::frozen
