/// What every elastic model keeps of its base design, whoever solves it, and
/// what it makes of a solution.
#pragma once

#include <string>
#include <vector>

#include "fea/equations/elastic_solution.h"
#include "fea/solver/assembly.h"
#include "fea/solver/conjugate_gradients.h"
#include "fea/solver/node_order.h"
#include "fea/supports/restraints.h"

namespace meniscus::equations {

/// What the regions of a mesh are made of, and the laws of that.
struct RegionMaterials {
  std::vector<element::Material> materials;
  std::vector<element::ElasticLaw> laws;
};

struct ElasticBase {
  /// Checks the input as ElasticModel states. `order`: of `mesh`, to be set
  /// once the mesh has been checked.
  ElasticBase(const TetMesh& mesh, const std::vector<element::Material>& given,
              const std::vector<loads::LoadCase>& load_cases,
              const ElasticOptions& chosen);

  /// Throws InvalidInput unless elements, faces, names, supports and pins are
  /// the base's; what these are held at, and where pins' points are, may move.
  void check_same(const TetMesh& mesh,
                  const std::vector<loads::LoadCase>& load_cases) const;

  /// Nodes in the solver's order.
  Points solver_points(const TetMesh& mesh) const;
  /// Nodal forces of every load case, in the solver's order [force].
  std::vector<VectorX> solver_forces(
      const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
      const std::vector<element::Material>& materials) const;
  /// Checks materials of a design; as many as the base's.
  RegionMaterials of_design(
      const TetMesh& mesh,
      const std::vector<element::Material>& materials) const;
  /// Elements and regions in the solver's order, as make_element_table and
  /// make_element_list take them.
  std::vector<int> solver_elements(const TetMesh& mesh) const;
  std::vector<int> solver_regions(const TetMesh& mesh) const;

  /// A node that is not finite.
  std::optional<Failure> bad_node(const TetMesh& mesh) const;
  /// Of an element (solver's) with a Jacobian that is not positive.
  Failure inverted(const TetMesh& mesh, int element) const;
  /// The restraints of `load_case` turned against the base's.
  static Failure turned(const loads::LoadCase& load_case);

  ElasticOptions options;
  RegionMaterials regions;
  std::vector<int> elements;  // the base's, to compare
  std::vector<int> faces;
  std::vector<loads::LoadCase> held;  // the base's, without what acts on them
  solver::NodeOrder order;
};

/// Load cases that are held alike, by index.
struct HeldCases {
  std::vector<int> cases;
  supports::Restraints restraints;
};

/// Throws what check_restraints throws.
std::vector<HeldCases> group_alike(
    const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
    const solver::NodeOrder& order);

/// One solution, in the solver's numbering, 3 per node.
struct SolvedCase {
  int load_case = 0;  // index
  const std::string& name;
  const Points& x;
  const VectorX& f;         // loads [force]
  const VectorX& u;         // [length]
  const VectorX& diagonal;  // of the stiffness [force/length]
  const std::vector<element::ElasticLaw>& laws;
  const supports::Restraints& restraints;
  const solver::CgColumn& column;
  bool enforced = false;  // something is held at another place than 0
};

/// Puts displacement, reactions and figures into `result`; where the solver
/// did not converge, or loads are not carried, a failure if it has none yet.
void finish_solution(const ElasticBase& base, const solver::ElementTable& table,
                     const SolvedCase& solved, ElasticSolution& result);

}  // namespace meniscus::equations
