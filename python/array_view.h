/// The engine's memory as NumPy arrays: not copied, read-only, alive for as
/// long as any array of it is.
#pragma once

#include <vector>

#include <pybind11/numpy.h>

#include "core/types.h"

namespace meniscus::python {

namespace py = pybind11;

/// `owner`: the Python object that holds the memory, the array's base.
py::array view(const double* data, std::vector<py::ssize_t> shape,
               py::handle owner);
py::array view(const int* data, std::vector<py::ssize_t> shape,
               py::handle owner);

/// (n, 3)
py::array view(const Points& points, py::handle owner);
/// (n,)
py::array view(const VectorX& values, py::handle owner);
py::array view(const std::vector<double>& values, py::handle owner);
py::array view(const std::vector<int>& values, py::handle owner);
/// (n / columns, columns)
py::array view(const VectorX& values, int columns, py::handle owner);
py::array view(const std::vector<int>& values, int columns, py::handle owner);

/// (n, N)
template <class T, std::size_t N>
py::array view(const std::vector<std::array<T, N>>& rows, py::handle owner) {
  return view(
      rows.empty() ? nullptr : rows.front().data(),
      {static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(N)},
      owner);
}

}  // namespace meniscus::python
