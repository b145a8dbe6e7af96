#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <omp.h>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/case_input.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "app/terminal_monitor.h"
#include "app/versions.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json.h"
#include "pipeline/decks/compared_deck.h"
#include "pipeline/files/part_file.h"
#include "pipeline/files/text_table.h"
#include "pipeline/forward/stress_figures.h"
#include "pipeline/results/imported_part.h"
#include "pipeline/results/part_comparison.h"
#include "pipeline/results/results.h"
#include "pipeline/store/study_store.h"
#include "report/page/report_page.h"

namespace meniscus::app {

namespace {

namespace fs = std::filesystem;

/// The row's values (not its ratios) times `factor`, "[from" now "[to".
void show_row(double factor, const std::string& from, const std::string& to,
              files::TextRow& row) {
  row[0].replace(row[0].size() - from.size(), from.size(), to);
  for (std::size_t k = 1; k < row.size(); k += k == 1 ? 1 : 2) {
    if (!row[k].empty()) {
      row[k] = fmt::format("{:.6g}", factor * std::stod(row[k]));
    }
  }
}

/// Masses as people read them, labels flush left in a table whose columns are
/// flush right.
std::string for_people(std::vector<files::TextRow> table,
                       const UnitSystem& units) {
  const ShownUnit mass = units.shown(Dimension::Mass);
  const std::string whole = "[" + units.mass + "]";
  const std::string per = "/" + units.mass + "]";
  for (files::TextRow& row : table) {
    if (row[0].ends_with(whole)) {
      show_row(mass.factor, whole, "[" + mass.unit + "]", row);
    } else if (row[0].ends_with(per)) {
      show_row(1.0 / mass.factor, per, "/" + mass.unit + "]", row);
    }
  }
  std::size_t width = 0;
  for (const files::TextRow& row : table) {
    width = std::max(width, row[0].size());
  }
  for (files::TextRow& row : table) {
    row[0].resize(width, ' ');
  }
  return files::aligned_text(table);
}

std::string surface_name(std::size_t part) {
  return fmt::format("part_{}.vtp", part);
}

/// Surfaces of a comparison that comes to nothing do not stay.
class Surfaces {
 public:
  Surfaces(fs::path folder, std::size_t parts)
      : folder_(std::move(folder)), parts_(parts) {}
  ~Surfaces() {
    std::error_code ignored;
    for (std::size_t part = 1; part <= parts_; ++part) {
      fs::remove(folder_ / surface_name(part), ignored);
    }
  }
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  void keep() { parts_ = 0; }

 private:
  fs::path folder_;
  std::size_t parts_;
};

/// Its surface with stresses beside compare.json, for the report page; of the
/// same load case for all.
void keep_surface(const case_data::Case& input,
                  const forward::EvaluationFields& fields,
                  const std::string& load_case, const fs::path& folder,
                  std::vector<results::PartFigures>& parts) {
  parts.back().surface = surface_name(parts.size());
  results::write_part_surface(folder / parts.back().surface, input, fields,
                              load_case);
}

/// "--face NAME=FACE" is of every file, "--face FILE:NAME=FACE" of one, and
/// that holds before the others.
struct FaceArgument {
  std::string file;  // as it stands in the arguments; empty: of all
  std::string face;
  std::string name;
};

std::vector<FaceArgument> face_arguments(const CompareArguments& arguments) {
  std::vector<FaceArgument> faces;
  for (const std::string& text : arguments.faces) {
    auto [name, face] = named_text(
        "--face", text,
        "NAME=FACE or FILE:NAME=FACE, the run's name and the file's surface");
    FaceArgument found{"", std::move(face), std::move(name)};
    const std::size_t colon = found.name.rfind(':');
    if (colon != std::string::npos) {
      found.file = found.name.substr(0, colon);
      found.name.erase(0, colon + 1);
      if (std::find(arguments.parts.begin(), arguments.parts.end(),
                    found.file) == arguments.parts.end()) {
        throw InvalidInput(
            fmt::format("--face {}: '{}' is none of the parts; they are {}",
                        text, found.file, fmt::join(arguments.parts, ", ")));
      }
    }
    faces.push_back(std::move(found));
  }
  return faces;
}

results::FaceNames names_for(const std::vector<FaceArgument>& faces,
                             const std::string& file) {
  results::FaceNames names;
  std::set<std::string> own;
  for (const FaceArgument& face : faces) {
    if (face.file == file) {
      names[face.face] = face.name;
      own.insert(face.name);
    }
  }
  for (const FaceArgument& face : faces) {
    if (face.file.empty() && own.count(face.name) == 0) {
      names.try_emplace(face.face, face.name);
    }
  }
  return names;
}

/// All runs, then the files, which take the first run's loads.
std::vector<results::PartFigures> load_parts(const CompareArguments& arguments,
                                             Monitor& monitor,
                                             UnitSystem& units) {
  const fs::path folder = arguments.out;
  const std::vector<FaceArgument> faces = face_arguments(arguments);
  std::vector<results::PartFigures> parts;
  if (files::is_part_file(arguments.parts.front()) ||
      decks::is_deck(arguments.parts.front())) {
    throw InvalidInput(
        "the first part must be a run: a file takes material, supports and "
        "loads from it, a deck its units");
  }
  std::map<std::string, decks::DeckPart> read;
  for (const std::string& part :
       arguments.parts) {        // refused before the others
    if (decks::is_deck(part)) {  // are computed
      read.insert_or_assign(part, decks::read_deck_part(part));
    } else if (!files::is_part_file(part)) {
      store::StudyStore::read(part);
    }
  }
  make_folder(folder);
  results::RunPart first =
      results::load_run_part(arguments.parts.front(), &monitor);
  units = first.input.units;
  parts.push_back(first.figures);
  const std::string worst =
      first.input.load_cases[forward::worst_load_case(first.fields)].name;
  keep_surface(first.input, first.fields, worst, folder, parts);
  for (std::size_t k = 1; k < arguments.parts.size(); ++k) {
    const fs::path path = arguments.parts[k];
    if (files::is_part_file(path)) {
      forward::EvaluationFields fields;
      parts.push_back(results::imported_part_figures(
          path, first, names_for(faces, arguments.parts[k]), &monitor,
          &fields));
      keep_surface(first.input, fields, worst, folder, parts);
      continue;
    }
    if (decks::is_deck(path)) {
      forward::EvaluationFields fields;
      parts.push_back(decks::compared_deck_figures(read.at(arguments.parts[k]),
                                                   arguments.parts[k], first,
                                                   &monitor, &fields));
      keep_surface(decks::case_for_fields(first.input, fields), fields, worst,
                   folder, parts);
      continue;
    }
    const results::RunPart run = results::load_run_part(path, &monitor);
    if (run.input.units.name != units.name) {
      throw InvalidInput(fmt::format(
          "{} is in {} and {} in {}; only parts in the same units can be "
          "compared",
          path.string(), run.input.units.name, arguments.parts.front(),
          units.name));
    }
    parts.push_back(run.figures);
    keep_surface(run.input, run.fields, worst, folder, parts);
  }
  return parts;
}

/// Surfaces of an earlier comparison of more parts.
void remove_other_surfaces(const fs::path& folder, std::size_t parts) {
  if (!fs::exists(folder / "compare.json")) {
    return;
  }
  const auto earlier = parse_json(read_file(folder / "compare.json"));
  if (!earlier.is_object() || !earlier.contains("parts") ||
      !earlier["parts"].is_array()) {
    return;
  }
  for (std::size_t part = parts + 1; part <= earlier["parts"].size(); ++part) {
    std::error_code ignored;
    fs::remove(folder / surface_name(part), ignored);
  }
}

void compare(const CompareArguments& arguments, Surfaces& surfaces,
             Monitor& monitor) {
  const fs::path folder = arguments.out;
  UnitSystem units;
  const std::vector<results::PartFigures> parts =
      load_parts(arguments, monitor, units);
  const std::vector<files::TextRow> table =
      results::comparison_table(parts, units);
  if (!arguments.quiet) {
    std::fputs(for_people(table, units).c_str(), stdout);
  }
  remove_other_surfaces(folder, parts.size());
  write_file(folder / "compare.csv", files::csv_text(table));
  write_file(
      folder / "compare.json",
      json_text(results::comparison_json(parts, units, kProgramVersion), 2) +
          "\n");
  surfaces.keep();
  page::write_report_or_warn(
      folder, {.versions = version_text()}, &monitor,
      [](const std::string& warning) { warn({warning}); });
  if (!arguments.quiet) {
    std::printf("written to %s\n", (folder / "compare.json").c_str());
  }
}

}  // namespace

int compare_command(const CompareArguments& arguments) {
  catch_stop_signals();
  TerminalMonitor monitor(
      {.style = arguments.quiet ? MonitorStyle::Quiet : MonitorStyle::Automatic,
       .stop = [] { return stop_signal() != 0; }});
  Surfaces surfaces(arguments.out, arguments.parts.size());
  return exit_code_of(
      {on<IoError>(kExitWrongInput), on<MeshError>(kExitNoSolution),
       on<SolverError>(kExitNoSolution)},
      [&] {
        compare(arguments, surfaces, monitor);
        return kExitDone;
      });
}

}  // namespace meniscus::app
