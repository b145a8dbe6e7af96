/// The exceptions of core/error.h as Python's, and designs that failed.
#pragma once

#include <pybind11/pybind11.h>

#include "core/error.h"

namespace meniscus::python {

namespace py = pybind11;

/// Asked of a design something that its failure left it without; DesignFailed
/// in Python.
class DesignFailed : public Error {
 public:
  explicit DesignFailed(Failure failure);
  const Failure& failure() const { return failure_; }

 private:
  Failure failure_;
};

/// Throws DesignFailed where there is a failure.
void refuse_failed(const std::optional<Failure>& failure);

void bind_errors(py::module_& module);

}  // namespace meniscus::python
