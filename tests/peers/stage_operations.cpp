/// The stages of one evaluation, one function each, with what their formulas
/// say of their work: run by stage_operations.py under callgrind, which counts.
#include <cstdio>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/operation_count.h"
#include "mesh_tet/motion_check.h"
#include "pipeline/case_reader.h"
#include "pipeline/design_stages.h"

namespace {

std::optional<meniscus::FilmModel> film;
std::optional<meniscus::ForwardModel> model;
meniscus::StagedDesign staged;

}  // namespace

// Callgrind knows them by these names.
extern "C" {

[[gnu::noinline]] bool stage_start(const meniscus::FilmSystem& system,
                                   double edge, int refinements) {
  film.emplace(meniscus::FilmModel::freeze(
      system, {.edge = edge, .refinements = refinements}));
  return !film->reference().failure;
}

[[gnu::noinline]] bool stage_film(const meniscus::DesignStages& stages,
                                  const meniscus::VectorX& design) {
  return stages.settle(design, staged);
}

[[gnu::noinline]] bool stage_motion(const meniscus::DesignStages& stages) {
  return stages.place_mesh(staged);
}

[[gnu::noinline]] bool stage_elasticity(const meniscus::DesignStages& stages) {
  return stages.solve(staged, meniscus::KeepStiffness::No);
}
}

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const Case input = read_case(argv[1], {argv + 2, argv + argc});
    const EvaluatedCase numbers = evaluate(input, initial_design(input));
    const double before = operations_done();
    if (!stage_start(numbers.film_system, numbers.fea_edge,
                     input.resolution.refinements)) {
      return 1;
    }
    const double start = operations_done() - before;
    model.emplace(input);
    if (model->failure()) {
      return 1;
    }
    const VectorX design = initial_design(input).array() + 2.0;  // a move
    const DesignStages stages(*model);
    if (!stage_film(stages, design) || !stage_motion(stages) ||
        !stage_elasticity(stages)) {
      return 1;
    }
    const StageOperations& done = staged.evaluation.operations;
    std::printf("start %.17g\nfilm %.17g\nmotion %.17g\nelasticity %.17g\n",
                start, done.film, done.mesh, done.fea);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
