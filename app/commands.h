/// The commands of the program: what the command line asks, and the exit code
/// (0 done, 2 wrong input, 3 no acceptable solution, 4 internal error or full
/// disk, 130 interrupted).
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace meniscus::app {

struct CommonArguments {
  std::vector<std::string> overrides;  // "name=value"
  std::string from;  // folder of a run whose answer is the start; empty: none
  std::string out;   // results folder; empty: results/<name>
  std::string log;   // JSON-lines log file; empty: none
  bool quiet = false;
};

struct RunArguments {
  std::string case_path;
  CommonArguments common;
  bool resume = false;
  bool pictures = true;
  bool frames = true;                // films of the design's history
  bool frame_pictures = false;       // and a picture of each
  bool report = true;                // report.html
  std::vector<std::string> exports;  // formats to write the part in besides
  int threads = 0;                   // 0: OpenMP's own number
  int jobs = 1;  // independent designs, or members of a family, side by side
  double time_limit = 0.0;  // [s], 0: none
};

struct ExportArguments {
  std::string run_folder;
  std::string format;          // "stl", "inp", "vtu"
  std::optional<double> edge;  // [length]; the run's own when absent
  std::string out;             // file; empty: into the run's folder
};

struct ReportArguments {
  std::string folder;  // of a run, a family or a comparison
  bool pictures = true;
};

struct CompareArguments {
  std::vector<std::string> parts;       // results folders, and files after one
  std::vector<std::string> faces;       // NAME=FACE, of the files
  std::string out = "results/compare";  // folder of compare.json, compare.csv
  bool quiet = false;
};

struct EvolveArguments {
  std::string path;  // a case, or a Surface Evolver datafile (*.fe)
  CommonArguments common;
  std::optional<int> refinements;  // datafiles
  std::string method = "newton";   // "gradient", "conjugate_gradients"
  std::string macro;               // datafiles: run it; empty: our own route
  bool pop = false;                // datafiles: junctions of too many films
  bool frames = false;             // cases: how the film settles
  bool pictures = true;
  std::vector<std::string> hidden;  // of the picture: surfaces left out
};

struct CheckGradientArguments {
  std::string case_path;
  CommonArguments common;
  std::vector<std::string> at;  // "name=value" of design variables
  int directions = 0;           // random ones; 0: by each variable
};

struct SolveArguments {
  std::string path;        // a deck (*.inp)
  std::string units;       // a system's name; empty: the deck's own
  CommonArguments common;  // out, log, quiet
};

struct CurvesArguments {
  std::string scan;              // an STL or OBJ file
  double angle = 25.0;           // [degrees]
  std::optional<double> radius;  // [length]
  std::optional<int> points;     // of each curve
  std::string out;               // file; empty: standard output
};

struct WatchArguments {
  std::string folder;  // of a run or a family
  bool once = false;   // one look
};

int new_command(const std::string& name);
int check_command(const std::string& case_path, const CommonArguments& common);
int check_gradient_command(const CheckGradientArguments& arguments);
int run_command(const RunArguments& arguments);
int evolve_command(const EvolveArguments& arguments);
/// Proposes rims of a scan as curves of a case.
int curves_command(const CurvesArguments& arguments);
int compare_command(const CompareArguments& arguments);
/// Solves the steps of a deck of CalculiX or Abaqus.
int solve_command(const SolveArguments& arguments);
int export_command(const ExportArguments& arguments);
int report_command(const ReportArguments& arguments);
int study_show_command(const std::string& folder, const std::string& csv);
/// Ends with the exit code of the run that it watches.
int study_watch_command(const WatchArguments& arguments);

/// Name and version of the program and of every library in it.
std::string version_text();

}  // namespace meniscus::app
