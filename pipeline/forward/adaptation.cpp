#include "pipeline/forward/adaptation.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "fea/stress/size_field.h"

namespace meniscus::forward {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kErrorWanted =
    0.4;  // of that there is; singular edges keep more
constexpr double kMostRefinement = 2.0;
// A facet is halved when that brings its edges nearer to what is wanted.
constexpr double kHalve = 0.70710678;

double mean_edge(const TetMesh& mesh, int f) {
  const auto ids = mesh.face(f);
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += (mesh.nodes[static_cast<std::size_t>(ids[k])] -
            mesh.nodes[static_cast<std::size_t>(ids[(k + 1) % 3])])
               .norm();
  }
  return sum / 3.0;
}

Json state_json(const case_data::Case& input, const AdaptedState& state) {
  Json json = {
      {"nodes", state.tet.nodes},    {"elements", state.tet.elements},
      {"dofs", state.dofs},          {"energy_error", state.errors.energy},
      {"responses", Json::object()}, {"response_errors", Json::object()}};
  for (std::size_t r = 0; r < input.responses.size(); ++r) {
    const auto k = static_cast<Eigen::Index>(r);
    const std::string& name = input.responses[r].name;
    json["responses"][name] = state.responses[k];
    json["response_errors"][name] = state.errors.responses[k];
  }
  return json;
}

}  // namespace

RefinementPlan plan_refinement(const TetMesh& mesh,
                               const std::vector<double>& share) {
  stress::EnergyError error{.error = 1.0};
  for (const double s : share) {
    error.element.push_back(std::sqrt(s));
  }
  const stress::SizeField field =
      stress::size_field(mesh, error,
                         {.relative_error = kErrorWanted,
                          .most_refinement = kMostRefinement,
                          .most_coarsening = 1.0});
  RefinementPlan plan{.size = field.function()};
  for (int f = 0; f < mesh.face_count(); ++f) {
    double wanted = 0.0;
    for (const int node : mesh.face(f).first<3>()) {
      wanted += field.length[static_cast<std::size_t>(node)] / 3.0;
    }
    plan.split.push_back(wanted < kHalve * mean_edge(mesh, f) ? 1 : 0);
  }
  return plan;
}

Json adaptation_json(const case_data::Case& input,
                     const Adaptation& adaptation) {
  return {{"before", state_json(input, adaptation.before)},
          {"after", state_json(input, adaptation.after)}};
}

}  // namespace meniscus::forward
