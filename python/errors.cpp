#include "python/errors.h"

#include <optional>
#include <utility>

namespace meniscus::python {

namespace {

/// Live as long as the module, which is never unloaded.
struct Types {
  PyObject* error = nullptr;
  PyObject* invalid_input = nullptr;
  PyObject* io_error = nullptr;
  PyObject* mesh_error = nullptr;
  PyObject* solver_error = nullptr;
  PyObject* interrupted = nullptr;
  PyObject* design_failed = nullptr;
};
Types types;

PyObject* add(py::module_& module, const char* name, const char* doc,
              const py::object& bases) {
  const std::string full = std::string("meniscus.") + name;
  PyObject* type =
      PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) {
    throw py::error_already_set();
  }
  module.add_object(name, py::reinterpret_borrow<py::object>(type));
  return type;
}

void raise_failed(const DesignFailed& error) {
  const py::object type =
      py::reinterpret_borrow<py::object>(types.design_failed);
  const py::object value = type(error.what());
  value.attr("failure") = py::cast(error.failure());
  PyErr_SetObject(type.ptr(), value.ptr());
}

/// The most special types first.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) {
      std::rethrow_exception(std::move(thrown));
    }
  } catch (const DesignFailed& error) {
    raise_failed(error);
  } catch (const InvalidInput& error) {
    PyErr_SetString(types.invalid_input, error.what());
  } catch (const IoError& error) {
    PyErr_SetString(types.io_error, error.what());
  } catch (const MeshError& error) {
    PyErr_SetString(types.mesh_error, error.what());
  } catch (const SolverError& error) {
    PyErr_SetString(types.solver_error, error.what());
  } catch (const Interrupted& error) {
    PyErr_SetString(types.interrupted, error.what());
  } catch (const Error& error) {
    PyErr_SetString(types.error, error.what());
  }
}

}  // namespace

DesignFailed::DesignFailed(Failure failure)
    : Error(std::string(name_of(failure.kind)) + ": " + failure.message),
      failure_(std::move(failure)) {}

void refuse_failed(const std::optional<Failure>& failure) {
  if (failure) {
    throw DesignFailed(*failure);
  }
}

void bind_errors(py::module_& module) {
  const auto builtin = [](PyObject* type) {
    return py::reinterpret_borrow<py::object>(type);
  };
  types.error = add(module, "Error", "Base of all errors of this package.",
                    builtin(PyExc_Exception));
  const py::object base = builtin(types.error);
  types.invalid_input =
      add(module, "InvalidInput",
          "The case, an option or an argument is wrong; of a case file every "
          "problem on a line of its own, as 'FILE:LINE: what, found, expected, "
          "try'.",
          py::make_tuple(base, builtin(PyExc_ValueError)));
  types.io_error =
      add(module, "IoError",
          "A file, a folder or a helper program cannot be used.", base);
  types.mesh_error =
      add(module, "MeshError",
          "A surface or a mesh breaks a condition that a stage needs.", base);
  types.solver_error =
      add(module, "SolverError",
          "A linear system or a model cannot be solved: supports too weak, "
          "memory.",
          base);
  types.interrupted = add(module, "Interrupted",
                          "Stopped on request without an exception of "
                          "Python's behind it.",
                          base);
  types.design_failed =
      add(module, "DesignFailed",
          "Asked of a design something that its failure left it without. "
          "`failure` says why it failed.",
          base);
  py::class_<Failure>(module, "Failure",
                      "Why a design cannot be evaluated: data, not an error.")
      .def_property_readonly(
          "kind", [](const Failure& self) { return name_of(self.kind); },
          "The cause, as in result.json: 'film_unstable', 'film_pinched', "
          "'film_not_found', 'film_rejoins', 'surface_invalid', "
          "'meshing_failed', "
          "'elements_inverted', 'solver_failed' or 'not_a_number'.")
      .def_readonly("message", &Failure::message,
                    "What, where, and what would help.")
      .def("__repr__", [](const Failure& self) {
        return std::string("<meniscus.Failure ") + name_of(self.kind) + ": " +
               self.message + ">";
      });
  py::register_exception_translator(&translate);
}

}  // namespace meniscus::python
