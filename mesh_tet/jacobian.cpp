#include "mesh_tet/jacobian.h"

#include <algorithm>
#include <numeric>

#include <Eigen/LU>

namespace meniscus::mesh_tet {

namespace {

/// Bernstein coefficients of the determinant: the coefficient of
/// lambda_i lambda_j lambda_k is the mean of det[a_i b_j c_k] over the
/// distinct orders of i, j, k. The four corner values are among them.
std::array<double, 20> bernstein(const CornerJacobians& jacobians) {
  std::array<double, 20> sum{};
  std::array<int, 20> count{};
  const auto slot = [](int i, int j, int k) {
    constexpr std::array<int, 4> kDigit = {1, 4, 16, 64};
    return kDigit[i] + kDigit[j] + kDigit[k];
  };
  static const std::array<int, 193> kIndex = [&] {
    std::array<int, 193> index;
    index.fill(-1);
    int next = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j) {
        for (int k = j; k < 4; ++k) {
          index[slot(i, j, k)] = next++;
        }
      }
    }
    return index;
  }();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Vec3 normal = jacobians[i].col(0).cross(jacobians[j].col(1));
      for (int k = 0; k < 4; ++k) {
        const int at = kIndex[slot(i, j, k)];
        sum[at] += normal.dot(jacobians[k].col(2));
        ++count[at];
      }
    }
  }
  for (int n = 0; n < 20; ++n) {
    sum[n] /= count[n];
  }
  return sum;
}

/// The eight parts that halving every edge gives: four at the corners, four
/// around the diagonal between the mid-sides (01) and (23).
std::array<CornerJacobians, 8> split(const CornerJacobians& j) {
  const auto half = [&](int a, int b) -> Mat3 { return 0.5 * (j[a] + j[b]); };
  const Mat3 m01 = half(0, 1);
  const Mat3 m02 = half(0, 2);
  const Mat3 m03 = half(0, 3);
  const Mat3 m12 = half(1, 2);
  const Mat3 m13 = half(1, 3);
  const Mat3 m23 = half(2, 3);
  return {{{j[0], m01, m02, m03},
           {j[1], m01, m12, m13},
           {j[2], m02, m12, m23},
           {j[3], m03, m13, m23},
           {m01, m23, m02, m03},
           {m01, m23, m03, m13},
           {m01, m23, m13, m12},
           {m01, m23, m12, m02}}};
}

}  // namespace

CornerJacobians corner_jacobians(const std::array<Vec3, 10>& x) {
  // Derivatives of the ten shape functions along the edges from corner 0, at
  // corner c. Corner function i: lambda_i (2 lambda_i - 1), mid-side (i, j):
  // 4 lambda_i lambda_j.
  constexpr std::array<std::array<int, 4>, 4> kMid = {
      {{-1, 4, 6, 7}, {4, -1, 5, 8}, {6, 5, -1, 9}, {7, 8, 9, -1}}};
  CornerJacobians jacobians;
  for (int c = 0; c < 4; ++c) {
    // g_i = derivative by lambda_i at corner c, the lambdas taken as free.
    std::array<Vec3, 4> g;
    for (int i = 0; i < 4; ++i) {
      g[i] = i == c ? Vec3(3.0 * x[c]) : Vec3(4.0 * x[kMid[c][i]] - x[i]);
    }
    for (int k = 0; k < 3; ++k) {
      jacobians[c].col(k) = g[k + 1] - g[0];
    }
  }
  return jacobians;
}

double mean_determinant(const CornerJacobians& jacobians) {
  const auto b = bernstein(jacobians);
  return std::accumulate(b.begin(), b.end(), 0.0) / 20.0;
}

bool determinant_above(const CornerJacobians& jacobians, double bound,
                       int depth) {
  for (const Mat3& j : jacobians) {
    if (!(j.determinant() > bound)) {
      return false;
    }
  }
  const auto b = bernstein(jacobians);
  if (*std::min_element(b.begin(), b.end()) > bound) {
    return true;
  }
  if (depth == 0) {
    return false;
  }
  const auto parts = split(jacobians);
  return std::all_of(parts.begin(), parts.end(), [&](const auto& part) {
    return determinant_above(part, bound, depth - 1);
  });
}

}  // namespace meniscus::mesh_tet
