#include "app/draw.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "pipeline/film_frames.h"
#include "report/picture.h"

namespace meniscus {

namespace {

std::string load_label(const Vec3& force, const std::string& unit) {
  const double size = force.norm();
  return size >= 1e4 && unit == "N" ? fmt::format("{:g} kN", size / 1e3)
                                    : fmt::format("{:g} {}", size, unit);
}

// Print resolution: 200 mm at 300 dots an inch.
constexpr int kStillWidth = 2400;
constexpr int kStillHeight = 1500;

/// Of the box around all frames: what one camera for all of them must see.
Points corners_of_all(const std::vector<FilmFrame>& frames) {
  Eigen::AlignedBox3d box;
  for (const FilmFrame& frame : frames) {
    for (const Vec3& p : frame.surface.points) {
      box.extend(p);
    }
  }
  Points corners;
  for (int k = 0; k < 8 && !box.isEmpty(); ++k) {
    corners.push_back(
        box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)));
  }
  return corners;
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
  add(PictureKind::Part, "part.png", kStillWidth, kStillHeight);
  add(PictureKind::Film, "film.png", kStillWidth, kStillHeight);
  add(PictureKind::Overview, "overview.png", 2700, 945);
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
  job.width = kStillWidth;
  job.height = kStillHeight;
  job.solids = solids;
  return render_pictures({job}, {.monitor = &monitor});
}

std::vector<std::string> draw_frames(const std::string& title,
                                     const std::vector<std::string>& solids,
                                     const std::vector<FilmFrame>& frames,
                                     const std::vector<std::string>& captions,
                                     const std::filesystem::path& folder,
                                     Monitor& monitor) {
  PictureJob job;
  job.kind = PictureKind::Film;
  job.title = title;
  job.width = kStillWidth;
  job.height = kStillHeight;
  job.solids = solids;
  job.seen = corners_of_all(frames);
  std::vector<PictureJob> jobs;
  jobs.reserve(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::filesystem::path film =
        folder / "frames" / frame_name(frames[k].evaluation);
    job.film = film.string();
    job.output = std::filesystem::path(film).replace_extension("png").string();
    job.caption = captions[k];
    jobs.push_back(job);
  }
  constexpr double kEach = 20.0;  // [s], a busy machine included
  return render_pictures(
      jobs, {.time_limit = kEach * static_cast<double>(jobs.size()),
             .monitor = &monitor});
}

}  // namespace meniscus
