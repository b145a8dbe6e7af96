/// What failed evaluations teach a search with steps of its own: a point that
/// cannot be evaluated stands for all behind it, until points beside it answer.
#pragma once

#include <vector>

#include "optimize/quadratic/quadratic_program.h"

namespace meniscus::quadratic {

/// Points x and steps d = (x - centre) / ranges.
class FailedPoints {
 public:
  void add(const VectorX& x) { points_.push_back({x, 0}); }

  /// Rows that keep steps of at most `radius` from `centre` on this side of
  /// each failed point within reach: no farther towards it than a part of the
  /// way. The part grows with each step that went so far and answered.
  void cut(const VectorX& centre, const VectorX& ranges, double radius,
           QuadraticProgram& program) const;

  /// The step from `centre` to x answered: points that held it up do so less.
  void passed(const VectorX& centre, const VectorX& ranges, const VectorX& x);

  /// True where one lies within `distance` of x in every variable [ranges].
  bool near(const VectorX& x, const VectorX& ranges, double distance) const;

 private:
  struct Point {
    VectorX x;
    std::size_t passed = 0;  // steps that it held up and that answered
  };
  std::vector<Point> points_;
};

}  // namespace meniscus::quadratic
