#include "report/page/packed_array.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace meniscus::page {

using Json = nlohmann::ordered_json;

namespace {

constexpr int kSteps = 65534;       // between the least and the largest
constexpr int kNotANumber = 65535;  // the level that is left

void append(std::string& bytes, std::uint32_t value, int size) {
  for (int k = 0; k < size; ++k) {
    bytes.push_back(static_cast<char>((value >> (8 * k)) & 0xFFU));
  }
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * ((bytes.size() + 2) / 3));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool there = i + k < bytes.size();
      group = (group << 8U) |
              (there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool there = i + k <= bytes.size();
      text.push_back(there ? kDigits[(group >> (18U - 6U * k)) & 63U] : '=');
    }
  }
  return text;
}

Json pack_reals(const std::vector<double>& values, int components) {
  const auto width = static_cast<std::size_t>(std::max(components, 1));
  if (components < 1 || values.size() % width != 0) {
    throw InvalidInput(fmt::format("{} values are no multiple of {} components",
                                   values.size(), components));
  }
  std::vector<double> low(width, std::numeric_limits<double>::infinity());
  std::vector<double> high(width, -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) {
      low[i % width] = std::min(low[i % width], values[i]);
      high[i % width] = std::max(high[i % width], values[i]);
    }
  }
  std::vector<double> step(width, 0.0);
  for (std::size_t c = 0; c < width; ++c) {
    low[c] = std::isfinite(low[c]) ? low[c] : 0.0;
    step[c] = std::isfinite(high[c]) ? (high[c] - low[c]) / kSteps : 0.0;
  }
  std::string bytes;
  bytes.reserve(2 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t c = i % width;
    int level = kNotANumber;
    if (std::isfinite(values[i])) {
      level = step[c] > 0.0 ? std::clamp(static_cast<int>(std::lround(
                                             (values[i] - low[c]) / step[c])),
                                         0, kSteps)
                            : 0;
    }
    append(bytes, static_cast<std::uint32_t>(level), 2);
  }
  return {{"type", "q16"},
          {"components", components},
          {"offset", low},
          {"step", step},
          {"data", base64(bytes)}};
}

Json pack_ids(const std::vector<int>& ids) {
  const int most = ids.empty() ? 0 : *std::max_element(ids.begin(), ids.end());
  constexpr int kByte = 0xFF;
  constexpr int kTwoBytes = 0xFFFF;
  const int size = most <= kByte ? 1 : most <= kTwoBytes ? 2 : 4;
  std::string bytes;
  bytes.reserve(ids.size() * static_cast<std::size_t>(size));
  for (const int id : ids) {
    append(bytes, static_cast<std::uint32_t>(id), size);
  }
  return {{"type", size == 1   ? "u8"
                   : size == 2 ? "u16"
                               : "u32"},
          {"data", base64(bytes)}};
}

}  // namespace meniscus::page
