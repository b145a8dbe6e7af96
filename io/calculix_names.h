/// Names as CalculiX takes them (internal to the deck writer).
#pragma once

#include <string>
#include <vector>

namespace meniscus {

/// Distinct deck names for the given ones, in order: capitals, digits and '_'.
std::vector<std::string> deck_names(const std::vector<std::string>& names);

/// One line, so that a title cannot smuggle in keywords.
std::string one_line(std::string text);

}  // namespace meniscus
