#include "io/file_notes.h"

#include <algorithm>

namespace meniscus::io {

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

std::string one_word(const std::string& name) {
  const std::string line = one_line(name);
  const std::size_t first = line.find_first_not_of(' ');
  if (first == std::string::npos) {
    return "unnamed";
  }
  std::string word = line.substr(first, line.find_last_not_of(' ') + 1 - first);
  std::replace(word.begin(), word.end(), ' ', '_');
  return word;
}

std::vector<std::string> comment_lines(const FileNotes& notes) {
  std::vector<std::string> lines;
  const auto add = [&](const char* what, const std::string& text) {
    if (!text.empty()) {
      lines.push_back(one_line(what + text));
    }
  };
  add("written by ", notes.program);
  add("case: ", notes.title);
  add("unit of length: ", notes.unit);
  add("units: ", notes.unit_system);
  for (const std::string& line : notes.lines) {
    add("", line);
  }
  return lines;
}

}  // namespace meniscus::io
