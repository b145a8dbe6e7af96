#include <fmt/format.h>

#include "core/geometry/surface_mesh.h"
#include "python/call.h"
#include "python/errors.h"
#include "python/stage_properties.h"

namespace meniscus::python {

namespace {

/// Without the interpreter's lock: another thread may hold the design's.
template <class Value, class Get>
const Value& fetch(const Get& get) {
  const py::gil_scoped_release release;
  return get();
}

const SurfaceMesh& film_of(const FilmStage& self) {
  return fetch<SurfaceMesh>(
      [&]() -> const SurfaceMesh& { return self.work->fine_film(); });
}

py::dict volumes_of(const settle::FilmReport& report,
                    double settle::BodyState::*number) {
  py::dict values;
  for (const settle::BodyState& body : report.bodies) {
    values[py::str(body.name)] = body.*number;
  }
  return values;
}

void bind_film_arrays(py::class_<FilmStage>& type) {
  type.def_property_readonly(
          "vertices",
          [](const py::object& self) {
            return view(film_of(self.cast<const FilmStage&>()).points, self);
          },
          "Vertices of film and caps at the film's own resolution, float64 "
          "(vertices, 3) [length]; a read-only view.")
      .def_property_readonly(
          "facets",
          [](const py::object& self) {
            return view(film_of(self.cast<const FilmStage&>()).facets, self);
          },
          "Vertex numbers of each facet, counter-clockwise from outside, int32 "
          "(facets, 3); a read-only view.")
      .def_property_readonly(
          "facet_labels",
          [](const py::object& self) {
            return view(film_of(self.cast<const FilmStage&>()).facet_label,
                        self);
          },
          "Per facet the position of its surface in `labels`, int32 "
          "(facets,); a read-only view.")
      .def_property_readonly(
          "labels", [](const FilmStage& self) { return film_of(self).labels; },
          "Names of films and caps.")
      .def(
          "surface",
          [](const FilmStage& self) {
            return SurfaceStage{
                self.work,
                &fetch<QuadraticSurface>([&]() -> const QuadraticSurface& {
                  return self.work->surface();
                })};
          },
          "The closed surface as it is filled with elements (Surface). Raises "
          "DesignFailed.")
      .def(
          "mesh",
          [](const FilmStage& self) {
            Call().run([&] { self.work->advance(Stage::Mesh); });
            refuse_failed(self.work->failure(Stage::Film));
            return MeshStage{self.work};
          },
          "Moves the frozen elements into the surface (Mesh). Raises "
          "DesignFailed where there is no film, InvalidInput for the film of a "
          "FilmModel.");
}

template <class Number>
auto film_figure(Number settle::FilmReport::*number) {
  return [number](const FilmStage& self) {
    return self.work->staged().evaluation.film.*number;
  };
}

}  // namespace

void bind_film(py::module_& module) {
  py::class_<FilmStage> type(module, "Film",
                             "A film at rest at one design, or why there is "
                             "none; its figures are there in both cases.");
  bind_failure<FilmStage, Stage::Film>(type);
  bind_film_arrays(type);
  type.def_property_readonly("verdict",
                             film_figure(&settle::FilmReport::verdict),
                             "'stable', 'unstable: ...' or 'pinching: ...'.")
      .def_property_readonly("residual",
                             film_figure(&settle::FilmReport::residual),
                             "Largest out-of-balance force at a free vertex "
                             "[force].")
      .def_property_readonly("residual_bound",
                             film_figure(&settle::FilmReport::residual_bound),
                             "What the residual is held below [force].")
      .def_property_readonly(
          "min_eigenvalue", film_figure(&settle::FilmReport::min_eigenvalue),
          "Smallest eigenvalue of the constrained Hessian in the metric of "
          "vertex areas [force/length^3]; above 0: stable.")
      .def_property_readonly("index", film_figure(&settle::FilmReport::index),
                             "Number of negative eigenvalues.")
      .def_property_readonly("iterations",
                             film_figure(&settle::FilmReport::iterations),
                             "Of Newton's method.")
      .def_property_readonly("energy", film_figure(&settle::FilmReport::energy),
                             "Tension times area, and fields [force length].")
      .def_property_readonly("area", film_figure(&settle::FilmReport::area),
                             "Of films, caps not counted [length^2].")
      .def_property_readonly(
          "smallest_neck", film_figure(&settle::FilmReport::smallest_neck),
          "Shortest way through the inside from film to film [length]; 0: "
          "none.")
      .def_property_readonly(
          "volumes",
          [](const FilmStage& self) {
            return volumes_of(self.work->staged().evaluation.film,
                              &settle::BodyState::volume);
          },
          "Volume of each body by name [length^3].")
      .def_property_readonly(
          "pressures",
          [](const FilmStage& self) {
            return volumes_of(self.work->staged().evaluation.film,
                              &settle::BodyState::pressure);
          },
          "Pressure of each body by name, inside minus outside "
          "[force/length^2].")
      .def("__repr__", [](const FilmStage& self) {
        const settle::FilmReport& film = self.work->staged().evaluation.film;
        return fmt::format("<meniscus.Film {}, {} facets>", film.verdict,
                           film.facets);
      });
}

}  // namespace meniscus::python
