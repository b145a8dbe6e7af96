#include "pipeline/step_parts/wall_step.h"

#include <algorithm>
#include <iterator>

#include "cad/step/step_writer.h"
#include "pipeline/step_parts/step_figures.h"

namespace meniscus::step_parts {

namespace {

/// What lies across the thickness (evolve/walls/thicken.h).
bool is_strip(const std::string& label) {
  return label.find("/rim:") != std::string::npos;
}

}  // namespace

SurfaceMesh with_ends(const walls::ThickWall& wall) {
  SurfaceMesh mesh = wall.surface;
  for (std::size_t f = 0; f < wall.cap.size(); ++f) {
    if (wall.cap[f] == 0) {
      continue;
    }
    const std::string end = mesh.labels[mesh.facet_label[f]] + kLineEnd;
    if (mesh.label_of(end) < 0) {
      mesh.labels.push_back(end);
    }
    mesh.facet_label[f] = mesh.label_of(end);
  }
  return mesh;
}

solid::FilmSolid wall_solid(const SurfaceMesh& surface, double edge) {
  solid::FilmSolidInput input{surface, {}, {}, {}, edge};
  std::copy_if(surface.labels.begin(), surface.labels.end(),
               std::back_inserter(input.sharp), is_strip);
  return solid::film_solid(input);
}

void export_walls(const std::filesystem::path& file,
                  const std::vector<WallBody>& walls,
                  const StepExport& options) {
  std::vector<step::StepPart> parts;
  std::vector<solid::FilmSolidReport> reports;
  for (const WallBody& wall : walls) {
    solid::FilmSolid made =
        options.faceted
            ? solid::FilmSolid{solid::faceted_solid(wall.surface), {}}
            : wall_solid(wall.surface, options.edge);
    reports.push_back(std::move(made.report));
    parts.push_back({walls.size() > 1 ? wall.name : options.title,
                     whole_solid(std::move(made.brep), options)});
  }
  const step::StepReport report =
      step::write_step(file, parts,
                       {.name = options.title,
                        .unit = options.unit,
                        .monitor = options.monitor});
  if (!options.faceted) {
    tell_step(options, summed(reports), "", parts.size(), report);
  }
}

}  // namespace meniscus::step_parts
