/// Names as CalculiX takes them (internal to the deck writer).
#pragma once

#include <string>
#include <vector>

namespace meniscus {

/// Distinct deck names for the given ones, in order: capitals, digits and '_'.
std::vector<std::string> deck_names(const std::vector<std::string>& names);

}  // namespace meniscus
