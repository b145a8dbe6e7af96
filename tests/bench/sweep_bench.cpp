/// Designs per minute of a sweep over the two-arm bracket at about 5k ten-node
/// tetrahedra: two jobs in one program beside two programs at once, with the
/// database of every run. Prints the table of docs/performance.md; an argument
/// is the number of designs, else 200.
#include <cstdio>
#include <cstdlib>
#include <omp.h>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "core/memory.h"
#include "core/process_settings.h"
#include "core/timer.h"
#include "optimize/samples/sampling.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/study/design_evaluator.h"
#include "pipeline/study/run_kind.h"
#include "tests/support/bench_target.h"
#include "tests/support/measured_child.h"
#include "tests/support/temp_folder.h"

namespace meniscus {
namespace {

constexpr const char* kEdge = "14.5";
constexpr const char* kFilmEdge = "7.25";

struct Setting {
  const char* name;
  int programs;
  int jobs;
  int threads;  // of each program
};
constexpr Setting kSettings[] = {
    {"one program, one thread", 1, 1, 1},
    {"one program, two threads", 1, 1, 2},
    {"two programs at once, one thread each", 2, 1, 1},
    {"one program, `--jobs 2`", 1, 2, 2},
};

/// Seconds of the sweep alone, and the elements.
std::string sweep_seconds(const Setting& setting, int designs) {
  omp_set_num_threads(setting.threads);
  const case_data::Case input =
      reader::read_case(MENISCUS_SOURCE_DIR "/cases/two_arm/case.toml",
                        {std::string("resolution.fea=") + kEdge,
                         std::string("resolution.film=") + kFilmEdge});
  const TempFolder folder;
  store::StudyStore store = store::StudyStore::start(folder.path().string(),
                                                     {.case_hash = input.hash});
  study::DesignEvaluator evaluator(input, store, {.jobs = setting.jobs});
  const std::vector<VectorX> points = samples::designs_of(
      study::variables_of(input, case_data::initial_design(input)),
      samples::sobol_samples(1, designs));
  const Timer timer;
  const auto records = evaluator.evaluate_all(points, "sweep");
  const double seconds = timer.seconds();
  if (evaluator.counts().failed > 0) {
    throw std::runtime_error("designs that cannot be evaluated");
  }
  return fmt::format("{} {}", seconds, evaluator.model().frozen().tet.elements);
}

struct Speed {
  double designs_per_minute = 0.0;
  double peak_megabytes = 0.0;  // of the largest program
  int elements = 0;
};

Speed sweep_speed(const Setting& setting, int designs) {
  std::vector<MeasuredChild> children(
      static_cast<std::size_t>(setting.programs));
  std::vector<std::thread> threads;
  threads.reserve(children.size());
  for (MeasuredChild& child : children) {
    threads.emplace_back([&child, &setting, designs] {
      child = measure_forked([&] { return sweep_seconds(setting, designs); });
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  Speed speed;
  double longest = 0.0;
  for (const MeasuredChild& child : children) {
    double seconds = 0.0;
    if (!child.succeeded || std::sscanf(child.output.c_str(), "%lf %d",
                                        &seconds, &speed.elements) != 2) {
      throw std::runtime_error(child.output);
    }
    longest = std::max(longest, seconds);
    speed.peak_megabytes =
        std::max(speed.peak_megabytes, child.peak_bytes / 1e6);
  }
  speed.designs_per_minute = 60.0 * setting.programs * designs / longest;
  return speed;
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
  meniscus::start_with_settings(argv);
  meniscus::keep_freed_memory();
  const int designs = argc > 1 ? std::atoi(argv[1]) : 200;
  std::printf(
      "| %d designs | designs per minute | peak memory [MB] |\n"
      "|---|---|---|\n",
      designs);
  int elements = 0;
  double programs = 0.0;  // two at once
  double jobs = 0.0;      // two in one
  for (const meniscus::Setting& setting : meniscus::kSettings) {
    const meniscus::Speed speed = meniscus::sweep_speed(setting, designs);
    elements = speed.elements;
    (setting.jobs > 1 ? jobs : programs) = speed.designs_per_minute;
    std::printf("| %s | %.0f | %.0f |\n", setting.name,
                speed.designs_per_minute, speed.peak_megabytes);
    std::fflush(stdout);
  }
  std::printf("%d ten-node tetrahedra\n", elements);
  constexpr double kLeastOfPrograms = 0.85;
  meniscus::BenchTargets targets;
  targets.at_least("`--jobs 2` over two programs", jobs / programs,
                   kLeastOfPrograms);
  return targets.finish();
}
