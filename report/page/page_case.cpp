#include "report/page/page_case.h"

#include <cmath>
#include <limits>
#include <optional>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "pipeline/case_data/study_kinds.h"
#include "pipeline/store/refreeze.h"
#include "report/page/packed_array.h"

namespace meniscus::page {

using Json = nlohmann::ordered_json;

namespace {

constexpr int kCurvePoints = 96;

using NameList = std::vector<std::string>;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::string load_case_of(const case_data::Case& input,
                         const case_data::ResponseEntry& response) {
  return response.load_case >= 0 &&
                 response.load_case < static_cast<int>(input.load_cases.size())
             ? input.load_cases[static_cast<std::size_t>(response.load_case)]
                   .name
             : "";
}

Json study_json(const case_data::Case& input) {
  const case_data::StudyEntry& study = input.study;
  const std::vector<std::string> names = case_data::response_names(input);
  Json json = {{"kind", case_data::row_of(study.kind).name},
               {"method", study.method},
               {"equal", study.equal},
               {"targets", Json::object()},
               {"tolerance", study.tolerance},
               {"constraints", Json::array()}};
  for (const auto& [response, value] : study.targets) {
    json["targets"][response] = value;
  }
  const auto named = [&](const std::optional<int>& response) {
    return response ? Json(names[static_cast<std::size_t>(*response)]) : Json();
  };
  json["objective"] = named(study.objective);
  json["second"] = named(study.second);
  for (const case_data::ConstraintEntry& bound : study.constraints) {
    json["constraints"].push_back(
        {{"response", names[static_cast<std::size_t>(bound.response)]},
         {"min", number(bound.lower)},
         {"max", number(bound.upper)}});
  }
  return json;
}

/// Closed curves at even parameters; parametric ones know no range.
bool has_range(const curves::Curve& curve) {
  return !std::holds_alternative<curves::ParametricCurve>(curve.shape);
}

std::vector<double> even_parameters() {
  std::vector<double> t;
  t.reserve(kCurvePoints);
  for (int k = 0; k < kCurvePoints; ++k) {
    t.push_back(static_cast<double>(k) / kCurvePoints);
  }
  return t;
}

Json pack_points(const Points& points) {
  const auto values = flat(points);
  return pack_reals({values.begin(), values.end()}, 3);
}

/// Adds each curve's motion by one design variable.
void add_motion(const case_data::Case& input, const VectorX& design,
                int variable, const case_data::EvaluatedCase& inputs,
                Json& curves) {
  const case_data::CaseRates rate = case_data::rates(input, design, variable);
  const std::vector<double> t = even_parameters();
  std::size_t k = 0;
  for (std::size_t c = 0; c < inputs.film_system.curves.size(); ++c) {
    const curves::Curve& curve = inputs.film_system.curves[c];
    if (!has_range(curve)) {
      continue;
    }
    const Points moved =
        curves::point_rates(curve.shape, rate.film_system.curves[c].shape, t);
    if (flat(moved).norm() > 0.0) {
      const std::string& name =
          input.design[static_cast<std::size_t>(variable)].name;
      curves[k]["motion"][name] = pack_points(moved);
    }
    ++k;
  }
}

}  // namespace

Json page_case(const case_data::Case& input) {
  Json json = {{"path", input.path},           {"text", input.text},
               {"overrides", input.overrides}, {"hash", input.hash},
               {"design", Json::array()},      {"responses", Json::array()},
               {"study", study_json(input)}};
  for (const case_data::DesignVariable& d : input.design) {
    json["design"].push_back(
        {{"name", d.name},
         {"unit", case_data::unit_of(input.units, d.measure)},
         {"initial", d.initial},
         {"lower", number(d.lower)},
         {"upper", number(d.upper)}});
  }
  json["vectors"] = Json::array();
  for (const case_data::DesignVector& v : input.vectors) {
    json["vectors"].push_back(
        {{"name", v.name}, {"shape", v.shape}, {"first", v.first}});
  }
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    const case_data::ResponseEntry& response = input.responses[k];
    json["responses"].push_back(
        {{"name", response.name},
         {"unit", case_data::response_unit(input, static_cast<int>(k))},
         {"on", response.surface},
         {"load_case", load_case_of(input, response)}});
  }
  json["parameter_units"] = Json::object();
  for (const case_data::Parameter& parameter : input.parameters) {
    json["parameter_units"][parameter.name] =
        case_data::unit_of(input.units, parameter.value.measure);
  }
  return json;
}

Json page_curves(const case_data::Case& input, const VectorX& design) {
  Json curves = Json::array();
  try {
    const case_data::EvaluatedCase inputs = case_data::evaluate(input, design);
    for (const curves::Curve& curve : inputs.film_system.curves) {
      if (!has_range(curve)) {
        continue;
      }
      Points points;
      points.reserve(kCurvePoints);
      for (const double t : even_parameters()) {
        points.push_back(curves::point_at(curve.shape, t));
      }
      curves.push_back({{"name", curve.name},
                        {"points", pack_points(points)},
                        {"motion", Json::object()}});
    }
    for (int k = 0; k < static_cast<int>(input.design.size()); ++k) {
      add_motion(input, design, k, inputs, curves);
    }
  } catch (const InvalidInput&) {
    return curves;  // no derivative there: curves without their motion
  }
  return curves;
}

Json page_loads(const case_data::Case& input,
                const case_data::EvaluatedCase& inputs) {
  Json cases = Json::array();
  for (const loads::LoadCase& load_case : inputs.load_cases) {
    Json items = Json::array();
    const auto add = [&](const loads::Surfaces& on, const char* kind,
                         Json vector, const std::optional<Vec3>& at = {}) {
      items.push_back({{"on", static_cast<const NameList&>(on)},
                       {"kind", kind},
                       {"vector", std::move(vector)},
                       {"at", at ? vector_json(*at) : Json()}});
    };
    for (const loads::SurfaceForce& force : load_case.forces) {
      add(force.surfaces, "force", vector_json(force.total));
    }
    for (const loads::BearingLoad& load : load_case.bearings) {
      add(load.surfaces, "force", vector_json(load.force), load.point);
    }
    for (const loads::RemoteLoad& load : load_case.remote_loads) {
      if (load.force.norm() > 0.0) {
        add(load.surfaces, "force", vector_json(load.force), load.point);
      }
      if (load.moment.norm() > 0.0) {
        add(load.surfaces, "moment", vector_json(load.moment), load.point);
      }
    }
    for (const loads::SurfacePressure& pressure : load_case.pressures) {
      add(pressure.surface, "pressure", Json());
    }
    for (const loads::SurfaceTraction& traction : load_case.tractions) {
      add(traction.surface, "traction", Json());
    }
    for (const loads::Support& support : load_case.supports) {
      if (!support.at) {
        add(support.surface, "support", Json());
      }
    }
    for (const loads::RigidPin& pin : load_case.pins) {
      for (const std::string& on : pin.surfaces) {
        if (pin.holds()) {
          add(on, "support", Json());
        }
      }
    }
    for (const loads::SpringBed& bed : load_case.springs) {
      add(bed.surface, "spring", Json());
    }
    cases.push_back({{"name", load_case.name},
                     {"unit", input.units.force},
                     {"items", std::move(items)}});
  }
  return cases;
}

Json page_gradients(const case_data::Case& input,
                    const std::vector<store::EvaluationRecord>& records,
                    const VectorX& design) {
  const store::EvaluationRecord* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const store::EvaluationRecord& record : records) {
    if (!store::is_study_model(record.model) || record.gradient.size() == 0 ||
        record.inputs.size() != design.size()) {
      continue;
    }
    double distance = 0.0;
    for (Eigen::Index k = 0; k < design.size(); ++k) {
      const case_data::DesignVariable& d =
          input.design[static_cast<std::size_t>(k)];
      distance += std::pow(
          (record.inputs[k] - design[k]) / std::max(d.upper - d.lower, 1e-300),
          2);
    }
    if (distance <= least) {
      least = distance;
      nearest = &record;
    }
  }
  if (nearest == nullptr) {
    return {};
  }
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < nearest->gradient.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < nearest->gradient.cols(); ++k) {
      row.push_back(number(nearest->gradient(r, k)));
    }
    rows.push_back(std::move(row));
  }
  return {{"evaluation", nearest->number},
          {"at_answer", least == 0.0},
          {"rows", std::move(rows)}};
}

}  // namespace meniscus::page
