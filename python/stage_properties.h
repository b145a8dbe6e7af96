/// What the classes of all stages have.
#pragma once

#include <pybind11/stl.h>

#include "python/array_view.h"
#include "python/bindings.h"

namespace meniscus::python {

/// What every stage has.
template <class Stage>
py::array design_of(const py::object& self) {
  return view(self.cast<const Stage&>().work->staged().evaluation.design, self);
}

template <class Kind, Stage stage>
void bind_failure(py::class_<Kind>& type) {
  type.def_property_readonly(
          "failure", [](const Kind& self) { return self.work->failure(stage); },
          "Why there is none (Failure); None where there is one.")
      .def_property_readonly(
          "ok", [](const Kind& self) { return !self.work->failure(stage); },
          "True without a failure.")
      .def_property_readonly("design", &design_of<Kind>,
                             "The design, float64 (design variables,), in the "
                             "case's units; a read-only view.");
}

}  // namespace meniscus::python
