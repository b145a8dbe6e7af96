#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/case_input.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "app/versions.h"
#include "core/atomic_file.h"
#include "core/count_text.h"
#include "core/geometry/mesh_checks.h"
#include "core/math/union_find.h"
#include "io/vtk_files.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/case_films/film_advice.h"
#include "pipeline/case_films/film_start.h"
#include "pipeline/forward/part_warnings.h"
#include "pipeline/forward/walls.h"
#include "pipeline/frames/film_frames.h"
#include "pipeline/results/datafile.h"
#include "pipeline/results/evolved_film.h"
#include "pipeline/results/family_table.h"
#include "pipeline/results/new_case.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_files.h"
#include "pipeline/shells/shell_advice.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/store/study_table.h"
#include "report/output/run_pictures.h"

namespace meniscus::app {

namespace fs = std::filesystem;

int new_command(const std::string& name) {
  const fs::path folder = name;
  const fs::path file = folder / "case.toml";
  if (fs::exists(file)) {
    std::fprintf(stderr, "%s is there already; choose another name\n",
                 file.string().c_str());
    return kExitWrongInput;
  }
  return exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    make_folder(folder);
    write_file(file, results::new_case_text(folder.filename().string()));
    std::printf("%s is written; run it with: meniscus run %s\n",
                file.string().c_str(), file.string().c_str());
    return kExitDone;
  });
}

namespace {

/// " (6 of them t [2 x 3])" beside the number of design variables.
std::string vectors_text(const case_data::Case& input) {
  std::vector<std::string> parts;
  for (const case_data::DesignRow& row : case_data::design_rows(input)) {
    if (row.vector != nullptr) {
      parts.push_back(fmt::format("{} of them {}", row.count, row.label()));
    }
  }
  return parts.empty() ? "" : fmt::format(" ({})", fmt::join(parts, ", "));
}

}  // namespace

int check_command(const std::string& case_path, const CommonArguments& common) {
  const reader::CaseReading reading = read_and_report_case(case_path, common);
  if (!reading.input) {
    return kExitWrongInput;
  }
  const case_data::Case& input = *reading.input;
  for (const std::string& remark : input.remarks) {
    std::printf("%s\n", remark.c_str());
  }
  for (const std::string& advice : shells::shell_advice(input)) {
    std::printf("%s\n", advice.c_str());
  }
  std::string text = fmt::format(
      "{}: {}: {}, {}, {}, {}, {}", case_path,
      reading.warnings.empty()
          ? "nothing wrong found"
          : "no errors, " + count_text(reading.warnings.size(), "warning"),
      count_text(input.curves.size(), "curve"),
      count_text(input.films.size(), "film"),
      count_text(input.bodies.size(), "body", "bodies"),
      count_text(input.design.size(), "design variable") + vectors_text(input),
      count_text(input.responses.size(), "response"));
  if (!input.study.members.empty()) {
    text += ", " + count_text(input.study.members.size(), "member");
  }
  std::printf("%s\n  %s\n", text.c_str(), results::study_text(input).c_str());
  return kExitDone;
}

namespace {

results::DatafileOptions datafile_options(const EvolveArguments& arguments,
                                          Monitor& monitor) {
  results::DatafileOptions options;
  options.refinements = arguments.refinements;
  for (const std::string& text : arguments.common.overrides) {
    const auto [name, value] = named_number("--set", text);
    options.parameters[name] = value;
  }
  options.method = arguments.method == "gradient"
                       ? results::DatafileMethod::Gradient
                   : arguments.method == "conjugate_gradients"
                       ? results::DatafileMethod::ConjugateGradients
                       : results::DatafileMethod::Newton;
  if (!arguments.macro.empty()) {
    options.macro = arguments.macro;
  }
  options.pop = arguments.pop;
  options.monitor = &monitor;
  return options;
}

int evolve_datafile_command(const EvolveArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const fs::path path = arguments.path;
  fs::path folder;
  results::DatafileResult result;
  TerminalMonitor monitor(monitor_options(common));
  const int refused = exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    const results::DatafileOptions options =
        datafile_options(arguments, monitor);
    folder = folder_without_run(path.stem().string(), common.out, "_film");
    make_folder(folder);
    catch_stop_signals();
    result = results::evolve_datafile(path, options);
    return kExitDone;
  });
  if (refused != kExitDone) {
    return refused;
  }
  const std::string title = path.filename().string();
  const std::string warning =
      results::write_datafile_result(result, title, folder);
  if (arguments.pictures) {
    warn(output::draw_film(title, results::solids_of(result.complex),
                           arguments.hidden, folder, monitor));
  }
  if (!common.quiet) {
    std::fputs(results::datafile_text(result).c_str(), stdout);
    std::printf("  written to %s\n", folder.string().c_str());
  }
  if (!warning.empty()) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
  if (result.stopped) {
    std::fprintf(stderr, "stopped by %s: the film is kept as it was\n",
                 name_of_signal(stop_signal()));
    return kExitInterrupted;
  }
  if (result.failure) {
    std::fprintf(stderr, "failed: %s\n", result.failure->message.c_str());
    const FailureKind kind = result.failure->kind;
    if (!arguments.pop && (kind == FailureKind::FilmUnstable ||
                           kind == FailureKind::FilmPinched)) {
      std::fprintf(stderr,
                   "--pop splits junctions and pinched necks and settles "
                   "what is left\n");
    }
    return kExitNoSolution;
  }
  return kExitDone;
}

/// A wall beyond its safe thickness is written too, to be looked at.
int write_walls(const case_data::Case& input,
                const std::vector<forward::CaseWall>& walls,
                const fs::path& folder, const CommonArguments& common) {
  int code = kExitDone;
  for (const forward::CaseWall& wall : walls) {
    forward::write_wall(input, wall, folder);
    if (!common.quiet) {
      std::fputs(forward::wall_text(input, wall).c_str(), stdout);
    }
    if (!wall.wall.findings.empty()) {
      std::fprintf(stderr, "failed: wall %s cannot be meshed: %s\n",
                   wall.name.c_str(), summary(wall.wall.findings).c_str());
      code = kExitNoSolution;
    }
  }
  return code;
}

/// What --hide names that is neither film nor solid of the case; or nothing.
std::string find_unknown(const films::FilmSystem& system,
                         const std::vector<std::string>& hidden) {
  for (const std::string& name : hidden) {
    const auto named = [&](const auto& surface) {
      return picture::is_hidden(surface.name, {name});
    };
    if (std::none_of(system.films.begin(), system.films.end(), named) &&
        std::none_of(system.caps.begin(), system.caps.end(), named)) {
      return name;
    }
  }
  return "";
}

/// Surfaces, by name, of bodies that hang together by common surfaces have one
/// number.
std::map<std::string, int> parts_of_surfaces(const films::FilmSystem& system) {
  std::map<std::string, int> first;  // body
  UnionFind bodies(system.bodies.size());
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    for (const std::string& name : system.bodies[b].enclosed_by) {
      bodies.join(static_cast<int>(b),
                  first.emplace(name, static_cast<int>(b)).first->second);
    }
  }
  for (auto& [name, body] : first) {
    body = bodies.root(body);
  }
  return first;
}

/// Why the settled film cannot be a part's surface. Left out: what walls lack,
/// which is told of them, and films of parts that hang together nowhere, whose
/// crossings the report on nesting has.
std::vector<Finding> surface_findings(const films::FilmSystem& system,
                                      const frozen::FilmModel& model) {
  constexpr int kMost = 100000;  // so that none is left out for another
  if (model.reference().failure || system.bodies.empty()) {
    return {};
  }
  const std::map<std::string, int> parts = parts_of_surfaces(system);
  const auto is_film = [&](const std::string& name) {
    return std::any_of(system.films.begin(), system.films.end(),
                       [&](const auto& film) { return film.name == name; });
  };
  const auto is_of_several = [&](const Finding& finding) {
    std::set<int> found;
    for (const std::string& name : finding.surfaces) {
      const auto part = parts.find(name);
      found.insert(part == parts.end() ? -1 : part->second);
    }
    return found.size() > 1 && std::all_of(finding.surfaces.begin(),
                                           finding.surfaces.end(), is_film);
  };
  std::vector<Finding> findings = check_surface(
      model.surface(model.reference().points).base, {.max_findings = kMost});
  findings.erase(
      std::remove_if(findings.begin(), findings.end(), is_of_several),
      findings.end());
  return findings;
}

/// film.vtp, film.json and, where they are wanted, the film's way to rest and
/// pictures.
void write_evolved(const case_data::Case& input,
                   const case_data::EvaluatedCase& inputs,
                   const frozen::FilmModel& model,
                   const films::NestingReport& nesting,
                   const std::optional<Failure>& failure,
                   const fs::path& folder, const EvolveArguments& arguments,
                   Monitor& monitor) {
  const settle::FilmState& film = model.reference();
  const std::vector<std::string> owned = results::owned_files(folder);
  if (!arguments.pictures &&
      std::find(owned.begin(), owned.end(), "film.png") != owned.end()) {
    fs::remove(folder / "film.png");  // of another film
  }
  results::claim_files(folder, {"film.vtp", "film.json", "film.png"});
  const std::vector<std::string> solids = case_data::solids_of_whole(input);
  results::write_film(input, model.fine_mesh(film.points), folder);
  std::vector<forward::FilmFrame> frames;
  if (arguments.frames) {
    frames = frames::settling_frames(inputs, model, monitor);
    frames::write_frames(input, frames, folder);
  }
  results::write_evolved_film(
      {.title = input.title,
       .units = input.units,
       .report = film.report,
       .nesting = nesting,
       .failure = failure,
       .solids = solids,
       .areas = results::areas_of_films(input, model),
       .curves = results::pieces_of_curves(inputs.film_system.curves)},
      frames, folder);
  if (!arguments.pictures) {
    return;
  }
  warn(output::draw_film(input.title, solids, arguments.hidden, folder,
                         monitor));
  std::vector<std::string> captions;
  captions.reserve(frames.size());
  for (const forward::FilmFrame& frame : frames) {
    captions.push_back(results::settling_caption(frame));
  }
  warn(output::draw_frames(input.title, solids, frames, captions, folder,
                           monitor));
}

}  // namespace

int evolve_command(const EvolveArguments& arguments) {
  if (fs::path(arguments.path).extension() == ".fe") {
    return evolve_datafile_command(arguments);
  }
  const CommonArguments& common = arguments.common;
  const reader::CaseReading reading =
      read_and_report_case(arguments.path, common);
  if (!reading.input) {
    return kExitWrongInput;
  }
  const case_data::Case& input = *reading.input;
  fs::path folder;
  const int refused = exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    folder = folder_without_run(input.name, common.out, "_film");
    make_folder(folder);
    return kExitDone;
  });
  if (refused != kExitDone) {
    return refused;
  }
  catch_stop_signals();
  TerminalMonitor monitor(monitor_options(common));
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  if (const std::string name =
          find_unknown(inputs.film_system, arguments.hidden);
      !name.empty()) {
    std::fprintf(stderr,
                 "--hide %s: the case has no film and no solid of "
                 "that name\n",
                 name.c_str());
    return kExitWrongInput;
  }
  const frozen::FilmModel model =
      case_films::freeze_films(input, inputs,
                               {.edge = inputs.fea_edge,
                                .refinements = input.resolution.refinements,
                                .monitor = &monitor});
  const settle::FilmState& film = model.reference();
  const films::NestingReport nesting =
      film.failure ? films::NestingReport{}
                   : results::nesting_of_films(input, model);
  const std::vector<Finding> findings =
      inputs.walls.empty() ? surface_findings(inputs.film_system, model)
                           : std::vector<Finding>();
  const std::optional<Failure> failure =
      findings.empty() ? film.failure
                       : std::optional<Failure>(
                             {FailureKind::SurfaceInvalid, summary(findings)});
  write_evolved(input, inputs, model, nesting, failure, folder, arguments,
                monitor);
  if (!common.quiet) {
    std::fputs(results::film_text(input, film.report).c_str(), stdout);
    if (const std::string text =
            films::nesting_text(nesting, input.units.length);
        !text.empty()) {
      std::printf("  films %s\n", text.c_str());
    }
  }
  if (failure) {
    const std::string advice =
        case_films::tried_advice(input, inputs, *failure,
                                 {.edge = inputs.fea_edge,
                                  .refinements = input.resolution.refinements,
                                  .findings = findings,
                                  .monitor = &monitor});
    std::string message = failure->message;
    message += advice.empty() ? "" : "; " + advice;
    if (arguments.pictures) {
      message += "; look at " + (folder / "film.png").string();
    }
    std::fprintf(stderr, "failed: %s\n", message.c_str());
    return kExitNoSolution;
  }
  warn(forward::film_warnings(input, film.report));
  return write_walls(input, forward::make_walls(inputs, model, film.points),
                     folder, common);
}

int study_show_command(const std::string& folder, const std::string& csv) {
  return exit_code_of({on<IoError>(kExitWrongInput)}, [&] {
    const fs::path family = fs::path(folder) / "family.csv";
    if (fs::exists(family)) {
      const std::string table = read_file(family);
      if (csv.empty()) {
        std::fputs(
            results::family_table_text(table, store::stored_units(folder))
                .c_str(),
            stdout);
      } else {
        write_file(csv, table);
      }
      return kExitDone;
    }
    const store::StudyStore store = store::StudyStore::read(folder);
    const std::vector<store::EvaluationRecord> records = store.all();
    if (csv.empty()) {
      std::fputs(
          store::study_table_text(records, store::stored_units(folder)).c_str(),
          stdout);
    } else {
      write_file(csv, store::history_csv(records));
    }
    return kExitDone;
  });
}

std::string version_text() {
  return fmt::format("meniscus {}\n{}", kProgramVersion, kLibraryVersions);
}

}  // namespace meniscus::app
