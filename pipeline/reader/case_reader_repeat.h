/// `repeat`: one entry of the file that stands for many. Part of the case-file
/// reader.
#pragma once

#include <string>
#include <vector>

#include "pipeline/reader/case_reader_fields.h"

namespace meniscus::reader {

/// What `repeat` says in `node`, which is of `path`: one to three counts, each
/// a whole number or a constant expression of one. Empty with a problem noted.
std::vector<int> read_counts(CaseContext& context, const toml::node& node,
                             const std::string& path);

/// The indices of each copy, from 1, the last running fastest, after those that
/// the entry has itself; `before` alone where `counts` is empty. Notes names of
/// the case that i, j, k would hide, and too many copies.
std::vector<std::vector<int>> copies_of(CaseContext& context,
                                        const toml::node& node,
                                        const std::string& path,
                                        const std::vector<int>& counts,
                                        const std::vector<int>& before);

/// The text with each {...} replaced by its value: whole-number arithmetic (+ -
/// * / %, brackets) of i, j, k and the case's constant whole numbers. a % b is
/// of b's sign, so that {i % 12 + 1} follows i around twelve. Notes what is
/// wrong at `line`.
std::string filled(CaseContext& context, const std::string& text,
                   const std::vector<int>& indices, case_data::SourceLine line,
                   const std::string& path);

}  // namespace meniscus::reader
