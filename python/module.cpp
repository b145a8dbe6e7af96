/// import meniscus: the module behind the package.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "core/find_program.h"
#include "python/bindings.h"
#include "python/call.h"
#include "python/errors.h"

namespace meniscus::python {

PYBIND11_MODULE(_meniscus, module) {
  module.doc() = "The engine behind the package meniscus.";
  module.attr("__version__") = MENISCUS_VERSION;
  bind_errors(module);
  bind_case(module);
  bind_surface(module);
  bind_film(module);
  bind_mesh(module);
  bind_solution(module);
  bind_evaluation(module);
  bind_model(module);
  bind_study(module);
  module.def("set_threads", &set_thread_count, py::arg("count"),
             "Threads that each call computes with from now on; 0: as many as "
             "there are cores, or OMP_NUM_THREADS. Results have the same bits "
             "for any number.");
  module.def("threads", &thread_count, "Threads that each call computes with.");
  module.def("_add_helper_folder", &add_helper_folder, py::arg("folder"),
             "Looks for helper programs (the mesher) in this folder too.");
}

}  // namespace meniscus::python
