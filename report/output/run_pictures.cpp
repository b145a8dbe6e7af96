#include "report/output/run_pictures.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "io/vtk_files.h"
#include "pipeline/study/film_frames.h"
#include "report/picture/picture.h"

namespace meniscus::output {

namespace fs = std::filesystem;

namespace {

std::string load_label(const Vec3& force, const std::string& unit) {
  const double size = force.norm();
  return size >= 1e4 && unit == "N" ? fmt::format("{:.4g} kN", size / 1e3)
                                    : fmt::format("{:.4g} {}", size, unit);
}

// Print resolution: 200 mm at 300 dots an inch.
constexpr int kStillWidth = 2400;
constexpr int kStillHeight = 1500;

/// Of the box around all frames: what one camera for all of them must see.
Points corners_of_all(const std::vector<forward::FilmFrame>& frames) {
  Eigen::AlignedBox3d box;
  for (const forward::FilmFrame& frame : frames) {
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

/// What all three have in common; the shapes are the caller's.
picture::PictureJob run_job(const case_data::Case& input,
                            const case_data::EvaluatedCase& numbers) {
  picture::PictureJob job;
  job.title = input.title;
  for (const films::CapSpec& cap : numbers.film_system.caps) {
    job.solids.push_back(cap.name);
  }
  const loads::LoadCase& load_case = numbers.load_cases.front();
  for (const loads::Support& support : load_case.supports) {
    job.supports.push_back(support.surface);
  }
  for (const loads::SpringBed& bed : load_case.springs) {
    job.supports.push_back(bed.surface);
  }
  for (const loads::RemoteLoad& load : load_case.remote_loads) {
    if (load.force.norm() > 0.0) {
      job.loads.push_back({.surface = load.surface,
                           .direction = load.force,
                           .label = load_label(load.force, input.units.force)});
    }
  }
  for (const loads::SurfaceForce& force : load_case.forces) {
    job.loads.push_back({.surface = force.surface,
                         .direction = force.total,
                         .label = load_label(force.total, input.units.force)});
  }
  return job;
}

std::vector<picture::PictureJob> three_of(picture::PictureJob job,
                                          const fs::path& folder) {
  std::vector<picture::PictureJob> jobs;
  const auto add = [&](picture::PictureKind kind, const char* name, int width,
                       int height) {
    job.kind = kind;
    job.output = (folder / name).string();
    job.width = width;
    job.height = height;
    jobs.push_back(job);
  };
  add(picture::PictureKind::Part, "part.png", kStillWidth, kStillHeight);
  add(picture::PictureKind::Film, "film.png", kStillWidth, kStillHeight);
  add(picture::PictureKind::Overview, "overview.png", 2700, 945);
  return jobs;
}

picture::PictureSurface part_surface(const case_data::Case& input,
                                     const forward::EvaluationFields& fields) {
  io::BoundarySurface boundary = io::boundary_surface(fields.mesh);
  const stress::StressField nodal =
      stress::nodal_stress(fields.mesh, fields.stresses.front().recovered);
  const VectorX& u = fields.solution.displacements.front();
  picture::PictureSurface surface;
  surface.mesh = std::move(boundary.mesh);
  surface.length_unit = input.units.length;
  surface.stress_unit = input.units.pressure;
  for (const int node : boundary.nodes) {
    surface.displacement.emplace_back(u.segment<3>(3 * node));
    surface.von_mises.push_back(
        nodal.von_mises[static_cast<std::size_t>(node)]);
  }
  return surface;
}

picture::PictureTets corner_tets(const TetMesh& mesh) {
  picture::PictureTets tets;
  tets.nodes.assign(mesh.nodes.begin(), mesh.nodes.begin() + mesh.corner_count);
  tets.corners.reserve(static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    const std::span<const int> nodes = mesh.element(e);
    tets.corners.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
  }
  return tets;
}

}  // namespace

std::vector<picture::PictureJob> run_pictures(
    const case_data::Case& input, const forward::EvaluationFields& fields,
    const fs::path& folder) {
  picture::PictureJob job = run_job(input, fields.inputs);
  picture::PictureSurface film;
  film.mesh = fields.film;
  job.film.data =
      std::make_shared<const picture::PictureSurface>(std::move(film));
  job.part_surface.data = std::make_shared<const picture::PictureSurface>(
      part_surface(input, fields));
  job.part.data =
      std::make_shared<const picture::PictureTets>(corner_tets(fields.mesh));
  return three_of(std::move(job), folder);
}

std::vector<picture::PictureJob> stored_run_pictures(
    const case_data::Case& input, const case_data::EvaluatedCase& numbers,
    const fs::path& folder) {
  picture::PictureJob job = run_job(input, numbers);
  job.part.file = (folder / "part.vtu").string();
  job.part_surface.file = (folder / "part_surface.vtp").string();
  job.film.file = (folder / "film.vtp").string();
  return three_of(std::move(job), folder);
}

std::vector<std::string> draw_film(const std::string& title,
                                   const std::vector<std::string>& solids,
                                   const std::vector<std::string>& hidden,
                                   const fs::path& folder, Monitor& monitor) {
  picture::PictureJob job;
  job.kind = picture::PictureKind::Film;
  job.hidden = hidden;
  job.film.file = (folder / "film.vtp").string();
  job.output = (folder / "film.png").string();
  job.title = title;
  job.width = kStillWidth;
  job.height = kStillHeight;
  job.solids = solids;
  return picture::render_pictures({job}, {.monitor = &monitor});
}

std::vector<std::string> draw_frames(
    const std::string& title, const std::vector<std::string>& solids,
    const std::vector<forward::FilmFrame>& frames,
    const std::vector<std::string>& captions, const fs::path& folder,
    Monitor& monitor) {
  picture::PictureJob job;
  job.kind = picture::PictureKind::Film;
  job.title = title;
  job.width = kStillWidth;
  job.height = kStillHeight;
  job.solids = solids;
  job.seen = corners_of_all(frames);
  std::vector<picture::PictureJob> jobs;
  jobs.reserve(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const fs::path film =
        folder / "frames" / study::frame_name(frames[k].evaluation);
    job.film.file = film.string();
    job.output = fs::path(film).replace_extension("png").string();
    job.caption = captions[k];
    jobs.push_back(job);
  }
  constexpr double kEach = 20.0;  // [s], a busy machine included
  return picture::render_pictures(
      jobs, {.time_limit = kEach * static_cast<double>(jobs.size()),
             .monitor = &monitor});
}

}  // namespace meniscus::output
