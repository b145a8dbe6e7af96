#include "evolve/frozen/line_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"

namespace meniscus::frozen {

namespace {

constexpr std::size_t kLine = 3;  // films that meet

/// The root of an area, and the middle.
std::pair<double, Vec3> size_of(const std::vector<Triangle>& facets,
                                const Points& points) {
  double area = 0.0;
  Vec3 middle = Vec3::Zero();
  for (const auto& [a, b, c] : facets) {
    const double own =
        0.5 * (points[b] - points[a]).cross(points[c] - points[a]).norm();
    area += own;
    middle += own / 3.0 * (points[a] + points[b] + points[c]);
  }
  return {std::sqrt(area), area > 0.0 ? Vec3(middle / area) : Vec3::Zero()};
}

}  // namespace

LineGaps::LineGaps(const films::FilmComplex& reference) {
  const SurfaceMesh& mesh = reference.mesh;
  std::map<Edge, std::vector<int>> around;  // liquid labels, ascending
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const int label = mesh.facet_label[f];
    if (reference.surfaces[label].liquid) {
      const Triangle& t = mesh.facets[f];
      for (int k = 0; k < 3; ++k) {
        around[edge_key(t[k], t[(k + 1) % 3])].push_back(label);
      }
    }
  }
  // A line is what the same films meet along; a rim, where a film ends alone.
  std::map<std::vector<int>, std::vector<Edge>> lines;
  for (auto& [edge, labels] : around) {
    std::sort(labels.begin(), labels.end());
    if (labels.size() != 2) {
      lines[labels].push_back(edge);
    }
  }
  std::map<int, int> uses;  // lines that have a vertex
  std::map<std::vector<int>, std::set<int>> vertices;
  for (const auto& [labels, edges] : lines) {
    std::set<int>& own = vertices[labels];
    for (const Edge& edge : edges) {
      own.insert(edge.begin(), edge.end());
    }
    for (const int v : own) {
      ++uses[v];
    }
  }
  for (std::size_t s = 0; s < reference.surfaces.size(); ++s) {
    Film film{.name = reference.surfaces[s].name};
    for (const auto& [labels, own] : vertices) {
      if (std::count(labels.begin(), labels.end(), static_cast<int>(s)) == 0) {
        continue;
      }
      Line line{.moves = labels.size() >= kLine};
      std::copy_if(own.begin(), own.end(), std::back_inserter(line.vertices),
                   [&](int v) { return uses[v] == 1; });
      film.lines.push_back(std::move(line));
    }
    if (std::none_of(film.lines.begin(), film.lines.end(),
                     [](const Line& line) { return line.moves; })) {
      continue;
    }
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (mesh.facet_label[f] == static_cast<int>(s)) {
        film.facets.push_back(mesh.facets[f]);
      }
    }
    for (std::size_t l = 0; l < film.lines.size(); ++l) {
      for (const int v : film.lines[l].vertices) {
        if (film.lines[l].moves) {
          film.usual.push_back(nearest(film, l, v, mesh.points).distance);
        }
      }
    }
    film.usual_size = size_of(film.facets, mesh.points).first;
    films_.push_back(std::move(film));
  }
}

LineGaps::Nearest LineGaps::nearest(const Film& film, std::size_t line,
                                    int vertex, const Points& points) {
  Nearest found{std::numeric_limits<double>::infinity(), -1, false};
  for (std::size_t other = 0; other < film.lines.size(); ++other) {
    for (const int w :
         other == line ? std::vector<int>() : film.lines[other].vertices) {
      const double distance = (points[w] - points[vertex]).norm();
      if (distance < found.distance) {
        found = {distance, w, film.lines[other].moves};
      }
    }
  }
  return found;
}

NarrowFilm LineGaps::narrowest(const Points& points) const {
  NarrowFilm least{.ratio = std::numeric_limits<double>::infinity()};
  for (const Film& film : films_) {
    const auto [size, middle] = size_of(film.facets, points);
    if (size / film.usual_size < least.ratio) {
      least = {.how = NarrowFilm::How::Whole,
               .ratio = size / film.usual_size,
               .width = size,
               .usual = film.usual_size,
               .place = middle,
               .film = film.name};
    }
    std::size_t next = 0;
    for (std::size_t l = 0; l < film.lines.size(); ++l) {
      for (const int v :
           film.lines[l].moves ? film.lines[l].vertices : std::vector<int>()) {
        const double usual = film.usual[next++];
        const Nearest at = nearest(film, l, v, points);
        if (at.vertex >= 0 && at.distance / usual < least.ratio) {
          least = {.how = at.moves ? NarrowFilm::How::BetweenLines
                                   : NarrowFilm::How::AtItsRim,
                   .ratio = at.distance / usual,
                   .width = at.distance,
                   .usual = usual,
                   .place = 0.5 * (points[v] + points[at.vertex]),
                   .film = film.name};
        }
      }
    }
  }
  return least;
}

}  // namespace meniscus::frozen
