#include "evolve/datafile/fe_format.h"

#include <array>
#include <cstdio>

namespace meniscus::datafile {

namespace {

constexpr std::size_t kLongestConversion = 12;  // "%+020.15f"

// At a '%': its text up to the letter; empty when it is not known.
std::string conversion_at(const std::string& format, std::size_t at) {
  const std::size_t end = format.find_first_not_of("+- #0123456789.l", at + 1);
  if (end == std::string::npos || end - at > kLongestConversion ||
      std::string("dieEfFgG").find(format[end]) == std::string::npos) {
    return "";
  }
  return format.substr(at, end - at + 1);
}

std::string converted(std::string conversion, double value) {
  std::erase(conversion, 'l');
  char& letter = conversion.back();
  if (letter == 'd' || letter == 'i') {
    letter = '0';
    conversion.insert(conversion.size() - 1, ".");
    conversion += 'f';
  }
  std::array<char, 512> buffer{};
  std::snprintf(buffer.data(), buffer.size(), conversion.c_str(), value);
  return buffer.data();
}

}  // namespace

std::optional<std::string> fe_formatted(const std::string& format,
                                        const std::vector<double>& values) {
  std::string result;
  std::size_t next = 0;
  for (std::size_t k = 0; k < format.size(); ++k) {
    if (format[k] == '\\' && k + 1 < format.size()) {
      ++k;
      result += format[k] == 'n' ? '\n' : format[k] == 't' ? '\t' : format[k];
    } else if (format[k] != '%') {
      result += format[k];
    } else if (k + 1 < format.size() && format[k + 1] == '%') {
      result += '%';
      ++k;
    } else {
      const std::string conversion = conversion_at(format, k);
      if (conversion.empty() || next == values.size()) {
        return std::nullopt;
      }
      result += converted(conversion, values[next++]);
      k += conversion.size() - 1;
    }
  }
  return result;
}

std::string lower(std::string text) {
  for (char& c : text) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return text;
}

}  // namespace meniscus::datafile
