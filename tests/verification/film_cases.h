/// What the films' verification tests share: settle a start, measure it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <fmt/core.h>

#include "core/geometry/edge_key.h"
#include "evolve/groom/refine.h"
#include "evolve/settle/find_equilibrium.h"

namespace meniscus::test_films {

struct Found {
  films::FilmComplex complex;
  settle::FilmState state;

  const settle::FilmReport& report() const { return state.report; }
  double pressure(int body = 0) const {
    return state.report.bodies[body].pressure;
  }
};

/// The engine without a recipe: residual 1e-10 tension x mean edge.
inline Found settled(films::FilmComplex start, int refinements) {
  settle::FindOptions options;
  options.refinements = refinements;
  options.settle.residual_factor = 1e-10;
  Found found{std::move(start), {}};
  found.state = settle::find_equilibrium(found.complex, options);
  return found;
}

/// `start` refined before the engine sees it, as a user's own mesh would be.
inline films::FilmComplex raw_fine(films::FilmComplex start, int refinements) {
  for (int k = 0; k < refinements; ++k) {
    start = groom::refine(start).complex;
  }
  return start;
}

/// Angles between the films at the edges where three meet, against 120.
struct TripleAngles {
  int edges = 0;
  double worst = 0.0;  // largest departure from 120 [degree]
  double mean = 0.0;   // mean absolute departure [degree]
};

inline TripleAngles triple_angles(const films::FilmComplex& complex) {
  const SurfaceMesh& mesh = complex.mesh;
  std::map<Edge, std::vector<Vec3>> arms;  // conormals at an edge
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (!complex.surfaces[mesh.facet_label[f]].liquid) {
      continue;
    }
    const Triangle& t = mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      const Vec3 along = (mesh.points[b] - mesh.points[a]).normalized();
      Vec3 arm = mesh.points[t[(k + 2) % 3]] - mesh.points[a];
      arm -= arm.dot(along) * along;
      arms[edge_key(a, b)].push_back(arm.normalized());
    }
  }
  TripleAngles result;
  for (const auto& [edge, arm] : arms) {
    if (arm.size() != 3) {
      continue;
    }
    ++result.edges;
    for (int k = 0; k < 3; ++k) {
      const double cosine = arm[k].dot(arm[(k + 1) % 3]);
      const double off = std::abs(std::acos(std::clamp(cosine, -1.0, 1.0)) *
                                      180.0 / std::numbers::pi -
                                  120.0);
      result.worst = std::max(result.worst, off);
      result.mean += off;
    }
  }
  result.mean /= std::max(1, 3 * result.edges);
  return result;
}

/// Rates of an error over nested refinements, log2 of neighbours' ratios.
inline std::vector<double> rates(const std::vector<double>& errors) {
  std::vector<double> result;
  for (std::size_t k = 1; k < errors.size(); ++k) {
    result.push_back(std::log2(std::abs(errors[k - 1] / errors[k])));
  }
  return result;
}

}  // namespace meniscus::test_films
