#include "pipeline/reader/facet_file.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "core/nearest_name.h"
#include "evolve/datafile/fe_complex.h"
#include "evolve/datafile/fe_file.h"
#include "io/obj.h"
#include "io/read_stl.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

constexpr std::size_t kMostFacets = 500000;

/// The films of a datafile, as far as they are nothing but films.
SurfaceMesh read_datafile(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  films::FilmComplex complex =
      datafile::complex_of(datafile::read_fe(read_file(path), name));
  // A datafile has gravity unless it says none; without weight it does nothing.
  const bool heavy = !complex.gravity.isZero() &&
                     std::any_of(complex.bodies.begin(), complex.bodies.end(),
                                 [](const auto& b) { return b.density != 0; });
  const char* more = !complex.level_sets.empty()   ? "constraints"
                     : !complex.integrals.empty()  ? "line integrals"
                     : !complex.quantities.empty() ? "quantities"
                     : !complex.curves.empty()     ? "boundaries"
                     : heavy                       ? "gravity"
                                                   : nullptr;
  if (more != nullptr) {
    throw InvalidInput(fmt::format(
        "{} has {}, which a case cannot hold; settle it with `meniscus evolve "
        "{}`, or write its curves and fields into the case and take them out "
        "of the file",
        path.string(), more, name));
  }
  SurfaceMesh films = complex.mesh;
  films.facets.clear();
  films.facet_label.clear();
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    const int label = complex.mesh.facet_label[f];
    if (complex.surfaces[label].liquid) {
      films.facets.push_back(complex.mesh.facets[f]);
      films.facet_label.push_back(label);
    }
  }
  return films;
}

SurfaceMesh read_surfaces(const std::filesystem::path& path) {
  const std::string ending = ending_of(path.string());
  if (ending == ".stl") {
    return io::read_stl(path);
  }
  if (ending == ".obj") {
    return io::read_obj(path);
  }
  if (ending == ".fe") {
    return read_datafile(path);
  }
  throw InvalidInput(
      fmt::format("'{}' ends in none of .stl, .obj, .fe", path.string()));
}

/// Corners by number from 1, points in the order of use.
std::string obj_text(const SurfaceMesh& mesh, int label, double scale) {
  std::vector<int> number(mesh.points.size(), 0);
  int count = 0;
  std::string points;
  std::string facets;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (label >= 0 && mesh.facet_label[f] != label) {
      continue;
    }
    for (const int v : mesh.facets[f]) {
      if (number[v] == 0) {
        number[v] = ++count;
        const Vec3 p = scale * mesh.points[v];
        points += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
      }
    }
    const Triangle& t = mesh.facets[f];
    facets +=
        fmt::format("f {} {} {}\n", number[t[0]], number[t[1]], number[t[2]]);
  }
  return points + facets;
}

std::string text_from_file(const std::filesystem::path& path,
                           const std::string& surface, double scale) {
  const SurfaceMesh mesh = read_surfaces(path);
  if (mesh.facets.size() > kMostFacets) {
    throw InvalidInput(fmt::format("{} has {} facets; at most {} are taken",
                                   path.string(), mesh.facets.size(),
                                   kMostFacets));
  }
  int label = -1;
  if (!surface.empty()) {
    label = mesh.label_of(surface);
    if (label < 0) {
      const std::string near = nearest_name(surface, mesh.labels);
      throw InvalidInput(fmt::format(
          "{} has no surface '{}'; {}", path.string(), surface,
          near.empty()
              ? fmt::format("known are {}", fmt::join(mesh.labels, ", "))
              : fmt::format("did you mean '{}'?", near)));
    }
  }
  const std::string text = obj_text(mesh, label, scale);
  if (text.empty()) {
    throw InvalidInput(fmt::format("{} has no facets", path.string()));
  }
  return text;
}

}  // namespace

std::shared_ptr<const films::StartFacets> start_from_file(
    case_data::Case& input, const std::string& path, const std::string& surface,
    double scale) {
  const std::string key =
      fmt::format("{}#surface={}&scale={}", path, surface, scale);
  auto held =
      std::find_if(input.files.begin(), input.files.end(),
                   [&](const case_data::CaseFile& f) { return f.path == key; });
  if (held == input.files.end()) {
    const auto place = std::filesystem::path(input.path).parent_path() / path;
    if (!std::filesystem::is_regular_file(place)) {
      throw InvalidInput(
          fmt::format("there is no file '{}'; expected an STL, OBJ or Surface "
                      "Evolver file, "
                      "its path relative to the case",
                      place.string()));
    }
    input.files.push_back({key, text_from_file(place, surface, scale)});
    held = std::prev(input.files.end());
  }
  SurfaceMesh mesh = io::read_obj_text(held->text, path);
  auto start = std::make_shared<films::StartFacets>();
  start->points = std::move(mesh.points);
  start->facets = std::move(mesh.facets);
  return start;
}

}  // namespace meniscus::reader
