#include "evolve/settle/contacts.h"

#include <algorithm>

#include <Eigen/Core>

#include "core/math/dense.h"

namespace meniscus::settle {

namespace {

constexpr double kThrough = 1e-10;  // of the film's size, still on the wall

double side_sign(const films::LevelSet& wall) {
  return wall.side == films::LevelSet::Side::AtLeast ? 1.0 : -1.0;
}

}  // namespace

bool has_contacts(const films::FilmComplex& complex) {
  return std::any_of(complex.level_sets.begin(), complex.level_sets.end(),
                     [](const films::LevelSet& wall) {
                       return wall.side != films::LevelSet::Side::On;
                     });
}

int update_contacts(films::FilmComplex& complex,
                    const energy::FilmEnergy& energy, const VectorX& pressure) {
  // Slope of the Lagrangian, E_x - sum p V_x: the force that walls have to
  // bear.
  Points slope =
      energy.gradient(complex.mesh.points, energy::targets_of(complex));
  for (int b = 0; b < energy.functionals(); ++b) {
    const Points more = energy.functional_gradient(complex.mesh.points, b);
    for (std::size_t v = 0; v < slope.size(); ++v) {
      slope[v] -= pressure[b] * more[v];
    }
  }
  const double size = bounding_diagonal(complex.mesh.points);
  int changed = 0;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    films::ComplexVertex& vertex = complex.vertices[v];
    if (vertex.kind != films::VertexKind::Free || vertex.constraints < 0) {
      continue;
    }
    const auto& set = complex.constraint_sets[vertex.constraints];
    // Wall gradients at the vertex, and the distances to the walls to first
    // order, phi / |grad phi|.
    Eigen::MatrixX3d rows(static_cast<Eigen::Index>(set.size()), 3);
    std::vector<double> value;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const PlaceJet jet =
          jet_at(complex.level_sets[set[i]].formula, complex.mesh.points[v]);
      rows.row(static_cast<Eigen::Index>(i)) = jet.gradient;
      value.push_back(jet.value / std::max(1e-300, jet.gradient.norm()));
    }
    // Multipliers of the walls as least-norm forces that balance the slope.
    // Complementarity: a held vertex must be pushed against its wall, a free
    // one must not be through it.
    const VectorX push = least_norm(rows.transpose(), slope[v]);
    bool through = false;
    bool pulled = false;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const films::LevelSet& wall = complex.level_sets[set[i]];
      if (wall.side == films::LevelSet::Side::On) {
        continue;
      }
      const double sign = side_sign(wall);
      through = through || sign * value[i] < -kThrough * size;
      pulled = pulled || sign * push[static_cast<Eigen::Index>(i)] < 0.0;
    }
    // One step of an active set: hold what went through, let go what the film
    // pulls off.
    if (!vertex.held && through) {
      vertex.held = true;
      ++changed;
    } else if (vertex.held && pulled) {
      vertex.held = false;
      ++changed;
    }
  }
  if (changed > 0) {
    energy::FilmSpace(complex).project(complex.mesh.points);
  }
  return changed;
}

}  // namespace meniscus::settle
