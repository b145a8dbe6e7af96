#include "pipeline/results/export_part.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "evolve/datafile/fe_write.h"
#include "evolve/start/wetted_faces.h"
#include "io/gmsh_msh.h"
#include "io/nastran_bdf.h"
#include "io/obj.h"
#include "io/shell_deck/calculix_shells.h"
#include "io/shell_deck/nastran_shells.h"
#include "io/stl.h"
#include "io/three_mf.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/forward/walls.h"
#include "pipeline/results/calculix_export.h"
#include "pipeline/results/export_job.h"
#include "pipeline/results/make_ledger.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_files.h"
#include "pipeline/results/shell_deck_export.h"
#include "pipeline/shells/shell_body.h"
#include "pipeline/step_parts/export_step.h"
#include "pipeline/step_parts/wall_step.h"
#include "pipeline/study/ledger.h"
#include "pipeline/whole/whole_part.h"
#include "pipeline/whole/whole_system.h"

namespace meniscus::results {

namespace {

namespace fs = std::filesystem;

/// Of shells the bodies of their walls.
SurfaceMesh printed_surface(ExportJob& job) {
  if (!job.input().shells.empty()) {
    return job.bodies_surface();
  }
  const SettledFilm& film = job.film();
  return whole::whole_surface(
      job.input(),
      forward::boundary_of(job.inputs(), film.model, film.state.points));
}

void stl(ExportJob& job, const fs::path& file) {
  io::write_stl(file, printed_surface(job),
                {.name = job.input().title,
                 .unit = job.input().units.length,
                 .program = job.notes().program});
}

void three_mf(ExportJob& job, const fs::path& file) {
  io::write_3mf(file, job.bodies_surface(),
                {.notes = job.notes(), .bodies = job.body_names()});
}

void obj(ExportJob& job, const fs::path& file) {
  io::write_obj(file, job.bodies_surface(),
                {.notes = job.notes(), .bodies = job.body_names()});
}

void fe(ExportJob& job, const fs::path& file) {
  const SettledFilm& film = job.film();
  std::vector<std::string> comments = io::comment_lines(job.notes());
  comments.push_back(fmt::format("energy of the films and fields: {} ({})",
                                 film.state.report.energy,
                                 job.input().units.unit_of(Dimension::Energy)));
  comments.emplace_back(
      "'m 0; g' sets the pressures that 'hessian' asks for, and moves nothing");
  // Surface Evolver has walls as it does: without faces, by line integrals.
  const films::FilmComplex complex = start::open_wetted_faces(
      film.model.complex_at(film.state, job.inputs().film_system));
  write_file(file, datafile::fe_text(complex, comments));
}

std::vector<step::MirrorPlane> mirrors_of(
    const case_data::Case& input, const std::vector<std::size_t>& planes) {
  std::vector<step::MirrorPlane> mirrors;
  for (const std::size_t p : planes) {
    const case_data::SymmetryPlane& plane = input.symmetry[p];
    mirrors.push_back(
        {plane.at, plane.normal, case_data::cuts_of_whole(input, p)});
  }
  return mirrors;
}

void wall_step(ExportJob& job, const fs::path& file, bool faceted) {
  const SettledFilm& film = job.film();
  std::vector<step_parts::WallBody> bodies;
  for (const forward::CaseWall& wall : forward::named_walls(
           job.inputs(),
           forward::wall_model(job.inputs(), film.model, film.state.points))) {
    bodies.push_back({wall.name, step_parts::with_ends(wall.wall)});
  }
  std::vector<std::size_t> planes(job.input().symmetry.size());
  std::iota(planes.begin(), planes.end(), 0);
  std::vector<step::MirrorPlane> mirrors = mirrors_of(job.input(), planes);
  for (step::MirrorPlane& mirror : mirrors) {  // lines end there as well
    const std::vector<std::string> cuts = mirror.cuts;
    for (const std::string& face : cuts) {
      mirror.cuts.push_back(face + step_parts::kLineEnd);
    }
  }
  step_parts::export_walls(
      file, bodies,
      {.title = job.input().title,
       .unit = job.input().units.length,
       .edge = job.edge().value_or(job.input().resolution.film),
       .faceted = faceted,
       .mirrors = std::move(mirrors),
       .monitor = job.monitor()});
}

void step(ExportJob& job, const fs::path& file, bool faceted) {
  if (!job.inputs().walls.empty()) {
    wall_step(job, file, faceted);
    return;
  }
  whole::WholeSystem whole{job.inputs().film_system, {}};
  if (faceted) {
    whole.mirrors.resize(job.input().symmetry.size());
    std::iota(whole.mirrors.begin(), whole.mirrors.end(), 0);
  } else {
    whole = whole::whole_system(job.input(), whole.system);
  }
  step_parts::export_step(
      file, whole.system,
      {.title = job.input().title,
       .unit = job.input().units.length,
       .edge = job.edge().value_or(job.input().resolution.film),
       .faceted = faceted,
       .mirrors = mirrors_of(job.input(), whole.mirrors),
       .monitor = job.monitor()});
}

void smooth_step(ExportJob& job, const fs::path& file) {
  step(job, file, false);
}

void faceted_step(ExportJob& job, const fs::path& file) {
  step(job, file, true);
}

/// The program before the deck's own comments, case and design after them.
template <class Deck>
Deck with_notes(const ExportJob& job, Deck deck) {
  const io::FileNotes notes = job.notes();
  deck.comments.insert(deck.comments.begin(), notes.program);
  deck.comments.insert(deck.comments.end(), notes.lines.begin(),
                       notes.lines.end());
  return deck;
}

io::CalculixDeck deck(ExportJob& job) {
  const forward::EvaluationFields& fields = job.meshed();
  return with_notes(job,
                    calculix_deck_of(job.input(), fields.inputs, fields.mesh));
}

shell_deck::ShellDeck deck_of_shells(ExportJob& job) {
  const forward::EvaluationFields& fields = job.meshed();
  return with_notes(job,
                    shell_deck_of(job.input(), fields.inputs, *fields.shell));
}

void inp(ExportJob& job, const fs::path& file) {
  if (job.meshed().shell) {
    shell_deck::write_calculix_shells(file, deck_of_shells(job));
    return;
  }
  io::write_calculix_inp(file, job.meshed().mesh, deck(job));
}

void bdf(ExportJob& job, const fs::path& file) {
  if (job.meshed().shell) {
    shell_deck::write_nastran_shells(file, deck_of_shells(job));
    return;
  }
  io::write_nastran_bdf(file, job.meshed().mesh, deck(job));
}

/// Of shells the largest of both faces and the middle.
std::vector<double> nodal_von_mises(const forward::EvaluationFields& fields,
                                    std::size_t load_case) {
  using W = shell::WallStress;
  return fields.shell
             ? shells::nodal_von_mises(*fields.shell, load_case,
                                       {&W::negative, &W::middle, &W::positive})
             : stress::nodal_stress(fields.mesh,
                                    fields.stresses[load_case].recovered)
                   .von_mises;
}

void msh(ExportJob& job, const fs::path& file) {
  const forward::EvaluationFields& fields = job.fields();
  io::MshOptions options{
      .notes = job.notes(), .regions = job.body_names(), .fields = {}};
  const UnitSystem& units = job.input().units;
  for (std::size_t k = 0; k < fields.solution.displacements.size(); ++k) {
    const std::string& load_case = fields.inputs.load_cases[k].name;
    const VectorX& u = fields.solution.displacements[k];
    options.fields.push_back(
        {.name = fmt::format("displacement, {} [{}]", load_case, units.length),
         .components = 3,
         .values = {u.begin(), u.end()}});
    if (fields.shell) {
      const VectorX turned =
          shell::rotations_of(fields.shell->cases[k].displacement);
      options.fields.push_back(
          {.name = fmt::format("rotation, {} [rad]", load_case),
           .components = 3,
           .values = {turned.begin(), turned.end()}});
    }
    options.fields.push_back(
        {.name = fmt::format("von Mises, {} [{}]", load_case, units.pressure),
         .components = 1,
         .values = nodal_von_mises(fields, k)});
  }
  io::write_msh(file, fields.mesh, options);
}

void vtu(ExportJob& job, const fs::path& file) {
  const io::FileNotes notes = job.notes();
  write_part(
      file, job.input(), job.fields(),
      {{"program", notes.program},
       {"case_and_design", fmt::format("{}", fmt::join(notes.lines, "; "))}});
}

const ExportFormat& format_named(const std::string& name) {
  for (const ExportFormat& format : export_formats()) {
    if (format.name == name) {
      return format;
    }
  }
  throw InvalidInput(fmt::format("format '{}' is not known; there are {}", name,
                                 export_format_names()));
}

/// CAD's solids are films or walls.
void refuse_shells(const case_data::Case& input, const ExportFormat& format) {
  if (!input.shells.empty() && case_data::has_solids(input) &&
      format.write != fe) {
    throw InvalidInput(fmt::format(
        "format '{}' cannot yet hold shells.{} beside solid bodies; take "
        "part.vtu and the STL file of the run, or [walls] in place of [shells]",
        format.name, input.shells.front().name));
  }
  if (!input.shells.empty() &&
      (format.write == smooth_step || format.write == faceted_step)) {
    throw InvalidInput(fmt::format(
        "format '{}' is of solids, and shells.{} is none; take [walls] in "
        "place of [shells] for it, or export stl, 3mf or obj, the body of its "
        "thickness",
        format.name, input.shells.front().name));
  }
}

}  // namespace

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats = {
      {"stl", "stl", "surface, binary, for printing", true, stl},
      {"3mf", "3mf", "surface with its unit, for slicers", true, three_mf},
      {"obj", "obj", "surface with named groups", true, obj},
      {"step", "step", "CAD, films as B-spline faces", true, smooth_step},
      {"step-faceted", "step", "CAD, a plane for each facet", true,
       faceted_step},
      {"fe", "fe", "film for Surface Evolver", true, fe},
      {"inp", "inp", "deck for CalculiX and Abaqus", false, inp},
      {"bdf", "bdf", "deck for Nastran", false, bdf},
      {"msh", "msh", "elements for Gmsh", false, msh},
      {"vtu", "vtu", "elements and fields for ParaView", false, vtu},
  };
  return formats;
}

std::string export_format_names() {
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) {
    names.emplace_back(format.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

fs::path export_part(const fs::path& folder, const ExportOptions& options) {
  const ExportFormat& format = format_named(options.format);
  ExportJob job(folder, {.edge = options.edge,
                         .program_version = options.program_version,
                         .monitor = options.monitor});
  refuse_shells(job.input(), format);
  const case_data::Resolution& resolution = job.input().resolution;
  const double edge =
      options.edge.value_or(format.of_film ? resolution.film : resolution.fea);
  fs::path file = options.out;
  if (file.empty()) {
    file = folder / fmt::format("part_{:g}.{}", edge, format.extension);
    claim_files(folder, {file.filename().string()});
  }
  format.write(job, file);
  note_file(folder, file, fmt::format("part_{:g}.{}", edge, format.name));
  return file;
}

}  // namespace meniscus::results
