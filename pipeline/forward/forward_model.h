/// The one forward model: design in, responses out. The command line, the
/// optimizer and the tests call evaluate() and nothing beside it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "core/monitor.h"
#include "evolve/frozen/film_model.h"
#include "evolve/walls/wall_model.h"
#include "fea/elastic/elasticity.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/design_gradient.h"
#include "pipeline/forward/exclusion.h"
#include "pipeline/forward/part_stress.h"
#include "pipeline/forward/stage_meter.h"
#include "pipeline/responses/response_modes.h"
#include "pipeline/responses/scans.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::forward {

struct TetFigures {
  int nodes = 0;
  int elements = 0;
  double min_dihedral_deg = 0.0;  // of the straight-sided elements
  double max_dihedral_deg = 0.0;
  int facets = 0;  // of shells beside these elements
};

/// What one design came to. `responses` stand in the case's order and are
/// empty when there is a failure; figures of the stages that ran are kept.
struct Evaluation {
  VectorX design;
  VectorX responses;
  std::optional<Failure> failure;
  settle::FilmReport film;
  TetFigures tet;
  equations::ElasticReport fea;
  StageSeconds seconds;
  StageOperations operations;
};

/// A mode of vibration or buckling, 3 per node.
struct ModeShape {
  std::string name;   // "mode_1", "buckling_service_1"
  std::string value;  // for people
  VectorX shape;
};

/// A load from any direction as it is shown (worst_cases.h).
struct WorstCase {
  int load_case = 0;  // index of the load case that shows it
  int first = 0;      // of its three unit loads
  Vec3 direction = Vec3::UnitZ();
};

/// The film of one design of a study's history, on the model's triangulation.
struct FilmFrame {
  int evaluation = 0;  // its number in the database
  std::string kept;    // why it is among the kept: "start", "better", "best"
  VectorX design;
  VectorX responses;
  SurfaceMesh surface;  // films and caps as meshed, without mid-sides
};

/// The fields behind an evaluation, for files and pictures.
struct EvaluationFields {
  std::vector<Finding> findings;  // why `surface.base` could not be filled
  SurfaceMesh film;               // at the film's own resolution
  SurfaceMesh boundary;           // of that what bounds material
  QuadraticSurface surface;       // as meshed
  TetMesh mesh;                   // ten-node
  equations::ElasticSolution solution;
  /// Of a case with shells, whose faces `mesh` has; of shells alone it has
  /// nothing else. Else null.
  std::shared_ptr<shells::ShellPart> shell;
  responses::ResponseModes response_modes;  // that the responses take
  std::vector<PartStress> stresses;    // per load case; found once, at the end
  std::vector<WorstCase> worst_cases;  // behind the load cases; the same
  std::vector<ModeShape> modes;        // that the case asks for; the same
  std::vector<FilmFrame> history;      // of the study, by evaluation; the same
  case_data::EvaluatedCase inputs;
  Exclusion exclusion;      // the model's
  double start_edge = 0.0;  // of the start that the model's film was found from
};

/// What gradient() needs beside the fields; as large as a stiffness matrix.
struct AdjointState {
  settle::FilmState film;
  equations::ElasticState elastic;
};

struct Adaptation;  // pipeline/forward/adaptation.h
struct FrozenPart;  // pipeline/forward/frozen_part.h

struct ForwardModelOptions {
  double edge_factor = 1.0;    // x all edge lengths of the case's resolution;
                               // above 1, exclusion zones may be empty
  Monitor* monitor = nullptr;  // not owned; must outlive the model
};

/// Throws IoError, with what to install, when the case's solver is a program
/// that is not here.
void require_solver(const case_data::Case& input);

class ForwardModel {
 public:
  /// Freezes films, tetrahedra and elasticity at the case's initial design,
  /// with analysis.adapt after one round of adaptive refinement there.
  /// When that design cannot be evaluated, failure() says why and the model
  /// must not be used. Throws what its stages throw for wrong input
  /// (choose_exclusion too), for walls that refuse_walls() refuses, and what
  /// require_solver and read_scans throw.
  explicit ForwardModel(const case_data::Case& input,
                        const ForwardModelOptions& options = {});
  ~ForwardModel();
  ForwardModel(ForwardModel&&) noexcept;
  ForwardModel& operator=(ForwardModel&&) noexcept;

  const std::optional<Failure>& failure() const;

  /// The surface that could not be filled, with what is wrong with it; no
  /// facets unless failure() is of that kind.
  const SurfaceMesh& unfilled_surface() const;
  const std::vector<Finding>& findings() const;

  /// Figures of the freeze itself: its film report and seconds per stage.
  const Evaluation& frozen() const;

  /// The film that evaluate() settles first: alone, settle() of a design's
  /// film system costs a hundredth of an evaluation and has the same bits.
  const frozen::FilmModel& film() const;

  bool has_shells() const;

  /// Its walls; null for a case without.
  const walls::WallModel* walls() const;

  /// What bounds the part on a settled film of the design that `inputs` are
  /// of: as it is filled, and as closed surface at the film's own resolution.
  QuadraticSurface surface(const case_data::EvaluatedCase& inputs,
                           const Points& film_points) const;
  SurfaceMesh boundary(const case_data::EvaluatedCase& inputs,
                       const Points& film_points) const;

  /// What its responses compare films with.
  const responses::Scans& scans() const;

  /// The elasticity that evaluate() solves with.
  const elastic::ElasticModel& elasticity() const;

  /// What was frozen, for the stages of a design (design_stages.h).
  const FrozenPart& part() const { return *part_; }

  /// What a case with analysis.adapt was adapted from and to; else null.
  const Adaptation* adaptation() const;

  /// A pure function of (model, design), safe to call from several threads if
  /// the monitor is. `fields`, when given, receives the
  /// meshes and the solution, `adjoint` what gradient() needs beside them.
  Evaluation evaluate(const VectorX& design, EvaluationFields* fields = nullptr,
                      AdjointState* adjoint = nullptr) const;

  /// The exact derivatives of `responses` (indices, a row each) at an evaluated
  /// design. A pure function; see design_gradient(), of which what has no
  /// derivative there is a failure here.
  DesignGradient gradient(const Evaluation& evaluation,
                          const EvaluationFields& fields,
                          const AdjointState& adjoint,
                          const std::vector<int>& responses) const;

 private:
  std::unique_ptr<FrozenPart> part_;
};

}  // namespace meniscus::forward
