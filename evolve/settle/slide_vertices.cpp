#include "evolve/settle/slide_vertices.h"

#include "evolve/settle/descent.h"

namespace meniscus::settle {

FilmState slide_vertices(films::FilmComplex& complex,
                         const SlideOptions& options) {
  const films::FilmTargets targets = energy::targets_of(complex);
  Points points = complex.mesh.points;
  const energy::FilmEnergy anywhere(complex, energy::FilmMotion::Anywhere);
  const DescentReport slid =
      descend(anywhere, targets, anywhere.space().directions(points), points,
              {.method = DescentMethod::ConjugateGradients,
               .max_steps = options.steps,
               .monitor = options.settle.monitor});
  const energy::FilmEnergy energy(complex);
  FilmState state =
      settle_in_normals(energy, complex, targets, points, options.settle);
  state.report.iterations += slid.steps;
  if (!state.failure) {
    complex.mesh.points = state.points;
  }
  return state;
}

}  // namespace meniscus::settle
