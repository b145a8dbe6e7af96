/// The parts of the module.
#pragma once

#include <memory>

#include "python/design_input.h"
#include "python/stages.h"

namespace meniscus::python {

/// Python's classes that hold a design at a stage; each keeps it alive.
struct FilmStage {
  std::shared_ptr<DesignWork> work;
};
struct MeshStage {
  std::shared_ptr<DesignWork> work;
};
struct SolutionStage {
  std::shared_ptr<DesignWork> work;
};
struct StressStage {
  std::shared_ptr<DesignWork> work;
  int load_case = 0;
  const stress::StressField* field = nullptr;  // in `work`
};
struct EvaluationStage {
  std::shared_ptr<DesignWork> work;
};
/// `surface` lives in what `owner` holds.
struct SurfaceStage {
  std::shared_ptr<const void> owner;
  const QuadraticSurface* surface = nullptr;
};

void bind_case(py::module_& module);
void bind_surface(py::module_& module);
void bind_film(py::module_& module);
void bind_mesh(py::module_& module);
void bind_solution(py::module_& module);
void bind_evaluation(py::module_& module);
void bind_model(py::module_& module);
void bind_study(py::module_& module);

}  // namespace meniscus::python
