#include "pipeline/accuracy/mesh_sequence.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/stress_figures.h"
#include "pipeline/forward/worst_cases.h"

namespace meniscus::accuracy {

namespace {

/// On the mesh with edges kEdgeFactors[m] times as long.
void add_mesh(const case_data::Case& input, const VectorX& design,
              std::size_t m, bool with_eigen, Monitor& monitor,
              MeshSequence& meshes) {
  monitor.progress(
      {.stage = "accuracy",
       .detail = fmt::format("a model with edges {:.2g} times as long",
                             kEdgeFactors[m])});
  const std::string prevented = what_prevents([&] {
    const forward::ForwardModel model(
        input, {.edge_factor = kEdgeFactors[m], .monitor = &monitor});
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
    forward::find_stresses(input, fields);
    meshes.peaks[m] = forward::highest_readings(fields);
    if (with_eigen) {
      meshes.eigen[m] = forward::eigen_figures(
          input, fields, fields.shell ? nullptr : &model.elasticity(),
          &monitor);
      meshes.seconds.fea += meshes.eigen[m].seconds;
    }
  });
  if (!prevented.empty()) {
    meshes.failures[m] = prevented;
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
      add_mesh(input, design, m, with_eigen, monitor, meshes);
    }
  }
  return meshes;
}

}  // namespace meniscus::accuracy
