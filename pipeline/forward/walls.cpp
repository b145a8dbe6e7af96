#include "pipeline/forward/walls.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/json.h"
#include "io/stl.h"
#include "io/vtk_files.h"
#include "pipeline/files/place_json.h"
#include "pipeline/forward/fillets.h"

namespace meniscus::forward {

walls::WallModel wall_model(const case_data::EvaluatedCase& inputs,
                            const frozen::FilmModel& model,
                            const Points& points) {
  return walls::WallModel::freeze(model, inputs.film_system, points,
                                  inputs.walls);
}

std::vector<CaseWall> named_walls(const case_data::EvaluatedCase& inputs,
                                  const walls::WallModel& model) {
  std::vector<CaseWall> walls;
  for (const walls::WallSpec& spec : inputs.walls) {
    if (spec.region == static_cast<int>(walls.size())) {
      walls.push_back({spec.name, model.walls()[walls.size()], {}});
    }
  }
  return walls;
}

std::vector<CaseWall> make_walls(const case_data::EvaluatedCase& inputs,
                                 const frozen::FilmModel& model,
                                 const Points& points) {
  if (inputs.walls.empty()) {
    return {};
  }
  const walls::WallModel made =
      walls::WallModel::freeze(model, inputs.film_system, points, inputs.walls,
                               walls::SafePlaces::Everywhere);
  std::vector<CaseWall> walls = named_walls(inputs, made);
  for (CaseWall& wall : walls) {
    for (const walls::WallTrace& trace : wall.wall.trace) {
      wall.safe.push_back(trace.vertex < 0
                              ? std::numeric_limits<double>::infinity()
                              : made.safe()[trace.vertex]);
    }
  }
  return walls;
}

std::string wall_text(const case_data::Case& input, const CaseWall& made) {
  const walls::ThickWall& wall = made.wall;
  const std::string& unit = input.units.length;
  const auto measured = [&](const walls::MeasuredThickness& t) {
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
      wall.safe.limit == walls::WallLimit::None
          ? std::string("not limited by the film")
          : fmt::format("{:.4g} {}: {}", wall.safe.value, unit,
                        wall.safe.message));
}

namespace {

using Json = nlohmann::ordered_json;

Json measured_json(const walls::MeasuredThickness& t) {
  return {{"value", t.value},
          {"asked", t.asked},
          {"place", files::place_json(t.place)}};
}

Json wall_json(const case_data::Case& input, const CaseWall& made) {
  const walls::ThickWall& wall = made.wall;
  Json json = {{"schema_version", 1},
               {"title", input.title},
               {"length_unit", input.units.length},
               {"facets", wall.surface.facets.size()},
               {"volume", wall.volume},
               {"thinnest", measured_json(wall.thinnest)},
               {"thickest", measured_json(wall.thickest)},
               {"safe", nullptr},
               {"findings", summary(wall.findings)}};
  if (wall.safe.limit != walls::WallLimit::None) {
    json["safe"] = {{"value", wall.safe.value},
                    {"asked", wall.safe.asked},
                    {"place", files::place_json(wall.safe.place)},
                    {"message", wall.safe.message}};
  }
  return json;
}

}  // namespace

void write_wall(const case_data::Case& input, const CaseWall& made,
                const std::filesystem::path& folder) {
  const std::string name = "wall_" + made.name;
  io::MeshFields fields;
  fields.notes = {{"title", input.title}, {"length_unit", input.units.length}};
  if (!made.safe.empty()) {
    // Viewers choke on infinity; nothing is thicker than the part is long.
    io::Field safe{.name = "safe_thickness",
                   .unit = input.units.length,
                   .components = 1,
                   .values = made.safe};
    const double most = bounding_diagonal(made.wall.surface.points);
    for (double& value : safe.values) {
      value = std::min(value, most);
    }
    fields.points.push_back(std::move(safe));
  }
  io::write_vtp(folder / (name + ".vtp"), made.wall.surface, fields);
  io::write_stl(folder / (name + ".stl"), made.wall.surface,
                {.name = input.title, .unit = input.units.length});
  write_file(folder / (name + ".json"),
             json_text(wall_json(input, made), 1) + "\n");
}

void refuse_walls(const case_data::Case& input) {
  if (input.walls.empty()) {
    return;
  }
  const case_data::WallEntry& first = input.walls.front();
  for (const case_data::BodyEntry& body : input.bodies) {
    if (body.material != case_data::kVoid) {
      throw InvalidInput(fmt::format(
          "{}: walls.{} stands beside bodies.{}, which is solid; a run "
          "analyses walls or bodies: make the body's material \"void\", so "
          "that it only shapes its films, or take [walls] out",
          case_data::place(input, first.line), first.name, body.name));
    }
  }
  for (const case_data::WallEntry& wall : input.walls) {
    if (wall.material == case_data::kVoid) {
      throw InvalidInput(fmt::format(
          "{}: walls.{} has no material, which a run needs; add material = "
          "\"NAME\" ({}), or look at the wall alone with `meniscus evolve`",
          case_data::place(input, wall.line), wall.name,
          input.materials.empty() ? "and a table [materials.NAME]"
                                  : "of [materials.NAME]"));
    }
  }
  if (input.load_cases.empty() || input.responses.empty()) {
    const bool loads = input.load_cases.empty();
    throw InvalidInput(fmt::format(
        "{}: the case has no [{}.NAME], which a run needs; add one, or look at "
        "the walls alone with `meniscus evolve`",
        input.path, loads ? "load_cases" : "responses"));
  }
}

SurfaceMesh boundary_of(const case_data::EvaluatedCase& inputs,
                        const frozen::FilmModel& model, const Points& points) {
  if (inputs.walls.empty()) {
    return model.boundary(rounded_anew(inputs.film_system, model, points));
  }
  const walls::WallModel walls = wall_model(inputs, model, points);
  return walls.fine(points, walls.numbers(inputs.walls));
}

std::optional<Failure> wall_failure(const case_data::EvaluatedCase& inputs,
                                    const walls::WallModel& model) {
  for (const CaseWall& made : named_walls(inputs, model)) {
    const walls::ThickWall& wall = made.wall;
    if (wall.findings.empty()) {
      continue;
    }
    std::string message = fmt::format("walls.{} cannot be meshed: ", made.name);
    if (wall.safe.limit != walls::WallLimit::None &&
        wall.safe.asked >= wall.safe.value) {
      message += wall.safe.message + ". ";
    }
    message += summary(wall.findings);
    return Failure{FailureKind::SurfaceInvalid, std::move(message)};
  }
  return std::nullopt;
}

}  // namespace meniscus::forward
