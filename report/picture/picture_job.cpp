#include "report/picture/picture_job.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>

#include <nlohmann/json.hpp>

#include "core/error.h"

namespace meniscus::picture {

using Cbor = nlohmann::json;  // sent as CBOR, which knows plain bytes

namespace {

constexpr std::array<const char*, 3> kKinds = {"part", "film", "overview"};

Cbor to_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Vec3 to_vector(const Cbor& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(),
          json.at(2).get<double>()};
}

template <class Item>
Cbor pack(const std::vector<Item>& items) {
  std::vector<std::uint8_t> bytes(items.size() * sizeof(Item));
  if (!bytes.empty()) {
    std::memcpy(bytes.data(), static_cast<const void*>(items.data()),
                bytes.size());
  }
  return Cbor::binary(std::move(bytes));
}

template <class Item>
std::vector<Item> unpack(const Cbor& json) {
  const auto& bytes = json.get_binary();
  std::vector<Item> items(bytes.size() / sizeof(Item));
  if (items.size() * sizeof(Item) != bytes.size()) {
    throw InvalidInput("picture jobs: an array of " +
                       std::to_string(bytes.size()) + " bytes is cut off");
  }
  if (!items.empty()) {
    std::memcpy(static_cast<void*>(items.data()), bytes.data(), bytes.size());
  }
  return items;
}

/// Each shape once, whichever jobs share it.
class Shapes {
 public:
  template <class Data>
  Cbor source(const PictureSource<Data>& from) {
    if (from.data == nullptr) {
      return from.file;
    }
    const auto [at, added] = numbers_.emplace(from.data.get(), all_.size());
    if (added) {
      all_.push_back(shape(*from.data));
    }
    return at->second;
  }

  Cbor take() { return std::move(all_); }

 private:
  static Cbor shape(const PictureSurface& surface) {
    return {{"points", pack(surface.mesh.points)},
            {"facets", pack(surface.mesh.facets)},
            {"facet_label", pack(surface.mesh.facet_label)},
            {"labels", surface.mesh.labels},
            {"displacement", pack(surface.displacement)},
            {"von_mises", pack(surface.von_mises)},
            {"length_unit", surface.length_unit},
            {"stress_unit", surface.stress_unit}};
  }
  static Cbor shape(const PictureTets& tets) {
    return {{"points", pack(tets.nodes)}, {"corners", pack(tets.corners)}};
  }

  std::map<const void*, std::size_t> numbers_;
  Cbor all_ = Cbor::array();
};

/// The shapes back, each once.
class StoredShapes {
 public:
  explicit StoredShapes(const Cbor& all) : all_(all) {}

  template <class Data>
  PictureSource<Data> source(
      const Cbor& json,
      std::map<std::size_t, std::shared_ptr<Data>>& made) const {
    if (json.is_string()) {
      return {nullptr, json.get<std::string>()};
    }
    const auto number = json.get<std::size_t>();
    auto& data = made[number];
    if (data == nullptr) {
      data = std::make_shared<Data>();
      fill(all_.at(number), *data);
    }
    return {data, ""};
  }

  std::map<std::size_t, std::shared_ptr<PictureSurface>> surfaces;
  std::map<std::size_t, std::shared_ptr<PictureTets>> tets;

 private:
  template <std::size_t N>
  static void check(const std::vector<std::array<int, N>>& cells,
                    std::size_t points) {
    for (const auto& cell : cells) {
      for (const int id : cell) {
        if (id < 0 || static_cast<std::size_t>(id) >= points) {
          throw InvalidInput("picture jobs: a cell with point " +
                             std::to_string(id) + " of " +
                             std::to_string(points));
        }
      }
    }
  }

  static void fill(const Cbor& json, PictureSurface& surface) {
    SurfaceMesh& mesh = surface.mesh;
    mesh.points = unpack<Vec3>(json.at("points"));
    mesh.facets = unpack<Triangle>(json.at("facets"));
    mesh.facet_label = unpack<int>(json.at("facet_label"));
    json.at("labels").get_to(mesh.labels);
    surface.displacement = unpack<Vec3>(json.at("displacement"));
    surface.von_mises = unpack<double>(json.at("von_mises"));
    json.at("length_unit").get_to(surface.length_unit);
    json.at("stress_unit").get_to(surface.stress_unit);
    check(mesh.facets, mesh.points.size());
    const auto names = static_cast<int>(mesh.labels.size());
    const auto fits = [&](std::size_t count) {
      return count == 0 || count == mesh.points.size();
    };
    if (mesh.facet_label.size() != mesh.facets.size() ||
        !fits(surface.displacement.size()) || !fits(surface.von_mises.size()) ||
        std::any_of(mesh.facet_label.begin(), mesh.facet_label.end(),
                    [&](int label) { return label < 0 || label >= names; })) {
      throw InvalidInput("picture jobs: a surface's arrays do not fit");
    }
  }
  static void fill(const Cbor& json, PictureTets& tets) {
    tets.nodes = unpack<Vec3>(json.at("points"));
    tets.corners = unpack<std::array<int, 4>>(json.at("corners"));
    check(tets.corners, tets.nodes.size());
  }

  const Cbor& all_;
};

PictureJob to_job(const Cbor& json, StoredShapes& shapes) {
  PictureJob job;
  const auto kind = std::find(kKinds.begin(), kKinds.end(),
                              json.at("kind").get<std::string>());
  if (kind == kKinds.end()) {
    throw InvalidInput("a picture's kind is part, film or overview, not " +
                       json.at("kind").dump());
  }
  job.kind = static_cast<PictureKind>(kind - kKinds.begin());
  json.at("output").get_to(job.output);
  job.part = shapes.source(json.at("part"), shapes.tets);
  job.part_surface = shapes.source(json.at("part_surface"), shapes.surfaces);
  job.film = shapes.source(json.at("film"), shapes.surfaces);
  json.at("title").get_to(job.title);
  json.at("width").get_to(job.width);
  json.at("height").get_to(job.height);
  json.at("supports").get_to(job.supports);
  json.at("support_labels").get_to(job.support_labels);
  json.at("solids").get_to(job.solids);
  for (const Cbor& load : json.at("loads")) {
    const int load_kind = load.at("kind").get<int>();
    if (load_kind < 0 || load_kind > static_cast<int>(PictureLoadKind::Body)) {
      throw InvalidInput("picture jobs: a load of kind " +
                         std::to_string(load_kind));
    }
    job.loads.push_back({load.at("surfaces").get<std::vector<std::string>>(),
                         to_vector(load.at("direction")),
                         load.at("label").get<std::string>(),
                         static_cast<PictureLoadKind>(load_kind)});
    if (load.contains("point")) {
      job.loads.back().point = to_vector(load.at("point"));
    }
  }
  json.at("load_case").get_to(job.load_case);
  json.at("field_ending").get_to(job.field_ending);
  json.at("length_unit").get_to(job.length_unit);
  job.view = to_vector(json.at("view"));
  json.at("facet_edges").get_to(job.facet_edges);
  json.at("hidden").get_to(job.hidden);
  job.seen = unpack<Vec3>(json.at("seen"));
  json.at("caption").get_to(job.caption);
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

Cbor to_json(const PictureJob& job, Shapes& shapes) {
  Cbor loads = Cbor::array();
  for (const PictureLoad& load : job.loads) {
    loads.push_back({{"surfaces", load.surfaces},
                     {"direction", to_json(load.direction)},
                     {"label", load.label},
                     {"kind", static_cast<int>(load.kind)}});
    if (load.point) {
      loads.back()["point"] = to_json(*load.point);
    }
  }
  return {{"kind", kKinds.at(static_cast<std::size_t>(job.kind))},
          {"output", job.output},
          {"part", shapes.source(job.part)},
          {"part_surface", shapes.source(job.part_surface)},
          {"film", shapes.source(job.film)},
          {"title", job.title},
          {"width", job.width},
          {"height", job.height},
          {"supports", job.supports},
          {"support_labels", job.support_labels},
          {"solids", job.solids},
          {"loads", std::move(loads)},
          {"load_case", job.load_case},
          {"field_ending", job.field_ending},
          {"length_unit", job.length_unit},
          {"view", to_json(job.view)},
          {"facet_edges", job.facet_edges},
          {"hidden", job.hidden},
          {"seen", pack(job.seen)},
          {"caption", job.caption}};
}

}  // namespace

bool is_hidden(const std::string& surface,
               const std::vector<std::string>& hidden) {
  return std::any_of(
      hidden.begin(), hidden.end(), [&](const std::string& name) {
        if (name.ends_with('*')) {
          return surface.starts_with(name.substr(0, name.size() - 1));
        }
        return surface == name;
      });
}

std::string to_bytes(const std::vector<PictureJob>& jobs) {
  Shapes shapes;
  Cbor list = Cbor::array();
  for (const PictureJob& job : jobs) {
    list.push_back(to_json(job, shapes));
  }
  std::string bytes;
  Cbor::to_cbor({{"jobs", std::move(list)}, {"shapes", shapes.take()}}, bytes);
  return bytes;
}

std::vector<PictureJob> picture_jobs_from_bytes(const std::string& bytes) {
  try {
    const Cbor all = Cbor::from_cbor(bytes);
    StoredShapes shapes(all.at("shapes"));
    std::vector<PictureJob> jobs;
    for (const Cbor& job : all.at("jobs")) {
      jobs.push_back(to_job(job, shapes));
    }
    return jobs;
  } catch (const Cbor::exception& error) {
    throw InvalidInput(std::string("picture jobs: ") + error.what());
  }
}

}  // namespace meniscus::picture
