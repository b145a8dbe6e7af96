/// What a ForwardModel holds; for its own sources.
#pragma once

#include <optional>
#include <vector>

#include "evolve/walls/wall_model.h"
#include "mesh_tet/mesh_motion.h"
#include "mesh_tet/tet_quality.h"
#include "mesh_tet/tetrahedralize.h"
#include "pipeline/forward/adaptation.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/responses.h"

namespace meniscus {

TetFigures figures_of(const TetMesh& mesh, const TetQuality& quality);

struct ForwardModel::Impl {
  Case input;
  Evaluation frozen;
  SurfaceMesh unfilled;
  std::vector<Finding> findings;
  std::optional<FilmModel> film;
  std::optional<WallModel> walls;  // of a case that has some
  TetMesh base_mesh;               // ten-node, at the initial design
  std::vector<char> curve_edge;
  std::optional<MeshMotion> motion;
  std::optional<ElasticModel> elasticity;
  Exclusion exclusion;
  ThicknessPairs pairs;
  Scans scans;
  std::optional<Adaptation> adaptation;
  Monitor* watcher = nullptr;  // of evaluations

  void freeze(const ForwardModelOptions& options);
  bool freeze_film(const EvaluatedCase& inputs,
                   const ForwardModelOptions& options, Monitor& monitor);
  bool freeze_mesh(const EvaluatedCase& inputs,
                   const TetrahedralizeOptions& options, Monitor& monitor);
  bool freeze_elasticity(const EvaluatedCase& inputs, Monitor& monitor);
  bool freeze_pairs();
  bool adapt(const EvaluatedCase& inputs, Monitor& monitor);
  AdaptedState state(const EvaluatedCase& inputs) const;
  VectorX responses(const EvaluatedCase& inputs, const FilmState& film_state,
                    const TetMesh& mesh, const ElasticSolution& solution) const;
  QuadraticSurface surface(const EvaluatedCase& inputs,
                           const Points& film_points) const;
  SurfaceGradient to_film(const EvaluatedCase& inputs,
                          const Points& film_points, const TetMesh& mesh,
                          const Points& by_nodes) const;
};

}  // namespace meniscus
