#include "io/nastran_fields.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "io/nastran_bdf.h"

namespace meniscus::io {

namespace {

constexpr std::size_t kLong = 16;
constexpr std::size_t kText = 70;
constexpr std::size_t kCaseLine = 70;  // Nastran reads 72
// From here up to 1e14 the plain form has as many digits as with an exponent.
constexpr double kPlainFrom = 1e-2;
constexpr double kPlainTo = 1e14;

std::string card(const std::string& name, std::vector<std::string> fields,
                 std::size_t per_line, int width, const char* more) {
  while (!fields.empty() && fields.back().empty()) {
    fields.pop_back();
  }
  std::string text;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (k % per_line == 0) {
      text += fmt::format("{}{:<8}", k == 0 ? "" : "\n", k == 0 ? name : more);
    }
    text += fmt::format("{:>{}}", fields[k], width);
  }
  return text + "\n";
}

/// "1.5e-09" as "1.5E-9", or "1.5-9" where that is too long.
std::string with_exponent(const std::string& text) {
  const std::size_t e = text.find('e');
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') == std::string::npos) {
    mantissa += '.';
  }
  const int power = std::atoi(text.c_str() + e + 1);
  const std::string full = fmt::format("{}E{:+d}", mantissa, power);
  return full.size() <= kLong ? full : fmt::format("{}{:+d}", mantissa, power);
}

}  // namespace

std::string nastran_real(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find('e') != std::string::npos) {
    text = with_exponent(text);
  } else if (text.find('.') == std::string::npos) {
    text += '.';
  }
  if (text.size() <= kLong) {
    return text;
  }
  const double size = std::abs(value);
  if (size >= kPlainFrom && size < kPlainTo) {
    for (int digits = 15; digits > 0; --digits) {
      std::string plain = fmt::format("{:.{}f}", value, digits);
      const std::size_t zero = size < 1.0 ? plain.find('0') : std::string::npos;
      if (zero != std::string::npos) {
        plain.erase(zero, 1);
      }
      if (plain.size() <= kLong) {
        return plain;
      }
    }
  }
  for (int digits = 14;; --digits) {
    std::string power = with_exponent(fmt::format("{:.{}e}", value, digits));
    if (power.size() <= kLong) {
      return power;
    }
  }
}

std::string long_card(const std::string& name,
                      const std::vector<std::string>& fields) {
  constexpr std::size_t kPerLine = 4;
  return card(name + "*", fields, kPerLine, kLong, "*");
}

std::string short_card(const std::string& name,
                       const std::vector<std::string>& fields) {
  constexpr std::size_t kPerLine = 8;
  return card(name, fields, kPerLine, 8, "+");
}

std::string case_set(int number, const std::vector<int>& members) {
  std::vector<std::string> items;
  for (std::size_t k = 0; k < members.size();) {
    std::size_t last = k;
    while (last + 1 < members.size() &&
           members[last + 1] == members[last] + 1) {
      ++last;
    }
    if (last > k + 1) {
      items.push_back(fmt::format("{} THRU {}", members[k], members[last]));
      k = last + 1;
    } else {
      items.push_back(std::to_string(members[k++]));
    }
  }
  std::string text;
  std::string line = fmt::format("SET {} = ", number);
  for (std::size_t k = 0; k < items.size(); ++k) {
    const std::string item = items[k] + (k + 1 < items.size() ? ", " : "");
    if (line.size() + item.size() > kCaseLine) {
      text += line + "\n";
      line = "    ";
    }
    line += item;
  }
  return text + line + "\n";
}

std::string plain_text(const std::string& text) {
  std::string plain = text.substr(0, kText);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c < ' ' || c > '~'; },
      '_');
  return plain;
}

}  // namespace meniscus::io
