#include "evolve/energy/tension_field.h"

#include <span>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::energy {

namespace {

double tension_at(const films::ComplexSurface& film, const Vec3& p) {
  const auto refuse = [&](const std::string& found) {
    throw InvalidInput(
        fmt::format("film '{}': its tension {} at ({:.6g}, {:.6g}, {:.6g}); it "
                    "must be above 0 wherever the film goes, max() keeps it so",
                    film.name, found, p.x(), p.y(), p.z()));
  };
  double tension = 0.0;
  try {
    tension =
        film.tension_field->evaluate(std::span<const double>(p.data(), 3));
  } catch (const ExpressionError& error) {
    refuse(fmt::format("has no value ({})", error.what()));
  }
  if (!(tension > 0.0)) {
    refuse(fmt::format("'{}' is {:.6g}", film.tension_field->text(), tension));
  }
  return tension;
}

double mean_tension(const films::FilmComplex& complex, int surface,
                    const Points& points) {
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
      sum += tension_at(complex.surfaces[surface], points[v]);
      ++count;
    }
  }
  return sum / count;
}

}  // namespace

std::vector<double> tensions_at(const films::FilmComplex& complex,
                                const Points& points) {
  std::vector<double> result;
  for (std::size_t s = 0; s < complex.surfaces.size(); ++s) {
    const films::ComplexSurface& surface = complex.surfaces[s];
    result.push_back(surface.liquid && surface.tension_field
                         ? mean_tension(complex, static_cast<int>(s), points)
                         : surface.tension);
  }
  return result;
}

Expression positive_only(const Expression& field) {
  // No value below 0, but nothing that is none as it stands: Surface Evolver
  // refuses a division by 0 as it reads.
  return Expression::parse(
      fmt::format("if(({0})>0,{0},sqrt(-1-x*x))", field.text()),
      {"x", "y", "z"});
}

}  // namespace meniscus::energy
