/// A design's films as a shell: what is solved, and what that gave.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/joint/edge_tie.h"
#include "fea/joint/joint_system.h"
#include "fea/loads/load_case.h"
#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_lines.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "fea/stress/patch_recovery.h"

namespace meniscus::shells {

/// A total force, spread evenly along a rim.
struct RimForce {
  std::string rim;
  Vec3 total = Vec3::Zero();  // [force]
};

/// What acts in a load case, in the terms of the shell.
struct ShellActions {
  shell::ShellLoads loads;     // all of it
  loads::LoadCase on_films;    // of that: as forces at nodes
  std::vector<RimForce> rims;  // of that: edge loads
};

struct ShellCase {
  ShellActions actions;
  std::shared_ptr<const shell::ShellSystem> system;  // of cases held alike
  VectorX displacement;                              // 6 per node
  // Beside solids, in the place of `system` (joint_part.h):
  std::shared_ptr<const joint::JointSystem> joint;
  VectorX both, forces;     // displacements and forces of solids and shells
  VectorX solid_reactions;  // 3 per node of the solids
  stress::RecoveredStress solid_stress;    // as `stress`
  std::vector<shell::FacetStress> stress;  // means at nodes; once, at the end
};

/// The solids that shells stand on.
struct SolidPart {
  TetMesh mesh;
  std::vector<element::Material> materials;   // one per region
  std::shared_ptr<const joint::EdgeTie> tie;  // frozen with the model
};

/// Systems refer to mesh and sections: it stays where it was made.
struct ShellPart {
  ShellPart() = default;
  ShellPart(const ShellPart&) = delete;
  ShellPart& operator=(const ShellPart&) = delete;
  ~ShellPart() = default;

  shell::ShellMesh mesh;
  TetMesh skin;   // no elements: its nodes, and its facets as faces with the
                  // films' names
  Points frozen;  // places of the corners, its first nodes, at the freeze
  std::vector<shell::Section> sections;     // one per shell of the case
  std::map<std::string, shell::Line> rims;  // "FILM/rim:CURVE", and those in
                                            // planes: "FILM/symmetry_1"
  std::map<std::string, Vec3> planes;       // of these: the unit normals
  std::optional<SolidPart> solid;           // of a case with both
  std::vector<ShellCase> cases;             // per load case
};

/// "FILM/rim:CURVE".
bool is_rim(const std::string& surface);
/// "FILM" of "FILM/back" and "FILM/rim:CURVE".
std::string film_of(const std::string& surface);

/// Throws InvalidInput for a rim of no edge.
const shell::Line& rim_of(const ShellPart& part, const std::string& rim);

/// What the load case, or its rates, are on the part; its numbers are those
/// that the case checks let pass. A pressure on FILM acts on the face that
/// normals point to, one on FILM/back on the other.
ShellActions shell_actions(const ShellPart& part,
                           const loads::LoadCase& load_case);

/// v . (f - K u) of a load case by nodes and thicknesses; 6 per node. Of u = 0
/// the work of the loads on v.
shell::ShellGradient work_gradient(const ShellPart& part, std::size_t load_case,
                                   const VectorX& v, const VectorX& u);

/// v . df for the load case's numbers that change at `rates`.
double work_rate(const ShellPart& part, const loads::LoadCase& load_case,
                 const loads::LoadCase& rates, const VectorX& v);

/// Means at the nodes, of a solved load case.
std::vector<shell::FacetStress> shell_stresses(const ShellPart& part,
                                               std::size_t load_case);

/// The largest von Mises stress at the nodes, of both faces and the middle.
struct ShellPeak {
  double von_mises = 0.0;        // [pressure]
  Vec3 position = Vec3::Zero();  // of the node [length]
  int facet = 0;
};
ShellPeak shell_peak(const ShellPart& part,
                     const std::vector<shell::FacetStress>& stress);

/// Of a load case with stresses, per node: the largest that its facets have at
/// these heights [pressure].
std::vector<double> nodal_von_mises(
    const ShellPart& part, std::size_t load_case,
    const std::vector<element::Stress shell::WallStress::*>& heights);

/// Of all their plies.
std::vector<shell::Section> with_density(std::vector<shell::Section> sections,
                                         double density);

}  // namespace meniscus::shells
