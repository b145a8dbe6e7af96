/// A case as the study database keeps it: path, text and overrides, so that
/// the part can be made again from the results folder alone.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"

namespace meniscus::store {

/// For StudyMeta::case_text (JSON).
std::string stored_case(const case_data::Case& input);

/// The case back. Throws IoError when the study holds none that can be read.
case_data::Case restore_case(const StudyMeta& meta);

/// Units of the responses, and of variables and parameters whose case says
/// them, by name, of the run in `folder` or of a family's
/// first member there; none where that has no case that can be read.
std::map<std::string, std::string> stored_units(
    const std::filesystem::path& folder);

/// The incumbent of a study on one of its models: the evaluated design with the
/// least mismatch; of a minimum the one that violates its bounds least, then
/// with the least objective; of an analysis the first. Throws InvalidInput when
/// there is none.
const EvaluationRecord& best_record(
    const case_data::Case& input, const std::vector<EvaluationRecord>& records,
    const std::string& model);
/// On the answering model.
const EvaluationRecord& best_record(
    const case_data::Case& input, const std::vector<EvaluationRecord>& records);

/// The design of the run's answer: that of FOLDER/result.json where the study
/// has it, else of best_record(). Throws as that does.
VectorX answer_of_run(const case_data::Case& input,
                      const std::vector<EvaluationRecord>& records,
                      const std::filesystem::path& folder);

/// The answer of the run in `folder` as "NAME=VALUE" for each design variable
/// that `input` has too, to the bit: overrides that make it the start. Throws
/// IoError (no study there), InvalidInput (no design that was evaluated, none
/// of these variables, other units than the case's).
std::vector<std::string> answer_as_overrides(
    const std::filesystem::path& folder, const case_data::Case& input);

}  // namespace meniscus::store
