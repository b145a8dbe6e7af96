/// What a part's stresses come to, load case by load case.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "fea/stress/peak_stress.h"
#include "fea/stress/stress_uniformity.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

struct StressFigures {
  std::string load_case;
  /// Of a load from any direction: not one that must come (worst_cases.h).
  bool is_unit_load = false;
  std::optional<Vec3> direction;  // of one that shows such a load
  double max_von_mises = 0.0;     // recovered, of elements that count
  Vec3 position = Vec3::Zero();   // of that [length]
  stress::PeakReadings readings;  // of the elements that count
  /// Of the peak, by all that is known of it: other meshes, the readings, and
  /// `singular` [pressure]; not a number where there is none.
  double peak_error = std::numeric_limits<double>::quiet_NaN();
  /// Where stress has no limit (fea/stress/singular_edges.h), of the elements
  /// that count: the place with the largest stress on shorter edges.
  struct Singular {
    Vec3 position = Vec3::Zero();  // [length]
    double von_mises = 0.0;        // recovered [pressure]
    double grown = 0.0;            // with edges shorter (singular_places.h)
    std::array<std::string, 2> surfaces;  // that meet there
    bool clamped = false;                 // the first of them is held
    double angle = 0.0;                   // of the material [rad]
    double order = 0.0;                   // stress grows as edges^-order
  };
  std::optional<Singular> singular;
  /// Where the part is nearest to yield, against each body's own material; none
  /// where no material has a yield strength.
  struct Safety {
    double factor = 0.0;
    double von_mises = 0.0;        // there [pressure]
    Vec3 position = Vec3::Zero();  // [length]
    std::string material;
    double yield_strength = 0.0;  // its [pressure]
  };
  std::optional<Safety> safety;
  /// Of the elements that count; none of shells.
  std::optional<stress::StressUniformity> uniformity;
  /// The same peaks of the zones that do not count, so that nothing is hidden.
  struct Excluded {
    double max_von_mises = 0.0;
    Vec3 position = Vec3::Zero();
    std::optional<Safety> safety;
  };
  std::optional<Excluded> excluded;  // where there are zones
};

/// Of `fields.stresses`; elements of `fields.exclusion` are left out.
std::vector<StressFigures> stress_figures(const EvaluationFields& fields);

/// The largest reading of each load case's peak [pressure].
std::vector<double> highest_readings(const EvaluationFields& fields);

/// What the singular place would have above the peak [pressure], >= 0.
double growth_of_peak(const StressFigures& figures);

/// How far the highest reading stands above the peak of the integration points
/// [pressure], >= 0: what is extrapolated to the surface. It falls with the
/// edges, and does not depend on other meshes that agree by chance.
double extrapolated_part(const StressFigures& figures);

/// True where the peak may grow with every refinement: a singular place would
/// have more on shorter edges, or materials differ, whose common edges the
/// search for such places does not know.
bool may_be_singular(const EvaluationFields& fields,
                     const StressFigures& figures);

/// That is more than a few per cent of the peak, which has no limit then.
bool has_no_limit(const StressFigures& figures);

/// A sentence on a peak without limit: place, surfaces, angle, growth and what
/// to do.
std::string no_limit_text(const StressFigures& figures,
                          const UnitSystem& units);

/// The safety factor where the stress is higher by the peak's error; nothing
/// without either.
std::optional<double> safety_with_error(const StressFigures& figures);

/// The load case that is nearest to yield, by the least safety factor; without
/// any, the one of the highest peak. The first of equals, 0 for none; no unit
/// load of a load from any direction.
std::size_t worst_load_case(const std::vector<StressFigures>& figures);

/// The same from the stresses themselves, at the price of their peaks.
std::size_t worst_load_case(const EvaluationFields& fields);

/// A line per load case for people: peak with its error, place and safety, the
/// stress that safety is of where another reading is worse, the safety with the
/// error, and the worst marked where there are several; below it the peak of
/// what is left out.
std::string stress_text(const std::vector<StressFigures>& figures,
                        const UnitSystem& units);

/// result.json's "stress": an entry per load case (docs/results.md).
nlohmann::ordered_json stress_json(const std::vector<StressFigures>& figures);

}  // namespace meniscus::forward
