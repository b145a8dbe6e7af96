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

using Coefficients = Eigen::Matrix<double, kTerms, 6>;

/// Solves the leading `Terms` equations for `right`, the other rows 0; false
/// when they are nearly singular.
template <int Terms>
bool solve(const Normal& normal, const Coefficients& right,
           Coefficients& solution) {
  Eigen::Matrix<double, Terms, Terms> A;
  for (int i = 0; i < Terms; ++i) {
    for (int j = i; j < Terms; ++j) {
      A(j, i) = normal.at(i, j);  // the factor reads the lower half
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
  const Eigen::Matrix<double, Terms, 6> B = right.template topRows<Terms>();
  solution.setZero();
  solution.template topRows<Terms>() = factor.solve(B);
  return true;
}

/// By the highest degree that the points determine well: quadratic, linear,
/// then the mean. The leading block of the sums is the system of a lower
/// degree.
void solve_best(const Normal& normal, int degree, bool single,
                const Coefficients& right, Coefficients& solution) {
  constexpr int kLinear = 4;
  const bool alone = single && normal.samples() == kLinear;
  if (degree == 2 && normal.samples() >= 2 * kTerms &&
      solve<kTerms>(normal, right, solution)) {
    return;
  }
  if ((normal.samples() >= 2 * kLinear || alone) &&
      solve<kLinear>(normal, right, solution)) {
    return;
  }
  solve<1>(normal, right, solution);
}

/// The root of a sample's weight, y from the centre; nothing out of reach.
std::optional<double> root_of_weight(const Vec3& y,
                                     const PatchOptions& options) {
  if (!options.reach || !(*options.reach > 0.0)) {
    return 1.0;
  }
  const double d = y.squaredNorm() / (*options.reach * *options.reach);
  if (d >= 1.0) {
    return std::nullopt;
  }
  return (1.0 - d) * (1.0 - d);
}

/// Normal equations P^T W P a = P^T W s over the integration points, as in
/// patch recovery (Zienkiewicz, Zhu 1992); sqrt(W) scales the rows.
Normal normal_of(const element::PointStress& points,
                 std::span<const int> elements, const StressPatch& patch,
                 const PatchOptions& options) {
  Normal normal;
  const double scale = 1.0 / patch.size;
  for (const int e : elements) {
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      const Vec3 y = points.position[at] - patch.centre;
      const std::optional<double> root = root_of_weight(y, options);
      if (!root) {
        continue;
      }
      Row row = sample(y * scale, points.stress[at]);
      for (double& term : row) {
        term *= *root;
      }
      normal.add(row);
    }
  }
  normal.finish();
  return normal;
}

/// The derivative of v . (the terms at y) by y.
Vec3 slope_of_terms(const Vec3& y, const Eigen::Matrix<double, kTerms, 1>& v) {
  return {v[1] + 2.0 * y.x() * v[4] + y.y() * v[7] + y.z() * v[9],
          v[2] + 2.0 * y.y() * v[5] + y.x() * v[7] + y.z() * v[8],
          v[3] + 2.0 * y.z() * v[6] + y.y() * v[8] + y.x() * v[9]};
}

using StressMap = Eigen::Map<const Eigen::Matrix<double, 6, 1>>;

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
  const Normal normal = normal_of(points, elements, patch, options);
  Coefficients right;
  for (int i = 0; i < kTerms; ++i) {
    for (int k = 0; k < 6; ++k) {
      right(i, k) = normal.at(i, kTerms + k);
    }
  }
  solve_best(normal, options.degree, elements.size() == 1, right,
             patch.coefficient);
  return patch;
}

PatchValueCovector transpose_value(const StressPatch& patch, const Vec3& x,
                                   const element::Stress& by_value) {
  const Vec3 y = (x - patch.centre) / patch.size;
  const Row row = sample(y, element::Stress{});
  const StressMap g(by_value.data());
  PatchValueCovector result;
  result.coefficient.noalias() =
      Eigen::Map<const Eigen::Matrix<double, kTerms, 1>>(row.data()) *
      g.transpose();
  result.x = slope_of_terms(y, patch.coefficient * g) / patch.size;
  return result;
}

FitCovector transpose_fit(const element::PointStress& points,
                          std::span<const int> elements,
                          const StressPatch& patch, const PatchOptions& options,
                          const Coefficients& by_coefficient) {
  // With N = P^T W P the number moves by B : (P^T W ds + d(P^T W) s - dN a), B
  // = N^-1 times what it changes by a; r = s - P a is what the fit leaves.
  const Normal normal = normal_of(points, elements, patch, options);
  Coefficients B = Coefficients::Zero();
  solve_best(normal, options.degree, elements.size() == 1, by_coefficient, B);
  FitCovector result;
  const double scale = 1.0 / patch.size;
  for (const int e : elements) {
    for (int q = 0; q < points.points_per_element; ++q) {
      FitCovector::Sample by{.point = points.index(e, q)};
      const Vec3 y = points.position[by.point] - patch.centre;
      const std::optional<double> root = root_of_weight(y, options);
      if (!root) {
        continue;
      }
      const double weight = *root * *root;
      const Row row = sample(y * scale, element::Stress{});
      const Eigen::Map<const Eigen::Matrix<double, kTerms, 1>> P(row.data());
      const Eigen::Matrix<double, 6, 1> b = B.transpose() * P;
      const Eigen::Matrix<double, 6, 1> r =
          StressMap(points.stress[by.point].data()) -
          patch.coefficient.transpose() * P;
      for (int k = 0; k < 6; ++k) {
        by.stress[k] = weight * b[k];
      }
      by.position = weight * scale *
                    slope_of_terms(y * scale, B * r - patch.coefficient * b);
      if (options.reach && *options.reach > 0.0) {
        // weight = (1 - d)^4, d = |y / reach|^2.
        const double reach = *options.reach;
        const double d = y.squaredNorm() / (reach * reach);
        const double by_d = -4.0 * std::pow(1.0 - d, 3) * b.dot(r);
        by.position += by_d * 2.0 / (reach * reach) * y;
        result.reach -= by_d * 2.0 * d / reach;
      }
      result.centre -= by.position;
      result.samples.push_back(by);
    }
  }
  return result;
}

}  // namespace meniscus::stress
