#include "evolve/groom/remesh.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/groom/flip_average.h"
#include "evolve/groom/surface_editor.h"

namespace meniscus::groom {

void remesh_films(films::FilmComplex& complex, const RemeshOptions& options) {
  if (!options.edge_field &&
      (!std::isfinite(options.edge) || options.edge <= 0.0)) {
    throw InvalidInput(
        fmt::format("edge length is {}, must be above 0", options.edge));
  }
  SurfaceEditor editor(complex);
  make_isotropic(editor, {options.edge, options.edge_field}, options.passes);
  complex = std::move(editor).finish();
}

int equiangulate(films::FilmComplex& complex, FlipRule rule) {
  SurfaceEditor editor(std::move(complex));
  const int flips = editor.flip_all(rule);
  complex = std::move(editor).finish();
  return flips;
}

void average_vertices(films::FilmComplex& complex,
                      const std::vector<char>& marked) {
  SurfaceEditor editor(std::move(complex));
  editor.average({}, marked);
  complex = std::move(editor).finish();
}

}  // namespace meniscus::groom
