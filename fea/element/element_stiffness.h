/// The stiffness of one element, block by block: for whoever assembles it, here
/// or in another process.
#pragma once

#include <array>

#include "fea/element/elastic_law.h"
#include "fea/element/tet_element.h"

namespace meniscus::element {

namespace element {

/// Width of a padded row of the element's outer products: whole AVX vectors.
template <int Nodes>
constexpr int kPadded = (3 * Nodes + 3) / 4 * 4;

/// G = sum over points of V h h^T, h the gradients of all nodes in ascending
/// order, one after another.
template <int Nodes>
void outer_products(const TetGradients<Nodes>& g, const unsigned char* slot,
                    double (*G)[kPadded<Nodes>]) {
  constexpr int kPoints = kTetPoints<Nodes>;
  alignas(32) double h[kPoints][kPadded<Nodes>] = {};
  for (int q = 0; q < kPoints; ++q) {
    for (int a = 0; a < Nodes; ++a) {
      for (int k = 0; k < 3; ++k) {
        h[q][3L * slot[a] + k] = g.gradient[q][a][k];
      }
    }
  }
  for (int r = 0; r < 3 * Nodes; ++r) {
    double s[kPoints];
    for (int q = 0; q < kPoints; ++q) {
      s[q] = g.volume[q] * h[q][r];
    }
    for (int c = 0; c < kPadded<Nodes>; ++c) {
      double sum = s[0] * h[0][c];
      for (int q = 1; q < kPoints; ++q) {
        sum += s[q] * h[q][c];
      }
      G[r][c] = sum;
    }
  }
}

/// block += lambda G_ab + mu G_ab^T + mu tr(G_ab) I.
template <int Width>
inline void add_stiffness(const double (*G)[Width], int a, int b, const Lame& m,
                          double* block) {
  const double* g0 = G[3L * a] + 3L * b;
  const double* g1 = g0 + Width;
  const double* g2 = g1 + Width;
  const double d = m.mu * (g0[0] + g1[1] + g2[2]);
  const double both = m.lambda + m.mu;
  block[0] += both * g0[0] + d;
  block[1] += m.lambda * g0[1] + m.mu * g1[0];
  block[2] += m.lambda * g0[2] + m.mu * g2[0];
  block[3] += m.lambda * g1[0] + m.mu * g0[1];
  block[4] += both * g1[1] + d;
  block[5] += m.lambda * g1[2] + m.mu * g2[1];
  block[6] += m.lambda * g2[0] + m.mu * g0[2];
  block[7] += m.lambda * g2[1] + m.mu * g1[2];
  block[8] += both * g2[2] + d;
}

/// block += C : G_ab, see ElasticLaw::tensor.
template <int Width>
inline void add_stiffness(const double (*G)[Width], int a, int b,
                          const ElasticLaw& m, double* block) {
  double g[9];
  for (int j = 0; j < 3; ++j) {
    for (int l = 0; l < 3; ++l) {
      g[3 * j + l] = G[3L * a + j][3L * b + l];
    }
  }
  const double* row = m.tensor.data();
  for (int k = 0; k < 9; ++k, row += 9) {
    double sum = 0.0;
    for (int c = 0; c < 9; ++c) {
      sum += row[c] * g[c];
    }
    block[k] += sum;
  }
}

}  // namespace element

/// Adds K_ab = sum over points of V (lambda g_a g_b^T + mu g_b g_a^T +
/// mu g_a . g_b I), or C g_a g_b^T where the law is not isotropic, to the nine
/// numbers (row-major) [force/length] at place(a, b), for all b <= a. `x`: the
/// nodes in TetMesh's order; `slot`: a and b of each, a permutation. False, and
/// nothing added, when the Jacobian determinant is not positive at a point.
template <int Nodes, class Place>
bool add_element_stiffness(const std::array<Vec3, Nodes>& x,
                           const unsigned char* slot, const ElasticLaw& law,
                           const Place& place) {
  TetGradients<Nodes> g;
  if (!tet_gradients<Nodes>(x, g)) {
    return false;
  }
  alignas(32) double G[3 * Nodes][element::kPadded<Nodes>];
  element::outer_products<Nodes>(g, slot, G);
  const auto add_all = [&](const auto& constants) {
    for (int a = 0; a < Nodes; ++a) {
      for (int b = 0; b <= a; ++b) {
        element::add_stiffness(G, a, b, constants, place(a, b));
      }
    }
  };
  if (law.isotropic) {
    add_all(law.lame);
  } else {
    add_all(law);
  }
  return true;
}

}  // namespace meniscus::element
