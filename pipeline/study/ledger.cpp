#include "pipeline/study/ledger.h"

#include <nlohmann/json.hpp>

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;

Json amount_json(const LedgerAmount& amount) {
  return {{"elements", amount.elements},
          {"area", amount.area ? Json(*amount.area) : Json()},
          {"bytes", amount.bytes}};
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

}  // namespace meniscus::study
