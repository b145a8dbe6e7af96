#include <algorithm>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/responses/responses.h"
#include "python/array_view.h"
#include "python/bindings.h"

namespace meniscus::python {

namespace {

ReadCase checked(reader::CaseReading reading) {
  if (!reading.input) {
    throw InvalidInput(fmt::format("{}", fmt::join(reading.problems, "\n")));
  }
  return {std::make_shared<const case_data::Case>(std::move(*reading.input)),
          std::move(reading.warnings)};
}

struct ResponseInfo {
  std::string name;
  std::string unit;
  bool has_gradient = false;
};

std::vector<ResponseInfo> responses_of(const case_data::Case& input) {
  std::vector<ResponseInfo> all;
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const auto index = static_cast<int>(k);
    all.push_back({input.responses[k].name,
                   case_data::response_unit(input, index),
                   case_data::has_derivatives(input, index)});
  }
  return all;
}

py::array bounds_of(const case_data::Case& input,
                    double case_data::DesignVariable::*end) {
  py::array_t<double> values(static_cast<py::ssize_t>(input.design.size()));
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    values.mutable_at(static_cast<py::ssize_t>(k)) = input.design[k].*end;
  }
  return values;
}

/// Numbers of design variables by name: floats, arrays of vectors.
py::dict by_name(const case_data::Case& input, const VectorX& values) {
  py::dict named;
  for (const case_data::DesignRow& row : case_data::design_rows(input)) {
    const double* first = values.data() + row.first;
    if (row.vector == nullptr) {
      named[py::str(row.name)] = *first;
      continue;
    }
    py::array_t<double> array(std::vector<py::ssize_t>(
        row.vector->shape.begin(), row.vector->shape.end()));
    std::copy(first, first + row.count, array.mutable_data());
    named[py::str(row.name)] = array;
  }
  return named;
}

void bind_entries(py::module_& module) {
  py::class_<case_data::DesignVariable>(
      module, "DesignVariable", "A number of the case that a study may move.")
      .def_readonly("name", &case_data::DesignVariable::name, "Its name.")
      .def_readonly("initial", &case_data::DesignVariable::initial,
                    "Where models are frozen, in the case's units.")
      .def_readonly("lower", &case_data::DesignVariable::lower,
                    "Its lower bound.")
      .def_readonly("upper", &case_data::DesignVariable::upper,
                    "Its upper bound.")
      .def("__repr__", [](const case_data::DesignVariable& self) {
        return fmt::format(
            "<meniscus.DesignVariable {} = {:g} in [{:g}, {:g}]>", self.name,
            self.initial, self.lower, self.upper);
      });
  py::class_<ResponseInfo>(module, "Response",
                           "A number that the case asks of a design.")
      .def_readonly("name", &ResponseInfo::name, "Its name.")
      .def_readonly("unit", &ResponseInfo::unit,
                    "Its unit ('mm', 't'); empty where it has none.")
      .def_readonly("has_gradient", &ResponseInfo::has_gradient,
                    "Whether Evaluation.gradient() knows it.")
      .def("__repr__", [](const ResponseInfo& self) {
        return fmt::format("<meniscus.Response {} [{}]>", self.name, self.unit);
      });
  py::class_<UnitSystem>(module, "Units",
                         "One consistent system: nothing is converted.")
      .def_readonly("system", &UnitSystem::name, "'mm-N-MPa', ...")
      .def_readonly("length", &UnitSystem::length, "Of lengths, 'mm'.")
      .def_readonly("force", &UnitSystem::force, "Of forces, 'N'.")
      .def_readonly("pressure", &UnitSystem::pressure, "Of stresses, 'MPa'.")
      .def_readonly("mass", &UnitSystem::mass, "Of masses, 't'.")
      .def("__repr__", [](const UnitSystem& self) {
        return fmt::format("<meniscus.Units {}>", self.name);
      });
}

void bind_names(py::class_<ReadCase>& type) {
  type.def_property_readonly(
          "name", [](const ReadCase& self) { return self.input->name; },
          "The file's name, or its folder's for case.toml.")
      .def_property_readonly(
          "title", [](const ReadCase& self) { return self.input->title; },
          "The case's title.")
      .def_property_readonly(
          "path", [](const ReadCase& self) { return self.input->path; },
          "The file, as messages name it.")
      .def_property_readonly(
          "text", [](const ReadCase& self) { return self.input->text; },
          "The case file, word for word, overrides not applied.")
      .def_property_readonly(
          "overrides",
          [](const ReadCase& self) { return self.input->overrides; },
          "What was set on top of the file, as 'name=value'.")
      .def_property_readonly(
          "hash", [](const ReadCase& self) { return self.input->hash; },
          "Fingerprint of all that evaluations depend on; result.json's "
          "case_hash.")
      .def_readonly("warnings", &ReadCase::warnings,
                    "What the reader warned of, 'FILE:LINE: ...' each.")
      .def_property_readonly(
          "units", [](const ReadCase& self) { return self.input->units; },
          "The unit system of all numbers of this case.")
      .def_property_readonly(
          "members",
          [](const ReadCase& self) {
            std::vector<std::string> names;
            for (const case_data::MemberEntry& member :
                 self.input->study.members) {
              names.push_back(member.name);
            }
            return names;
          },
          "Names of a family's members; empty for other cases.")
      .def_property_readonly(
          "load_cases",
          [](const ReadCase& self) {
            std::vector<std::string> names;
            for (const case_data::LoadCaseEntry& load_case :
                 self.input->load_cases) {
              names.push_back(load_case.name);
            }
            return names;
          },
          "Names of the load cases, in order.");
}

void bind_case_numbers(py::class_<ReadCase>& type) {
  type.def_property_readonly(
          "design", [](const ReadCase& self) { return self.input->design; },
          "The design variables (DesignVariable), in the order of designs; a "
          "vector's elements, 't[2,3]', one by one, the last index fastest.")
      .def(
          "by_name",
          [](const ReadCase& self, const py::object& values) {
            return by_name(*self.input, to_values(*self.input, values));
          },
          py::arg("values") = py::none(),
          "Numbers per design variable by name: of a design (the initial one), "
          "a gradient or bounds, float64 (design variables,). A float each, of "
          "a vector a float64 array of its shape; new ones. A dict of them is "
          "a design again.")
      .def_property_readonly(
          "initial_design",
          [](const ReadCase& self) {
            return bounds_of(*self.input, &case_data::DesignVariable::initial);
          },
          "Initial values, float64 of shape (design variables,); a new array.")
      .def_property_readonly(
          "lower_bounds",
          [](const ReadCase& self) {
            return bounds_of(*self.input, &case_data::DesignVariable::lower);
          },
          "Lower bounds, float64 of shape (design variables,); a new array.")
      .def_property_readonly(
          "upper_bounds",
          [](const ReadCase& self) {
            return bounds_of(*self.input, &case_data::DesignVariable::upper);
          },
          "Upper bounds, float64 of shape (design variables,); a new array.")
      .def_property_readonly(
          "responses",
          [](const ReadCase& self) { return responses_of(*self.input); },
          "The responses (Response: name, unit), in the order of "
          "Evaluation.responses.")
      .def(
          "parameters",
          [](const ReadCase& self, const py::object& design) {
            py::dict values;
            for (const auto& [name, value] : case_data::parameter_values(
                     *self.input, to_design(*self.input, design))) {
              values[py::str(name)] = value;
            }
            return values;
          },
          py::arg("design") = py::none(),
          "The case's named numbers at a design (the initial one), by name.");
}

}  // namespace

void bind_case(py::module_& module) {
  bind_entries(module);
  py::class_<ReadCase> type(module, "Case",
                            "A case that was read and checked; it does not "
                            "change.");
  bind_names(type);
  bind_case_numbers(type);
  type.def("__repr__", [](const ReadCase& self) {
    return fmt::format("<meniscus.Case {}: {} design variables, {} responses>",
                       self.input->name, self.input->design.size(),
                       self.input->responses.size());
  });
  module.def(
      "_read_case_file",
      [](const std::string& path, const std::vector<std::string>& overrides) {
        return checked(reader::read_case_file(path, overrides));
      },
      py::arg("path"), py::arg("overrides"), "A case from its file.");
  module.def(
      "_read_case_text",
      [](const std::string& text, const std::string& path,
         const std::vector<std::string>& overrides) {
        return checked(reader::read_case_text(text, path, overrides));
      },
      py::arg("text"), py::arg("path"), py::arg("overrides"),
      "A case from text; `path` for messages and files beside it.");
}

}  // namespace meniscus::python
