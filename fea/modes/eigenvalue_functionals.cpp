#include "fea/modes/eigenvalue_functionals.h"

#include <cmath>
#include <numbers>

namespace meniscus::modes {

namespace {

void add_points(double factor, const Points& more, Points& sum) {
  for (std::size_t i = 0; i < more.size(); ++i) {
    sum[i] += factor * more[i];
  }
}

void add_numbers(double factor, const std::vector<double>& more,
                 std::vector<double>& sum) {
  for (std::size_t r = 0; r < more.size(); ++r) {
    sum[r] += factor * more[r];
  }
}

/// A functional of a mesh with nothing in it yet.
void clear(const TetMesh& mesh, std::size_t regions,
           const loads::LoadCase& held, ModeFunctional& result) {
  result.by_pin_point.assign(held.pins.size(), Vec3::Zero());
  result.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
  result.by_modulus.assign(regions, 0.0);
}

}  // namespace

ModeFunctional factor_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& u,
    const WeightedModes& modes) {
  ModeFunctional result;
  clear(mesh, materials.size(), load_case, result);
  result.by_displacement = VectorX::Zero(u.size());
  for (std::size_t k = 0; k < modes.values.size(); ++k) {
    const double weight = modes.weights[static_cast<Eigen::Index>(k)];
    if (weight == 0.0) {
      continue;
    }
    const double factor = modes.values[k];
    const VectorX& x = modes.shapes[k];
    const element::Functional geometric =
        geometric_work(mesh, materials, load_case, u, x);
    const ModeFunctional stiffness = stiffness_work(
        mesh, materials, load_case, x,
        buckling_reactions(mesh, materials, load_case, u, factor, x));
    const double by_stiffness = -weight / geometric.value;
    const double by_geometric = factor * by_stiffness;
    result.value += weight * factor;
    add_points(by_stiffness, stiffness.by_nodes, result.by_nodes);
    add_points(by_stiffness, stiffness.by_pin_point, result.by_pin_point);
    add_points(by_geometric, geometric.by_nodes, result.by_nodes);
    add_numbers(by_stiffness, stiffness.by_modulus, result.by_modulus);
    add_numbers(by_geometric, geometric.by_modulus, result.by_modulus);
    result.by_displacement += by_geometric * geometric.by_displacement;
    if (geometric.by_temperature.size() > 0) {
      result.by_temperature.conservativeResizeLike(
          VectorX::Zero(geometric.by_temperature.size()));
      result.by_temperature += by_geometric * geometric.by_temperature;
    }
  }
  return result;
}

ModeFunctional frequency_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& held, const WeightedModes& modes) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  ModeFunctional result;
  clear(mesh, materials.size(), held, result);
  result.by_density.assign(materials.size(), 0.0);
  for (std::size_t k = 0; k < modes.values.size(); ++k) {
    const double weight = modes.weights[static_cast<Eigen::Index>(k)];
    if (weight == 0.0) {
      continue;
    }
    const double frequency = modes.values[k];
    const double square = std::pow(kTurn * frequency, 2);
    const VectorX& x = modes.shapes[k];
    const ModeFunctional inertia = inertia_work(mesh, materials, x);
    const ModeFunctional stiffness =
        stiffness_work(mesh, materials, held, x,
                       vibration_reactions(mesh, materials, square, x));
    // df = d omega^2 / (2 (2 pi)^2 f).
    const double by_stiffness =
        weight / (2.0 * kTurn * kTurn * frequency * inertia.value);
    const double by_inertia = -square * by_stiffness;
    result.value += weight * frequency;
    add_points(by_stiffness, stiffness.by_nodes, result.by_nodes);
    add_points(by_stiffness, stiffness.by_pin_point, result.by_pin_point);
    add_points(by_inertia, inertia.by_nodes, result.by_nodes);
    add_numbers(by_stiffness, stiffness.by_modulus, result.by_modulus);
    add_numbers(by_inertia, inertia.by_density, result.by_density);
  }
  return result;
}

}  // namespace meniscus::modes
