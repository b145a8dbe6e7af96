/// A design's films as a shell: what is solved, and what that gave.
#pragma once

#include <functional>
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
#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "fea/shell_actions/line_load.h"
#include "fea/shell_actions/shell_lines.h"
#include "fea/stress/patch_recovery.h"
#include "fea/supports/springs.h"

namespace meniscus::shells {

/// What acts in a load case, in the terms of the shell.
struct ShellActions {
  shell::ShellLoads loads;             // all of it
  loads::LoadCase on_films;            // of that: as forces at nodes; springs
  std::vector<shell::LineLoad> lines;  // of that: on rims, the same
};

struct ShellCase {
  ShellActions actions;
  std::shared_ptr<const shell::ShellSystem> system;  // of cases held alike
  VectorX displacement;                              // 6 per node
  VectorX reaction;                                  // the same: K u - f
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
  std::vector<shell::Section> sections;  // one per shell of the case, of its
                                         // layers
  int first_layer = 0;                   // of these, among the case's materials
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

/// The edges of facets of their own films, each once: edges that films share
/// stand for the first. Throws as rim_of().
std::vector<shell::FacetEdge> rim_edges(const ShellPart& part,
                                        const loads::Surfaces& rims);

/// What the load case, or its rates, are on the part; its numbers are those
/// that the case checks let pass. A pressure on FILM acts on the face that
/// normals point to, one on FILM/back on the other.
ShellActions shell_actions(const ShellPart& part,
                           const loads::LoadCase& load_case);

/// What the springs under films pull with, by nodes' displacements.
supports::SpringBlocks spring_blocks(const ShellPart& part,
                                     const loads::LoadCase& load_case);

/// Adds the gradient by nodes of -v . S u, S the springs' blocks.
void add_spring_gradient(const ShellPart& part, std::size_t load_case,
                         const VectorX& v, const VectorX& u, Points& by_nodes);

/// v . (f - K u) of a load case by nodes and thicknesses; 6 per node. Of u = 0
/// the work of the loads on v.
shell::ShellGradient work_gradient(const ShellPart& part, std::size_t load_case,
                                   const VectorX& v, const VectorX& u);

/// What a value changes by at fixed displacements as the load case's numbers
/// do at `rates`; of an empty gradient 0.
double action_rate(const ShellPart& part, const loads::LoadCase& load_case,
                   const loads::LoadCase& rates,
                   const shell::ActionGradient& by);

/// v . df for the load case's numbers that change at `rates`.
double work_rate(const ShellPart& part, const loads::LoadCase& load_case,
                 const loads::LoadCase& rates, const VectorX& v);

/// Means at the nodes, of a solved load case.
std::vector<shell::FacetStress> shell_stresses(const ShellPart& part,
                                               std::size_t load_case);

/// Index of each section's first layer among the case's materials.
std::vector<int> first_layers(const ShellPart& part);

/// Per material of the case, as shell::PlyGradient; of solids 0.
struct LayerGradient {
  std::vector<double> modulus, density, angle;
};
LayerGradient layer_gradient(const ShellPart& part,
                             const shell::PlyGradients& by_ply);

/// visit(facet, node, layer, stress) of a solved load case at the nodes of all
/// facets, means as of shell_stresses(): at both faces of each layer and half
/// way between, `node` from 0 to 5, `layer` among the case's materials.
void visit_nodal_stresses(
    const ShellPart& part, std::size_t load_case,
    const std::function<void(int facet, int node, int layer,
                             const element::Stress& stress)>& visit);

/// The largest von Mises stress of these.
struct ShellPeak {
  double von_mises = 0.0;        // [pressure]
  Vec3 position = Vec3::Zero();  // of the node [length]
  int layer = 0;
};
ShellPeak shell_peak(const ShellPart& part, std::size_t load_case);

/// Of a load case with stresses, per node: the largest that its facets have at
/// these heights [pressure].
std::vector<double> nodal_von_mises(
    const ShellPart& part, std::size_t load_case,
    const std::vector<element::Stress shell::WallStress::*>& heights);

/// Of all their plies.
std::vector<shell::Section> with_density(std::vector<shell::Section> sections,
                                         double density);

}  // namespace meniscus::shells
