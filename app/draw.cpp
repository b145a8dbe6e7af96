#include "app/draw.h"

#include <fmt/format.h>

#include "report/picture.h"

namespace meniscus {

namespace {

std::string load_label(const Vec3& force, const std::string& unit) {
  const double size = force.norm();
  return size >= 1e4 && unit == "N" ? fmt::format("{:g} kN", size / 1e3)
                                    : fmt::format("{:g} {}", size, unit);
}

}  // namespace

std::vector<std::string> draw(const Case& input, const EvaluationFields& fields,
                              const std::filesystem::path& folder,
                              Monitor& monitor) {
  PictureJob job;
  job.part = (folder / "part.vtu").string();
  job.part_surface = (folder / "part_surface.vtp").string();
  job.film = (folder / "film.vtp").string();
  job.title = input.title;
  for (const CapSpec& cap : fields.inputs.film_system.caps) {
    job.solids.push_back(cap.name);
  }
  const LoadCase& load_case = fields.inputs.load_cases.front();
  for (const Support& support : load_case.supports) {
    job.supports.push_back(support.surface);
  }
  for (const SpringBed& bed : load_case.springs) {
    job.supports.push_back(bed.surface);
  }
  for (const RemoteLoad& load : load_case.remote_loads) {
    if (load.force.norm() > 0.0) {
      job.loads.push_back({.surface = load.surface,
                           .direction = load.force,
                           .label = load_label(load.force, input.units.force)});
    }
  }
  for (const SurfaceForce& force : load_case.forces) {
    job.loads.push_back({.surface = force.surface,
                         .direction = force.total,
                         .label = load_label(force.total, input.units.force)});
  }
  std::vector<PictureJob> jobs;
  const auto add = [&](PictureKind kind, const char* name, int width,
                       int height) {
    job.kind = kind;
    job.output = (folder / name).string();
    job.width = width;
    job.height = height;
    jobs.push_back(job);
  };
  add(PictureKind::Part, "part.png", 1600, 1000);
  add(PictureKind::Film, "film.png", 1600, 1000);
  add(PictureKind::Overview, "overview.png", 2000, 700);
  return render_pictures(jobs, {.monitor = &monitor});
}

std::vector<std::string> draw_film(const std::string& title,
                                   const std::vector<std::string>& solids,
                                   const std::filesystem::path& folder,
                                   Monitor& monitor) {
  PictureJob job;
  job.kind = PictureKind::Film;
  job.film = (folder / "film.vtp").string();
  job.output = (folder / "film.png").string();
  job.title = title;
  job.solids = solids;
  return render_pictures({job}, {.monitor = &monitor});
}

}  // namespace meniscus
