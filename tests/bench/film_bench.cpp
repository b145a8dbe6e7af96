/// Films side by side with Surface Evolver: the speed table, growth of the
/// time with the facets, and memory at four million facets.
///
///   film_bench [--scale N] [--only NAME] [--repeat N] [--no-evolver] [--large]
///
/// --scale N runs at 1/4^N of the size; --repeat N takes the fastest of N runs
/// of each program (2). Ratios are of CPU seconds, user and system, of one
/// thread, one run at a time. At full size it ends with 1 where a target is
/// missed.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "core/process_settings.h"
#include "tests/support/bench_target.h"
#include "tests/support/evolver.h"
#include "tests/support/film_complexes.h"
#include "tests/support/film_race.h"

namespace meniscus {
namespace {

constexpr double kMega = 1e6;
constexpr double kGrowthBound = 1.2;  // time ~ facets^1.2 at most
constexpr double kLargeBound = 4.0 * 1024 * 1024 * 1024;  // [byte]

struct BenchOptions {
  int scale = 0;
  int repeat = 2;
  std::optional<std::string> only;
  bool evolver = true;
  bool large = false;
};

void print_own(const FilmRun& run) {
  fmt::print(
      "  {:<8} {:>8.2f} {:>6.2f} {:>8.2f} {:>7.0f} {:>19.14g} {:>10.2e}  {}\n",
      "ours", run.user_seconds, run.system_seconds, run.wall_seconds,
      run.peak_bytes / kMega, run.energy, run.residual, run.verdict);
  if (!run.settled) {
    fmt::print(
        "           NOT SETTLED: residual bound {:.2e}, lowest "
        "eigenvalue {:.3g}\n",
        run.residual_bound, run.min_eigenvalue);
  }
}

void print_evolver(const char* script, const EvolverRun& run) {
  fmt::print(
      "  {:<8} {:>8.2f} {:>6.2f} {:>8} {:>7.0f} {:>19.14g} {:>10.2e}  {}\n",
      script, run.user_seconds, run.system_seconds, "", run.peak_bytes / kMega,
      run.energy, run.residual.value_or(NAN),
      !run.ended       ? "failed"
      : !run.converged ? "last step still moved"
                       : "");
}

// "x 7.3 (at least 5, aim 10) aim".
std::string ratio(const EvolverRun& theirs, const FilmRun& own, double least,
                  double aim) {
  if (!own.settled) {
    return "no film of ours";
  }
  const double value = (theirs.user_seconds + theirs.system_seconds) /
                       (own.user_seconds + own.system_seconds);
  const char* mark = value >= aim ? "AIM" : value >= least ? "ok" : "BELOW";
  return fmt::format("x {:.1f} (at least {:g}, aim {:g}: {})", value, least,
                     aim, mark);
}

EvolverRun evolver_run(const SpeedWork& work, EvolverScript script,
                       int refinements, int repeat) {
  return fastest(repeat, [&] {
    return run_evolver(work.start(), {.refinements = refinements,
                                      .script = script,
                                      .descent = work.descent});
  });
}

/// Bounds are for full size; at others everything is printed alone.
void judge(const SpeedWork& work, const FilmRun& own, const EvolverRun& tuned,
           const EvolverRun& typical, BenchTargets& targets) {
  const double seconds = own.user_seconds + own.system_seconds;
  targets.at_least(work.name + ", faster than tuned",
                   (tuned.user_seconds + tuned.system_seconds) / seconds,
                   work.least_tuned);
  targets.at_least(work.name + ", faster than typical",
                   (typical.user_seconds + typical.system_seconds) / seconds,
                   work.least_typical);
  targets.at_most(work.name + ", memory over evolver's",
                  own.peak_bytes / tuned.peak_bytes, 1.0);
}

void race(const SpeedWork& work, const BenchOptions& options,
          BenchTargets& targets) {
  const int refinements = std::max(0, work.refinements - options.scale);
  const FilmRun own = fastest(
      options.repeat, [&] { return run_film(work.start(), refinements); });
  fmt::print("{}, {} facets\n", work.name, own.facets);
  print_own(own);
  targets.holds(work.name + " settles", own.settled, own.verdict);
  if (options.evolver) {
    const EvolverRun tuned =
        evolver_run(work, EvolverScript::Tuned, refinements, options.repeat);
    print_evolver("tuned", tuned);
    const EvolverRun typical =
        evolver_run(work, EvolverScript::Typical, refinements, options.repeat);
    print_evolver("typical", typical);
    fmt::print(
        "  faster than tuned   {}\n  faster than typical {}\n"
        "  memory / evolver's  {:.2f} (at most 1)\n",
        ratio(tuned, own, work.least_tuned, work.aim_tuned),
        ratio(typical, own, work.least_typical, work.aim_typical),
        own.peak_bytes / tuned.peak_bytes);
    if (options.scale == 0) {
      judge(work, own, tuned, typical, targets);
    }
  }
  std::fflush(stdout);
}

void growth(const BenchOptions& options, BenchTargets& targets) {
  fmt::print("\ngrowth: catenoid, user seconds ~ facets^p, p at most {:g}\n",
             kGrowthBound);
  double first_seconds = 0.0;
  int first_facets = 0;
  for (const int refinements : {5, 6, 7}) {
    const FilmRun run = fastest(options.repeat, [&] {
      return run_film(test_films::catenoid_start(),
                      std::max(0, refinements - options.scale));
    });
    if (first_facets == 0) {
      first_seconds = run.user_seconds;
      first_facets = run.facets;
      fmt::print("  {:>8} facets {:>8.2f} s\n", run.facets, run.user_seconds);
      continue;
    }
    const double power =
        std::log(run.user_seconds / first_seconds) /
        std::log(static_cast<double>(run.facets) / first_facets);
    fmt::print("  {:>8} facets {:>8.2f} s  {:>6.0f} MB  p = {:.2f}\n",
               run.facets, run.user_seconds, run.peak_bytes / kMega, power);
    std::fflush(stdout);
    if (options.scale == 0) {
      targets.at_most(
          fmt::format("power of the growth to {} facets", run.facets), power,
          kGrowthBound);
    }
  }
}

void large(BenchTargets& targets) {
  const FilmRun run = run_film(test_films::catenoid_start(), 8);
  fmt::print(
      "\nlarge: catenoid, {} facets: {:.1f} s, {:.0f} MB (at most "
      "{:.0f}), {}\n",
      run.facets, run.user_seconds, run.peak_bytes / kMega, kLargeBound / kMega,
      run.verdict);
  targets.holds("the large film settles", run.settled, run.verdict);
  targets.at_most("its memory [byte]", run.peak_bytes, kLargeBound);
}

int number(const char* text) {
  int value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

std::optional<BenchOptions> read_options(int count, char** words) {
  BenchOptions options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool more = i + 1 < count;
    if (word == "--scale" && more) {
      options.scale = number(words[++i]);
    } else if (word == "--repeat" && more) {
      options.repeat = std::max(1, number(words[++i]));
    } else if (word == "--only" && more) {
      options.only = words[++i];
    } else if (word == "--no-evolver") {
      options.evolver = false;
    } else if (word == "--large") {
      options.large = true;
    } else {
      return std::nullopt;
    }
  }
  return options;
}

int run(int count, char** words) {
  std::optional<BenchOptions> options = read_options(count, words);
  if (!options) {
    fmt::print(stderr,
               "usage: film_bench [--scale N] [--only NAME] [--repeat N] "
               "[--no-evolver] [--large]\n");
    return 2;
  }
  if (options->evolver && !have_evolver()) {
    fmt::print("evolver (Debian package evolver) is not installed\n");
    options->evolver = false;
  }
  fmt::print("{:<10} {:>8} {:>6} {:>8} {:>7} {:>19} {:>10}\n", "", "user s",
             "sys s", "wall s", "MB", "energy", "residual");
  BenchTargets targets;
  for (const SpeedWork& work : speed_works()) {
    if (!options->only || work.name == *options->only) {
      race(work, *options, targets);
    }
  }
  if (!options->only) {
    growth(*options, targets);
  }
  if (options->large) {
    large(targets);
  }
  return targets.finish();
}

}  // namespace
}  // namespace meniscus

int main(int count, char** words) {
  meniscus::start_with_settings(words);  // as the program does
  return meniscus::run(count, words);
}
