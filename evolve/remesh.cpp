#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/grooming.h"
#include "evolve/rims.h"
#include "evolve/surface_editor.h"

namespace meniscus {

namespace {

SurfaceEditor editor_of(const FilmComplex& complex) {
  EditLimits limits;
  limits.held.resize(complex.vertices.size());
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    limits.held[v] = complex.vertices[v].kind == VertexKind::Free ? 0 : 1;
  }
  limits.frozen.resize(complex.mesh.facets.size());
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    limits.frozen[f] =
        complex.surfaces[complex.mesh.facet_label[f]].liquid ? 0 : 1;
  }
  limits.rim_next = rim_neighbours(complex);
  return {complex.mesh, std::move(limits)};
}

void take_back(const SurfaceEditor& editor, FilmComplex& complex) {
  std::vector<int> origin;
  complex.mesh = editor.finish(&origin);
  std::vector<ComplexVertex> vertices;
  vertices.reserve(origin.size());
  for (const int old : origin) {
    vertices.push_back(old < 0 ? ComplexVertex{} : complex.vertices[old]);
  }
  complex.vertices = std::move(vertices);
}

}  // namespace

void remesh_films(FilmComplex& complex, const RemeshOptions& options) {
  if (!std::isfinite(options.edge) || options.edge <= 0.0) {
    throw InvalidInput(
        fmt::format("edge length is {}, must be above 0", options.edge));
  }
  SurfaceEditor editor = editor_of(complex);
  make_isotropic(editor, options.edge, options.passes);
  take_back(editor, complex);
}

int equiangulate(FilmComplex& complex) {
  SurfaceEditor editor = editor_of(complex);
  const int flips = editor.flip_all();
  take_back(editor, complex);
  return flips;
}

void average_vertices(FilmComplex& complex) {
  SurfaceEditor editor = editor_of(complex);
  editor.average();
  take_back(editor, complex);
}

}  // namespace meniscus
