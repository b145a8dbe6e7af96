#include "evolve/films/rim_grading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "evolve/curves/curve_shape.h"
#include "evolve/films/rims.h"

namespace meniscus::films {

namespace {

constexpr double kFine = 0.6;    // x edge: what counts as finer
constexpr double kGrowth = 0.4;  // of the length per distance
constexpr double kMuchFiner = 1.25;

using Cell = std::array<long, 3>;

bool has_many_sides(const curves::CurveShape& shape) {
  // Rims of fewer pieces than this are cut finer for the sake of roundness.
  constexpr int kRound = 12;
  return curves::curve_shape::part_count(shape) > kRound;
}

/// Fine rim points by cells as wide as their reach.
class Grading {
 public:
  explicit Grading(double edge) : edge_(edge), width_(edge / kGrowth) {}

  void add(const Vec3& place, double piece) {
    cells_[cell_of(place)].emplace_back(place, piece);
  }
  bool empty() const { return cells_.empty(); }

  double at(const Vec3& place) const {
    double least = edge_;
    const Cell middle = cell_of(place);
    for (long i = -1; i <= 1; ++i) {
      for (long j = -1; j <= 1; ++j) {
        for (long k = -1; k <= 1; ++k) {
          const auto found =
              cells_.find({middle[0] + i, middle[1] + j, middle[2] + k});
          if (found == cells_.end()) {
            continue;
          }
          for (const auto& [point, piece] : found->second) {
            least = std::min(least, piece + kGrowth * (place - point).norm());
          }
        }
      }
    }
    return least;
  }

 private:
  Cell cell_of(const Vec3& place) const {
    return {std::lround(place.x() / width_), std::lround(place.y() / width_),
            std::lround(place.z() / width_)};
  }

  double edge_;
  double width_;
  std::map<Cell, std::vector<std::pair<Vec3, double>>> cells_;
};

/// `next`: per point the one that follows on its rim; below 0: not on one.
std::function<double(const Vec3&)> graded(const Points& points,
                                          const std::vector<int>& next,
                                          double edge) {
  std::vector<double> piece(points.size(), 0.0);  // two pieces, halved
  for (std::size_t v = 0; v < next.size(); ++v) {
    if (next[v] >= 0) {
      const double half = 0.5 * (points[next[v]] - points[v]).norm();
      piece[v] += half;
      piece[next[v]] += half;
    }
  }
  Grading grading(edge);
  for (std::size_t v = 0; v < next.size(); ++v) {
    if (next[v] >= 0 && piece[v] > 0.0 && piece[v] < kFine * edge) {
      grading.add(points[v], piece[v]);
    }
  }
  if (grading.empty()) {
    return {};
  }
  return [grading = std::move(grading)](const Vec3& place) {
    return grading.at(place);
  };
}

}  // namespace

bool is_cut_finely(const curves::Curve& curve) {
  return curve.fineness < 1.0 || has_many_sides(curve.shape);
}

std::function<double(const Vec3&)> graded_edge(const Points& rim, double edge) {
  std::vector<int> next;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    next.push_back(static_cast<int>((k + 1) % rim.size()));
  }
  return graded(rim, next, edge);
}

std::function<double(const Vec3&)> graded_edge(const FilmComplex& complex,
                                               double edge) {
  std::vector<int> next = rim_neighbours(complex);
  for (std::size_t v = 0; v < next.size(); ++v) {
    if (next[v] >= 0 &&
        !is_cut_finely(complex.curves[complex.vertices[v].curve])) {
      next[v] = -1;
    }
  }
  return graded(complex.mesh.points, next, edge);
}

bool halving_is_too_fine(const FilmSystem& system, double edge) {
  return std::any_of(
      system.curves.begin(), system.curves.end(),
      [&](const curves::Curve& curve) {
        return has_many_sides(curve.shape) &&
               2.0 * static_cast<double>(
                         curves::sample_parameters(curve.shape, 2.0 * edge)
                             .size()) >
                   kMuchFiner *
                       static_cast<double>(
                           curves::sample_parameters(curve.shape, edge).size());
      });
}

}  // namespace meniscus::films
