#include "tests/support/elastic_race.h"

#include <cmath>
#include <omp.h>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/memory.h"
#include "core/timer.h"
#include "fea/element/point_stress.h"
#include "io/calculix_inp.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/calculix.h"
#include "tests/support/mapped_shapes.h"
#include "tests/support/measured_child.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus {

namespace {

element::Material aluminium() {
  return {"aluminium", 70000.0, 0.33, 2.7e-9, {}};
}

ElasticPart loaded(TetMesh mesh, const std::string& held,
                   const std::string& pulled) {
  ElasticPart part;
  part.moved = mesh;
  double size = 0.0;
  for (const Vec3& x : mesh.nodes) {
    size = std::max(size, x.cwiseAbs().maxCoeff());
  }
  for (Vec3& x : part.moved.nodes) {
    const Vec3 s = 3.0 / size * x;
    x += 0.01 * size * Vec3(std::sin(s.y()), std::sin(s.z()), std::sin(s.x()));
  }
  part.mesh = std::move(mesh);
  part.materials = {aluminium()};
  part.load_case.name = "service";
  part.load_case.supports = {
      {.surface = held, .fix_x = true, .fix_y = true, .fix_z = true}};
  part.load_case.forces = {{pulled, {300.0, -100.0, -1000.0}}};
  return part;
}

/// Cells along a side, from those at scale 1.
int cells(double count, double scale) {
  return std::max(1, static_cast<int>(std::lround(count * std::cbrt(scale))));
}

TetMesh tet_block(double count, double scale) {
  const double edge = 100.0 / cells(count, scale);
  SurfaceMesh surface = shapes::box({200.0, 100.0, 100.0}, cells(count, scale));
  mesh_tet::Tetrahedralization result =
      mesh_tet::tetrahedralize(surface, {.edge = edge});
  if (result.failure) {
    throw std::runtime_error(result.failure->message);
  }
  return std::move(result.mesh);
}

ElasticPart tube(double scale) {
  return loaded(shapes::quarter_ring(20.0, 22.0, 35.0, cells(4, scale),
                                     cells(70, scale), cells(68, scale)),
                "z0", "z1");
}

ElasticPart block(double scale) {
  return loaded(shapes::straight_quadratic(tet_block(19.5, scale)), "x0", "x1");
}

ElasticPart linear_block(double scale) {
  return loaded(tet_block(19.5, scale), "x0", "x1");
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) +
           1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Of the design at `mesh`, whose displacement is `u`.
double recovery_seconds(const TetMesh& mesh, const ElasticPart& part,
                        const VectorX& u) {
  const Timer timer;
  stress::recover_stress(mesh, part.materials, u);
  return timer.seconds();
}

void require(const equations::ElasticSolution& solution) {
  if (solution.failure) {
    throw std::runtime_error(solution.failure->message);
  }
}

std::string solve(ElasticPart (*make)(double), double scale, int threads,
                  equations::SolverKind solver) {
  keep_freed_memory();  // as the program does
  omp_set_num_threads(threads);
  const ElasticPart part = make(scale);
  const double start = cpu_seconds();
  const elastic::ElasticModel model(part.mesh, part.materials, {part.load_case},
                                    {.solver = solver});
  const equations::ElasticSolution& base = model.base_solution();
  require(base);
  const double stress =
      recovery_seconds(part.mesh, part, base.displacements[0]);
  const double first = cpu_seconds();
  const equations::ElasticSolution next = model.solve(part.moved);
  require(next);
  const double next_stress =
      recovery_seconds(part.moved, part, next.displacements[0]);
  const double end = cpu_seconds();
  return fmt::format(
      "{} {} {} {} {} {} {} {} {} {} {}", part.mesh.element_count(),
      base.report.dofs, base.report.iterations, base.report.setup_seconds,
      base.report.solve_seconds, stress, next.report.setup_seconds,
      next.report.solve_seconds, next_stress, first - start, end - first);
}

io::CalculixDeck deck_of(const ElasticPart& part) {
  io::CalculixDeck deck;
  deck.materials = {{.name = "aluminium",
                     .youngs_modulus = part.materials[0].youngs_modulus,
                     .poisson_ratio = part.materials[0].poisson_ratio}};
  io::DeckStep step{.name = "service"};
  step.supports = {{.surface = part.load_case.supports[0].surface,
                    .fix_x = true,
                    .fix_y = true,
                    .fix_z = true}};
  step.nodal_forces =
      loads::nodal_forces(part.mesh, part.load_case, part.materials);
  deck.steps = {step};
  return deck;
}

std::string compare(ElasticPart (*make)(double), double scale,
                    double time_limit) {
  const ElasticPart part = make(scale);
  io::CalculixDeck deck = deck_of(part);
  deck.output = io::DeckOutput::Print;
  const std::vector<CalculixStep> theirs = run_calculix(
      io::calculix_deck(part.mesh, deck),
      static_cast<int>(part.mesh.nodes.size()),
      {.time_limit = time_limit, .threads = omp_get_max_threads()});
  const elastic::ElasticModel model(part.mesh, part.materials,
                                    {part.load_case});
  require(model.base_solution());
  const VectorX& u = model.base_solution().displacements[0];
  return fmt::format(
      "{} {}", relative_difference(u, theirs.at(0).displacement),
      relative_difference(
          element::point_stress(part.mesh, part.materials, u).stress,
          theirs.at(0).stress));
}

}  // namespace

void PrintTo(const ElasticWork& work, std::ostream* out) { *out << work.name; }

const std::vector<ElasticWork>& elastic_works() {
  static const std::vector<ElasticWork> works = {
      {"tube", tube, 20, 5, 40, 15, 40, 80},
      {"block", block, 20, 5, 40, 15, 40, 80},
      {"linear_block", linear_block, 3, 1.5, 8, 4, 3, 8, false}};
  return works;
}

ElasticPart large_block(double scale) {
  return loaded(shapes::straight_quadratic(tet_block(31.4, scale)), "x0", "x1");
}

ElasticRun run_elastic(ElasticPart (*make)(double), double scale, int threads,
                       equations::SolverKind solver) {
  const MeasuredChild child =
      measure_forked([&] { return solve(make, scale, threads, solver); });
  ElasticRun run;
  run.peak_bytes = child.peak_bytes;
  run.message = child.output;
  if (child.succeeded) {
    std::istringstream text(child.output);
    run.solved = static_cast<bool>(
        text >> run.elements >> run.dofs >> run.iterations >> run.first.setup >>
        run.first.solve >> run.first.stress >> run.next.setup >>
        run.next.solve >> run.next.stress >> run.first_cpu >> run.next_cpu);
  }
  return run;
}

CalculixTime time_calculix(ElasticPart (*make)(double), double scale,
                           const std::string& solver, double time_limit) {
  const TempFolder folder;
  const MeasuredChild written = measure_forked([&] {
    const ElasticPart part = make(scale);
    io::CalculixDeck deck = deck_of(part);
    deck.solver = solver;
    deck.output = io::DeckOutput::Nothing;
    io::write_calculix_inp(folder / "job.inp", part.mesh, deck);
    return std::string();
  });
  CalculixTime time;
  if (!written.succeeded) {
    return time;
  }
  const MeasuredChild child =
      measure_program({"env", "OMP_NUM_THREADS=1", "ccx", "-i", "job"},
                      folder.path(), time_limit);
  time.ended =
      child.succeeded && child.output.find("Job finished") != std::string::npos;
  time.user_seconds = child.user_seconds + child.system_seconds;
  time.wall_seconds = child.wall_seconds;
  time.peak_bytes = child.peak_bytes;
  return time;
}

CalculixAgreement compare_with_calculix(ElasticPart (*make)(double),
                                        double scale, double time_limit) {
  // A child: one that ran OpenMP cannot fork others that do.
  const MeasuredChild child =
      measure_forked([&] { return compare(make, scale, time_limit); });
  CalculixAgreement agreement;
  std::istringstream text(child.output);
  if (!child.succeeded ||
      !(text >> agreement.displacement >> agreement.stress)) {
    throw std::runtime_error(child.output);
  }
  return agreement;
}

}  // namespace meniscus
