#include <fmt/format.h>

#include "fea/stress/stress.h"
#include "python/call.h"
#include "python/errors.h"
#include "python/stage_properties.h"

namespace meniscus::python {

namespace {

const equations::ElasticSolution& solution_of(const SolutionStage& self) {
  self.work->require(Stage::Solution);
  return self.work->staged().fields.solution;
}

py::array nodal_vectors(
    const py::object& self, const py::object& load_case,
    std::vector<VectorX> equations::ElasticSolution::*vectors) {
  const auto& stage = self.cast<const SolutionStage&>();
  const int index = to_load_case(stage.work->input(), load_case);
  return view((solution_of(stage).*vectors)[static_cast<std::size_t>(index)], 3,
              self);
}

template <class Number>
auto solution_figure(Number equations::ElasticReport::*number) {
  return [number](const SolutionStage& self) {
    return self.work->staged().evaluation.fea.*number;
  };
}

StressStage stress_of(const SolutionStage& self, const py::object& load_case) {
  const int index = to_load_case(self.work->input(), load_case);
  StressStage stress{self.work, index, nullptr};
  Call().run([&] { stress.field = &self.work->stress(index); });
  return stress;
}

void bind_solution_fields(py::class_<SolutionStage>& type) {
  type.def(
          "displacement",
          [](const py::object& self, const py::object& load_case) {
            return nodal_vectors(self, load_case,
                                 &equations::ElasticSolution::displacements);
          },
          py::arg("load_case") = py::none(),
          "Displacement of each node under a load case (the first), float64 "
          "(nodes, 3) [length]; a read-only view.")
      .def(
          "reactions",
          [](const py::object& self, const py::object& load_case) {
            return nodal_vectors(self, load_case,
                                 &equations::ElasticSolution::reactions);
          },
          py::arg("load_case") = py::none(),
          "Forces of the supports on each node under a load case (the first), "
          "0 where nothing is held, float64 (nodes, 3) [force]; a read-only "
          "view.")
      .def("stress", &stress_of, py::arg("load_case") = py::none(),
           "Stresses under a load case (the first), recovered at the nodes "
           "(Stress).")
      .def(
          "evaluate",
          [](const SolutionStage& self) {
            Call().run([&] { self.work->advance(Stage::Responses); });
            refuse_failed(self.work->failure(Stage::Solution));
            return EvaluationStage{self.work};
          },
          "The case's responses (Evaluation). Raises DesignFailed where there "
          "is no solution.");
}

void bind_stress(py::module_& module) {
  py::class_<StressStage>(module, "Stress",
                          "Stresses of one load case, recovered at the nodes "
                          "by patches; as in part.vtu.")
      .def_property_readonly(
          "nodal",
          [](const py::object& self) {
            return view(self.cast<const StressStage&>().field->nodal, self);
          },
          "xx yy zz xy yz zx at each node, float64 (nodes, 6) [pressure]; a "
          "read-only view.")
      .def_property_readonly(
          "von_mises",
          [](const py::object& self) {
            return view(self.cast<const StressStage&>().field->von_mises, self);
          },
          "Von Mises stress at each node, float64 (nodes,) [pressure]; a "
          "read-only view.")
      .def_property_readonly(
          "max_von_mises",
          [](const StressStage& self) { return self.field->max_von_mises; },
          "The largest at any node [pressure]; at a clamped rim it grows with "
          "every refinement.")
      .def_property_readonly(
          "element_errors",
          [](const py::object& self) {
            const auto& stress = self.cast<const StressStage&>();
            return view(stress.work->stresses()[stress.load_case].error.element,
                        self);
          },
          "Estimated error of each element in the energy norm, float64 "
          "(elements,) [(force length)^(1/2)]; a read-only view.")
      .def_property_readonly(
          "relative_error",
          [](const StressStage& self) {
            return self.work->stresses()[self.load_case].error.relative();
          },
          "Estimated error in the energy norm over that norm; 0.05 is a usual "
          "demand.");
}

}  // namespace

void bind_solution(py::module_& module) {
  py::class_<SolutionStage> type(module, "Solution",
                                 "Displacements of one design under all load "
                                 "cases, and what follows from them.");
  bind_failure<SolutionStage, Stage::Solution>(type);
  bind_solution_fields(type);
  type.def_property_readonly("dofs",
                             solution_figure(&equations::ElasticReport::dofs),
                             "Free unknowns of the first load case.")
      .def_property_readonly("solver",
                             solution_figure(&equations::ElasticReport::solver),
                             "'p-multigrid', 'cholmod' or 'petsc'.")
      .def_property_readonly(
          "iterations", solution_figure(&equations::ElasticReport::iterations),
          "Of the last load case.")
      .def_property_readonly(
          "residual", solution_figure(&equations::ElasticReport::residual),
          "Relative, the largest over load cases.")
      .def_property_readonly(
          "strain_energy",
          solution_figure(&equations::ElasticReport::strain_energy),
          "Of the first load case [force length].")
      .def_property_readonly(
          "reaction_imbalance",
          solution_figure(&equations::ElasticReport::reaction_imbalance),
          "|reactions + loads| / |loads|.")
      .def("__repr__", [](const SolutionStage& self) {
        const equations::ElasticReport& fea =
            self.work->staged().evaluation.fea;
        return fmt::format("<meniscus.Solution {} unknowns, {}>", fea.dofs,
                           fea.solver);
      });
  bind_stress(module);
}

}  // namespace meniscus::python
