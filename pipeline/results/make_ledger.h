/// From a run to its ledger.
#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/forward/forward_model.h"
#include "pipeline/study/ledger.h"
#include "pipeline/study/study.h"

namespace meniscus::results {

/// Of a run whose best design was evaluated, after its files are in `folder`,
/// those that export_part() wrote for it among them; `fields`: of that design.
/// Operations: docs/theory.md, Counting work.
study::Ledger make_ledger(
    const case_data::Case& input, const study::RunResult& result,
    const forward::EvaluationFields& fields,
    const std::filesystem::path& folder,
    const std::vector<std::filesystem::path>& exported = {});

/// Puts an exported file into the ledger of FOLDER/result.json, in the place of
/// what stood there under its name: the file's own where it lies in the folder,
/// else `name`. Nothing happens where there is no result with a ledger or it
/// cannot be written: an export does not need one.
void note_file(const std::filesystem::path& folder,
               const std::filesystem::path& file, const std::string& name);

}  // namespace meniscus::results
