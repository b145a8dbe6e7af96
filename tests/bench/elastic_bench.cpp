/// Elasticity side by side with CalculiX, from a mesh in memory to stresses:
/// the speed table, two threads, growth and memory.
///
///   elastic_bench [--scale X] [--only NAME] [--repeat N] [--no-calculix]
///                 [--compare] [--large]
///
/// --scale X runs with X times the elements; --repeat N takes the fastest of N
/// runs of ours (3); --compare adds a run of CalculiX that prints, and compares
/// displacements and stresses; --large adds 480,000 ten-node elements. Ratios
/// are of CPU seconds, user and system, of one thread. At full size it ends
/// with 1 where a target is missed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/process_settings.h"
#include "tests/support/bench_target.h"
#include "tests/support/calculix.h"
#include "tests/support/elastic_race.h"

namespace meniscus {
namespace {

constexpr double kMega = 1e6;
constexpr double kTimeLimit = 3600.0;  // of a peer's run [s]
constexpr double kGrowthBound = 1.15;
constexpr double kThreadsBound = 1.5;        // two threads, times one
constexpr double kDisplacementBound = 1e-6;  // apart from CalculiX
constexpr double kStressBound = 1e-5;

struct BenchOptions {
  double scale = 1.0;
  int repeat = 3;
  std::optional<std::string> only;
  bool calculix = true;
  bool compare = false;
  bool large = false;
};

void keep_shorter(ElasticStages& best, const ElasticStages& other) {
  best.setup = std::min(best.setup, other.setup);
  best.solve = std::min(best.solve, other.solve);
  best.stress = std::min(best.stress, other.stress);
}

ElasticRun fastest_run(ElasticPart (*make)(double), double scale, int threads,
                       int repeat) {
  ElasticRun best = run_elastic(make, scale, threads);
  for (int i = 1; i < repeat && best.solved; ++i) {
    const ElasticRun other = run_elastic(make, scale, threads);
    best.first_cpu = std::min(best.first_cpu, other.first_cpu);
    best.next_cpu = std::min(best.next_cpu, other.next_cpu);
    keep_shorter(best.first, other.first);
    keep_shorter(best.next, other.next);
  }
  return best;
}

void print_own(const ElasticRun& run, int threads) {
  if (!run.solved) {
    fmt::print("  ours: FAILED: {}\n", run.message);
    return;
  }
  fmt::print(
      "  ours, {} thread{}: {:.2f} s CPU (wall: set-up {:.2f}, solve {:.2f}, "
      "{} iterations, stresses {:.2f}); next design {:.2f} s; {:.0f} MB\n",
      threads, threads == 1 ? "" : "s", run.first_cpu, run.first.setup,
      run.first.solve, run.iterations, run.first.stress, run.next_cpu,
      run.peak_bytes / kMega);
}

void print_ratio(const char* what, double theirs, double ours, double least,
                 double aim) {
  const double value = theirs / ours;
  fmt::print("  {:<28} x {:.1f} (at least {:g}, aim {:g}: {})\n", what, value,
             least, aim,
             value >= aim     ? "AIM"
             : value >= least ? "ok"
                              : "BELOW");
}

/// Wall clock, stage by stage; of the next design where there is one, for a
/// first one also touches its memory for the first time.
void print_threads(const ElasticRun& one, const ElasticRun& two) {
  fmt::print(
      "  two threads, times one: assembly {:.2f}, iterations {:.2f}, stresses "
      "{:.2f} (at least 1.5); first design {:.2f} of {:.2f} s ({:.2f}), next "
      "{:.2f} of {:.2f} s ({:.2f})\n",
      one.next.setup / two.next.setup, one.next.solve / two.next.solve,
      one.next.stress / two.next.stress, two.first.all(), one.first.all(),
      one.first.all() / two.first.all(), two.next.all(), one.next.all(),
      one.next.all() / two.next.all());
  std::fflush(stdout);
}

void judge_threads(const std::string& name, const ElasticRun& one,
                   const ElasticRun& two, BenchTargets& targets) {
  const std::string gain = name + ", two threads: ";
  targets.at_least(gain + "assembly", one.next.setup / two.next.setup,
                   kThreadsBound);
  targets.at_least(gain + "iterations", one.next.solve / two.next.solve,
                   kThreadsBound);
  targets.at_least(gain + "stresses", one.next.stress / two.next.stress,
                   kThreadsBound);
}

void print_agreement(const ElasticWork& work, double scale,
                     BenchTargets& targets) {
  const CalculixAgreement apart =
      compare_with_calculix(work.make, scale, kTimeLimit);
  fmt::print(
      "  apart from CalculiX: displacements {:.1e} (at most 1e-6), stresses at "
      "integration points {:.1e} (at most 1e-5)\n",
      apart.displacement, apart.stress);
  std::fflush(stdout);
  targets.at_most(work.name + ", displacements apart from CalculiX's",
                  apart.displacement, kDisplacementBound);
  targets.at_most(work.name + ", stresses apart from CalculiX's", apart.stress,
                  kStressBound);
}

void race(const ElasticWork& work, const BenchOptions& options,
          BenchTargets& targets) {
  const ElasticRun own =
      fastest_run(work.make, options.scale, 1, options.repeat);
  fmt::print("{}: {} elements, {} unknowns\n", work.name, own.elements,
             own.dofs);
  print_own(own, 1);
  targets.holds(work.name + " is solved", own.solved, own.message);
  const ElasticRun two =
      fastest_run(work.make, options.scale, 2, options.repeat);
  print_threads(own, two);
  // A four-node block is too small for a second thread in its iterations.
  if (options.scale == 1.0 && work.large) {
    judge_threads(work.name, own, two, targets);
  }
  if (!options.calculix || !own.solved) {
    return;
  }
  double best = HUGE_VAL;
  double standard = HUGE_VAL;
  for (const char* solver :
       {"SPOOLES", "ITERATIVE CHOLESKY", "ITERATIVE SCALING"}) {
    const CalculixTime time =
        time_calculix(work.make, options.scale, solver, kTimeLimit);
    fmt::print("  CalculiX {:<19} {:.1f} s, {:.0f} MB{}\n", solver,
               time.user_seconds, time.peak_bytes / kMega,
               time.ended ? "" : ", not ended");
    std::fflush(stdout);
    if (time.ended) {
      standard = standard == HUGE_VAL ? time.user_seconds : standard;
      best = std::min(best, time.user_seconds);
    }
  }
  print_ratio("faster than its default", standard, own.first_cpu,
              work.least_default, work.aim_default);
  print_ratio("faster than its best", best, own.first_cpu, work.least_best,
              work.aim_best);
  print_ratio("next design, than default", standard, own.next_cpu,
              work.least_next, work.aim_next);
  std::fflush(stdout);
  if (options.scale == 1.0) {
    targets.at_least(work.name + ", than CalculiX's default",
                     standard / own.first_cpu, work.least_default);
    targets.at_least(work.name + ", than CalculiX's best", best / own.first_cpu,
                     work.least_best);
    targets.at_least(work.name + ", the next design", standard / own.next_cpu,
                     work.least_next);
  }
  if (options.compare) {
    print_agreement(work, options.scale, targets);
  }
}

void growth(const BenchOptions& options, BenchTargets& targets) {
  fmt::print(
      "growth: block, ten nodes, CPU seconds ~ unknowns^p, p at most "
      "{:g}\n",
      kGrowthBound);
  std::optional<ElasticRun> first;
  for (const double scale : {0.05, 0.25, 1.0}) {
    const ElasticRun run =
        fastest_run(large_block, scale * options.scale, 1, 1);
    print_own(run, 1);
    if (first && run.solved) {
      const double power = std::log(run.first_cpu / first->first_cpu) /
                           std::log(1.0 * run.dofs / first->dofs);
      fmt::print("  {} unknowns: p = {:.2f}\n", run.dofs, power);
      targets.at_most(fmt::format("power of the growth to {}", run.dofs), power,
                      kGrowthBound);
    } else {
      fmt::print("  {} unknowns\n", run.dofs);
    }
    std::fflush(stdout);
    first = first ? first : run;
  }
}

int usage() {
  fmt::print(stderr,
             "usage: elastic_bench [--scale X] [--only NAME] "
             "[--repeat N] [--no-calculix] [--compare] [--large]\n");
  return 2;
}

int run(int count, char** words) {
  BenchOptions options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool more = i + 1 < count;
    if (word == "--scale" && more) {
      options.scale = std::atof(words[++i]);
    } else if (word == "--repeat" && more) {
      options.repeat = std::atoi(words[++i]);
    } else if (word == "--only" && more) {
      options.only = words[++i];
    } else if (word == "--no-calculix") {
      options.calculix = false;
    } else if (word == "--compare") {
      options.compare = true;
    } else if (word == "--large") {
      options.large = true;
    } else {
      return usage();
    }
  }
  if (options.calculix && !have_calculix()) {
    fmt::print("ccx (Debian package calculix-ccx) is not installed\n");
    options.calculix = false;
  }
  BenchTargets targets;
  for (const ElasticWork& work : elastic_works()) {
    if (!options.only || work.name == *options.only) {
      race(work, options, targets);
    }
  }
  if (options.large) {
    growth(options, targets);
  }
  return targets.finish();
}

}  // namespace
}  // namespace meniscus

int main(int count, char** words) {
  meniscus::start_with_settings(words);  // as the program does
  return meniscus::run(count, words);
}
