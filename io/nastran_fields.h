/// Cards of bulk data field by field (internal to the Nastran writer).
#pragma once

#include <string>
#include <vector>

namespace meniscus::io {

/// What stands on a card after its name, a text each.
using Fields = std::vector<std::string>;

/// A card in long fields: four of 16 characters a line. Trailing empty fields
/// are left out.
std::string long_card(const std::string& name,
                      const std::vector<std::string>& fields);

/// A card in short fields: eight of 8 characters a line.
std::string short_card(const std::string& name,
                       const std::vector<std::string>& fields);

/// "SET 3 = 1, 4 THRU 9, ..." of ascending numbers, lines of at most 72.
std::string case_set(int number, const std::vector<int>& members);

/// Printable ASCII, for titles and comments; at most 70 characters.
std::string plain_text(const std::string& text);

}  // namespace meniscus::io
