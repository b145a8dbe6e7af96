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

namespace meniscus::forward {

TetFigures figures_of(const TetMesh& mesh, const mesh_tet::TetQuality& quality);

struct ForwardModel::Impl {
  case_data::Case input;
  Evaluation frozen;
  SurfaceMesh unfilled;
  std::vector<Finding> findings;
  std::optional<frozen::FilmModel> film;
  std::optional<walls::WallModel> walls;  // of a case that has some
  TetMesh base_mesh;                      // ten-node, at the initial design
  std::vector<char> curve_edge;
  std::optional<mesh_tet::MeshMotion> motion;
  std::optional<elastic::ElasticModel> elasticity;
  Exclusion exclusion;
  functionals::ThicknessPairs pairs;
  Scans scans;
  std::optional<Adaptation> adaptation;
  Monitor* watcher = nullptr;  // of evaluations

  void freeze(const ForwardModelOptions& options);
  bool freeze_film(const case_data::EvaluatedCase& inputs,
                   const ForwardModelOptions& options, Monitor& monitor);
  bool freeze_mesh(const case_data::EvaluatedCase& inputs,
                   const mesh_tet::TetrahedralizeOptions& options,
                   Monitor& monitor);
  bool freeze_elasticity(const case_data::EvaluatedCase& inputs,
                         Monitor& monitor);
  bool freeze_pairs();
  bool adapt(const case_data::EvaluatedCase& inputs, Monitor& monitor);
  AdaptedState state(const case_data::EvaluatedCase& inputs) const;
  VectorX responses(const case_data::EvaluatedCase& inputs,
                    const settle::FilmState& film_state, const TetMesh& mesh,
                    const equations::ElasticSolution& solution) const;
  QuadraticSurface surface(const case_data::EvaluatedCase& inputs,
                           const Points& film_points) const;
  SurfaceGradient to_film(const case_data::EvaluatedCase& inputs,
                          const Points& film_points, const TetMesh& mesh,
                          const Points& by_nodes) const;
};

}  // namespace meniscus::forward
