/// What Python's objects share: a frozen model, and one design on its way
/// through it. Memory that arrays show is written once and never moved.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "pipeline/forward/design_stages.h"

namespace meniscus::python {

/// With elements, or the film alone.
struct FrozenModel {
  std::shared_ptr<const case_data::Case> input;
  std::optional<forward::ForwardModel> whole;
  std::optional<frozen::FilmModel> film_alone;

  /// Of the freeze.
  const std::optional<Failure>& failure() const;
  /// Not when the freeze failed.
  const frozen::FilmModel& film() const;
};

/// `edge_factor`: x all edge lengths of the case's resolution. Throws what
/// ForwardModel throws.
std::shared_ptr<const FrozenModel> freeze_whole(
    const std::shared_ptr<const case_data::Case>& input, double edge_factor,
    Monitor& monitor);
std::shared_ptr<const FrozenModel> freeze_film(
    const std::shared_ptr<const case_data::Case>& input, double edge_factor,
    Monitor& monitor);

enum class Stage { None, Film, Mesh, Solution, Responses };

/// One design. Each stage is run once, when it is first asked for; may be asked
/// from several threads.
class DesignWork {
 public:
  DesignWork(std::shared_ptr<const FrozenModel> model, VectorX design,
             forward::KeepStiffness keep);

  /// Runs the stages up to this one, as far as they do not fail. Throws
  /// InvalidInput for stages beyond the film of a film alone.
  void advance(Stage stage);

  /// The film at its own resolution, the surface as meshed, stresses per load
  /// case: made at the first call. Throw DesignFailed where there is none.
  const SurfaceMesh& fine_film();
  const QuadraticSurface& surface();
  const std::vector<forward::PartStress>& stresses();
  const stress::StressField& stress(int load_case);

  /// Gives memory back: all but figures and responses, or the stiffness alone.
  /// Only before arrays of it were handed out.
  void drop_fields();
  bool has_fields() const { return !dropped_; }

  const FrozenModel& model() const { return *model_; }
  const case_data::Case& input() const { return *model_->input; }
  const forward::StagedDesign& staged() const { return staged_; }
  const VectorX& responses() const { return responses_; }

  /// Why a stage up to this one has failed.
  std::optional<Failure> failure(Stage stage) const;

  /// Throws DesignFailed when a stage up to this one has failed, InvalidInput
  /// when its fields are dropped.
  void require(Stage stage) const;

  forward::DesignGradient gradient(const std::vector<int>& wanted) const;

 private:
  bool run(Stage stage);

  std::shared_ptr<const FrozenModel> model_;
  VectorX design_;
  forward::KeepStiffness keep_;
  mutable std::mutex mutex_;
  Stage done_ = Stage::None;
  Stage failed_ = Stage::None;  // at this stage, when there is a failure
  bool dropped_ = false;
  forward::StagedDesign staged_;
  VectorX responses_;  // NaN where the design failed
  std::optional<SurfaceMesh> fine_film_;
  std::optional<QuadraticSurface> surface_;
  std::optional<std::vector<forward::PartStress>> stresses_;
  std::vector<std::unique_ptr<stress::StressField>> nodal_;
};

}  // namespace meniscus::python
