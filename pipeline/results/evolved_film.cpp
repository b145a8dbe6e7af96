#include "pipeline/results/evolved_film.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/json.h"
#include "pipeline/forward/figures_json.h"
#include "pipeline/results/results.h"

namespace meniscus::results {

using Json = nlohmann::ordered_json;

namespace {

Json numbers(const Points& points) {
  const auto values = flat(points);
  return std::vector<double>(values.begin(), values.end());
}

/// Of the case, or made by a pop.
bool is_film(const case_data::Case& input, const frozen::FilmModel& model,
             const std::string& name) {
  const std::vector<settle::PulledFilm>& popped =
      model.reference().report.popped;
  return std::any_of(input.films.begin(), input.films.end(),
                     [&](const case_data::FilmEntry& entry) {
                       return entry.spec.name == name;
                     }) ||
         std::any_of(
             popped.begin(), popped.end(),
             [&](const settle::PulledFilm& film) { return film.name == name; });
}

Json nesting_json(const films::NestingReport& nesting) {
  Json json = {{"apart", nesting.apart},
               {"crossing_pairs", nesting.crossing_pairs},
               {"gaps", Json::array()},
               {"inside", Json::array()}};
  for (const films::GroupGap& gap : nesting.gaps) {
    json["gaps"].push_back(
        {{"films", {gap.group, gap.other}},
         {"gap", gap.gap},
         {"place", {gap.on_group.x(), gap.on_group.y(), gap.on_group.z()}}});
  }
  for (const films::GroupInside& pair : nesting.inside) {
    json["inside"].push_back({{"inner", pair.inner}, {"outer", pair.outer}});
  }
  return json;
}

}  // namespace

std::vector<std::pair<std::string, double>> areas_of_films(
    const case_data::Case& input, const frozen::FilmModel& model) {
  const VectorX areas = model.areas(model.reference().points);
  std::vector<std::pair<std::string, double>> all;
  for (std::size_t k = 0; k < model.labels().size(); ++k) {
    const std::string& name = model.labels()[k];
    if (is_film(input, model, name)) {
      all.emplace_back(name, areas[static_cast<Eigen::Index>(k)]);
    }
  }
  return all;
}

films::NestingReport nesting_of_films(const case_data::Case& input,
                                      const frozen::FilmModel& model) {
  const SurfaceMesh mesh = model.fine_mesh(model.reference().points);
  std::vector<int> all;
  for (std::size_t k = 0; k < mesh.labels.size(); ++k) {
    if (is_film(input, model, mesh.labels[k])) {
      all.push_back(static_cast<int>(k));
    }
  }
  return films::check_nesting(mesh, all);
}

std::vector<CurvePieces> pieces_of_curves(
    const std::vector<curves::Curve>& curves) {
  constexpr int kPieces = 96;
  std::vector<CurvePieces> all;
  for (const curves::Curve& curve : curves) {
    if (std::holds_alternative<curves::ParametricCurve>(curve.shape)) {
      continue;
    }
    CurvePieces& pieces = all.emplace_back();
    pieces.name = curve.name;
    for (int k = 0; k < kPieces; ++k) {
      for (const int end : {k, (k + 1) % kPieces}) {
        pieces.ends.push_back(
            curves::point_at(curve.shape, static_cast<double>(end) / kPieces));
      }
    }
  }
  return all;
}

std::vector<CurvePieces> pieces_of_curves(const films::FilmComplex& complex) {
  std::map<int, Points> ends;  // by curve
  for (const films::ComplexEdge& edge : complex.edges) {
    if (edge.curve >= 0 && edge.kind != films::VertexKind::OnEdge) {
      for (const int end : {edge.a, edge.b}) {
        ends[edge.curve].push_back(
            complex.mesh.points[static_cast<std::size_t>(end)]);
      }
    }
  }
  std::vector<CurvePieces> all;
  all.reserve(ends.size());
  for (auto& [curve, points] : ends) {
    all.push_back({complex.curves[static_cast<std::size_t>(curve)].name,
                   std::move(points)});
  }
  return all;
}

void write_evolved_film(const EvolvedFilm& film,
                        const std::vector<forward::FilmFrame>& frames,
                        const std::filesystem::path& folder) {
  Json json = {{"schema_version", kResultSchemaVersion},
               {"title", film.title},
               {"status", film.failure ? "failed" : "converged"},
               {"message", film.failure ? film.failure->message
                                        : "the film is at rest and stable"}};
  if (film.units) {
    json["units"] = forward::units_json(*film.units);
  }
  json.update(forward::film_json(film.report));
  if (!film.report.popped.empty()) {
    json["popped"] = forward::popped_json(film.report);
  }
  json["nesting"] = nesting_json(film.nesting);
  for (const auto& [name, value] : film.quantities) {
    json["quantities"][name] = value;
  }
  for (const auto& [name, area] : film.areas) {
    json["films"][name] = {{"area", area}};
  }
  json["seconds"] = film.report.seconds;
  json["solids"] = film.solids;
  json["curves"] = Json::array();
  for (const CurvePieces& curve : film.curves) {
    json["curves"].push_back(
        {{"name", curve.name}, {"ends", numbers(curve.ends)}});
  }
  json["frames"] = Json::array();
  for (const forward::FilmFrame& frame : frames) {
    json["frames"].push_back(settling_caption(frame));
  }
  write_file(folder / "film.json", json_text(json, 1) + "\n");
}

std::string settling_caption(const forward::FilmFrame& frame) {
  return frame.kept == "flowing" ? fmt::format("step {}", frame.evaluation)
                                 : frame.kept;
}

}  // namespace meniscus::results
