/// A design's shells together with the solids that they stand on.
///
/// Vectors have the solid's 3 numbers per node and behind them the shell's 6,
/// as joint::JointSystem wants them.
#pragma once

#include <string>

#include "core/geometry/tet_mesh.h"
#include "fea/elastic/elasticity.h"
#include "pipeline/case_data/case.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

/// Ten-node elements of the solids, and behind their nodes those of the skin,
/// with its faces, behind which are no elements (-1).
TetMesh joint_mesh(const TetMesh& solid, const TetMesh& skin);

/// Of its films, their backs and rims.
bool is_of_shells(const ShellPart& part, const std::string& surface);

/// What of a load case is on solids, and what on shells; gravity and spin are
/// on both. Rates likewise.
loads::LoadCase on_solids(const ShellPart& part,
                          const loads::LoadCase& load_case);
loads::LoadCase on_shells(const ShellPart& part,
                          const loads::LoadCase& load_case);

/// Solves all load cases, those held alike with one factor; displacements are
/// of joint_mesh(). What can move is a failure. The part has solids.
equations::ElasticSolution solve_joint(const case_data::EvaluatedCase& inputs,
                                       ShellPart& part);

/// A functional's derivative by 3 numbers per node of joint_mesh(), or by the
/// shell's 6 alone, as one by both.
VectorX by_both(const ShellPart& part, const VectorX& by_displacement);

/// What the equations change a functional by, its adjoint held: by the nodes of
/// joint_mesh() and thicknesses. `by_displacement`: the functional's own, of
/// both.
shell::ShellGradient joint_gradient(const ShellPart& part,
                                    const case_data::EvaluatedCase& inputs,
                                    std::size_t load_case,
                                    const VectorX& lambda,
                                    const VectorX& by_displacement);

/// v . f of a load case by nodes and thicknesses.
shell::ShellGradient joint_force_gradient(
    const ShellPart& part, const case_data::EvaluatedCase& inputs,
    std::size_t load_case, const VectorX& v);

/// v . df for the load case's numbers that change at `rates`.
double joint_work_rate(const ShellPart& part, const loads::LoadCase& load_case,
                       const loads::LoadCase& rates, const VectorX& v);

/// Means at the solid's nodes, in its own mesh.
stress::RecoveredStress solid_stress(const ShellPart& part,
                                     std::size_t load_case);

}  // namespace meniscus::shells
