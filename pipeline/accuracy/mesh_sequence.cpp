#include "pipeline/accuracy/mesh_sequence.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/case_data/film_start.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/stress_figures.h"

namespace meniscus::accuracy {

namespace {

/// How the film of another mesh is found.
enum class FilmFrom { OwnFacets, TheDesignsFilm };

/// On the mesh with edges kEdgeFactors[m] times as long.
void add_mesh(const case_data::Case& input, const VectorX& design,
              std::size_t m, FilmFrom film, bool with_eigen, Monitor& monitor,
              MeshSequence& meshes) {
  monitor.progress(
      {.stage = "accuracy",
       .detail = fmt::format("a model with edges {:.2g} times as long",
                             kEdgeFactors[m])});
  const std::string prevented = what_prevents([&] {
    const forward::ForwardModel model(
        input, {.edge_factor = kEdgeFactors[m],
                .earlier_at_own_edges = film == FilmFrom::TheDesignsFilm,
                .monitor = &monitor});
    meshes.seconds += model.frozen().seconds;
    if (model.failure()) {
      meshes.failures[m] = model.failure()->message;
      return;
    }
    forward::EvaluationFields fields;
    const forward::Evaluation there = model.evaluate(design, &fields);
    meshes.seconds += there.seconds;
    if (there.failure) {
      meshes.failures[m] = there.failure->message;
      return;
    }
    meshes.responses[m] = there.responses;
    if (film == FilmFrom::OwnFacets) {
      fields.stresses =
          forward::part_stresses(fields.mesh, fields.inputs, fields.solution);
      meshes.peaks[m] = forward::highest_readings(fields);
    }
    if (with_eigen) {
      meshes.eigen[m] =
          forward::eigen_figures(input, fields, model.elasticity(), &monitor);
      meshes.seconds.fea += meshes.eigen[m].seconds;
    }
  });
  if (!prevented.empty()) {
    meshes.failures[m] = prevented;
  }
}

/// Beside a collapse, facets that begin anew may find no film where there is
/// one: it begins from that of the design then, and what the film's own figures
/// are there counts. Rims keep their divisions on that way, so that nothing is
/// said of the rest.
void add_films(const case_data::Case& input, const VectorX& design,
               Monitor& monitor, MeshSequence& meshes) {
  const case_data::Case there = case_data::frozen_at(input, design);
  for (const std::size_t m : {std::size_t{1}, kFinerMesh}) {
    add_mesh(there, design, m, FilmFrom::TheDesignsFilm, false, monitor,
             meshes);
    VectorX& found = meshes.responses[m];
    for (Eigen::Index r = 0; r < found.size(); ++r) {
      const auto kind = input.responses[static_cast<std::size_t>(r)].kind;
      if (!case_data::row_of(kind).of_films) {
        found[r] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }
}

/// Every figure of the coarser meshes is that of the first.
bool tell_nothing(const MeshSequence& meshes) {
  for (std::size_t m = 1; m < kFinerMesh; ++m) {
    const VectorX& found = meshes.responses[m];
    for (Eigen::Index r = 0; r < found.size(); ++r) {
      const double own = meshes.responses[0][r];
      if (std::abs(found[r] - own) > kAlike * std::abs(own)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

MeshSequence evaluate_on_other_meshes(const case_data::Case& input,
                                      const VectorX& design,
                                      const VectorX& responses, bool with_eigen,
                                      Monitor& monitor) {
  MeshSequence meshes;
  meshes.responses[0] = responses;
  for (std::size_t m = 1; m < kEdgeFactors.size(); ++m) {
    if (m == kFinerMesh && tell_nothing(meshes)) {
      for (std::size_t coarser = 1; coarser < kFinerMesh; ++coarser) {
        meshes.responses[coarser] = {};
        meshes.peaks[coarser] = {};
        meshes.eigen[coarser] = {};
      }
    }
    if (m != kFinerMesh || !meshes.has_coarser()) {
      add_mesh(input, design, m, FilmFrom::OwnFacets, with_eigen, monitor,
               meshes);
    }
  }
  if (!meshes.has_others()) {
    add_films(input, design, monitor, meshes);
  }
  return meshes;
}

}  // namespace meniscus::accuracy
