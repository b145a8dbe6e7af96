#include "fea/stress/stress_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace meniscus::stress {

namespace {

constexpr int kTerms = StressPatch::kTerms;
constexpr int kWidth = 16;  // ten terms and six components: whole vectors

/// Cholesky pivots below this part of the largest: the points do not tell the
/// terms apart.
constexpr double kFlat = 1e-7;

/// Terms and stress of one sample, side by side.
using Row = std::array<double, kWidth>;

Row sample(const Vec3& y, const element::Stress& s) {
  return {1.0,           y.x(),         y.y(),         y.z(),
          y.x() * y.x(), y.y() * y.y(), y.z() * y.z(), y.x() * y.y(),
          y.y() * y.z(), y.z() * y.x(), s[0],          s[1],
          s[2],          s[3],          s[4],          s[5]};
}

/// P^T [P S] over all samples: normal matrix and right sides. Samples are
/// taken in batches, so that the sums stay in registers. Of the square part
/// only columns from the row's own vector on are right.
class Normal {
 public:
  void add(const Row& row) {
    batch_[samples_++ % kBatch] = row;
    if (samples_ % kBatch == 0) {
      flush();
    }
  }
  void finish() {
    if (samples_ % kBatch != 0) {
      std::fill(batch_.begin() + samples_ % kBatch, batch_.end(), Row{});
      flush();
    }
  }
  int samples() const { return samples_; }
  double at(int row, int column) const { return sum_[row][column]; }

 private:
  static constexpr int kBatch = 4;
  static constexpr int kVector = 4;

  /// Two rows at a time, so that each value read serves twice.
  template <int Row>
  void add_rows() {
    constexpr int kFirst = Row / kVector * kVector;
    for (int j = kFirst; j < kWidth; ++j) {
      double first = sum_[Row][j];
      double second = sum_[Row + 1][j];
      for (int q = 0; q < kBatch; ++q) {
        first += batch_[q][Row] * batch_[q][j];
        second += batch_[q][Row + 1] * batch_[q][j];
      }
      sum_[Row][j] = first;
      sum_[Row + 1][j] = second;
    }
  }
  template <int... Pairs>
  void add_pairs(std::integer_sequence<int, Pairs...>) {
    (add_rows<2 * Pairs>(), ...);
  }
  void flush() { add_pairs(std::make_integer_sequence<int, kTerms / 2>()); }

  alignas(64) double sum_[kTerms][kWidth] = {};
  alignas(64) std::array<Row, kBatch> batch_;
  int samples_ = 0;
};

/// Solves the leading `Terms` equations; false when they are nearly singular.
template <int Terms>
bool solve(const Normal& normal, StressPatch& patch) {
  Eigen::Matrix<double, Terms, Terms> A;
  Eigen::Matrix<double, Terms, 6> B;
  for (int i = 0; i < Terms; ++i) {
    for (int j = i; j < Terms; ++j) {
      A(j, i) = normal.at(i, j);  // the factor reads the lower half
    }
    for (int k = 0; k < 6; ++k) {
      B(i, k) = normal.at(i, kTerms + k);
    }
  }
  const Eigen::LLT<Eigen::Matrix<double, Terms, Terms>> factor(A);
  if (factor.info() != Eigen::Success) {
    return false;
  }
  const auto pivots = factor.matrixLLT().diagonal();
  if (!(pivots.minCoeff() * pivots.minCoeff() >
        kFlat * pivots.maxCoeff() * pivots.maxCoeff())) {
    return false;
  }
  patch.coefficient.setZero();
  patch.coefficient.template topRows<Terms>() = factor.solve(B);
  return true;
}

}  // namespace

element::Stress StressPatch::at(const Vec3& x) const {
  const Row row = sample((x - centre) / size, element::Stress{});
  element::Stress s{};
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < kTerms; ++i) {
      s[k] += row[i] * coefficient(i, k);
    }
  }
  return s;
}

StressPatch fit_patch(const element::PointStress& points,
                      std::span<const int> elements, const Vec3& centre,
                      const PatchOptions& options) {
  StressPatch patch;
  patch.coefficient.setZero();
  patch.centre = centre;
  // Coordinates over the patch's own size keep the terms of one magnitude.
  double reach = 0.0;
  for (const int e : elements) {
    for (int q = 0; q < points.points_per_element; ++q) {
      reach = std::max(
          reach, (points.position[points.index(e, q)] - centre).squaredNorm());
    }
  }
  patch.size = reach > 0.0 ? std::sqrt(reach) : 1.0;
  // Normal equations P^T W P a = P^T W s over the integration points, as in
  // patch recovery (Zienkiewicz, Zhu 1992); sqrt(W) scales the rows.
  Normal normal;
  const double scale = 1.0 / patch.size;
  for (const int e : elements) {
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      const Vec3 y = points.position[at] - centre;
      double root = 1.0;  // of the weight
      if (options.reach && *options.reach > 0.0) {
        const double d = y.squaredNorm() / (*options.reach * *options.reach);
        if (d >= 1.0) {
          continue;
        }
        root = (1.0 - d) * (1.0 - d);
      }
      Row row = sample(y * scale, points.stress[at]);
      for (double& term : row) {
        term *= root;
      }
      normal.add(row);
    }
  }
  normal.finish();
  // The highest degree that the points determine well: quadratic, linear, then
  // the mean. The leading block of the sums is the system of a lower degree.
  constexpr int kLinear = 4;
  const bool alone = elements.size() == 1 && normal.samples() == kLinear;
  if (options.degree == 2 && normal.samples() >= 2 * kTerms &&
      solve<kTerms>(normal, patch)) {
    return patch;
  }
  if ((normal.samples() >= 2 * kLinear || alone) &&
      solve<kLinear>(normal, patch)) {
    return patch;
  }
  solve<1>(normal, patch);
  return patch;
}

}  // namespace meniscus::stress
