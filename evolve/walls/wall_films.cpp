#include "evolve/walls/wall_films.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"
#include "evolve/films/shared_sides.h"
#include "evolve/walls/flush_ends.h"
#include "evolve/walls/rim_shape.h"
#include "evolve/walls/wall_reference.h"

namespace meniscus::walls {

namespace {

constexpr double kFlat = 1e-6;  // of a cone's largest volume

void turn_outward(SurfaceMesh& mesh, int label, const Vec3& middle) {
  double volume = 0.0;  // six times that of the cones to the middle
  double size = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      const Triangle& t = mesh.facets[f];
      const Vec3 a = mesh.points[t[0]] - middle;
      const Vec3 b = mesh.points[t[1]] - middle;
      const Vec3 c = mesh.points[t[2]] - middle;
      volume += a.dot(b.cross(c));
      size += a.norm() * (b - a).cross(c - a).norm();
    }
  }
  if (volume < -kFlat * size) {
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      if (mesh.facet_label[f] == label) {
        std::swap(mesh.facets[f][1], mesh.facets[f][2]);
      }
    }
  }
}

Vec3 middle_of_rim(const films::FilmSystem& system, const std::string& film,
                   const frozen::FilmModel& model, const Points& points) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const films::FilmSpec& spec : system.films) {
    for (const std::string& curve : spec.curves) {
      for (const int v :
           spec.name == film ? model.rim(curve) : std::vector<int>()) {
        sum += points[static_cast<std::size_t>(v)];
        ++count;
      }
    }
  }
  if (count > 0) {
    return sum / count;
  }
  // Its curves are free: where its facets end.
  std::map<Edge, int> facets;
  const SurfaceMesh all = model.meshed_facets();
  for (std::size_t f = 0; f < all.facets.size(); ++f) {
    const Triangle& t = all.facets[f];
    for (int k = 0; k < 3 && all.labels[all.facet_label[f]] == film; ++k) {
      ++facets[edge_key(t[k], t[(k + 1) % 3])];
    }
  }
  for (const auto& [edge, uses] : facets) {
    if (uses == 1) {
      sum += points[static_cast<std::size_t>(edge[0])] +
             points[static_cast<std::size_t>(edge[1])];
      count += 2;
    }
  }
  return sum / std::max(count, 1);
}

WallPlanes planes_of(const frozen::FilmModel& model,
                     const films::FilmSystem& system) {
  frozen::SlidingPlanes sliding = model.sliding_planes();
  WallPlanes result;
  for (const frozen::SlidingPlanes::Plane& plane : sliding.planes) {
    const auto cap = std::find_if(
        system.caps.begin(), system.caps.end(),
        [&](const films::CapSpec& c) { return c.name == plane.face; });
    result.planes.push_back(
        {plane.normal,
         cap == system.caps.end() || !cap->wall ? plane.face : cap->wall->rim});
  }
  if (!result.planes.empty()) {
    result.at = std::move(sliding.at);
  }
  return result;
}

/// Per wall that at the first of its points.
std::vector<double> usual_thicknesses(const WallFilms& films,
                                      const std::vector<WallSpec>& walls) {
  std::vector<int> first(walls.size(), -1);
  for (std::size_t f = 0; f < films.mesh.facets.size(); ++f) {
    int& point = first[films.wall[films.mesh.facet_label[f]]];
    const Triangle& t = films.mesh.facets[f];
    const int least = *std::min_element(t.begin(), t.end());
    point = point < 0 ? least : std::min(point, least);
  }
  std::vector<double> result;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Vec3& at = films.mesh.points[std::max(first[w], 0)];
    result.push_back(thickness_at(walls[w], walls[w].thickness.own(), at));
  }
  return result;
}

using SideName = std::pair<int, int>;  // curve, side

/// The first curve's side that each of the others is.
std::map<SideName, SideName> first_sides(
    const std::vector<curves::Curve>& curves) {
  std::map<SideName, SideName> first;
  for (const films::SharedSide& side : films::shared_sides(curves)) {
    const SideName known(side.first_curve, side.first_side);
    const auto at = first.find(known);
    first.emplace(SideName(side.second_curve, side.second_side),
                  at == first.end() ? known : at->second);
  }
  return first;
}

/// A vertex belongs to one curve, a side to all that have it.
std::vector<RimName> rim_names(const frozen::FilmModel& model,
                               const films::FilmSystem& system,
                               const Points& points) {
  constexpr double kAtCorner = 1e-9;  // of a side, and of the size of all
  const double reach = kAtCorner * bounding_diagonal(points);
  const std::map<SideName, SideName> first = first_sides(system.curves);
  const auto known = [&](const SideName& side) {
    const auto at = first.find(side);
    return at == first.end() ? side : at->second;
  };
  std::map<SideName, std::vector<int>> between;
  std::vector<int> corners;
  std::vector<std::vector<films::CurveSide>> sides;
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    const curves::Curve& curve = system.curves[c];
    sides.push_back(films::sides_of(curve.shape));
    const auto count = static_cast<double>(sides.back().size());
    const std::vector<int> vertices = model.rim(curve.name);
    const std::vector<double> t = model.rim_parameters(curve.name);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const double at = count * t[k];
      if (count > 0.0 && std::abs(at - std::round(at)) < kAtCorner) {
        corners.push_back(vertices[k]);
      } else {
        between[known({static_cast<int>(c), static_cast<int>(at)})].push_back(
            vertices[k]);
      }
    }
  }
  std::vector<RimName> names;
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    RimName name{.curve = system.curves[c].name, .holds = false};
    for (const films::FilmSpec& film : system.films) {
      if (std::find(film.curves.begin(), film.curves.end(), name.curve) !=
          film.curves.end()) {
        name.films.push_back(film.name);
      }
    }
    const auto caps = system.caps;
    name.holds =
        !name.films.empty() ||
        std::any_of(caps.begin(), caps.end(), [&](const auto& cap) {
          const std::vector<std::string> held = cap.curves();
          return std::find(held.begin(), held.end(), name.curve) != held.end();
        });
    for (std::size_t k = 0; k < std::max<std::size_t>(sides[c].size(), 1);
         ++k) {
      RimName side = name;
      side.vertices =
          between[known({static_cast<int>(c), static_cast<int>(k)})];
      for (const int v : corners) {
        const Vec3& x = points[static_cast<std::size_t>(v)];
        if (k < sides[c].size() && ((x - sides[c][k].from).norm() <= reach ||
                                    (x - sides[c][k].to).norm() <= reach)) {
          side.vertices.push_back(v);
        }
      }
      std::sort(side.vertices.begin(), side.vertices.end());
      names.push_back(std::move(side));
    }
  }
  return names;
}

}  // namespace

WallFilms wall_films(const frozen::FilmModel& model,
                     const films::FilmSystem& system, const Points& points,
                     const std::vector<WallSpec>& walls) {
  const SurfaceMesh all = model.meshed_facets();
  WallFilms films;
  films.middles = model.middles();
  films.levels = model.refinements();
  SurfaceMesh& mesh = films.mesh;
  mesh.points = points;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const auto add = [&](const std::string& film) {
      mesh.labels.push_back(film);
      films.wall.push_back(static_cast<int>(w));
    };
    for (const std::string& film : walls[w].films) {
      add(film);
      for (const settle::PulledFilm& popped : model.reference().report.popped) {
        if (popped.pulled_from == film) {
          add(popped.name);
        }
      }
    }
    films.region.push_back(walls[w].region);
  }
  for (std::size_t f = 0; f < all.facets.size(); ++f) {
    const int label = mesh.label_of(all.labels[all.facet_label[f]]);
    if (label >= 0) {
      mesh.facets.push_back(all.facets[f]);
      mesh.facet_label.push_back(label);
    }
  }
  for (std::size_t label = 0; label < mesh.labels.size(); ++label) {
    turn_outward(mesh, static_cast<int>(label),
                 middle_of_rim(system, mesh.labels[label], model, points));
  }
  for (const curves::Curve& curve : system.curves) {
    films.rims.push_back(
        {curve.name, model.rim(curve.name), model.rim_parameters(curve.name)});
  }
  films.names = rim_names(model, system, points);
  films.planes = planes_of(model, system);
  add_flush_planes(system.curves, walls, films);
  films.asked =
      usual_thicknesses(films, on_films(walls, mesh, films.wall, films.rims));
  return films;
}

}  // namespace meniscus::walls
