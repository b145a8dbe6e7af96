#include "python/design_input.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "core/nearest_name.h"

namespace meniscus::python {

namespace {

VectorX from_mapping(const case_data::Case& input, const py::dict& values) {
  VectorX design = case_data::initial_design(input);
  const std::vector<std::string> names = case_data::design_names(input);
  for (const auto& [key, value] : values) {
    design[position_of(py::str(key).cast<std::string>(), names,
                       "design variable")] = value.cast<double>();
  }
  return design;
}

VectorX from_numbers(const case_data::Case& input, const py::object& values) {
  using Numbers =
      py::array_t<double, py::array::c_style | py::array::forcecast>;
  const Numbers numbers = Numbers::ensure(values);
  if (!numbers) {
    PyErr_Clear();
    throw InvalidInput("design: expected numbers, found " +
                       py::repr(values).cast<std::string>());
  }
  const auto wanted = static_cast<py::ssize_t>(input.design.size());
  if (numbers.ndim() != 1 || numbers.size() != wanted) {
    throw InvalidInput(
        fmt::format("design: found an array of shape {}, expected ({},): {}",
                    py::repr(numbers.attr("shape")).cast<std::string>(), wanted,
                    fmt::join(case_data::design_names(input), ", ")));
  }
  return Eigen::Map<const VectorX>(numbers.data(), wanted);
}

}  // namespace

int position_of(const std::string& found, const std::vector<std::string>& names,
                const char* what) {
  const auto at = std::find(names.begin(), names.end(), found);
  if (at == names.end()) {
    const std::string near = nearest_name(found, names);
    throw InvalidInput(fmt::format(
        "no {} '{}'{}; there are: {}", what, found,
        near.empty() ? "" : fmt::format(", did you mean '{}'", near),
        names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
  }
  return static_cast<int>(at - names.begin());
}

VectorX to_design(const case_data::Case& input, const py::object& design) {
  if (design.is_none()) {
    return case_data::initial_design(input);
  }
  const VectorX values = py::isinstance<py::dict>(design)
                             ? from_mapping(input, design)
                             : from_numbers(input, design);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) {
      throw InvalidInput(fmt::format(
          "design: {} is {}, expected a finite number",
          input.design[static_cast<std::size_t>(k)].name, values[k]));
    }
  }
  return values;
}

int to_response(const case_data::Case& input, const std::string& name) {
  return position_of(name, case_data::response_names(input), "response");
}

int to_load_case(const case_data::Case& input, const py::object& name) {
  if (name.is_none()) {
    return 0;
  }
  std::vector<std::string> names;
  names.reserve(input.load_cases.size());
  for (const case_data::LoadCaseEntry& load_case : input.load_cases) {
    names.push_back(load_case.name);
  }
  return position_of(py::str(name).cast<std::string>(), names, "load case");
}

}  // namespace meniscus::python
