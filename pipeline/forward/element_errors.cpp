#include "pipeline/forward/element_errors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "evolve/frozen/gap_between.h"
#include "fea/functionals/groove.h"
#include "fea/functionals/place_functionals.h"
#include "fea/functionals/thickness.h"
#include "fea/loads/body_loads.h"
#include "fea/stress/averaged_stress.h"
#include "fea/stress/error_estimate.h"
#include "fea/stress/peak_stress.h"
#include "pipeline/case_data/composed_responses.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/response_kinds.h"
#include "pipeline/forward/worst_cases.h"
#include "pipeline/responses/response_partials.h"

namespace meniscus::forward {

namespace {

/// The load case's supports under the forces `by_displacement`, dJ/du, times
/// `scale`: as large as the load case's own (its reactions, where displacements
/// alone act), for the solver starts from that one's solution.
struct DualLoad {
  loads::LoadCase load;
  double scale = 1.0;
};
DualLoad dual_load(const EvaluationFields& fields,
                   const loads::LoadCase& load_case, const VectorX& reactions,
                   const VectorX& by_displacement) {
  loads::LoadCase dual = load_case;
  dual.forces.clear();
  dual.pressures.clear();
  dual.tractions.clear();
  dual.remote_loads.clear();
  dual.bearings.clear();
  dual.gravity.setZero();
  dual.spin.reset();
  dual.temperature.reset();
  for (loads::Support& support : dual.supports) {
    support.displacement.reset();
  }
  for (loads::RigidPin& pin : dual.pins) {
    pin.displacement.reset();
    pin.rotation.reset();
  }
  const double force =
      loads::nodal_forces(fields.mesh, load_case, fields.inputs.materials)
          .norm();
  const double scale =
      (force > 0.0 ? force : reactions.norm()) / by_displacement.norm();
  dual.nodal = scale * by_displacement;
  return {std::move(dual), scale};
}

stress::ResponseError dual_weighted(const EvaluationFields& fields,
                                    std::size_t load_case,
                                    const VectorX& dual) {
  const auto& materials = fields.inputs.materials;
  const PartStress& primal = fields.stresses[load_case];
  const stress::RecoveredStress stress = stress::recover_by_patches(
      fields.mesh, element::point_stress(fields.mesh, materials, dual));
  return stress::response_error(fields.mesh, materials,
                                {fields.solution.displacements[load_case],
                                 primal.recovered, primal.temperature_change},
                                {dual, stress, {}});
}

/// Sums shares of errors that have different units.
class Shares {
 public:
  explicit Shares(int elements)
      : share_(static_cast<std::size_t>(elements), 0.0) {}

  /// `part(e)`: not negative.
  template <class Part>
  void add(const Part& part) {
    double sum = 0.0;
    for (std::size_t e = 0; e < share_.size(); ++e) {
      sum += part(e);
    }
    if (!(sum > 0.0)) {
      return;
    }
    for (std::size_t e = 0; e < share_.size(); ++e) {
      share_[e] += part(e) / sum;
    }
    ++count_;
  }

  std::vector<double> mean() const {
    std::vector<double> mean = share_;
    for (double& s : mean) {
      s /= std::max(count_, 1);
    }
    return mean;
  }

 private:
  std::vector<double> share_;
  int count_ = 0;
};

struct Dual {
  std::size_t response = 0;
  VectorX by_displacement;
};

/// What the elements' errors mean for responses.
class ResponseErrors {
 public:
  ResponseErrors(const case_data::Case& input, const EvaluationFields& fields,
                 const VectorX& values, Shares& shares, ElementErrors& errors)
      : input_(input),
        fields_(fields),
        values_(values),
        shares_(shares),
        errors_(errors) {
    errors_.responses =
        VectorX::Zero(static_cast<Eigen::Index>(input.responses.size()));
  }

  void run(const elastic::ElasticModel& model);

 private:
  /// Duals that are to be solved, by load case; what needs none is written.
  std::vector<std::vector<Dual>> duals();
  bool solve(const std::vector<std::vector<Dual>>& duals, std::size_t round,
             const elastic::ElasticModel& model);
  void add_composed();
  double peak_error(std::size_t load_case) const;
  double smoothing_error(std::size_t r) const;
  double& error(std::size_t response) {
    return errors_.responses[static_cast<Eigen::Index>(response)];
  }

  const case_data::Case& input_;
  const EvaluationFields& fields_;
  const VectorX& values_;
  Shares& shares_;
  ElementErrors& errors_;
};

/// Do displacements that supports enforce act alone? The strain energy is then
/// the least of all fields that have them, and elements make it too large.
bool is_driven(const EvaluationFields& fields,
               const loads::LoadCase& load_case) {
  return loads::enforces(load_case) && load_case.springs.empty() &&
         !load_case.temperature &&
         loads::nodal_forces(fields.mesh, load_case, fields.inputs.materials)
             .isZero(0.0);
}

/// What the largest of the readings of a peak is above the one that is told.
double ResponseErrors::peak_error(std::size_t load_case) const {
  const PartStress& found = fields_.stresses[load_case];
  const stress::RecoveredStress averaged =
      stress::average_extrapolations(fields_.mesh, found.points);
  const stress::PeakReadings peaks = stress::peak_readings(
      {fields_.mesh, found.recovered, averaged, found.points},
      fields_.exclusion.what);
  return peaks.largest().von_mises - peaks.recovered.von_mises;
}

/// What smoothing alone makes of an extreme: it is proportional to the
/// smoothing, so that an eighth of it shows the rest.
double ResponseErrors::smoothing_error(std::size_t r) const {
  constexpr double kPart = 8.0;
  using Kind = case_data::ResponseKind;
  const case_data::ResponseEntry& response = input_.responses[r];
  const double edge = fields_.inputs.fea_edge;
  std::function<double(double)> value;  // by the smoothing
  double smoothing = response.smoothing.value_or(0.1 * edge);
  functionals::ThicknessPairs pairs;
  if (response.kind == Kind::Thickness) {
    pairs = functionals::thickness_pairs(fields_.mesh);
    smoothing =
        response.smoothing.value_or(1.0 / functionals::usual_sharpness(pairs));
    value = [&](double s) {
      return functionals::thickness_functional(fields_.mesh, pairs, 1.0 / s,
                                               element::Derivatives::None)
          .value;
    };
  } else if (response.kind == Kind::Groove) {
    smoothing = responses::kGrooveSmoothing;
    value = [&](double s) {
      return functionals::groove_functional(fields_.mesh, 1.0 / s,
                                            element::Derivatives::None)
          .value;
    };
  } else if (response.kind == Kind::Gap) {
    smoothing = response.smoothing.value_or(responses::kGapSmoothing * edge);
    value = [&](double s) {
      return frozen::gap_between(fields_.film,
                                 fields_.film.label_of(response.films[0]),
                                 fields_.film.label_of(response.films[1]), s)
          .value;
    };
  } else {
    const loads::NumberOfPlace& level = fields_.inputs.responses[r].level;
    value = [&](double s) {
      return functionals::intrusion_functional(
                 fields_.mesh, {level, {}}, 1.0 / s, element::Derivatives::None)
          .value;
    };
  }
  return std::abs(value(smoothing / kPart) - value(smoothing)) * kPart /
         (kPart - 1.0);
}

std::vector<std::vector<Dual>> ResponseErrors::duals() {
  std::vector<std::vector<Dual>> result(fields_.inputs.load_cases.size());
  for (std::size_t r = 0; r < input_.responses.size(); ++r) {
    const case_data::ResponseEntry& response = input_.responses[r];
    const case_data::ErrorSource estimate =
        case_data::row_of(response.kind).error;
    if (estimate == case_data::ErrorSource::ByReadings) {
      error(r) = peak_error(case_data::shown_load_case(input_, response));
    } else if (estimate == case_data::ErrorSource::BySmoothing) {
      error(r) = smoothing_error(r);
    } else if (estimate == case_data::ErrorSource::Unknown) {
      error(r) = std::numeric_limits<double>::quiet_NaN();
    }
    if (estimate != case_data::ErrorSource::ByDual) {
      continue;
    }
    responses::ResponsePartials partials =
        responses::partials_of(response, fields_.inputs.responses[r],
                               {fields_.inputs, fields_.mesh, fields_.solution,
                                fields_.exclusion.what},
                               element::Derivatives::All);
    for (responses::CasePartials& by : partials.cases) {
      const auto k = static_cast<std::size_t>(by.load_case);
      const double norm = fields_.stresses[k].error.error;
      if (by.self_adjoint != 0.0) {  // the dual is the solution itself
        error(r) += by.self_adjoint * norm * norm;
      } else if (response.kind == case_data::ResponseKind::StrainEnergy &&
                 is_driven(fields_, fields_.inputs.load_cases[k])) {
        error(r) -= 0.5 * norm * norm;
      } else if (by.by_displacement.norm() > 0.0) {
        result[k].push_back({r, std::move(by.by_displacement)});
      }
    }
  }
  return result;
}

/// One dual a load case, all load cases together; false when none is left.
bool ResponseErrors::solve(const std::vector<std::vector<Dual>>& duals,
                           std::size_t round,
                           const elastic::ElasticModel& model) {
  std::vector<loads::LoadCase> loads = solved_load_cases(fields_);
  std::vector<double> scale(loads.size(), 0.0);  // 0: no dual left
  for (std::size_t k = 0; k < loads.size(); ++k) {
    if (round < duals[k].size()) {
      DualLoad dual =
          dual_load(fields_, loads[k], fields_.solution.reactions[k],
                    duals[k][round].by_displacement);
      loads[k] = std::move(dual.load);
      scale[k] = dual.scale;
    }
  }
  if (std::all_of(scale.begin(), scale.end(),
                  [](double s) { return s == 0.0; })) {
    return false;
  }
  const equations::ElasticSolution solution =
      model.solve(fields_.mesh, loads, fields_.inputs.materials, nullptr);
  errors_.failure = solution.failure;
  for (std::size_t k = 0; k < loads.size() && !errors_.failure; ++k) {
    if (scale[k] != 0.0) {
      const stress::ResponseError found =
          dual_weighted(fields_, k, solution.displacements[k]);
      error(duals[k][round].response) += found.value / scale[k];
      shares_.add([&](std::size_t i) { return std::abs(found.element[i]); });
    }
  }
  return !errors_.failure;
}

/// What a composed response would change by if all that it is made of did.
void ResponseErrors::add_composed() {
  const VectorX& here = values_;
  const VectorX there = here + errors_.responses;
  for (std::size_t r = 0; r < input_.responses.size(); ++r) {
    const case_data::ResponseEntry& response = input_.responses[r];
    if (case_data::is_composed(response)) {
      const std::vector<int> parts = case_data::responses_in(input_, response);
      if (!std::all_of(parts.begin(), parts.end(), [&](int part) {
            return std::isfinite(there[part]);
          })) {  // nothing is known of a part
        error(r) = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      const VectorX& design = fields_.inputs.design;
      error(r) =
          case_data::composed_value(input_, response, design,
                                    {there.data(), r}) -
          case_data::composed_value(input_, response, design, {here.data(), r});
    }
  }
}

void ResponseErrors::run(const elastic::ElasticModel& model) {
  const std::vector<std::vector<Dual>> waiting = duals();
  for (std::size_t round = 0; solve(waiting, round, model);) {
    ++round;
  }
  if (!errors_.failure) {
    add_composed();
  }
}

}  // namespace

ElementErrors estimate_element_errors(const case_data::Case& input,
                                      const EvaluationFields& fields,
                                      const VectorX& responses,
                                      const elastic::ElasticModel& model) {
  ElementErrors errors;
  Shares shares(fields.mesh.element_count());
  for (const PartStress& stress : fields.stresses) {
    errors.energy = std::max(errors.energy, stress.error.relative());
    const std::vector<double>& e = stress.error.element;
    shares.add([&](std::size_t i) { return e[i] * e[i]; });
  }
  ResponseErrors(input, fields, responses, shares, errors).run(model);
  errors.share = shares.mean();
  return errors;
}

}  // namespace meniscus::forward
