/// Names as CalculiX takes them, and what its deck is written to (internal to
/// the deck writer).
#pragma once

#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace meniscus::io {

using Out = std::back_insert_iterator<fmt::memory_buffer>;

/// Distinct deck names for the given ones, in order: capitals, digits and '_'.
std::vector<std::string> deck_names(const std::vector<std::string>& names);

/// Numbers from 0 as CalculiX counts them, on lines of a set.
void write_ids(Out out, const std::vector<int>& ids);

}  // namespace meniscus::io
