#include "evolve/datafile/fe_write.h"
#include "evolve/frozen/film_model_impl.h"

namespace meniscus {

std::string FilmModel::datafile(
    const FilmState& state, const FilmSystem& system,
    const std::vector<std::string>& comments) const {
  if (state.failure) {
    throw InvalidInput("there is no film to write: " + state.failure->message);
  }
  FilmComplex complex = impl_->complex;
  if (state.points.size() != complex.mesh.points.size()) {
    throw InvalidInput("the film's state is not of this model");
  }
  complex.mesh.points = state.points;
  complex.curves = impl_->curves_of_system(system);
  const FilmTargets targets = impl_->targets_of_system(system);
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    complex.surfaces[s].tension = targets.tension[s];
  }
  for (std::size_t b = 0; b < complex.bodies.size(); ++b) {
    complex.bodies[b].volume = targets.bodies[b].volume;
    complex.bodies[b].pressure = targets.bodies[b].pressure;
  }
  return fe_text(complex, comments);
}

}  // namespace meniscus
