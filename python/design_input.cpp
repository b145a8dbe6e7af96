#include "python/design_input.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "core/nearest_name.h"
#include "pipeline/case_data/design_vectors.h"

namespace meniscus::python {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The numbers that a value of a mapping stands for: one for each of the
/// variables of that name, or an array of a vector's shape.
Numbers numbers_for(const case_data::Case& input, const std::string& name,
                    const py::handle& value) {
  Numbers numbers = Numbers::ensure(py::reinterpret_borrow<py::object>(value));
  if (!numbers) {
    PyErr_Clear();
    throw InvalidInput(fmt::format("design: '{}' is {}, expected numbers", name,
                                   py::repr(value).cast<std::string>()));
  }
  std::vector<int> shape;
  for (const case_data::DesignVector& vector : input.vectors) {
    if (vector.name == name) {
      shape = vector.shape;
    }
  }
  const std::vector<int> found(numbers.shape(),
                               numbers.shape() + numbers.ndim());
  if (!found.empty() && found != shape) {
    throw InvalidInput(fmt::format(
        "design: '{}' is an array of shape {}, expected {}", name,
        py::repr(numbers.attr("shape")).cast<std::string>(),
        shape.empty() ? "one number"
                      : fmt::format("({}) or one number for all elements",
                                    fmt::join(shape, ", "))));
  }
  return numbers;
}

VectorX from_mapping(const case_data::Case& input, const py::dict& values) {
  VectorX design = case_data::initial_design(input);
  for (const auto& [key, value] : values) {
    const std::string name = py::str(key).cast<std::string>();
    const std::vector<std::size_t> found = case_data::positions_of(input, name);
    if (found.empty()) {
      position_of(name, case_data::row_names(input), "design variable");
    }
    const Numbers numbers = numbers_for(input, name, value);
    for (std::size_t k = 0; k < found.size(); ++k) {
      design[static_cast<Eigen::Index>(found[k])] =
          numbers.data()[numbers.ndim() == 0 ? 0 : k];
    }
  }
  return design;
}

VectorX from_numbers(const case_data::Case& input, const py::object& values) {
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
                    fmt::join(case_data::row_names(input), ", ")));
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

VectorX to_values(const case_data::Case& input, const py::object& values) {
  return values.is_none()                   ? case_data::initial_design(input)
         : py::isinstance<py::dict>(values) ? from_mapping(input, values)
                                            : from_numbers(input, values);
}

VectorX to_design(const case_data::Case& input, const py::object& design) {
  const VectorX values = to_values(input, design);
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
