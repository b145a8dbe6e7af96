/// What a bound of nodal stress costs beside one patch recovery, and what four
/// load cases' adjoints cost in step beside one by one; prints a table and ends
/// with 1 where a target is missed. load_case_bench [CELLS]: along a beam of
/// ten-node elements, 60 when left out.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/memory.h"
#include "core/process_settings.h"
#include "core/timer.h"
#include "fea/elastic/elasticity.h"
#include "fea/functionals/nodal_peak.h"
#include "fea/functionals/stress_criteria.h"
#include "fea/stress/patch_recovery.h"
#include "tests/support/bench_target.h"
#include "tests/support/parts.h"

namespace meniscus {
namespace {

constexpr int kRuns = 3;

/// The least of some runs [s].
template <class Work>
double least_seconds(const Work& work) {
  double least = 1e300;
  for (int run = 0; run < kRuns; ++run) {
    const Timer timer;
    work();
    least = std::min(least, timer.seconds());
  }
  return least;
}

int run(int cells) {
  constexpr double kMostOfOneByOne = 0.8;
  constexpr double kMostOfRecovery = 5.0;
  const TetMesh mesh = shapes::straight_quadratic(
      shapes::brick({0.1 * cells, 1.0, 1.0}, cells, cells / 6, cells / 6));
  const std::vector<element::Material> materials = {parts::steel()};
  std::vector<loads::LoadCase> load_cases;
  for (const Vec3& force : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0),
                            Vec3(0.0, 0.0, 1.0), Vec3(1.0, 2.0, -3.0)}) {
    load_cases.push_back(parts::pulled(force));
    load_cases.back().name += std::to_string(load_cases.size());
  }
  const elastic::ElasticModel model(mesh, materials, load_cases);
  equations::ElasticState state;
  const equations::ElasticSolution solution =
      model.solve(mesh, load_cases, &state);
  const stress::Excluded none;
  const functionals::NodeCriterion criterion =
      functionals::von_mises_ratio({1.0});
  const auto bound = [&](std::size_t c, element::Derivatives derivatives) {
    return functionals::nodal_peak(
        {mesh,
         materials,
         {{load_cases[c], solution.displacements[c]}},
         none,
         0.02,
         derivatives},
        criterion);
  };
  const element::PointStress points =
      element::point_stress(mesh, materials, solution.displacements[1]);
  const double recovery =
      least_seconds([&] { stress::recover_by_patches(mesh, points); });
  const double value =
      least_seconds([&] { bound(1, element::Derivatives::None); });
  const double gradient =
      least_seconds([&] { bound(1, element::Derivatives::All); });
  std::vector<VectorX> right;
  for (std::size_t c = 0; c < load_cases.size(); ++c) {
    right.push_back(
        bound(c, element::Derivatives::All).states[0].by_displacement);
  }
  const double in_step = least_seconds([&] {
    model.solve_adjoints(state, {0, 1, 2, 3}, right);
  });
  const double one_by_one = least_seconds([&] {
    for (int c = 0; c < 4; ++c) {
      model.solve_adjoint(state, c, {right[static_cast<std::size_t>(c)]});
    }
  });
  std::printf("| what | seconds | ratio |\n|---|---|---|\n");
  std::printf("| patch recovery (%d elements) | %.3f | 1 |\n",
              mesh.element_count(), recovery);
  std::printf("| bound of stress, its value | %.3f | %.2f |\n", value,
              value / recovery);
  std::printf("| with derivatives | %.3f | %.2f |\n", gradient,
              gradient / recovery);
  std::printf("| four adjoints one by one | %.3f | 1 |\n", one_by_one);
  std::printf("| in step | %.3f | %.2f |\n", in_step, in_step / one_by_one);
  BenchTargets targets;
  targets.at_most("bound of stress with derivatives, of a patch recovery",
                  gradient / recovery, kMostOfRecovery);
  targets.at_most("four adjoints in step, of one by one", in_step / one_by_one,
                  kMostOfOneByOne);
  return targets.finish();
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
  meniscus::start_with_settings(argv);  // as the program does
  meniscus::keep_freed_memory();
  return meniscus::run(argc > 1 ? std::atoi(argv[1]) : 60);
}
