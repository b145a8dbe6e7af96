#include "report/output/run_pictures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "io/vtk_files.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/stress_figures.h"
#include "pipeline/frames/film_frames.h"
#include "pipeline/shells/shell_body.h"
#include "pipeline/whole/whole_part.h"
#include "report/picture/renderer.h"

namespace meniscus::output {

namespace fs = std::filesystem;

namespace {

std::string load_label(double size, const std::string& unit) {
  return size >= 1e4 && unit == "N" ? fmt::format("{:.4g} kN", size / 1e3)
                                    : fmt::format("{:.4g} {}", size, unit);
}

/// "12 kN m" of 1.2e7 N mm.
std::string moment_label(double size, const UnitSystem& units) {
  if (units.name == "mm-N-MPa") {
    return size >= 1e6 ? fmt::format("{:.4g} kN m", size / 1e6)
                       : fmt::format("{:.4g} N m", size / 1e3);
  }
  return fmt::format("{:.4g} {}", size, units.unit_of(Dimension::Energy));
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

std::string support_label(const loads::Support& support) {
  if (support.kind == loads::SupportKind::Normal) {
    return "slides";
  }
  if (support.kind == loads::SupportKind::Symmetry) {
    return "symmetry";
  }
  std::string label = "held ";
  label += support.fix_x ? "x" : "";
  label += support.fix_y ? "y" : "";
  label += support.fix_z ? "z" : "";
  return label;
}

std::string pin_label(const loads::RigidPin& pin) {
  std::string held;
  std::string turns;
  for (std::size_t k = 0; k < 3; ++k) {
    held += pin.fix[k] ? std::string(1, "xyz"[k]) : "";
    turns += pin.fix_rotation[k] ? std::string(1, "xyz"[k]) : "";
  }
  std::string label = "rigid";
  label += held.empty() ? "" : ", held " + held;
  label += turns.empty() ? "" : ", no turn about " + turns;
  return label;
}

void add_supports(const case_data::Case& input,
                  const loads::LoadCase& load_case, picture::PictureJob& job) {
  const std::vector<std::string> cut = case_data::cut_faces(input);
  for (const loads::Support& support : load_case.supports) {
    if (std::ranges::find(cut, support.surface) != cut.end()) {
      continue;  // within the whole
    }
    if (support.at) {
      continue;  // too small to draw: told in words
    }
    job.supports.push_back(support.surface);
    job.support_labels.push_back(support_label(support));
  }
  for (const loads::RigidPin& pin : load_case.pins) {
    for (const std::string& surface : pin.surfaces) {
      job.supports.push_back(surface);
      job.support_labels.push_back(pin_label(pin));
    }
  }
  for (const loads::SpringBed& bed : load_case.springs) {
    job.supports.push_back(bed.surface);
    job.support_labels.emplace_back("on springs");
  }
}

void add_forces(const loads::LoadCase& load_case, const UnitSystem& units,
                picture::PictureJob& job) {
  using Kind = picture::PictureLoadKind;
  const auto add = [&](const loads::Surfaces& surfaces, const Vec3& direction,
                       Kind kind, const std::string& label,
                       const std::optional<Vec3>& point = {}) {
    if (direction.norm() > 0.0) {
      job.loads.push_back({surfaces, direction, label, kind, point});
    }
  };
  for (const loads::RemoteLoad& load : load_case.remote_loads) {
    add(load.surfaces, load.force, Kind::Force,
        load_label(load.force.norm(), units.force), load.point);
    add(load.surfaces, load.moment, Kind::Moment,
        moment_label(load.moment.norm(), units), load.point);
  }
  for (const loads::BearingLoad& load : load_case.bearings) {
    add(load.surfaces, load.force, Kind::Force,
        load_label(load.force.norm(), units.force), load.point);
  }
  for (const loads::SurfaceForce& force : load_case.forces) {
    add(force.surfaces, force.total, Kind::Force,
        load_label(force.total.norm(), units.force));
  }
  // Of fields the arrows say where, the label that it changes.
  const std::string varies = "pressure that varies";
  for (const loads::SurfacePressure& p : load_case.pressures) {
    const double sign = p.field ? 1.0 : p.pressure;
    add(p.surface, Vec3(sign, 0, 0), Kind::Pressure,
        p.field ? varies : load_label(std::abs(sign), units.pressure));
  }
  for (const loads::SurfaceTraction& t : load_case.tractions) {
    if (!t.field) {
      add(t.surface, t.traction, Kind::Traction,
          load_label(t.traction.norm(), units.pressure));
    }
  }
}

/// What acts on the whole part, or has no surface to draw it on: gravity as an
/// arrow, the rest in words.
void add_body_loads(const loads::LoadCase& load_case,
                    picture::PictureJob& job) {
  if (load_case.gravity.norm() > 0.0) {
    job.loads.push_back(
        {{}, load_case.gravity, "gravity", picture::PictureLoadKind::Body});
  }
  const bool at_points =
      std::any_of(load_case.supports.begin(), load_case.supports.end(),
                  [](const loads::Support& s) { return s.at.has_value(); });
  const bool varied = std::any_of(
      load_case.tractions.begin(), load_case.tractions.end(),
      [](const loads::SurfaceTraction& t) { return bool(t.field); });
  for (const auto& [acts, what] :
       {std::pair(at_points, ", held at points"),
        std::pair(load_case.spin.has_value(), ", it spins"),
        std::pair(load_case.temperature.has_value(), ", it is heated"),
        std::pair(varied, ", a traction that varies"),
        std::pair(!load_case.rim_tensions.empty(),
                  ", rims pulled or pressed")}) {
    job.load_case += acts ? what : "";
  }
}

/// What all have in common; the shapes are the caller's.
picture::PictureJob run_job(const case_data::Case& input) {
  picture::PictureJob job;
  job.title = input.title;
  job.length_unit = input.units.length;
  job.solids = case_data::solids_of_whole(input);
  return job;
}

/// `remark`: on the load case's name.
picture::PictureJob of_load_case(picture::PictureJob job,
                                 const case_data::Case& input,
                                 const loads::LoadCase& load_case,
                                 const std::string& remark) {
  const bool from_any = std::ranges::any_of(
      input.directions, [&](const case_data::DirectionsEntry& load) {
        return load.name == load_case.name;
      });
  job.load_case =
      fmt::format("'{}'{}{}", load_case.name,
                  from_any ? ", from its worst direction" : "", remark);
  add_supports(input, load_case, job);
  add_forces(load_case, input.units, job);
  add_body_loads(load_case, job);
  return job;
}

void add_job(picture::PictureJob job, picture::PictureKind kind,
             const fs::path& file, std::vector<picture::PictureJob>& jobs) {
  const bool overview = kind == picture::PictureKind::Overview;
  job.kind = kind;
  job.output = file.string();
  job.width = overview ? 2700 : kStillWidth;
  job.height = overview ? 945 : kStillHeight;
  jobs.push_back(std::move(job));
}

/// Without the unit loads of loads from any direction that another shows.
std::vector<std::size_t> shown_cases(const case_data::Case& input,
                                     const case_data::EvaluatedCase& numbers) {
  const bool with_worst = numbers.load_cases.size() > input.load_cases.size();
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < numbers.load_cases.size(); ++k) {
    if (!with_worst ||
        case_data::directions_with(input, k) == input.directions.end()) {
      shown.push_back(k);
    }
  }
  return shown;
}

/// part.png, film.png and overview.png of the worst load case and, `with_each`,
/// a part_NAME.png of each where there are several. `shape(k)`: the part under
/// load case k.
template <class Shape>
std::vector<picture::PictureJob> all_pictures(
    const picture::PictureJob& common, const case_data::Case& input,
    const case_data::EvaluatedCase& numbers, std::size_t worst, bool with_each,
    const fs::path& folder, const Shape& shape) {
  using Kind = picture::PictureKind;
  std::vector<picture::PictureJob> jobs;
  const std::vector<std::size_t> shown = shown_cases(input, numbers);
  const bool several = with_each && shown.size() > 1;
  const std::string remark =
      several ? fmt::format(" (the worst of {})", shown.size()) : "";
  picture::PictureJob job =
      of_load_case(common, input, numbers.load_cases[worst], remark);
  shape(worst, "", job);
  add_job(job, Kind::Part, folder / "part.png", jobs);
  add_job(job, Kind::Film, folder / "film.png", jobs);
  add_job(job, Kind::Overview, folder / "overview.png", jobs);
  for (std::size_t i = 0; i < shown.size() && several; ++i) {
    const std::size_t k = shown[i];
    const std::string ending = "_" + numbers.load_cases[k].name;
    picture::PictureJob each = of_load_case(
        common, input, numbers.load_cases[k], k == worst ? remark : "");
    shape(k, ending, each);
    add_job(std::move(each), Kind::Part, folder / ("part" + ending + ".png"),
            jobs);
  }
  return jobs;
}

/// Of a shell the body that it stands for.
picture::PictureSurface part_surface(const case_data::Case& input,
                                     const forward::EvaluationFields& fields,
                                     std::size_t load_case) {
  VectorX u = fields.solution.displacements[load_case];
  std::vector<double> nodal;
  io::BoundarySurface boundary;
  if (fields.shell) {
    const shells::ShellPart& part = *fields.shell;
    const shells::ShellBody body = shells::shell_body(part);
    u = shells::body_displacements(body, part.cases[load_case].displacement);
    nodal = shells::body_von_mises(body, part, load_case);
    boundary = io::boundary_surface(body.mesh);
  } else {
    nodal =
        stress::nodal_stress(fields.mesh, fields.stresses[load_case].recovered)
            .von_mises;
    boundary = io::boundary_surface(fields.mesh);
  }
  picture::PictureSurface surface;
  surface.mesh = std::move(boundary.mesh);
  surface.length_unit = input.units.length;
  surface.stress_unit = input.units.pressure;
  for (const int node : boundary.nodes) {
    surface.displacement.emplace_back(u.segment<3>(3 * node));
    surface.von_mises.push_back(nodal[static_cast<std::size_t>(node)]);
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
    const case_data::Case& input, const forward::EvaluationFields& drawn,
    const fs::path& folder) {
  const std::optional<forward::EvaluationFields> whole =
      whole::whole_part(input, drawn);
  const forward::EvaluationFields& fields = whole ? *whole : drawn;
  picture::PictureJob job = run_job(input);
  picture::PictureSurface film;
  film.mesh = fields.film;
  job.film.data =
      std::make_shared<const picture::PictureSurface>(std::move(film));
  job.part.data =
      std::make_shared<const picture::PictureTets>(corner_tets(fields.mesh));
  std::map<std::size_t, std::shared_ptr<const picture::PictureSurface>> made;
  return all_pictures(
      job, input, fields.inputs, forward::worst_load_case(fields), true, folder,
      [&](std::size_t k, const std::string&, picture::PictureJob& to) {
        auto& surface = made[k];
        if (surface == nullptr) {
          surface = std::make_shared<const picture::PictureSurface>(
              part_surface(input, fields, k));
        }
        to.part_surface.data = surface;
      });
}

std::vector<picture::PictureJob> stored_run_pictures(
    const case_data::Case& input, const case_data::EvaluatedCase& numbers,
    const std::string& worst, const fs::path& folder) {
  picture::PictureJob job = run_job(input);
  job.part.file = (folder / "part.vtu").string();
  job.part_surface.file = (folder / "part_surface.vtp").string();
  job.film.file = (folder / "film.vtp").string();
  std::size_t number = 0;
  for (std::size_t k = 0; k < numbers.load_cases.size(); ++k) {
    number = numbers.load_cases[k].name == worst ? k : number;
  }
  return all_pictures(
      job, input, numbers, number, !worst.empty(), folder,
      [](std::size_t, const std::string& ending, picture::PictureJob& to) {
        to.field_ending = ending;
      });
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
        folder / "frames" / frames::frame_name(frames[k].evaluation);
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
