/// Designs and names of responses as Python gives them.
#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "pipeline/case_data/case.h"

namespace meniscus::python {

namespace py = pybind11;

/// A case with what its reader warned of.
struct ReadCase {
  std::shared_ptr<const case_data::Case> input;
  std::vector<std::string> warnings;
};

/// A number per design variable in their order, or a mapping of names, those
/// left out at their initial values: of a vector an array of its shape, or one
/// number for all elements; "t[2, 3]" is one. None: the initial design. Throws
/// InvalidInput for anything else.
VectorX to_values(const case_data::Case& input, const py::object& values);

/// The same; numbers that are not finite are refused too.
VectorX to_design(const case_data::Case& input, const py::object& design);

/// Position of a response. Throws InvalidInput with the nearest name.
int to_response(const case_data::Case& input, const std::string& name);

/// Position of a load case; None: the first.
int to_load_case(const case_data::Case& input, const py::object& name);

/// `found` among `names`; throws InvalidInput for "WHAT 'found'".
int position_of(const std::string& found, const std::vector<std::string>& names,
                const char* what);

}  // namespace meniscus::python
