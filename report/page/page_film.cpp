#include "report/page/page_film.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "report/page/packed_array.h"
#include "report/page/vtk_input.h"

namespace meniscus::page {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

std::vector<double> coordinates(const Points& points) {
  const auto flat_points = flat(points);
  return {flat_points.begin(), flat_points.end()};
}

/// Names and a label per triangle. Throws InvalidInput.
std::vector<int> labels_of(const VtkInput& surface, const fs::path& path,
                           std::vector<std::string>& names) {
  const auto labels = surface.cell_data.find("surface");
  const auto texts = surface.texts.find("surface_names");
  if (surface.cell_size != 3 || labels == surface.cell_data.end() ||
      texts == surface.texts.end()) {
    throw InvalidInput(fmt::format("'{}' holds no triangles of named surfaces",
                                   path.string()));
  }
  names = texts->second;
  std::vector<int> ids;
  ids.reserve(labels->second.size());
  for (const double label : labels->second) {
    ids.push_back(static_cast<int>(label));
    if (ids.back() < 0 || ids.back() >= static_cast<int>(names.size())) {
      throw InvalidInput(fmt::format("'{}' has a triangle of surface {}",
                                     path.string(), label));
    }
  }
  return ids;
}

Json surface_json(const VtkInput& surface, const std::vector<int>& labels,
                  const std::vector<std::string>& names) {
  return {{"nodes", pack_reals(coordinates(surface.points), 3)},
          {"triangles", pack_ids(surface.cells)},
          {"labels", pack_ids(labels)},
          {"names", names}};
}

double cotangent(const Vec3& a, const Vec3& b) {
  return a.dot(b) /
         std::max(a.cross(b).norm(), std::numeric_limits<double>::min());
}

/// A vertex's share of a facet: Voronoi, or half or a quarter of an obtuse one.
double mixed_area(const Vec3& at, const Vec3& next, const Vec3& last) {
  const double area = 0.5 * (next - at).cross(last - at).norm();
  if ((next - at).dot(last - at) < 0.0) {
    return 0.5 * area;
  }
  if ((at - next).dot(last - next) < 0.0 ||
      (at - last).dot(next - last) < 0.0) {
    return 0.25 * area;
  }
  return 0.125 *
         ((next - at).squaredNorm() * cotangent(at - last, next - last) +
          (last - at).squaredNorm() * cotangent(at - next, last - next));
}

/// Vertices whose facets do not close around them.
std::vector<char> rim_vertices(std::size_t count,
                               const std::vector<Triangle>& facets) {
  std::vector<Edge> out;  // directed edges
  out.reserve(3 * facets.size());
  for (const Triangle& f : facets) {
    for (std::size_t k = 0; k < 3; ++k) {
      out.push_back({f[k], f[(k + 1) % 3]});
    }
  }
  std::sort(out.begin(), out.end());
  std::vector<char> rim(count, 0);
  for (const Edge& e : out) {
    if (!std::binary_search(out.begin(), out.end(), Edge{e[1], e[0]})) {
      rim[static_cast<std::size_t>(e[0])] = 1;
      rim[static_cast<std::size_t>(e[1])] = 1;
    }
  }
  return rim;
}

}  // namespace

std::vector<double> mean_curvature(const Points& points,
                                   const std::vector<Triangle>& facets) {
  const std::vector<char> rim = rim_vertices(points.size(), facets);
  Points laplacian(points.size(), Vec3::Zero());
  Points normal(points.size(), Vec3::Zero());
  std::vector<double> area(points.size(), 0.0);
  for (const Triangle& f : facets) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(f[k]);
      const Vec3& p = points[at];
      const Vec3& next = points[static_cast<std::size_t>(f[(k + 1) % 3])];
      const Vec3& last = points[static_cast<std::size_t>(f[(k + 2) % 3])];
      laplacian[at] += 0.5 * (cotangent(p - last, next - last) * (next - p) +
                              cotangent(p - next, last - next) * (last - p));
      normal[at] += (next - p).cross(last - p);
      area[at] += mixed_area(p, next, last);
    }
  }
  std::vector<double> curvature(points.size(),
                                std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (rim[i] == 0 && area[i] > 0.0) {
      curvature[i] = -0.5 * laplacian[i].dot(normal[i].normalized()) / area[i];
    }
  }
  return curvature;
}

Json page_film(const fs::path& path, const std::vector<std::string>& solids) {
  const VtkInput surface = read_vtk(path);
  std::vector<std::string> names;
  const std::vector<int> labels = labels_of(surface, path, names);
  std::vector<bool> solid;
  solid.reserve(names.size());
  for (const std::string& name : names) {
    solid.push_back(std::find(solids.begin(), solids.end(), name) !=
                    solids.end());
  }
  std::vector<Triangle> liquid;
  for (std::size_t t = 0; t < labels.size(); ++t) {
    if (!solid[static_cast<std::size_t>(labels[t])]) {
      liquid.push_back({surface.cells[3 * t], surface.cells[3 * t + 1],
                        surface.cells[3 * t + 2]});
    }
  }
  Json json = surface_json(surface, labels, names);
  json["solid"] = solid;
  json["fields"] = {{"mean_curvature",
                     pack_reals(mean_curvature(surface.points, liquid), 1)}};
  return json;
}

namespace {

/// The value of an attribute in a tag's text, or empty.
std::string attribute(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string::npos) {
    return "";
  }
  const std::size_t from = at + name.size() + 3;
  return tag.substr(from, tag.find('"', from) - from);
}

}  // namespace

std::vector<PageFrame> page_frames(const fs::path& folder) {
  const fs::path list = folder / "frames.pvd";
  std::vector<PageFrame> frames;
  if (!fs::exists(list)) {
    return frames;
  }
  const std::string text = read_file(list);
  for (std::size_t at = text.find("<DataSet"); at != std::string::npos;
       at = text.find("<DataSet", at + 1)) {
    const std::string tag = text.substr(at, text.find('>', at) - at);
    PageFrame frame{.evaluation = static_cast<int>(std::strtol(
                        attribute(tag, "timestep").c_str(), nullptr, 10)),
                    .file = attribute(tag, "file")};
    const fs::path file = fs::path(frame.file).lexically_normal();
    if (frame.file.empty() || file.is_absolute() || *file.begin() == "..") {
      throw InvalidInput(
          fmt::format("'{}' names the file '{}', which is not in its folder",
                      list.string(), frame.file));
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

namespace {

/// `count` of `all`, evenly, with the first and the last.
std::vector<std::size_t> evenly(std::size_t count, std::size_t all) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    chosen.push_back(count > 1 ? k * (all - 1) / (count - 1) : all - 1);
  }
  return chosen;
}

/// Of frames after each other as text, each with triangles of its own where
/// the one before has others.
double bytes_of_frames(const std::vector<VtkInput>& frames,
                       const std::vector<std::size_t>& chosen) {
  constexpr double kPerNode = 8.0;    // 3 x 2 bytes in base64
  constexpr double kPerCorner = 5.4;  // 4 bytes
  double bytes = 0.0;
  const VtkInput* before = nullptr;
  for (const std::size_t at : chosen) {
    const VtkInput& frame = frames[at];
    bytes += kPerNode * static_cast<double>(frame.points.size());
    if (before == nullptr || before->cells != frame.cells) {
      bytes += kPerCorner * static_cast<double>(frame.cells.size());
    }
    before = &frame;
  }
  return bytes;
}

}  // namespace

Json frames_json(const fs::path& folder, const std::vector<PageFrame>& frames,
                 double bytes) {
  Json json;
  if (frames.empty()) {
    return json;
  }
  std::vector<VtkInput> surfaces;
  surfaces.reserve(frames.size());
  for (const PageFrame& frame : frames) {
    surfaces.push_back(read_vtk(folder / frame.file));
  }
  std::vector<std::size_t> chosen = evenly(frames.size(), frames.size());
  while (chosen.size() > 2 && bytes_of_frames(surfaces, chosen) > bytes) {
    chosen = evenly(chosen.size() - 1, frames.size());
  }
  json["stored"] = frames.size();
  json["frames"] = Json::array();
  const VtkInput* before = nullptr;
  for (const std::size_t at : chosen) {
    const VtkInput& surface = surfaces[at];
    Json frame = {{"evaluation", frames[at].evaluation},
                  {"place", at},
                  {"nodes", pack_reals(coordinates(surface.points), 3)}};
    if (before == nullptr || before->cells != surface.cells ||
        before->points.size() != surface.points.size()) {
      std::vector<std::string> names;
      const std::vector<int> labels =
          labels_of(surface, folder / frames[at].file, names);
      frame["surface"] = surface_json(surface, labels, names);
      frame["surface"].erase("nodes");
    }
    before = &surface;
    json["frames"].push_back(std::move(frame));
  }
  return json;
}

Json page_findings(const fs::path& folder) {
  const VtkInput found = read_vtk(folder / "findings.vtp");
  const auto messages = found.texts.find("messages");
  Json json = {
      {"nodes", pack_reals(coordinates(found.points), 3)},
      {"triangles", pack_ids(found.cells)},
      {"places", found.vertices},
      {"messages", messages == found.texts.end() ? std::vector<std::string>{}
                                                 : messages->second}};
  const fs::path whole = folder / "unfilled_surface.vtp";
  if (fs::exists(whole)) {
    const VtkInput surface = read_vtk(whole);
    std::vector<std::string> names;
    const std::vector<int> labels = labels_of(surface, whole, names);
    json["surface"] = surface_json(surface, labels, names);
  }
  return json;
}

}  // namespace meniscus::page
