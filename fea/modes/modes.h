/// Natural frequencies: K x = omega^2 M x with the consistent mass matrix.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "fea/elastic/elasticity.h"
#include "fea/solver/nodal_matrix.h"

namespace meniscus::modes {

struct ModeOptions {
  int count = 6;            // lowest elastic modes
  double tolerance = 1e-6;  // residual of each mode, see eigenpairs.h;
                            // omega^2 is off by about its square
  int max_iterations = 200;
  solver::MassRule mass = solver::MassRule::Exact;
  Monitor* monitor = nullptr;  // not owned
  /// Of the design, one per region, not owned; null: those of the model's base.
  const std::vector<element::Material>* materials = nullptr;
  /// Shapes of another design of the same mesh to begin with, not owned.
  const std::vector<VectorX>* start = nullptr;
  bool may_factor = false;  // see eigenpairs_of()
};

struct NaturalModes {
  /// Of the elastic modes, ascending [1/time], in the time unit that goes with
  /// force, length and mass.
  std::vector<double> frequencies;
  /// Per mode, 3 per node: x^T M x = 1; the first of the largest components is
  /// positive [1/sqrt(mass)].
  std::vector<VectorX> shapes;
  std::vector<double> residuals;  // relative, per mode
  int rigid_motions = 0;          // of frequency 0, not among `frequencies`
  int iterations = 0;
  double seconds = 0.0;
  std::optional<Failure> failure;  // no convergence; what there is, is kept
};

/// With the supports and springs of load case `load_case` (index; its loads do
/// not matter), by the model's own preconditioner. Throws what
/// ElasticModel::operator_at() throws, InvalidInput for options out of range
/// and for a material without density.
NaturalModes natural_modes(const elastic::ElasticModel& model,
                           const TetMesh& mesh,
                           const std::vector<loads::LoadCase>& load_cases,
                           int load_case, const ModeOptions& options = {});

/// Without a model; supports may leave rigid motions or be missing: the
/// stiffness is then shifted by a multiple of the mass, and motions that
/// springs do not resist either are counted. `held`: its loads are not read.
/// Throws InvalidInput and MeshError as ElasticModel does.
NaturalModes natural_modes(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const loads::LoadCase& held,
                           const ModeOptions& options = {});

}  // namespace meniscus::modes
