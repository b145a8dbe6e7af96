#include "evolve/energy/tension_field.h"

#include <span>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::energy {

namespace {

double tension_at(const films::ComplexSurface& film, Numbers numbers,
                  const Vec3& p) {
  try {
    return value_at(*film.tension_field, numbers, p);
  } catch (const ExpressionError& error) {
    throw InvalidInput(
        fmt::format("film '{}': its tension {}", film.name, error.what()));
  }
}

double mean_tension(const films::FilmComplex& complex, int surface,
                    Numbers numbers, const Points& points) {
  std::vector<char> on_film(points.size(), 0);
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (complex.mesh.facet_label[f] == surface) {
      for (const int v : complex.mesh.facets[f]) {
        on_film[v] = 1;
      }
    }
  }
  double sum = 0.0;
  int count = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (on_film[v] != 0) {
      sum += tension_at(complex.surfaces[surface], numbers, points[v]);
      ++count;
    }
  }
  return sum / count;
}

}  // namespace

std::vector<double> tensions_at(const films::FilmComplex& complex,
                                const films::FilmTargets& targets,
                                const Points& points) {
  std::vector<double> result = targets.tension;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    if (complex.surfaces[s].liquid && complex.surfaces[s].tension_field) {
      const VectorX& numbers = targets.numbers[complex.quantities.size() + s];
      result[s] = mean_tension(
          complex, static_cast<int>(s),
          {numbers.data(), static_cast<std::size_t>(numbers.size())}, points);
    }
  }
  return result;
}

}  // namespace meniscus::energy
