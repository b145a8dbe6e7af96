/// Natural frequencies and buckling factors beside one solve, on the parts of
/// the elasticity's speed table: CPU seconds of one thread.
///
///   modes_bench [--scale X]
#include <cstdlib>
#include <ctime>
#include <string>

#include <fmt/format.h>

#include "fea/modes/buckling.h"
#include "fea/modes/modes.h"
#include "tests/support/elastic_race.h"
#include "tests/support/measured_child.h"

namespace meniscus {
namespace {

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::string line(const char* what, double seconds, double solve, int iterations,
                 const std::string& values) {
  return fmt::format(
      "  {:<34} {:6.2f} s, x {:.2f} of a solve, {} iterations{}\n", what,
      seconds, seconds / solve, iterations, values);
}

std::string buckle(const char* what, const elastic::ElasticModel& model,
                   const ElasticPart& part, double solve,
                   const modes::BucklingOptions& options) {
  const double start = cpu_seconds();
  const modes::BucklingModes modes =
      modes::buckling_modes(model, part.mesh, {part.load_case}, 0,
                            model.base_solution().displacements[0], options);
  std::string values = modes.failure ? ": " + modes.failure->message : ":";
  for (const double factor : modes.factors) {
    values += fmt::format(" {:.6g}", factor);
  }
  return line(what, cpu_seconds() - start, solve, modes.iterations, values);
}

std::string vibrate(const elastic::ElasticModel& model, const ElasticPart& part,
                    double solve) {
  const double start = cpu_seconds();
  const modes::NaturalModes modes =
      modes::natural_modes(model, part.mesh, {part.load_case}, 0);
  std::string values = modes.failure ? ": " + modes.failure->message : ":";
  for (const double f : modes.frequencies) {
    values += fmt::format(" {:.6g}", f);
  }
  return line("6 frequencies, 1e-6", cpu_seconds() - start, solve,
              modes.iterations, values);
}

std::string measure(const ElasticWork& work, double scale) {
  const ElasticPart part = work.make(scale);
  const double start = cpu_seconds();
  const elastic::ElasticModel model(part.mesh, part.materials,
                                    {part.load_case});
  const equations::ElasticReport& report = model.base_solution().report;
  const double first = cpu_seconds() - start;
  const double solve = first * report.solve_seconds /
                       (report.solve_seconds + report.setup_seconds);
  std::string text = fmt::format(
      "{}: {} elements, {} unknowns\n  first model {:.2f} s, of it the solve "
      "{:.2f} s, {} iterations\n",
      work.name, part.mesh.element_count(), report.dofs, first, solve,
      report.iterations);
  text += buckle(
      "first factor, 1e-3 (by default)", model, part, solve,
      {.tolerance = 1e-3, .largest = 1e3, .guards = 1, .max_iterations = 40});
  text += buckle("2 factors, 1e-6", model, part, solve, {.count = 2});
  return text + vibrate(model, part, solve);
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
  double scale = 1.0;
  if (argc == 3 && std::string(argv[1]) == "--scale") {
    scale = std::atof(argv[2]);
  }
  for (const meniscus::ElasticWork& work : meniscus::elastic_works()) {
    const meniscus::MeasuredChild child = meniscus::measure_forked(
        [&] { return meniscus::measure(work, scale); });
    fmt::print("{}  peak {:.0f} MB\n", child.output, child.peak_bytes / 1e6);
  }
  return 0;
}
