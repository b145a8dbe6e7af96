#include "pipeline/step_parts/step_figures.h"

#include <algorithm>

#include <fmt/format.h>

namespace meniscus::step_parts {

namespace {

std::string number_of(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string at_place(const std::string& film, const Vec3& place) {
  return film.empty() ? ""
                      : fmt::format(", in {} at ({:.4g}, {:.4g}, {:.4g})", film,
                                    place[0], place[1], place[2]);
}

}  // namespace

solid::FilmSolidReport summed(
    const std::vector<solid::FilmSolidReport>& reports) {
  solid::FilmSolidReport sum;
  for (const solid::FilmSolidReport& one : reports) {
    sum.patches += one.patches;
    sum.planes += one.planes;
    sum.cylinders += one.cylinders;
    sum.cones += one.cones;
    sum.spheres += one.spheres;
    sum.gap = std::max(sum.gap, one.gap);
    if (std::max(one.film_to_solid, one.solid_to_film) >
        std::max(sum.film_to_solid, sum.solid_to_film)) {
      sum.off_film = one.off_film;
      sum.off_place = one.off_place;
    }
    sum.film_to_solid = std::max(sum.film_to_solid, one.film_to_solid);
    sum.solid_to_film = std::max(sum.solid_to_film, one.solid_to_film);
    if (one.tangent_break > sum.tangent_break) {
      sum.tangent_break = one.tangent_break;
      sum.break_film = one.break_film;
      sum.break_place = one.break_place;
    }
    sum.simple.insert(sum.simple.end(), one.simple.begin(), one.simple.end());
  }
  return sum;
}

void tell_step(const StepExport& options, const solid::FilmSolidReport& film,
               const std::string& faces, std::size_t solids,
               const step::StepReport& step) {
  Monitor& monitor =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  const std::string& unit = options.unit;
  monitor.log(
      Severity::Info,
      fmt::format("{}, {}, {}, {}, {}{}; {} of {:.6g} {}3",
                  number_of(film.patches, "B-spline face"),
                  number_of(film.planes, "plane"),
                  number_of(film.cylinders, "cylinder"),
                  number_of(film.cones, "cone"),
                  number_of(film.spheres, "sphere"), faces,
                  solids == 1 ? std::string("valid closed solid")
                              : fmt::format("{} valid closed solids", solids),
                  step.volume, unit));
  for (const solid::SimpleFace& face : film.simple) {
    monitor.log(
        Severity::Info,
        fmt::format("{} is a {}{}; the film leaves it by {:.2g} {} at "
                    "most ({:.2g} of its edge)",
                    face.film, face.shape, face.has_radius ? " " + unit : "",
                    face.off, unit, face.off / options.edge));
  }
  monitor.log(
      Severity::Info,
      fmt::format(
          "gap at edges {:.2g} {} at most; film to faces {:.2g} {}, faces "
          "to film {:.2g} {} ({:.2g} of its edge){}",
          film.gap, unit, film.film_to_solid, unit, film.solid_to_film, unit,
          std::max(film.film_to_solid, film.solid_to_film) / options.edge,
          at_place(film.off_film, film.off_place)));
  monitor.log(Severity::Info,
              fmt::format("tangent breaks between faces of one film {:.2g} "
                          "degrees at most{}",
                          film.tangent_break,
                          at_place(film.break_film, film.break_place)));
}

}  // namespace meniscus::step_parts
