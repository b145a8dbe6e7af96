/// The kinds of study, one row each: what a case says of one and what the rest
/// of the program asks about it; pipeline/study/run_kind does them.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

struct StudyRow {
  const char* name;
  StudyKind kind;
  std::vector<std::string> keys;     // of [study], beside those of all kinds
  std::vector<std::string> methods;  // in the order of messages
  const char* usual_method;
  const char* outer_stage;  // of the monitor, around the evaluations' own
  /// As studied_responses(); null: none.
  std::vector<int> (*responses)(const Case& input);
  /// As asks_for_gradients(); null: never.
  bool (*gradients)(const StudyEntry& study);
  /// Evaluations that it asks for at most, where that is known; null: never.
  int (*planned)(const StudyEntry& study);
};

/// All of them, in the order of the reference.
const std::vector<StudyRow>& study_kinds();

const StudyRow& row_of(StudyKind kind);

}  // namespace meniscus::case_data
