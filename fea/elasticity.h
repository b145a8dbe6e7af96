/// Linear static elasticity on tetrahedra.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "core/tet_mesh.h"

namespace meniscus {

struct Material {
  std::string name;
  double youngs_modulus = 0.0;           // [pressure], > 0
  double poisson_ratio = 0.0;            // -1 < nu < 0.5
  double density = 0.0;                  // [mass/length^3], >= 0
  std::optional<double> yield_strength;  // [pressure]
};

/// Fixes components of displacement on a surface.
struct Support {
  std::string surface;
  bool fix_x = false, fix_y = false, fix_z = false;
};

/// A total force spread as uniform traction over a surface [force].
struct SurfaceForce {
  std::string surface;
  Vec3 total = Vec3::Zero();
};

/// Pressure on a surface, positive into the solid [pressure].
struct SurfacePressure {
  std::string surface;
  double pressure = 0.0;
};

struct LoadCase {
  std::string name;
  std::vector<Support> supports;
  std::vector<SurfaceForce> forces;
  std::vector<SurfacePressure> pressures;
};

/// Consistent weights of a surface: integral of each node's shape function
/// over it, by the three-point rule (CalculiX's own for C3D10) [length^2].
struct SurfaceWeights {
  std::vector<int> nodes;  // ascending
  VectorX weights;         // one per node; their sum is the surface's area
};
SurfaceWeights surface_weights(const TetMesh& mesh, const std::string& surface);

/// Nodal forces of a load case, 3 per node [force]. Throws InvalidInput for a
/// surface that the mesh does not have.
VectorX nodal_forces(const TetMesh& mesh, const LoadCase& load_case);

/// Area-weighted mean displacement of a surface along `direction` (made unit).
double mean_displacement(const TetMesh& mesh, const std::string& surface,
                         const Vec3& direction, const VectorX& displacement);

struct ElasticReport {
  int dofs = 0;                     // free unknowns
  std::string solver;               // "p-multigrid", "cholmod"
  int iterations = 0;               // of the last load case
  double residual = 0.0;            // relative, largest over load cases
  double strain_energy = 0.0;       // of the first load case [force length]
  double reaction_imbalance = 0.0;  // |reactions + loads| / |loads|
  double setup_seconds = 0.0;
  double solve_seconds = 0.0;
  double stress_seconds = 0.0;
};

/// Nodal displacement [length], 3 per node, per load case; reactions [force].
struct ElasticSolution {
  std::vector<VectorX> displacements;
  std::vector<VectorX> reactions;
  ElasticReport report;
  std::optional<Failure> failure;
};

enum class SolverKind { Automatic, Cholesky, Multigrid };

struct ElasticOptions {
  SolverKind solver = SolverKind::Automatic;
  double tolerance = 1e-10;  // relative residual of the solve
  int max_iterations = 400;
  Monitor* monitor = nullptr;
};

/// The elasticity of one mesh topology. Built once at the base design:
/// sparsity, orderings, coarse Cholesky factor and smoother. solve() then
/// assembles the stiffness of any mesh of the same topology and solves it by
/// conjugate gradients preconditioned with the base's factors, from the base's
/// solution: a pure function of (base, mesh).
class ElasticModel {
 public:
  /// `materials`: one per region of the mesh. Throws InvalidInput (Poisson's
  /// ratio, unknown surface, no support) and SolverError (supports too weak:
  /// names the free motion).
  ElasticModel(const TetMesh& base, std::vector<Material> materials,
               std::vector<LoadCase> load_cases,
               const ElasticOptions& options = {});
  ~ElasticModel();
  ElasticModel(ElasticModel&&) noexcept;
  ElasticModel& operator=(ElasticModel&&) noexcept;

  /// The base mesh's own solution.
  const ElasticSolution& base_solution() const;

  ElasticSolution solve(const TetMesh& mesh) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Stress by averaging element extrapolations at nodes (volume-weighted).
/// Six components per node: xx yy zz xy yz zx [pressure].
struct StressField {
  std::vector<std::array<double, 6>> nodal;
  std::vector<double> von_mises;  // per node [pressure]
  double max_von_mises = 0.0;
  int max_node = 0;
};
StressField recover_stress(const TetMesh& mesh,
                           const std::vector<Material>& materials,
                           const VectorX& displacement);

/// Volume [length^3] and mass [mass] by quadrature on curved elements.
double mesh_volume(const TetMesh& mesh);
double mesh_mass(const TetMesh& mesh, const std::vector<Material>& materials);

}  // namespace meniscus
