/// What a ForwardModel freezes at its case's initial design; for the sources of
/// the chain (forward_model.cpp, design_stages.cpp, design_gradient.cpp).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "evolve/fillets/fillet_model.h"
#include "evolve/walls/wall_model.h"
#include "fea/joint/edge_tie.h"
#include "mesh_tet/mesh_motion.h"
#include "mesh_tet/tet_quality.h"
#include "mesh_tet/tetrahedralize.h"
#include "pipeline/forward/adaptation.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/responses/responses.h"
#include "pipeline/shells/shell_model.h"

namespace meniscus::forward {

TetFigures figures_of(const TetMesh& mesh, const mesh_tet::TetQuality& quality);
/// Of shells: their facets.
TetFigures figures_of(const QuadraticSurface& surface);
/// Of solids with the shells beside them.
TetFigures joint_figures(TetFigures solid, const shell::ShellMesh& shell);

/// Derivatives of a number by what makes the part's surface.
struct SurfaceGradient {
  Points film;                     // by the film's vertices
  std::vector<VectorX> thickness;  // by the numbers of the walls'; empty
                                   // without walls
  VectorX fillets;  // by the fillets' radii; empty without fillets
};

struct FrozenPart {
  case_data::Case input;
  Monitor* monitor = nullptr;  // of evaluations; not owned, may be null
  Evaluation start;            // of the freeze: figures, and why it failed
  SurfaceMesh unfilled;        // that no elements fit in, and why
  std::vector<Finding> findings;
  std::optional<frozen::FilmModel> film;
  std::optional<fillets::FilletModel> fillets;  // of a case that has some
  std::optional<walls::WallModel> walls;        // the same
  std::optional<shells::ShellModel> shells;     // the same
  // Of the solids; nothing of it is there in a case of shells alone, and beside
  // shells nothing below `motion` but the tie:
  TetMesh base_mesh;  // ten-node, at the initial design
  std::vector<char> curve_edge;
  std::optional<mesh_tet::MeshMotion> motion;
  std::shared_ptr<const joint::EdgeTie> tie;  // of shells to these
  std::optional<elastic::ElasticModel> elasticity;
  responses::ResponseModes base_modes;  // of the initial design
  Exclusion exclusion;
  functionals::ThicknessPairs pairs;
  responses::Scans scans;
  std::optional<Adaptation> adaptation;

  /// Points of the film, of the design of `inputs`, with the fillets.
  Points rounded(const case_data::EvaluatedCase& inputs,
                 const Points& points) const;
  /// The solids' surface as meshed, or of shells alone theirs, on the film
  /// `points` of the design of `inputs`.
  QuadraticSurface surface(const case_data::EvaluatedCase& inputs,
                           const Points& points) const;
  /// Its transpose: from a gradient by all nodes of the mesh.
  SurfaceGradient to_surface(const case_data::EvaluatedCase& inputs,
                             const Points& points, const TetMesh& mesh,
                             const Points& by_nodes) const;
  /// Shells and, beside them, solids of a design on its film, without
  /// solutions; `solid` is empty where there are none. Throws as
  /// shells::ShellModel::part().
  std::shared_ptr<shells::ShellPart> shell_part(
      const case_data::EvaluatedCase& inputs, const Points& points,
      const TetMesh& solid) const;
  /// What the responses of a design look at, on loan.
  responses::ResponseContext context(
      const case_data::EvaluatedCase& inputs,
      const settle::FilmState& film_state, const TetMesh& mesh,
      const equations::ElasticSolution& solution,
      const responses::ResponseModes& modes,
      const shells::ShellPart* shell = nullptr) const;
};

/// The chain of stages at the initial design of `part.input`, each kept for
/// every design after: film, walls, elements, elasticity, and with
/// analysis.adapt a second, finer mesh. What fails stands in part.start.failure
/// and ends the chain. Throws as ForwardModel does.
void freeze_part(const ForwardModelOptions& options, FrozenPart& part);

/// The same as far as the elements. False when that failed.
bool freeze_mesh(const ForwardModelOptions& options, FrozenPart& part);

}  // namespace meniscus::forward
