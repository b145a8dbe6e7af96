#include "python/stages.h"

#include <algorithm>
#include <limits>

#include "fea/stress/stress.h"
#include "pipeline/case_films/film_start.h"
#include "pipeline/forward/adaptation.h"
#include "python/call.h"
#include "python/errors.h"

namespace meniscus::python {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

Stage after(Stage stage) {
  return static_cast<Stage>(static_cast<int>(stage) + 1);
}

}  // namespace

const std::optional<Failure>& FrozenModel::failure() const {
  return whole ? whole->failure() : film_alone->reference().failure;
}

const frozen::FilmModel& FrozenModel::film() const {
  return whole ? whole->film() : *film_alone;
}

std::shared_ptr<const FrozenModel> freeze_whole(
    const std::shared_ptr<const case_data::Case>& input, double edge_factor,
    Monitor& monitor) {
  auto model = std::make_shared<FrozenModel>();
  model->input = input;
  model->whole.emplace(*input,
                       forward::ForwardModelOptions{.edge_factor = edge_factor,
                                                    .monitor = &monitor});
  return model;
}

std::shared_ptr<const FrozenModel> freeze_film(
    const std::shared_ptr<const case_data::Case>& input, double edge_factor,
    Monitor& monitor) {
  auto model = std::make_shared<FrozenModel>();
  model->input = input;
  const case_data::EvaluatedCase numbers =
      case_data::evaluate(*input, case_data::initial_design(*input));
  model->film_alone.emplace(
      case_films::freeze_films(*input, numbers,
                               {.edge = numbers.fea_edge * edge_factor,
                                .refinements = input->resolution.refinements,
                                .monitor = &monitor}));
  return model;
}

DesignWork::DesignWork(std::shared_ptr<const FrozenModel> model, VectorX design,
                       forward::KeepStiffness keep)
    : model_(std::move(model)), design_(std::move(design)), keep_(keep) {
  responses_ = VectorX::Constant(
      static_cast<Eigen::Index>(input().responses.size()), kNothing);
  staged_.evaluation.design = design_;
  staged_.evaluation.failure = model_->failure();
}

bool DesignWork::run(Stage stage) {
  if (!model_->whole) {
    if (stage != Stage::Film) {
      throw InvalidInput(
          "this film was settled without elements; use meniscus.Model");
    }
    return forward::settle_film(input(), model_->film(), design_,
                                &Call::of_this_thread(), staged_);
  }
  const forward::FrozenPart& part = model_->whole->part();
  switch (stage) {
    case Stage::Film:
      return forward::settle_film(part, design_, staged_);
    case Stage::Mesh:
      return forward::move_mesh(part, staged_);
    case Stage::Solution:
      return forward::solve_elasticity(part, keep_, staged_);
    default:
      break;
  }
  if (!forward::compute_responses(part, staged_)) {
    return false;
  }
  responses_ = staged_.evaluation.responses;
  return true;
}

void DesignWork::advance(Stage stage) {
  const std::lock_guard lock(mutex_);
  while (done_ < stage && !staged_.evaluation.failure) {
    // Interrupted, the stage is run anew when it is asked for again.
    run(after(done_));
    done_ = after(done_);
    failed_ = done_;
  }
}

std::optional<Failure> DesignWork::failure(Stage stage) const {
  const std::lock_guard lock(mutex_);
  return failed_ <= stage ? staged_.evaluation.failure : std::nullopt;
}

void DesignWork::require(Stage stage) const {
  refuse_failed(failure(stage));
  if (dropped_) {
    throw InvalidInput(
        "this design was evaluated for its responses alone; evaluate it with "
        "keep='fields' or keep='all'");
  }
}

const SurfaceMesh& DesignWork::fine_film() {
  require(Stage::Film);
  const std::lock_guard lock(mutex_);
  if (!fine_film_) {
    fine_film_ = model_->film().fine_mesh(staged_.adjoint.film.points);
  }
  return *fine_film_;
}

const QuadraticSurface& DesignWork::surface() {
  require(Stage::Film);
  const std::lock_guard lock(mutex_);
  if (!surface_) {
    const Points& points = staged_.adjoint.film.points;
    surface_ = model_->whole
                   ? model_->whole->surface(staged_.fields.inputs, points)
                   : model_->film().surface(points);
  }
  return *surface_;
}

const std::vector<forward::PartStress>& DesignWork::stresses() {
  require(Stage::Solution);
  if (staged_.fields.shell) {
    throw InvalidInput(
        "a shell has no stress inside; a run's part.vtu has it at both faces, "
        "and max_von_mises is its peak");
  }
  const std::lock_guard lock(mutex_);
  if (!stresses_) {
    stresses_ = forward::part_stresses(
        staged_.fields.mesh, staged_.fields.inputs, staged_.fields.solution);
    nodal_.resize(stresses_->size());
  }
  return *stresses_;
}

const stress::StressField& DesignWork::stress(int load_case) {
  const forward::PartStress& part = stresses()[load_case];
  const std::lock_guard lock(mutex_);
  std::unique_ptr<stress::StressField>& nodal = nodal_[load_case];
  if (nodal == nullptr) {
    nodal = std::make_unique<stress::StressField>(
        stress::nodal_stress(staged_.fields.mesh, part.recovered));
  }
  return *nodal;
}

void DesignWork::drop_fields() {
  dropped_ = true;
  staged_.fields = {};
  staged_.adjoint = {};
}

forward::DesignGradient DesignWork::gradient(
    const std::vector<int>& wanted) const {
  return model_->whole->gradient(staged_.evaluation, staged_.fields,
                                 staged_.adjoint, wanted);
}

}  // namespace meniscus::python
