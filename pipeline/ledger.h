/// What a design costs: from a few curves to megabytes of files, stage by
/// stage.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/forward_model.h"

namespace meniscus {

/// What stands before or after a stage.
struct LedgerAmount {
  double elements = 0.0;       // curves, facets or tetrahedra
  std::optional<double> area;  // [length^2] of films and caps; none of curves
  double bytes = 0.0;          // in memory, of files on the disk
};

struct LedgerStage {
  std::string name;
  LedgerAmount before;
  LedgerAmount after;
  std::optional<double> operations;  // of floating point; none: not counted
  std::optional<double> seconds;     // none: within the next stage
};

struct FileBytes {
  std::string name;
  double bytes = 0.0;
  bool written = true;  // in the run's folder; else as `meniscus export` would,
                        // or did elsewhere
};

/// One evaluation of the best design, and what was done once before it.
struct Ledger {
  std::vector<LedgerStage> stages;
  double input_bytes = 0.0;      // the case file
  std::vector<FileBytes> files;  // of the same part
};

struct RunResult;

/// Of a run whose best design was evaluated, after its files are in `folder`,
/// those that export_part() wrote for it among them; `fields`: of that design.
/// Operations: docs/theory.md, Counting work.
Ledger make_ledger(const Case& input, const RunResult& result,
                   const EvaluationFields& fields,
                   const std::filesystem::path& folder,
                   const std::vector<std::filesystem::path>& exported = {});

/// Puts an exported file into the ledger of FOLDER/result.json, in the place of
/// what stood there under its name: the file's own where it lies in the folder,
/// else `name`. Nothing happens where there is no result with a ledger or it
/// cannot be written: an export does not need one.
void note_file(const std::filesystem::path& folder,
               const std::filesystem::path& file, const std::string& name);

/// The part `ledger` of result.json (docs/results.md).
nlohmann::ordered_json ledger_json(const Ledger& ledger);

/// A line per stage and one for the files, for people.
std::string ledger_text(const Ledger& ledger, const std::string& length_unit);

}  // namespace meniscus
