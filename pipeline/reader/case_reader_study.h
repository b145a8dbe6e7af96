/// Parts of the reader of [study], by kind of study.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

/// The study's method, the usual one when left out.
void read_method(CaseContext& context, const CaseTable& table,
                 case_data::StudyEntry& study);

/// Notes keys that belong to another kind of study and what this kind lacks.
/// To analyse is to leave a study's work for later, and its keys wait; so do
/// the file's where --set asks for another kind.
void check_keys(CaseContext& context, const CaseTable& table,
                const std::string& kind);

/// What a sweep looks at; after the method.
void read_sweep(CaseContext& context, const CaseTable& table,
                case_data::Case& result);

/// Standard deviations and samples; after the method.
void read_tolerance(CaseContext& context, const CaseTable& table,
                    case_data::Case& result);

/// Index of the response with that name; nothing, and a note, without one.
std::optional<int> find_response(CaseContext& context,
                                 const case_data::Case& result,
                                 const std::string& name,
                                 case_data::SourceLine line);

/// A constant of the dimension `measure`, if that is known and the text says
/// one; else a note and nothing.
std::optional<double> read_like(CaseContext& context, const toml::node& node,
                                const Measure& measure, const std::string& key);

/// The two objectives and the number of points; before the constraints.
void read_front(CaseContext& context, const CaseTable& table,
                case_data::Case& result);

}  // namespace meniscus::reader
