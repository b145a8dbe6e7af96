#include "pipeline/accuracy/mesh_sequence.h"

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/forward/forward_model.h"

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
    const forward::Evaluation there =
        model.evaluate(design, with_eigen ? &fields : nullptr);
    meshes.seconds += there.seconds;
    if (there.failure) {
      meshes.failures[m] = there.failure->message;
      return;
    }
    meshes.responses[m] = there.responses;
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

}  // namespace

MeshSequence evaluate_on_other_meshes(const case_data::Case& input,
                                      const VectorX& design,
                                      const VectorX& responses, bool with_eigen,
                                      Monitor& monitor) {
  MeshSequence meshes;
  meshes.responses[0] = responses;
  for (std::size_t m = 1; m < kEdgeFactors.size(); ++m) {
    if (m != kFinerMesh || !meshes.has_coarser()) {
      add_mesh(input, design, m, with_eigen, monitor, meshes);
    }
  }
  return meshes;
}

}  // namespace meniscus::accuracy
