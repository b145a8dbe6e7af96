#include "tests/support/film_race.h"

#include <chrono>
#include <omp.h>
#include <sstream>

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/memory.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_complexes.h"
#include "tests/support/measured_child.h"

namespace meniscus {

namespace {

constexpr double kResidualFactor = 1e-10;  // x tension x mean edge

constexpr const char* kDescent = "g 10; u; V; g 5;";
// From fewer steps on the coarse frame, the fine levels diverge.
constexpr const char* kLongDescent = "g 20; u; V; g 10;";

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

int film_facets(const films::FilmComplex& complex) {
  int count = 0;
  for (const int label : complex.mesh.facet_label) {
    count += complex.surfaces[label].liquid ? 1 : 0;
  }
  return count;
}

std::string settle_film(const films::FilmComplex& start, int refinements) {
  keep_freed_memory();  // as the program does
  films::FilmComplex complex = start;
  omp_set_num_threads(1);
  const double before = user_seconds();
  const auto begin = std::chrono::steady_clock::now();
  const settle::FilmState state = find_refined(complex, refinements);
  const std::chrono::duration<double> wall =
      std::chrono::steady_clock::now() - begin;
  const double user = user_seconds() - before;
  const settle::FilmReport& report = state.report;
  const bool settled = !state.failure && report.index == 0 &&
                       report.residual <= report.residual_bound;
  return fmt::format(
      "{:d} {:.17g} {:.17g} {} {:.17g} {:.17g} {:.17g} {:.17g}"
      "\n{}",
      settled, user, wall.count(), film_facets(complex), report.energy,
      report.residual, report.residual_bound, report.min_eigenvalue,
      report.verdict);
}

}  // namespace

void PrintTo(const SpeedWork& work, std::ostream* out) { *out << work.name; }

const std::vector<SpeedWork>& speed_works() {
  static const std::vector<SpeedWork> works = {
      {"catenoid", [] { return test_films::catenoid_start(); }, 6, kDescent, 5,
       16, 10, 30},
      {"cube", [] { return test_films::cube_start(); }, 5, kDescent, 5, 20, 12,
       48},
      {"strut", [] { return test_films::strut_start(); }, 5, kDescent, 5, 25,
       10, 50},
      {"triple_disk", [] { return test_films::triple_disk_start(); }, 6,
       kDescent, 3, 9, 8, 24},
      {"cube_frame", [] { return test_films::cube_frame_start(); }, 6,
       kLongDescent, 3, 8, 6, 16}};
  return works;
}

settle::FilmState find_refined(films::FilmComplex& complex, int refinements) {
  return settle::find_equilibrium(
      complex, {.refinements = refinements,
                .settle = {.residual_factor = kResidualFactor}});
}

FilmRun run_film(const films::FilmComplex& start, int refinements) {
  const MeasuredChild child =
      measure_forked([&] { return settle_film(start, refinements); });
  FilmRun run;
  run.peak_bytes = child.peak_bytes;
  run.user_seconds = child.user_seconds;
  run.system_seconds = child.system_seconds;
  run.wall_seconds = child.wall_seconds;
  run.verdict = child.output;
  if (child.succeeded) {
    std::istringstream text(child.output);
    text >> run.settled >> run.user_seconds >> run.wall_seconds >> run.facets >>
        run.energy >> run.residual >> run.residual_bound >> run.min_eigenvalue;
    text.ignore();
    std::getline(text, run.verdict);
  }
  return run;
}

}  // namespace meniscus
