#include "pipeline/walls.h"

#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "io/stl.h"
#include "io/vtk_files.h"

namespace meniscus {

namespace {

constexpr double kFlat = 1e-6;  // of a cone's largest volume

/// The facets of the films named; every point stays.
SurfaceMesh films_of(const SurfaceMesh& all,
                     const std::vector<std::string>& films) {
  SurfaceMesh mesh;
  mesh.points = all.points;
  mesh.labels = films;
  for (std::size_t f = 0; f < all.facets.size(); ++f) {
    const int label = mesh.label_of(all.labels[all.facet_label[f]]);
    if (label >= 0) {
      mesh.facets.push_back(all.facets[f]);
      mesh.facet_label.push_back(label);
    }
  }
  return mesh;
}

/// Turns a film whose normals face the middle of its rim: how a film starts
/// must not decide where its inside is. A flat one stays as its curve runs.
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

Vec3 middle_of_rim(const FilmSystem& system, const std::string& film,
                   const FilmModel& model, const Points& points) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const FilmSpec& spec : system.films) {
    for (const std::string& curve : spec.curves) {
      for (const int v :
           spec.name == film ? model.rim(curve) : std::vector<int>()) {
        sum += points[static_cast<std::size_t>(v)];
        ++count;
      }
    }
  }
  return sum / count;
}

}  // namespace

std::vector<CaseWall> make_walls(const EvaluatedCase& numbers,
                                 const FilmModel& model, const Points& points) {
  const SurfaceMesh all = model.fine_mesh(points);
  std::vector<CaseWall> walls;
  for (const WallSpec& spec : numbers.walls) {
    ThickenOptions options{.thickness = spec.thickness, .side = spec.side};
    for (const Curve& curve : numbers.film_system.curves) {
      options.rims.push_back({curve.name, model.rim(curve.name)});
    }
    SurfaceMesh film = films_of(all, spec.films);
    for (const std::string& name : spec.films) {
      turn_outward(film, film.label_of(name),
                   middle_of_rim(numbers.film_system, name, model, points));
    }
    try {
      walls.push_back({spec.name, thicken(film, options)});
    } catch (const Error& error) {
      throw InvalidInput(fmt::format("walls.{}: {}", spec.name, error.what()));
    }
  }
  return walls;
}

std::string wall_text(const Case& input, const CaseWall& made) {
  const ThickWall& wall = made.wall;
  const std::string& unit = input.units.length;
  const auto measured = [&](const MeasuredThickness& t) {
    return fmt::format("{:.4g} {} of {:.4g} asked at ({:.4g}, {:.4g}, {:.4g})",
                       t.value, unit, t.asked, t.place.x(), t.place.y(),
                       t.place.z());
  };
  return fmt::format(
      "wall {}: {} facets, volume {:.8g} {}\n"
      "  thinnest {}\n  thickest {}\n  largest safe thickness {}\n",
      made.name, wall.surface.facets.size(), wall.volume,
      input.units.unit_of(Dimension::Volume), measured(wall.thinnest),
      measured(wall.thickest),
      wall.safe.limit == WallLimit::None
          ? std::string("not limited by the film")
          : fmt::format("{:.4g} {}: {}", wall.safe.value, unit,
                        wall.safe.message));
}

void write_wall(const Case& input, const CaseWall& made,
                const std::filesystem::path& folder) {
  const std::string name = "wall_" + made.name;
  MeshFields fields;
  fields.notes = {{"title", input.title}, {"length_unit", input.units.length}};
  write_vtp(folder / (name + ".vtp"), made.wall.surface, fields);
  write_stl(folder / (name + ".stl"), made.wall.surface,
            {.name = input.title, .unit = input.units.length});
}

void refuse_walls(const Case& input) {
  if (!input.walls.empty()) {
    const WallEntry& wall = input.walls.front();
    throw InvalidInput(fmt::format(
        "{}: walls.{} cannot be analysed in this version; `meniscus evolve` "
        "settles the film and writes the closed wall (wall_{}.stl) for another "
        "mesher, or take [walls] out to analyse the bodies alone",
        place(input, wall.line), wall.name, wall.name));
  }
}

}  // namespace meniscus
