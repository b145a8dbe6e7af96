#include "evolve/walls/thicken.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/walls/wall_offset.h"

namespace meniscus::walls {

namespace {

// Rim strips get rows of about square cells, at most so many.
constexpr int kMostRows = 64;

std::string at_vertex(const Sheet& sheet, int v) {
  const Vec3& p = sheet.film.points[v];
  return fmt::format("at vertex {} of the film, ({:.6g}, {:.6g}, {:.6g})",
                     sheet.origin[v], p.x(), p.y(), p.z());
}

void check_options(const SurfaceMesh& film, const ThickenOptions& options) {
  for (const int name : options.thickness.names_used()) {
    if (name > 2) {
      throw InvalidInput(fmt::format(
          "wall: the thickness \"{}\" uses names other than x, y and z",
          options.thickness.text()));
    }
  }
  if (!(options.accuracy > 0.0) || !std::isfinite(options.accuracy)) {
    throw InvalidInput(
        fmt::format("wall: accuracy = {}, must be above 0", options.accuracy));
  }
  if (options.max_corrections < 0) {
    throw InvalidInput(
        fmt::format("wall: max_corrections = {}, must be at least 0",
                    options.max_corrections));
  }
  for (const WallRim& rim : options.rims) {
    for (const int v : rim.vertices) {
      if (v < 0 || v >= static_cast<int>(film.points.size())) {
        throw InvalidInput(
            fmt::format("wall: rim \"{}\" names vertex {}, but the film has {}",
                        rim.name, v, film.points.size()));
      }
    }
  }
  for (const std::string& label : film.labels) {
    if (film.label_of(label + "/back") >= 0) {
      throw InvalidInput(fmt::format(
          "wall: a film is called \"{}/back\", which names the back of \"{}\"; "
          "call it otherwise",
          label, label));
    }
  }
}

std::vector<double> asked_thickness(const Sheet& sheet,
                                    const Expression& thickness) {
  std::vector<double> asked;
  asked.reserve(sheet.film.points.size());
  for (int v = 0; v < static_cast<int>(sheet.film.points.size()); ++v) {
    const Vec3& p = sheet.film.points[v];
    const std::array<double, 3> values = {p.x(), p.y(), p.z()};
    double t = 0.0;
    try {
      t = thickness.evaluate(values);
    } catch (const ExpressionError& error) {
      throw InvalidInput(fmt::format("wall: thickness \"{}\" {}: {}",
                                     thickness.text(), at_vertex(sheet, v),
                                     error.what()));
    }
    if (!(t > 0.0) || !std::isfinite(t)) {
      throw InvalidInput(fmt::format(
          "wall: thickness \"{}\" is {} {}; it must be above 0 and finite on "
          "the whole film",
          thickness.text(), t, at_vertex(sheet, v)));
    }
    asked.push_back(t);
  }
  return asked;
}

/// A closed rim: edges a -> b as its facets run.
struct RimLoop {
  std::vector<int> vertices;  // from the lowest on
  std::vector<int> facets;    // of the edge from each vertex to the next
};

std::vector<RimLoop> rim_loops(const Sheet& sheet) {
  const std::size_t points = sheet.film.points.size();
  std::vector<int> next(points, -1);
  std::vector<int> facet(points, -1);
  for (std::size_t e = 0; e < sheet.edges.size(); ++e) {
    const auto& [f, g] = sheet.edge_facets[e];
    if (g >= 0) {
      continue;
    }
    auto [a, b] = sheet.edges[e];
    const Triangle& t = sheet.film.facets[f];
    for (int k = 0; k < 3; ++k) {
      if (t[k] == b && t[(k + 1) % 3] == a) {
        std::swap(a, b);
        break;
      }
    }
    next[a] = b;
    facet[a] = f;
  }
  std::vector<RimLoop> loops;
  for (std::size_t v = 0; v < points; ++v) {
    if (next[v] < 0) {
      continue;
    }
    RimLoop& loop = loops.emplace_back();
    for (int a = static_cast<int>(v); next[a] >= 0;) {
      loop.vertices.push_back(a);
      loop.facets.push_back(facet[a]);
      const int b = next[a];
      next[a] = -1;
      a = b;
    }
  }
  return loops;
}

/// Puts front, back and rims together.
class Assembly {
 public:
  Assembly(const Sheet& sheet, const SurfaceMesh& film,
           const ThickenOptions& options)
      : sheet_(sheet), options_(options) {
    curves_.assign(film.points.size(), {});
    for (std::size_t r = 0; r < options.rims.size(); ++r) {
      for (const int v : options.rims[r].vertices) {
        curves_[v].push_back(static_cast<int>(r));
      }
    }
  }

  void add_sides(const OffsetSides& sides) {
    const SurfaceMesh& film = sheet_.film;
    count_ = static_cast<int>(film.points.size());
    surface_.points = sides.front;
    surface_.points.insert(surface_.points.end(), sides.back.begin(),
                           sides.back.end());
    for (const double across : {1.0, 0.0}) {
      for (int v = 0; v < count_; ++v) {
        trace_.push_back({sheet_.origin[v], across});
      }
    }
    const auto labels = static_cast<int>(film.labels.size());
    surface_.labels = film.labels;
    for (const std::string& label : film.labels) {
      surface_.labels.push_back(label + "/back");
    }
    surface_.facets = film.facets;
    surface_.facet_label = film.facet_label;
    for (std::size_t f = 0; f < film.facets.size(); ++f) {
      const auto& [a, b, c] = film.facets[f];
      add({a + count_, c + count_, b + count_}, film.facet_label[f] + labels);
    }
  }

  void add_rim(const RimLoop& loop, const std::vector<double>& asked) {
    const int rows = rows_of(loop, asked);
    std::vector<int> column;  // point ids, row by row, of each loop vertex
    for (const int v : loop.vertices) {
      column.push_back(v);
      for (int j = 1; j < rows; ++j) {
        const double across = 1.0 - static_cast<double>(j) / rows;
        column.push_back(static_cast<int>(surface_.points.size()));
        surface_.points.push_back(across * surface_.points[v] +
                                  (1.0 - across) * surface_.points[v + count_]);
        trace_.push_back({sheet_.origin[v], across});
      }
      column.push_back(v + count_);
    }
    const auto length = static_cast<int>(loop.vertices.size());
    bool unnamed = false;
    for (int i = 0; i < length; ++i) {
      const int after = (i + 1) % length;
      const int label = label_of(loop.vertices[i], loop.vertices[after],
                                 loop.facets[i], unnamed);
      for (int j = 0; j < rows; ++j) {
        const int* here = &column[i * (rows + 1) + j];
        const int* there = &column[after * (rows + 1) + j];
        add_cell(there[0], here[0], here[1], there[1], label);
      }
    }
    unnamed_ += unnamed ? 1 : 0;
  }

  void finish(ThickWall& wall) {
    wall.surface = std::move(surface_);
    wall.trace = std::move(trace_);
  }

 private:
  int rows_of(const RimLoop& loop, const std::vector<double>& asked) const {
    double thickness = 0.0;
    double length = 0.0;
    const Points& x = sheet_.film.points;
    for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
      const int a = loop.vertices[i];
      const int b = loop.vertices[(i + 1) % loop.vertices.size()];
      thickness += asked[a];
      length += (x[b] - x[a]).norm();
    }
    const double rows = std::round(thickness / length);
    return static_cast<int>(
        std::clamp(rows, 1.0, static_cast<double>(kMostRows)));
  }

  int label_of(int a, int b, int facet, bool& unnamed) {
    std::string curve;
    const std::vector<int>& there = curves_[sheet_.origin[b]];
    for (const int r : curves_[sheet_.origin[a]]) {
      if (std::find(there.begin(), there.end(), r) != there.end()) {
        curve = options_.rims[r].name;
        break;
      }
    }
    if (curve.empty()) {
      unnamed = true;
      curve = std::to_string(unnamed_ + 1);
    }
    const std::string& film =
        sheet_.film.labels[sheet_.film.facet_label[facet]];
    const std::string name = film + "/rim:" + curve;
    const int known = surface_.label_of(name);
    if (known >= 0) {
      return known;
    }
    surface_.labels.push_back(name);
    return static_cast<int>(surface_.labels.size()) - 1;
  }

  void add(const Triangle& facet, int label) {
    surface_.facets.push_back(facet);
    surface_.facet_label.push_back(label);
  }

  // A quadrilateral cut along its shorter diagonal.
  void add_cell(int a, int b, int c, int d, int label) {
    const Points& x = surface_.points;
    if ((x[a] - x[c]).squaredNorm() <= (x[b] - x[d]).squaredNorm()) {
      add({a, b, c}, label);
      add({a, c, d}, label);
    } else {
      add({a, b, d}, label);
      add({b, c, d}, label);
    }
  }

  const Sheet& sheet_;
  const ThickenOptions& options_;
  std::vector<std::vector<int>> curves_;  // per film point: rims it lies on
  SurfaceMesh surface_;
  std::vector<WallTrace> trace_;
  int count_ = 0;    // of the sheet's points
  int unnamed_ = 0;  // rims so far
};

}  // namespace

ThickWall thicken(const SurfaceMesh& film, const ThickenOptions& options) {
  check_options(film, options);
  const Sheet sheet = make_sheet(film);
  const std::vector<double> asked = asked_thickness(sheet, options.thickness);
  const std::vector<Jet> jets = fit_jets(sheet);
  const OffsetSides sides = offset_sides(
      sheet, offset_directions(sheet, jets, asked), asked, options);
  Assembly assembly(sheet, film, options);
  assembly.add_sides(sides);
  for (const RimLoop& loop : rim_loops(sheet)) {
    assembly.add_rim(loop, asked);
  }
  ThickWall wall;
  assembly.finish(wall);
  wall.volume = enclosed_volume(wall.surface);
  wall.thinnest = sides.thinnest;
  wall.thickest = sides.thickest;
  wall.corrections = sides.corrections;
  wall.safe = safe_thickness(sheet, jets, asked, options.side);
  wall.findings = check_surface(wall.surface);
  return wall;
}

}  // namespace meniscus::walls
