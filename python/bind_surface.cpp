#include <pybind11/stl.h>

#include "core/geometry/surface_mesh.h"
#include "python/array_view.h"
#include "python/bindings.h"

namespace meniscus::python {

namespace {

const QuadraticSurface& surface_of(const py::object& self) {
  return *self.cast<const SurfaceStage&>().surface;
}

}  // namespace

void bind_surface(py::module_& module) {
  py::class_<SurfaceStage>(module, "Surface",
                           "A closed surface of six-node triangles.")
      .def_property_readonly(
          "vertices",
          [](const py::object& self) {
            return view(surface_of(self).base.points, self);
          },
          "Corners, float64 (vertices, 3) [length]; a read-only view.")
      .def_property_readonly(
          "facets",
          [](const py::object& self) {
            return view(surface_of(self).base.facets, self);
          },
          "Corner numbers of each facet, counter-clockwise from outside, int32 "
          "(facets, 3); a read-only view.")
      .def_property_readonly(
          "facet_labels",
          [](const py::object& self) {
            return view(surface_of(self).base.facet_label, self);
          },
          "Per facet the position of its surface in `labels`, int32 "
          "(facets,); a read-only view.")
      .def_property_readonly(
          "labels",
          [](const py::object& self) { return surface_of(self).base.labels; },
          "Names of films and caps.")
      .def_property_readonly(
          "edges",
          [](const py::object& self) {
            return view(surface_of(self).edges, self);
          },
          "Corner numbers of each edge, int32 (edges, 2); a read-only view.")
      .def_property_readonly(
          "mid_sides",
          [](const py::object& self) {
            return view(surface_of(self).mid, self);
          },
          "The point amid each edge, on the finer film, float64 (edges, 3) "
          "[length]; a read-only view.")
      .def_property_readonly(
          "facet_edges",
          [](const py::object& self) {
            return view(surface_of(self).facet_edges, self);
          },
          "Edge numbers (01) (12) (20) of each facet, int32 (facets, 3); a "
          "read-only view.")
      .def_property_readonly(
          "volume",
          [](const SurfaceStage& self) {
            return enclosed_volume(self.surface->base);
          },
          "Enclosed by the flat facets [length^3].")
      .def_property_readonly(
          "area",
          [](const SurfaceStage& self) {
            return surface_area(self.surface->base);
          },
          "Of the flat facets [length^2].");
}

}  // namespace meniscus::python
