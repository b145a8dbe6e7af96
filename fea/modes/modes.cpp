#include "fea/modes/modes.h"

#include <cmath>

#include <fmt/format.h>

#include "core/timer.h"
#include "fea/equations/elastic_checks.h"
#include "fea/equations/elastic_operator.h"
#include "fea/modes/eigen_shapes.h"
#include "fea/modes/eigenpairs.h"
#include "fea/modes/shifted_system.h"
#include "fea/supports/held_check.h"

namespace meniscus::modes {

namespace {

constexpr double kPi = 3.14159265358979323846;
/// omega^2 over the shift: below this a motion is rigid. Rounding leaves 1e-12
/// there, a slender part's lowest bending some 1e-3.
constexpr double kRigid = 1e-7;

/// Modes of parts that supports leave free do not know rigid pins.
void refuse_pins(const loads::LoadCase& load_case) {
  if (!load_case.pins.empty()) {
    throw InvalidInput(fmt::format(
        "load case '{}': natural frequencies of a part that supports leave "
        "free do not know rigid pins ('{}'); build an ElasticModel of it",
        load_case.name, load_case.pins.front().surfaces.text()));
  }
}

std::vector<double> densities(const TetMesh& mesh,
                              const std::vector<element::Material>& materials) {
  std::vector<double> density;
  density.reserve(materials.size());
  for (const element::Material& material : materials) {
    density.push_back(material.density);
  }
  for (const int region : mesh.element_region) {
    if (!(density[region] > 0.0)) {
      throw InvalidInput(
          fmt::format("natural frequencies: material '{}' of region {} has "
                      "density {}; give its mass per volume",
                      materials[region].name, region, density[region]));
    }
  }
  return density;
}

void check_modes(const ModeOptions& options) {
  if (options.count < 1 || !(options.tolerance > 0.0) ||
      options.max_iterations < 1) {
    throw InvalidInput(fmt::format(
        "natural frequencies: count is {}, tolerance {}, max_iterations {}; "
        "all must be above 0",
        options.count, options.tolerance, options.max_iterations));
  }
}

/// The operator's K is shifted by shift M.
struct Shifted {
  double shift = 0.0;
  solver::Columns start;  // motions that supports leave
  int rigid = 0;          // of these, how many springs leave too
};

NaturalModes solve(const TetMesh& mesh, const equations::ElasticOperator& op,
                   const Shifted& shifted, const ModeOptions& options) {
  const Timer timer;
  check_modes(options);
  const solver::NodalMatrix M = solver::mass_matrix(
      *op.table, op.x, densities(mesh, op.materials), options.mass);
  const EigenPairs pairs = eigenpairs_of(
      op, M, start_columns(*op.order, shifted.start, options.start),
      {.count = options.count + shifted.rigid,
       .tolerance = options.tolerance,
       .max_iterations = options.max_iterations,
       .monitor = options.monitor},
      options.may_factor);
  NaturalModes modes;
  modes.failure = why_not(pairs, "natural frequencies");
  modes.iterations = pairs.iterations;
  for (Eigen::Index k = 0; k < pairs.theta.size(); ++k) {
    const double square = 1.0 / pairs.theta[k] - shifted.shift;
    if (k < shifted.rigid && square < kRigid * shifted.shift) {
      ++modes.rigid_motions;
      continue;
    }
    modes.frequencies.push_back(std::sqrt(square) / (2.0 * kPi));
    modes.residuals.push_back(pairs.residuals[k]);
    modes.shapes.push_back(with_fixed_sign(equations::to_mesh(
        *op.order, pairs.x.col(k) / std::sqrt(pairs.theta[k]))));
  }
  modes.seconds = timer.seconds();
  return modes;
}

}  // namespace

NaturalModes natural_modes(const elastic::ElasticModel& model,
                           const TetMesh& mesh,
                           const std::vector<loads::LoadCase>& load_cases,
                           int load_case, const ModeOptions& options) {
  const Timer timer;
  const equations::ElasticOperator op =
      model.operator_at(mesh, load_cases, load_case, options.materials);
  const loads::LoadCase& held = load_cases[load_case];
  if (held.pins.empty() &&
      (!held.springs.empty() || !held.node_springs.empty()) &&
      supports::free_motions(mesh, supports::held_directions(mesh, held))
              .cols() > 0) {
    return natural_modes(mesh, op.materials, held, options);
  }
  NaturalModes modes = solve(mesh, op, {}, options);
  modes.seconds = timer.seconds();
  return modes;
}

NaturalModes natural_modes(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const loads::LoadCase& held,
                           const ModeOptions& options) {
  const Timer timer;
  refuse_pins(held);
  const ShiftedSystem system(mesh, materials, held);
  NaturalModes modes = solve(mesh, system.shifted(),
                             {.shift = system.shift(),
                              .start = system.free_motions(),
                              .rigid = system.unsprung_motions()},
                             options);
  modes.seconds = timer.seconds();
  return modes;
}

}  // namespace meniscus::modes
