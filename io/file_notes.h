/// What a file for another program says of itself beside its geometry.
#pragma once

#include <string>
#include <vector>

namespace meniscus::io {

struct FileNotes {
  std::string program;             // with its version: "Meniscus 0.1.0"
  std::string title;               // of the case
  std::string unit;                // of lengths: "mm", "m", "in"
  std::string unit_system;         // of all else: "mm-N-MPa"
  std::vector<std::string> lines;  // more, one each: "support_x = 12.3"
};

/// The notes as single lines of printable text, for comments; what is empty is
/// left out.
std::vector<std::string> comment_lines(const FileNotes& notes);

/// Control characters, line ends too, become spaces.
std::string one_line(std::string text);

/// Names that readers take: one_line(), without spaces at either end and with
/// '_' for those within; "unnamed" for nothing.
std::string one_word(const std::string& name);

}  // namespace meniscus::io
