#include "io/calculix_names.h"

#include <cctype>
#include <set>

#include <fmt/format.h>

namespace meniscus::io {

namespace {

constexpr std::size_t kNameLength = 60;  // CalculiX reads 80

std::string plain_name(const std::string& name) {
  std::string result;
  for (const char c : name.substr(0, kNameLength)) {
    const auto u = static_cast<unsigned char>(c);
    result += u < 128 && (std::isalnum(u) != 0)
                  ? static_cast<char>(std::toupper(u))
                  : '_';
  }
  if (result.empty() ||
      std::isalpha(static_cast<unsigned char>(result[0])) == 0) {
    result.insert(0, "S_");
  }
  return result;
}

}  // namespace

std::vector<std::string> deck_names(const std::vector<std::string>& names) {
  std::set<std::string> taken = {"NALL", "EALL"};
  std::vector<std::string> result;
  for (const std::string& name : names) {
    const std::string base = plain_name(name);
    std::string candidate = base;
    for (int i = 2; !taken.insert(candidate).second; ++i) {
      candidate = fmt::format("{}_{}", base, i);
    }
    result.push_back(candidate);
  }
  return result;
}

void write_ids(Out out, const std::vector<int>& ids) {
  constexpr std::size_t kPerLine = 12;  // CalculiX reads at most 16
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool last = i + 1 == ids.size() || i % kPerLine == kPerLine - 1;
    fmt::format_to(out, "{}{}", ids[i] + 1, last ? "\n" : ", ");
  }
}

}  // namespace meniscus::io
