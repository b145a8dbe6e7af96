/// The reference and the editors' schema are what the reader's table says.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "pipeline/case_schema.h"

namespace meniscus {
namespace {

const std::string kDocs = MENISCUS_SOURCE_DIR "/docs/";

TEST(CaseDocs, TheReferenceHoldsTheTables) {
  std::string tables = schema_markdown();
  tables.erase(tables.find_last_not_of('\n') + 1);
  EXPECT_NE(read_file(kDocs + "case-file.md").find(tables), std::string::npos)
      << "write this at the end of docs/case-file.md:\n"
      << tables;
}

TEST(CaseDocs, TheSchemaFileIsWhatTheTableGives) {
  EXPECT_EQ(read_file(kDocs + "case.schema.json"), json_schema());
  const auto schema = nlohmann::json::parse(json_schema());
  for (const char* table : {"curves", "films", "bodies", "load_cases"}) {
    EXPECT_TRUE(schema["properties"].contains(table)) << table;
  }
}

}  // namespace
}  // namespace meniscus
