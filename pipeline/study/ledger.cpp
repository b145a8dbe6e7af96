#include "pipeline/study/ledger.h"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;

// and its label

Json amount_json(const LedgerAmount& amount) {
  return {{"elements", amount.elements},
          {"area", amount.area ? Json(*amount.area) : Json()},
          {"bytes", amount.bytes}};
}

std::string size_text(double bytes) {
  constexpr std::array<const char*, 4> kUnits = {"byte", "kB", "MB", "GB"};
  std::size_t unit = 0;
  while (bytes >= 1000.0 && unit + 1 < kUnits.size()) {
    bytes /= 1000.0;
    ++unit;
  }
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

}  // namespace

nlohmann::ordered_json ledger_json(const Ledger& ledger) {
  Json stages = Json::array();
  for (const LedgerStage& stage : ledger.stages) {
    stages.push_back(
        {{"name", stage.name},
         {"before", amount_json(stage.before)},
         {"after", amount_json(stage.after)},
         {"operations", stage.operations ? Json(*stage.operations) : Json()},
         {"seconds", stage.seconds ? Json(*stage.seconds) : Json()}});
  }
  Json files = Json::array();
  for (const FileBytes& file : ledger.files) {
    files.push_back({{"name", file.name},
                     {"bytes", file.bytes},
                     {"written", file.written}});
  }
  return {{"stages", stages},
          {"input_bytes", ledger.input_bytes},
          {"files", files}};
}

std::string ledger_text(const Ledger& ledger, const std::string& length_unit) {
  std::string text;
  for (const LedgerStage& stage : ledger.stages) {
    if (stage.operations && stage.seconds && *stage.seconds > 0.0) {
      text += fmt::format(
          "  {:<12} {:.3g} -> {:.3g} elements, {:.3g} operations in {:.3g} s "
          "({:.2g} a second)\n",
          stage.name, stage.before.elements, stage.after.elements,
          *stage.operations, *stage.seconds,
          *stage.operations / *stage.seconds);
    }
  }
  double bytes = 0.0;
  for (const FileBytes& file : ledger.files) {
    bytes += file.written ? file.bytes : 0.0;
  }
  const LedgerStage& first = ledger.stages.front();
  text += fmt::format(
      "  from {} of case, {:.0f} curves, to {} of files of a part of {:.4g} "
      "{}2\n",
      size_text(ledger.input_bytes), first.before.elements, size_text(bytes),
      ledger.stages[1].after.area.value_or(0.0), length_unit);
  return text;
}

}  // namespace meniscus::study
