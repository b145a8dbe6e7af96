#include "app/terminal.h"

#include <cstdlib>
#include <string_view>
#include <unistd.h>

#include <sys/ioctl.h>

namespace meniscus::app {

namespace {

constexpr int kColumns = 80;  // of a terminal that does not tell

}  // namespace

bool is_terminal(std::FILE* stream) {
  const char* term = std::getenv("TERM");
  return isatty(fileno(stream)) != 0 &&
         (term == nullptr || std::string_view(term) != "dumb");
}

int columns_of(std::FILE* stream) {
  winsize size{};
  const bool told =
      ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return told ? size.ws_col : kColumns;
}

std::string truncate_to(const std::string& text, int columns) {
  std::string line;
  int used = 0;
  for (const char c : text) {
    const bool starts = (c & 0xc0) != 0x80;
    if (starts && ++used > columns) {
      break;
    }
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    line += control ? ' ' : c;
  }
  return line;
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    // Those of the case file's reader name file and line before the word.
    const bool placed = warning.find(": warning: ") != std::string::npos;
    std::fprintf(stderr, "%s%s\n", placed ? "" : "warning: ", warning.c_str());
  }
}

}  // namespace meniscus::app
