/// A finished run's part, written for another program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"

namespace meniscus::results {

class ExportJob;

/// One line of the table of formats.
struct ExportFormat {
  const char* name;       // as --format takes it
  const char* extension;  // of its files
  const char* what;       // for --help and messages: "surface for slicers"
  bool of_film;           // of the film's own mesh; else of the elements
  void (*write)(ExportJob& job, const std::filesystem::path& file);
};

/// All of them, in the order in which they are listed.
const std::vector<ExportFormat>& export_formats();

/// Their names: "stl, 3mf, ...".
std::string export_format_names();

/// How the warning of a run begins that lacks a format it was asked for.
inline constexpr const char* kNotWritten = "not written as ";

struct ExportOptions {
  std::string format = "stl";   // of export_formats()
  std::optional<double> edge;   // [length]; the run's own when absent
  std::filesystem::path out;    // file; empty: part_<edge>.<format> in the run,
                                // which goes with the run's own files
  std::string program_version;  // for the file's head
  Monitor* monitor = nullptr;
};

/// Settles and, where the format is of elements, meshes the answer of the study
/// in `folder` again, which is the same bits when no edge is given, and writes
/// it; its bytes go into the ledger of the run's result.json. Returns the file.
/// Throws IoError (no study there, file), InvalidInput (unknown format, no
/// finished evaluation), MeshError (no film or mesh at that edge).
std::filesystem::path export_part(const std::filesystem::path& folder,
                                  const ExportOptions& options);

}  // namespace meniscus::results
