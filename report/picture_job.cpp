#include "report/picture_job.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/error.h"

namespace meniscus {

using Json = nlohmann::json;

namespace {

constexpr std::array<const char*, 3> kKinds = {"part", "film", "overview"};

Json to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Vec3 to_vector(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(),
          json.at(2).get<double>()};
}

PictureJob to_job(const Json& json) {
  PictureJob job;
  const auto kind = std::find(kKinds.begin(), kKinds.end(),
                              json.at("kind").get<std::string>());
  if (kind == kKinds.end()) {
    throw InvalidInput("a picture's kind is part, film or overview, not " +
                       json.at("kind").dump());
  }
  job.kind = static_cast<PictureKind>(kind - kKinds.begin());
  json.at("output").get_to(job.output);
  job.part = json.value("part", "");
  job.part_surface = json.value("part_surface", "");
  job.film = json.value("film", "");
  job.title = json.value("title", "");
  job.width = json.value("width", job.width);
  job.height = json.value("height", job.height);
  job.supports = json.value("supports", job.supports);
  job.solids = json.value("solids", job.solids);
  for (const Json& load : json.value("loads", Json::array())) {
    job.loads.push_back({load.at("surface").get<std::string>(),
                         to_vector(load.at("direction")),
                         load.value("label", "")});
  }
  if (json.contains("view")) {
    job.view = to_vector(json.at("view"));
  }
  job.facet_edges = json.value("facet_edges", false);
  for (const Json& place : json.value("seen", Json::array())) {
    job.seen.push_back(to_vector(place));
  }
  job.caption = json.value("caption", "");
  constexpr int kLeast = 200;
  constexpr int kMost = 8000;
  for (const int size : {job.width, job.height}) {
    if (size < kLeast || size > kMost) {
      throw InvalidInput("a picture of " + std::to_string(job.width) + " x " +
                         std::to_string(job.height) +
                         " pixels; sides must be 200 to 8000");
    }
  }
  return job;
}

}  // namespace

std::string to_json(const std::vector<PictureJob>& jobs) {
  Json list = Json::array();
  for (const PictureJob& job : jobs) {
    Json loads = Json::array();
    for (const PictureLoad& load : job.loads) {
      loads.push_back({{"surface", load.surface},
                       {"direction", to_json(load.direction)},
                       {"label", load.label}});
    }
    Json seen = Json::array();
    for (const Vec3& place : job.seen) {
      seen.push_back(to_json(place));
    }
    list.push_back({{"kind", kKinds.at(static_cast<std::size_t>(job.kind))},
                    {"output", job.output},
                    {"part", job.part},
                    {"part_surface", job.part_surface},
                    {"film", job.film},
                    {"title", job.title},
                    {"width", job.width},
                    {"height", job.height},
                    {"supports", job.supports},
                    {"solids", job.solids},
                    {"loads", loads},
                    {"view", to_json(job.view)},
                    {"facet_edges", job.facet_edges},
                    {"seen", seen},
                    {"caption", job.caption}});
  }
  // A path need not be UTF-8; such bytes are replaced, not thrown about.
  return list.dump(1, ' ', false, Json::error_handler_t::replace);
}

std::vector<PictureJob> picture_jobs_from_json(const std::string& text) {
  try {
    std::vector<PictureJob> jobs;
    for (const Json& job : Json::parse(text)) {
      jobs.push_back(to_job(job));
    }
    return jobs;
  } catch (const Json::exception& error) {
    throw InvalidInput(std::string("picture jobs: ") + error.what());
  }
}

}  // namespace meniscus
