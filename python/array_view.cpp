#include "python/array_view.h"

namespace meniscus::python {

namespace {

template <class T>
py::array read_only(const T* data, std::vector<py::ssize_t> shape,
                    py::handle owner) {
  py::array array(py::dtype::of<T>(), std::move(shape), {}, data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace

py::array view(const double* data, std::vector<py::ssize_t> shape,
               py::handle owner) {
  return read_only(data, std::move(shape), owner);
}

py::array view(const int* data, std::vector<py::ssize_t> shape,
               py::handle owner) {
  return read_only(data, std::move(shape), owner);
}

py::array view(const Points& points, py::handle owner) {
  return view(points.empty() ? nullptr : points.front().data(),
              {static_cast<py::ssize_t>(points.size()), 3}, owner);
}

py::array view(const VectorX& values, py::handle owner) {
  return view(values.data(), {values.size()}, owner);
}

py::array view(const std::vector<double>& values, py::handle owner) {
  return view(values.data(), {static_cast<py::ssize_t>(values.size())}, owner);
}

py::array view(const std::vector<int>& values, py::handle owner) {
  return view(values.data(), {static_cast<py::ssize_t>(values.size())}, owner);
}

py::array view(const VectorX& values, int columns, py::handle owner) {
  return view(values.data(), {values.size() / columns, columns}, owner);
}

py::array view(const std::vector<int>& values, int columns, py::handle owner) {
  return view(values.data(),
              {static_cast<py::ssize_t>(values.size()) / columns, columns},
              owner);
}

}  // namespace meniscus::python
