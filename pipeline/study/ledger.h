/// What a design costs: from a few curves to megabytes of files, stage by
/// stage (pipeline/results/make_ledger.h fills it in).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace meniscus::study {

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

/// The part `ledger` of result.json (docs/results.md).
nlohmann::ordered_json ledger_json(const Ledger& ledger);

}  // namespace meniscus::study
