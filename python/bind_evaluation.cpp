#include <fmt/format.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/responses/responses.h"
#include "python/array_view.h"
#include "python/bindings.h"
#include "python/call.h"
#include "python/errors.h"

namespace meniscus::python {

namespace {

double response_of(const EvaluationStage& self, const std::string& name) {
  const int index = to_response(self.work->input(), name);
  refuse_failed(self.work->failure(Stage::Responses));
  return self.work->responses()[index];
}

py::dict seconds_of(const EvaluationStage& self) {
  const forward::StageSeconds& seconds = self.work->staged().evaluation.seconds;
  py::dict out;
  out["film"] = seconds.film;
  out["mesh"] = seconds.mesh;
  out["fea"] = seconds.fea;
  return out;
}

std::vector<int> wanted_of(const case_data::Case& input,
                           const py::object& names) {
  std::vector<int> wanted;
  if (names.is_none()) {
    for (std::size_t k = 0; k < input.responses.size(); ++k) {
      wanted.push_back(static_cast<int>(k));
    }
  } else if (py::isinstance<py::str>(names)) {
    wanted.push_back(to_response(input, names.cast<std::string>()));
  } else {
    for (const py::handle name : names) {
      wanted.push_back(to_response(input, py::str(name).cast<std::string>()));
    }
  }
  for (const int k : wanted) {
    if (!case_data::has_derivatives(input, k)) {
      throw InvalidInput(fmt::format(
          "response '{}' has no derivatives (a peak of nodal stress, or made "
          "of one); ask for the gradients of others by name, or use a "
          "von_mises_norm, a mean below the peak",
          input.responses[static_cast<std::size_t>(k)].name));
    }
  }
  return wanted;
}

py::array gradient_of(const EvaluationStage& self, const py::object& names) {
  DesignWork& work = *self.work;
  const std::vector<int> wanted = wanted_of(work.input(), names);
  work.require(Stage::Responses);
  if (work.staged().adjoint.elastic.empty() &&
      work.staged().fields.shell == nullptr) {
    throw InvalidInput(
        "this design was evaluated without its stiffness; evaluate it with "
        "keep='all' for gradients");
  }
  forward::DesignGradient gradient;
  Call().run([&] { gradient = work.gradient(wanted); });
  refuse_failed(gradient.failure);
  const Eigen::MatrixXd& jacobian = gradient.jacobian;
  py::array_t<double> rows({jacobian.rows(), jacobian.cols()});
  for (Eigen::Index r = 0; r < jacobian.rows(); ++r) {
    for (Eigen::Index c = 0; c < jacobian.cols(); ++c) {
      rows.mutable_at(r, c) = jacobian(r, c);
    }
  }
  return py::isinstance<py::str>(names)
             ? py::array(rows.attr("reshape")(jacobian.cols()))
             : py::array(rows);
}

template <class Kind, Stage stage>
auto to_stage() {
  return [](const EvaluationStage& self) {
    self.work->require(stage);
    return Kind{self.work};
  };
}

void bind_evaluation_numbers(py::class_<EvaluationStage>& type) {
  type.def_property_readonly(
          "failure",
          [](const EvaluationStage& self) {
            return self.work->failure(Stage::Responses);
          },
          "Why the design cannot be evaluated (Failure); None where it can.")
      .def_property_readonly(
          "ok",
          [](const EvaluationStage& self) {
            return !self.work->failure(Stage::Responses);
          },
          "True without a failure.")
      .def_property_readonly(
          "design",
          [](const py::object& self) {
            return view(self.cast<const EvaluationStage&>()
                            .work->staged()
                            .evaluation.design,
                        self);
          },
          "The design, float64 (design variables,), in the case's units; a "
          "read-only view.")
      .def_property_readonly(
          "responses",
          [](const py::object& self) {
            return view(self.cast<const EvaluationStage&>().work->responses(),
                        self);
          },
          "All responses in the case's order and units, NaN where the design "
          "failed, float64 (responses,); a read-only view.")
      .def_property_readonly(
          "names",
          [](const EvaluationStage& self) {
            return case_data::response_names(self.work->input());
          },
          "Names of the responses, in order.")
      .def("__getitem__", &response_of, py::arg("name"),
           "A response by name, in its unit. Raises DesignFailed where the "
           "design failed.")
      .def(
          "gradient", &gradient_of, py::arg("names") = py::none(),
          "Exact derivatives of responses by the design variables: of one name "
          "float64 (design variables,), of several (names, design variables), "
          "of None all responses; [response / design variable]. Costs one "
          "solve per response that depends on displacements. Raises "
          "DesignFailed where the design failed, InvalidInput for a response "
          "without derivatives.")
      .def_property_readonly("seconds", &seconds_of,
                             "Wall clock by stage: 'film', 'mesh', 'fea' [s].");
}

}  // namespace

void bind_evaluation(py::module_& module) {
  py::class_<EvaluationStage> type(
      module, "Evaluation",
      "What one design came to: its responses, or why there are none.");
  bind_evaluation_numbers(type);
  type.def_property_readonly("film", to_stage<FilmStage, Stage::Film>(),
                             "Its film (Film). Raises DesignFailed.")
      .def_property_readonly("mesh", to_stage<MeshStage, Stage::Mesh>(),
                             "Its elements (Mesh). Raises DesignFailed.")
      .def_property_readonly("solution",
                             to_stage<SolutionStage, Stage::Solution>(),
                             "Its displacements (Solution). Raises "
                             "DesignFailed.")
      .def("__repr__", [](const EvaluationStage& self) {
        if (const auto failure = self.work->failure(Stage::Responses)) {
          return fmt::format("<meniscus.Evaluation failed: {}>",
                             name_of(failure->kind));
        }
        std::string text = "<meniscus.Evaluation";
        const std::vector<std::string> names =
            case_data::response_names(self.work->input());
        for (std::size_t k = 0; k < names.size(); ++k) {
          text +=
              fmt::format("{} {} = {:.6g}", k == 0 ? "" : ",", names[k],
                          self.work->responses()[static_cast<Eigen::Index>(k)]);
        }
        return text + ">";
      });
}

}  // namespace meniscus::python
