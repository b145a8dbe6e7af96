#include "report/render/render_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/union_find.h"
#include "report/render/cut_plane.h"
#include "report/render/drawn_loads.h"
#include "report/render/shaded_surface.h"

namespace meniscus::render {

namespace {

constexpr double kShownDeflection = 0.06;  // x bounding-box diagonal, at most
constexpr double kRobustPart = 0.998;      // of the nodes lie below the bar's
                                           // top: corners peak without limit
constexpr double kThickestRim = 0.01;      // x length of the shortest rim
constexpr Colour kInk = {0.13, 0.16, 0.20};

std::vector<char> every_label(const SurfaceMesh& mesh) {
  return std::vector<char>(mesh.labels.size(), 1);
}

std::vector<char> labels_among(const SurfaceMesh& mesh,
                               const std::vector<std::string>& names) {
  std::vector<char> use(mesh.labels.size(), 0);
  for (std::size_t l = 0; l < use.size(); ++l) {
    use[l] = static_cast<char>(
        std::find(names.begin(), names.end(), mesh.labels[l]) != names.end());
  }
  return use;
}

/// Length of the shortest chain of `rims`; infinite where there is none.
double shortest_rim(const Points& points, const std::vector<Edge>& rims) {
  UnionFind chains(points.size());
  for (const Edge& e : rims) {
    chains.join(e[0], e[1]);
  }
  std::vector<double> length(points.size(), 0.0);
  for (const Edge& e : rims) {
    length[chains.root(e[0])] += (points[e[1]] - points[e[0]]).norm();
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double one : length) {
    least = one > 0.0 ? std::min(least, one) : least;
  }
  return least;
}

struct BarRange {
  double top = 1.0;
  double step = 0.5;     // between ticks
  bool clipped = false;  // some values lie above
};
BarRange bar_range(std::vector<double> values) {
  const double largest = *std::max_element(values.begin(), values.end());
  const auto at = static_cast<std::ptrdiff_t>(
      kRobustPart * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  const double robust = values[static_cast<std::size_t>(at)];
  if (!(robust > 0.0) || !std::isfinite(robust)) {
    return {};
  }
  const double step = round_down_nice(robust / 3.0);
  const double top = step * std::ceil(robust / step * (1 - 1e-9));
  return {top, step, largest > top * (1 + 1e-9)};
}

/// A factor that makes values up to `top` short to print, and what they are
/// then in: 1.4e6 Pa is 1.4 [MPa].
std::pair<double, std::string> readable_unit(double top,
                                             const std::string& unit) {
  if (unit == "Pa") {
    constexpr std::array<std::pair<double, const char*>, 3> kPrefixes = {
        {{1e9, " [GPa]"}, {1e6, " [MPa]"}, {1e3, " [kPa]"}}};
    for (const auto& [size, name] : kPrefixes) {
      if (top >= size) {
        return {1.0 / size, name};
      }
    }
  }
  constexpr double kLongest = 1e5;
  if (top >= kLongest) {
    return {1e-3, fmt::format(" [1000 {}]", unit)};
  }
  return {1.0, unit.empty() ? "" : fmt::format(" [{}]", unit)};
}

}  // namespace

bool draw_film(Panel& panel, const picture::PictureJob& job,
               const picture::PictureSurface& film) {
  const SurfaceMesh& mesh = film.mesh;
  const double diagonal = bounding_diagonal(mesh.points);
  const Vec3 eye = job.view.normalized();
  const std::vector<char> solid = labels_among(mesh, job.solids);
  std::vector<char> liquid(solid.size());
  for (std::size_t l = 0; l < solid.size(); ++l) {
    liquid[l] = static_cast<char>(solid[l] == 0);
  }
  const ShadedSurface skin = shade(mesh, liquid);
  const bool any = skin.data->GetNumberOfPoints() > 0;
  if (any) {
    // Light passes a film best where it falls straight through: opacity and
    // tint follow the angle to the eye (Schlick's curve, exaggerated).
    constexpr Colour kGrazing = {0.06, 0.27, 0.62};
    auto* normals = skin.data->GetPointData()->GetNormals();
    std::vector<Paint> colours;
    for (vtkIdType i = 0; i < skin.data->GetNumberOfPoints(); ++i) {
      Vec3 n;
      normals->GetTuple(i, n.data());
      const double g = std::pow(1.0 - std::abs(n.dot(eye)), 2.0);
      auto& c = colours.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        c[k] = (1 - g) * kFilmColour[k] + g * kGrazing[k];
      }
      c[3] = 0.30 + 0.60 * g;
    }
    SurfaceStyle style;
    style.finish.specular = 0.7;
    style.edges = job.facet_edges;
    style.edge_colour = {0.10, 0.30, 0.55};
    style.edge_width = 0.7;
    panel.add_surface(skin.data, style, colours);
  }
  SurfaceStyle cap;
  cap.colour = kCapColour;
  cap.opacity = 0.95;
  const ShadedSurface caps = shade(mesh, solid);
  if (caps.data->GetNumberOfPoints() > 0) {
    panel.add_surface(caps.data, cap);
  }
  const std::vector<Edge> rims = rim_edges(mesh);
  const double thick = std::min(0.0045 * diagonal,
                                kThickestRim * shortest_rim(mesh.points, rims));
  panel.add_tubes(mesh.points, rims, thick, kRimColour);
  // The camera of a series must not depend on the film.
  panel.show(job.seen.empty() ? mesh.points : job.seen);
  return any;
}

void draw_cut_mesh(Panel& panel, const picture::PictureJob& job,
                   const picture::PictureTets& tets) {
  const SurfaceMesh mesh = cut_open(tets, cut_plane(tets, job.view));
  SurfaceStyle style;
  style.flat = true;
  style.only_front = true;
  style.edges = true;
  style.finish = {.specular = 0.0, .ambient = 0.3};
  style.edge_width = 0.8;
  style.colour = kOutsideColour;
  style.edge_colour = {0.22, 0.33, 0.46};
  panel.add_surface(shade(mesh, {1, 0}).data, style);
  style.colour = kInsideColour;
  style.edge_colour = {0.50, 0.34, 0.12};
  panel.add_surface(shade(mesh, {0, 1}).data, style);
  panel.show(tets.nodes);
}

PartFigures draw_part(Panel& panel, const picture::PictureJob& job,
                      const picture::PictureSurface& part,
                      const ViewLayout& layout) {
  const SurfaceMesh& rest = part.mesh;
  if (part.displacement.empty() || part.von_mises.empty()) {
    throw InvalidInput(fmt::format(
        "the part of '{}' has no 'displacement' and 'von_mises'", job.output));
  }
  const double diagonal = bounding_diagonal(rest.points);
  double largest = 0.0;
  for (const Vec3& u : part.displacement) {
    largest = std::max(largest, u.norm());
  }
  const double factor =
      largest > 0.0 ? round_down_nice(kShownDeflection * diagonal / largest)
                    : 1.0;
  SurfaceMesh moved = rest;
  for (std::size_t i = 0; i < moved.points.size(); ++i) {
    moved.points[i] += factor * part.displacement[i];
  }
  const auto [top, step, clipped] = bar_range(part.von_mises);
  const ShadedSurface shaded = shade(moved, every_label(moved));
  std::vector<Paint> colours;
  for (const int id : shaded.source) {
    const Colour c =
        viridis(part.von_mises[static_cast<std::size_t>(id)] / top);
    colours.push_back({c[0], c[1], c[2], 1.0});
  }
  panel.add_surface(
      shaded.data,
      {.finish = {.specular = 0.15, .ambient = 0.4}, .only_front = true},
      colours);
  panel.add_tubes(moved.points, rim_edges(moved), 0.0016 * diagonal, kInk);
  panel.add_surface(
      shade(rest, every_label(rest)).data,
      {.colour = {0.45, 0.5, 0.58}, .opacity = 0.13, .only_front = true});
  panel.add_tubes(rest.points, rim_edges(rest), 0.0013 * diagonal,
                  {0.66, 0.69, 0.73});
  panel.show(rest.points);
  panel.show(moved.points);
  draw_supports(panel, job, rest, diagonal, layout.text);
  draw_loads(panel, job, moved, diagonal, layout.text);
  const auto [scale, unit] = readable_unit(top, part.stress_unit);
  panel.add_colour_bar(layout.bar, "von Mises stress" + unit,
                       {top * scale, step * scale, clipped}, layout.text);
  return {factor, largest,
          *std::max_element(part.von_mises.begin(), part.von_mises.end())};
}

}  // namespace meniscus::render
