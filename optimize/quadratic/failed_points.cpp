#include "optimize/quadratic/failed_points.h"

#include <array>
#include <cmath>

namespace meniscus::quadratic {
namespace {

// The part of the way to a failed point that a step may go, by how often it
// went so far and answered; then the point is forgotten.
constexpr std::array<double, 3> kPartOfTheWay = {0.5, 0.75, 0.9};
// A step this near to a cut was held up by it.
constexpr double kHeldUp = 0.99;
// Points farther than this x the radius (by length) cannot be reached.
constexpr double kReach = 2.5;

}  // namespace

void FailedPoints::cut(const VectorX& centre, const VectorX& ranges,
                       double radius, QuadraticProgram& program) const {
  for (const Point& point : points_) {
    const VectorX way = (point.x - centre).cwiseQuotient(ranges);
    const double length = way.norm();
    if (point.passed < kPartOfTheWay.size() && length > 0.0 &&
        way.cwiseAbs().maxCoeff() <= kReach * radius) {
      program.add(way / length, kPartOfTheWay[point.passed] * length);
    }
  }
}

void FailedPoints::passed(const VectorX& centre, const VectorX& ranges,
                          const VectorX& x) {
  const VectorX step = (x - centre).cwiseQuotient(ranges);
  for (Point& point : points_) {
    const VectorX way = (point.x - centre).cwiseQuotient(ranges);
    const double part = way.dot(step) / way.squaredNorm();
    if (point.passed < kPartOfTheWay.size() &&
        part >= kHeldUp * kPartOfTheWay[point.passed]) {
      ++point.passed;
    }
  }
}

bool FailedPoints::near(const VectorX& x, const VectorX& ranges,
                        double distance) const {
  for (const Point& point : points_) {
    if ((point.x - x).cwiseQuotient(ranges).cwiseAbs().maxCoeff() <= distance) {
      return true;
    }
  }
  return false;
}

}  // namespace meniscus::quadratic
