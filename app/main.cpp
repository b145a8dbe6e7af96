#include <cmath>
#include <cstdio>
#include <functional>
#include <omp.h>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_code.h"
#include "core/memory.h"
#include "core/process_settings.h"
#include "pipeline/results/export_part.h"
#include "pipeline/study/ordered_jobs.h"

namespace {

using meniscus::app::CommonArguments;

void add_case(CLI::App& command, std::string& path) {
  command.add_option("CASE", path, "case file (TOML)")->required();
}

void add_overrides(CLI::App& command, CommonArguments& common) {
  command
      .add_option("--set", common.overrides,
                  "override a parameter, a design variable's start or a key: "
                  "load_left=5e4, resolution.fea=6")
      ->type_name("NAME=VALUE");
  command
      .add_option("--from", common.from,
                  "begin at the answer of another run: its design variables "
                  "that this case has too; --set goes before it")
      ->type_name("DIR");
}

void add_common(CLI::App& command, CommonArguments& common) {
  add_overrides(command, common);
  command.add_option("--out", common.out,
                     "results folder (default: results/<case name>)");
  command.add_option("--log", common.log, "write a log of JSON lines");
  command.add_flag("--quiet", common.quiet, "errors only");
}

/// What is wrong in one line, and where to read on; without any command all
/// of them.
std::string usage_error(const CLI::App* app, const CLI::Error& error) {
  if (app->get_subcommands().empty()) {
    return fmt::format("{}\n\n{}", error.what(), app->help());
  }
  std::string name = app->get_name();
  while (!app->get_subcommands().empty()) {
    app = app->get_subcommands().front();
    name += " " + app->get_name();
  }
  return fmt::format("{}; see '{} --help'\n", error.what(), name);
}

/// A finite number above 0, refused in words that tell so.
CLI::Validator positive() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && value > 0.0 &&
                       std::isfinite(value)
                   ? std::string()
                   : fmt::format("'{}' is no number above 0", text);
      },
      "POSITIVE");
}

/// A line for each format.
std::string formats_text() {
  std::string text = "one of";
  for (const meniscus::results::ExportFormat& format :
       meniscus::results::export_formats()) {
    text += fmt::format("\n{}: {}", format.name, format.what);
  }
  return text;
}

std::string no_export_format(const std::string& name) {
  for (const meniscus::results::ExportFormat& format :
       meniscus::results::export_formats()) {
    if (format.name == name) {
      return "";
    }
  }
  return fmt::format("'{}' is no format; there are {}", name,
                     meniscus::results::export_format_names());
}

int run_program(int argc, char** argv) {
  CLI::App app("Designs load-carrying parts with liquid films.", "meniscus");
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       [] { return meniscus::app::version_text(); });
  app.failure_message(usage_error);
  std::function<int()> command;

  std::string name;
  CLI::App* create = app.add_subcommand("new", "write a commented start case");
  create->add_option("NAME", name, "folder to make, with NAME/case.toml")
      ->required();
  create->callback(
      [&] { command = [&] { return meniscus::app::new_command(name); }; });

  std::string case_path;
  CommonArguments common;
  CLI::App* check =
      app.add_subcommand("check", "read and validate a case, compute nothing");
  add_case(*check, case_path);
  add_overrides(*check, common);
  check->callback([&] {
    command = [&] { return meniscus::app::check_command(case_path, common); };
  });

  meniscus::app::RunArguments run_arguments;
  CLI::App* run = app.add_subcommand("run", "run a case's study");
  add_case(*run, run_arguments.case_path);
  add_common(*run, run_arguments.common);
  run->add_flag("--resume", run_arguments.resume,
                "go on where an earlier run in the same folder ended");
  run->add_flag("!--no-pictures", run_arguments.pictures,
                "leave the pictures out");
  run->add_flag("!--no-frames", run_arguments.frames,
                "leave out frames.pvd, the films of the design's history");
  run->add_flag("--frame-pictures", run_arguments.frame_pictures,
                "a picture of each of these films, from one fixed camera");
  run->add_flag("!--no-report", run_arguments.report, "leave report.html out");
  run->add_option("--export", run_arguments.exports,
                  "write the part, or each member's, in this format too; may "
                  "be given again; " +
                      formats_text())
      ->type_name("FORMAT")
      ->allow_extra_args(false)
      ->check(no_export_format);
  run->add_option("--threads", run_arguments.threads,
                  "threads that a run may use; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  run->add_option("--jobs", run_arguments.jobs,
                  "designs, or members of a family, worked on side by side "
                  "where a study knows several ahead, each with its share of "
                  "the threads; results do not depend on it")
      ->check(CLI::Range(1, meniscus::study::kMostJobs));
  run->add_option("--time-limit", run_arguments.time_limit,
                  "stop after so many seconds, or \"10 min\", and keep the "
                  "best point")
      ->transform(CLI::AsNumberWithUnit(
          std::map<std::string, double>{
              {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}},
          CLI::AsNumberWithUnit::UNIT_OPTIONAL, "TIME"))
      ->check(positive());
  run->callback([&] {
    command = [&] { return meniscus::app::run_command(run_arguments); };
  });

  meniscus::app::CheckGradientArguments gradient_arguments;
  CLI::App* gradient =
      app.add_subcommand("check-gradient",
                         "compare the exact gradient of all responses with "
                         "central differences");
  add_case(*gradient, gradient_arguments.case_path);
  add_overrides(*gradient, gradient_arguments.common);
  gradient
      ->add_option("--at", gradient_arguments.at,
                   "another design than the initial one")
      ->type_name("NAME=VALUE");
  gradient
      ->add_option("--directions", gradient_arguments.directions,
                   "along so many random directions of all design variables "
                   "together, not by each one: for cases of many")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  gradient->add_flag("--quiet", gradient_arguments.common.quiet,
                     "tell only what differs");
  gradient->callback([&] {
    command = [&] {
      return meniscus::app::check_gradient_command(gradient_arguments);
    };
  });

  meniscus::app::EvolveArguments evolve_arguments;
  CLI::App* evolve = app.add_subcommand(
      "evolve", "film equilibrium only, of a case or a Surface Evolver file");
  evolve
      ->add_option("FILE", evolve_arguments.path,
                   "case file (TOML) or datafile (.fe)")
      ->required();
  add_common(*evolve, evolve_arguments.common);
  evolve
      ->add_option("--refine", evolve_arguments.refinements,
                   "datafiles: 1:4 refinements (default: to 2,000 facets)")
      ->check(CLI::Range(0, 10));
  evolve
      ->add_option("--method", evolve_arguments.method,
                   "datafiles: newton, gradient or conjugate_gradients")
      ->check(CLI::IsMember({"newton", "gradient", "conjugate_gradients"}));
  CLI::Option* script =
      evolve
          ->add_option("--script", evolve_arguments.macro,
                       "datafiles: run this macro of the file (default: gogo) "
                       "in place of our own route")
          ->expected(0, 1)
          ->default_str("gogo");
  CLI::Option* pop = evolve->add_flag(
      "--pop", evolve_arguments.pop,
      "datafiles: split junctions of more than three films, and settle again");
  pop->excludes(script);
  evolve->add_flag("--frames", evolve_arguments.frames,
                   "cases: write how the film settles, and pictures of it from "
                   "one fixed camera");
  evolve->add_flag("!--no-pictures", evolve_arguments.pictures,
                   "leave the picture out");
  evolve
      ->add_option("--hide", evolve_arguments.hidden,
                   "leave this film or solid out of the picture; NAME* stands "
                   "for all whose names begin so; may be given again")
      ->type_name("NAME")
      ->expected(1)
      ->take_all();
  evolve->callback([&, script] {
    if (script->count() > 0 && evolve_arguments.macro.empty()) {
      evolve_arguments.macro = "gogo";
    }
    command = [&] { return meniscus::app::evolve_command(evolve_arguments); };
  });

  meniscus::app::ExportArguments export_arguments;
  CLI::App* write =
      app.add_subcommand("export", "write a run's part for another program");
  write
      ->add_option("RUN", export_arguments.run_folder,
                   "results folder; of a family all members are written")
      ->required();
  write->add_option("--format", export_arguments.format, formats_text())
      ->required()
      ->type_name("FORMAT")
      ->check(no_export_format);
  write
      ->add_option("--edge", export_arguments.edge,
                   "settle and mesh again at this edge length")
      ->check(positive());
  write->add_option("--out", export_arguments.out,
                    "file (default: into the run's folder)");
  write->callback([&] {
    command = [&] { return meniscus::app::export_command(export_arguments); };
  });

  meniscus::app::SolveArguments solve_arguments;
  CLI::App* solve = app.add_subcommand(
      "solve", "solve the steps of a deck of CalculiX or Abaqus (.inp)");
  solve
      ->add_option("FILE", solve_arguments.path,
                   "deck of C3D4 or C3D10 elements; docs/decks.md lists the "
                   "keywords")
      ->required();
  solve
      ->add_option("--units", solve_arguments.units,
                   "what the deck's numbers are in (default: nothing is said)")
      ->check(CLI::IsMember({"mm-N-MPa", "m-N-Pa", "in-lbf-psi"}));
  solve->add_option("--out", solve_arguments.common.out,
                    "results folder (default: results/<deck name>)");
  solve->add_option("--log", solve_arguments.common.log,
                    "write a log of JSON lines");
  solve->add_flag("--quiet", solve_arguments.common.quiet, "errors only");
  solve->callback([&] {
    command = [&] { return meniscus::app::solve_command(solve_arguments); };
  });

  meniscus::app::CompareArguments compare_arguments;
  CLI::App* compare = app.add_subcommand(
      "compare", "parts side by side: mass, stiffness, stress, uniformity");
  compare
      ->add_option("PART", compare_arguments.parts,
                   "results folders; after the first also files: ASCII STL "
                   "with a solid for each named face, OBJ with a group, STEP, "
                   "Surface Evolver datafiles (.fe), and decks of CalculiX or "
                   "Abaqus (.inp) with materials and loads of their own")
      ->required()
      ->expected(2, 100);
  compare
      ->add_option(
          "--face", compare_arguments.faces,
          "what the run calls NAME is FACE in the files, or in FILE alone; "
          "repeatable")
      ->type_name("[FILE:]NAME=FACE")
      ->expected(1)
      ->take_all();
  compare->add_option("--out", compare_arguments.out,
                      "folder of compare.json and compare.csv");
  compare->add_flag("--quiet", compare_arguments.quiet, "errors only");
  compare->callback([&] {
    command = [&] { return meniscus::app::compare_command(compare_arguments); };
  });

  meniscus::app::CurvesArguments curves_arguments;
  CLI::App* curves = app.add_subcommand(
      "curves", "propose curves: the lines along which a scan bends most");
  curves->add_option("SCAN", curves_arguments.scan, "STL or OBJ file")
      ->required();
  curves->add_option("--angle", curves_arguments.angle,
                     "least turn of the surface across a line, in degrees "
                     "(default: 25)");
  curves
      ->add_option("--radius", curves_arguments.radius,
                   "normals are averaged so far on each side of a line "
                   "(default: 1/40 of the scan's size)")
      ->check(positive());
  curves->add_option("--points", curves_arguments.points,
                     "points of each curve (default: as few as serve)");
  curves->add_option("--out", curves_arguments.out,
                     "write the curves into this file");
  curves->callback([&] {
    command = [&] { return meniscus::app::curves_command(curves_arguments); };
  });

  meniscus::app::ReportArguments report_arguments;
  CLI::App* report = app.add_subcommand(
      "report", "make report.html and the pictures of a run again");
  report
      ->add_option("RUN", report_arguments.folder,
                   "folder of a run, a family or a comparison")
      ->required();
  report->add_flag("!--no-pictures", report_arguments.pictures,
                   "leave the pictures out");
  report->callback([&] {
    command = [&] { return meniscus::app::report_command(report_arguments); };
  });

  std::string folder;
  std::string csv;
  CLI::App* study = app.add_subcommand("study", "look into a study");
  study->require_subcommand(1);
  CLI::App* show =
      study->add_subcommand("show", "the table of all evaluations");
  show->add_option("DIR", folder, "results folder")->required();
  show->add_option("--csv", csv, "write the table as CSV into this file");
  show->callback([&] {
    command = [&] { return meniscus::app::study_show_command(folder, csv); };
  });

  meniscus::app::WatchArguments watch_arguments;
  CLI::App* watch = study->add_subcommand(
      "watch", "the figures of a running study, each second, until it ends");
  watch->add_option("DIR", watch_arguments.folder, "results folder")
      ->required();
  watch->add_flag("--once", watch_arguments.once, "look once and end");
  watch->callback([&] {
    command = [&] {
      return meniscus::app::study_watch_command(watch_arguments);
    };
  });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : meniscus::app::kExitWrongInput;
  }
  if (run_arguments.threads > 0) {
    omp_set_num_threads(run_arguments.threads);
  }
  meniscus::start_threads();
  return command();
}

}  // namespace

/// What escapes a command becomes a message and an exit code.
int main(int argc, char** argv) {
  meniscus::start_with_settings(argv);
  meniscus::keep_freed_memory();
  return meniscus::app::exit_code_of(meniscus::app::program_rules(),
                                     [&] { return run_program(argc, argv); });
}
