#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "python/bindings.h"
#include "python/call.h"

namespace meniscus::python {

namespace {

/// Python's Model and FilmModel.
struct WholeModel {
  std::shared_ptr<const FrozenModel> frozen;
};
struct FilmAlone {
  std::shared_ptr<const FrozenModel> frozen;
};

template <class Kind>
Kind freeze(const ReadCase& input, double edge_factor,
            const py::object& progress) {
  if (!std::isfinite(edge_factor) || edge_factor <= 0.0) {
    throw InvalidInput(fmt::format(
        "edge_factor: found {}, expected a number above 0", edge_factor));
  }
  Kind model;
  Call(progress).run([&] {
    Monitor& monitor = Call::of_this_thread();
    if constexpr (std::is_same_v<Kind, WholeModel>) {
      model.frozen = freeze_whole(input.input, edge_factor, monitor);
    } else {
      model.frozen = freeze_film(input.input, edge_factor, monitor);
    }
  });
  return model;
}

template <class Kind>
FilmStage settle(const Kind& self, const py::object& design) {
  const auto work = std::make_shared<DesignWork>(
      self.frozen, to_design(*self.frozen->input, design),
      forward::KeepStiffness::Yes);
  Call().run([&] { work->advance(Stage::Film); });
  return {work};
}

EvaluationStage evaluate_design(const WholeModel& self,
                                const py::object& design,
                                const std::string& keep) {
  if (keep != "all" && keep != "fields" && keep != "responses") {
    throw InvalidInput(fmt::format(
        "keep: found '{}', expected 'all', 'fields' or 'responses'", keep));
  }
  const auto work = std::make_shared<DesignWork>(
      self.frozen, to_design(*self.frozen->input, design),
      keep == "all" ? forward::KeepStiffness::Yes : forward::KeepStiffness::No);
  Call().run([&] {
    work->advance(Stage::Responses);
    if (keep == "responses") {
      work->drop_fields();
    }
  });
  return {work};
}

std::vector<std::string> findings_of(const WholeModel& self) {
  std::vector<std::string> messages;
  messages.reserve(self.frozen->whole->findings().size());
  for (const Finding& finding : self.frozen->whole->findings()) {
    messages.push_back(finding.message);
  }
  return messages;
}

std::optional<SurfaceStage> unfilled_of(const WholeModel& self) {
  const SurfaceMesh& surface = self.frozen->whole->unfilled_surface();
  if (surface.facets.empty()) {
    return std::nullopt;
  }
  auto whole = std::make_shared<QuadraticSurface>();
  whole->base = surface;
  return SurfaceStage{whole, whole.get()};
}

template <class Kind>
void bind_common(py::class_<Kind>& type) {
  type.def(py::init(&freeze<Kind>), py::arg("case"), py::kw_only(),
           py::arg("edge_factor") = 1.0, py::arg("progress") = py::none(),
           "Freezes at the case's initial design. `edge_factor` times all edge "
           "lengths of the case; `progress`: called with stage, detail and "
           "fraction done (or None).")
      .def_property_readonly(
          "case",
          [](const Kind& self) {
            return ReadCase{self.frozen->input, {}};
          },
          "The case.")
      .def_property_readonly(
          "failure", [](const Kind& self) { return self.frozen->failure(); },
          "Why the initial design cannot be evaluated (Failure), and with it "
          "no other; None where it can.")
      .def("settle", &settle<Kind>, py::arg("design") = py::none(),
           "The film at rest at a design (Film): numbers in the order of "
           "Case.design, a dict of names (of a vector an array), or None for "
           "the "
           "initial one. Safe "
           "from several threads.");
}

}  // namespace

void bind_model(py::module_& module) {
  py::class_<WholeModel> model(
      module, "Model",
      "A case frozen at its initial design: film, elements and elasticity. "
      "What it says of a design depends on the design alone, to the last bit.");
  bind_common(model);
  model
      .def("evaluate", &evaluate_design, py::arg("design") = py::none(),
           py::kw_only(), py::arg("keep") = "all",
           "All stages at a design (Evaluation), given as for settle(). "
           "`keep`: 'all' keeps fields and what gradients need (as large as "
           "the stiffness matrix), 'fields' no gradients, 'responses' neither. "
           "Safe from several threads.")
      .def_property_readonly("findings", &findings_of,
                             "What is wrong with the surface that could not be "
                             "filled, a sentence each.")
      .def_property_readonly("unfilled_surface", &unfilled_of,
                             "The surface that could not be filled (Surface), "
                             "or None.");
  py::class_<FilmAlone> film(
      module, "FilmModel",
      "The film of a case frozen at its initial design, without elements: "
      "quick, for shapes alone.");
  bind_common(film);
}

}  // namespace meniscus::python
