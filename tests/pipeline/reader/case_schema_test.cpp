#include "pipeline/reader/case_schema.h"

#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include "pipeline/case_data/response_kinds.h"
#include "pipeline/case_data/study_kinds.h"
#include "pipeline/results/export_part.h"
#include "pipeline/results/new_case.h"
#include "tests/support/case_text.h"

namespace meniscus::case_schema_test {
namespace {

using nlohmann::json;

/// What of `value` breaks `schema`, of the keywords that json_schema() uses.
void validate(const json& schema, const json& value, const std::string& path,
              std::vector<std::string>& problems) {
  const auto is = [&](const std::string& type) {
    return (type == "object" && value.is_object()) ||
           (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) ||
           (type == "boolean" && value.is_boolean()) ||
           (type == "integer" && value.is_number_integer()) ||
           (type == "number" && value.is_number());
  };
  if (schema.contains("type")) {
    const json types = schema["type"].is_array()
                           ? schema["type"]
                           : json::array({schema["type"]});
    if (std::none_of(types.begin(), types.end(), is)) {
      problems.push_back(path + ": type");
      return;
    }
  }
  if (schema.contains("enum") &&
      std::find(schema["enum"].begin(), schema["enum"].end(), value) ==
          schema["enum"].end()) {
    problems.push_back(path + ": enum");
  }
  if (value.is_array()) {
    if (value.size() < schema.value("minItems", std::size_t{0}) ||
        value.size() > schema.value("maxItems", std::size_t{1000})) {
      problems.push_back(path + ": size");
    }
    for (const json& item : value) {
      validate(schema.value("items", json::object()), item, path + "[]",
               problems);
    }
  }
  const json any = schema.value("anyOf", json::array());
  if (!any.empty() &&
      std::none_of(any.begin(), any.end(), [&](const json& one) {
        std::vector<std::string> found;
        validate(one, value, path, found);
        return found.empty();
      })) {
    problems.push_back(path + ": none of anyOf");
  }
  if (!value.is_object()) {
    return;
  }
  for (const json& key : schema.value("required", json::array())) {
    if (!value.contains(key.get<std::string>())) {
      problems.push_back(path + ": needs " + key.get<std::string>());
    }
  }
  for (const auto& [key, item] : value.items()) {
    const json properties = schema.value("properties", json::object());
    const json others = schema.value("additionalProperties", json(true));
    if (properties.contains(key)) {
      validate(properties[key], item, path + "." + key, problems);
    } else if (others.is_object()) {
      validate(others, item, path + "." + key, problems);
    } else if (others == false) {
      problems.push_back(path + ": unknown " + key);
    }
  }
}

std::vector<std::string> against_schema(const std::string& text) {
  std::ostringstream stream;
  stream << toml::json_formatter(toml::parse(std::string_view(text)));
  std::vector<std::string> problems;
  validate(json::parse(reader::json_schema()), json::parse(stream.str()), "",
           problems);
  return problems;
}

std::string file_text(const std::string& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(JsonSchema, AcceptsTheCasesThatTheReaderAccepts) {
  EXPECT_THAT(against_schema(file_text(two_arm_path())), testing::IsEmpty());
  EXPECT_THAT(against_schema(results::new_case_text("x")), testing::IsEmpty());
  EXPECT_THAT(against_schema(strut()), testing::IsEmpty());
  const std::string analysis =
      "[analysis]\nadapt = true\nexclude = [\n"
      "  { near = \"foot_pad\", distance = \"5 mm\" },\n"
      "  { center = [0, 0, \"length\"], radius = 7 },\n"
      "  { low = [-1, -2, -3], high = [1, 2, 3] }]\n"
      "solver = \"petsc\"\nprocesses = 4\n";
  EXPECT_THAT(problems_of(strut() + analysis), testing::IsEmpty());
  EXPECT_THAT(against_schema(strut() + analysis), testing::IsEmpty());
  EXPECT_THAT(
      against_schema(tube("films = [\"skin\"]\nthickness = \"z + 1\"\n")),
      testing::IsEmpty());
}

TEST(JsonSchema, KnowsVectorsOfDesignVariables) {
  const std::string text = petal_strut();
  EXPECT_THAT(against_schema(text), testing::IsEmpty());
  EXPECT_THAT(against_schema(changed(
                  changed(text, "initial = 25.0",
                          "initial = [[21, \"22 mm\", 23], [24, 25, 26]]"),
                  "bounds = [20.0, 32.0]",
                  "bounds = [20, [[27, 28, 29], [30, 31, \"3.2 cm\"]]]")),
              testing::IsEmpty());
  for (const char* shape : {"\"six\"", "[]", "[2, 3.5]", "[1, 1, 2, 3]"}) {
    EXPECT_THAT(against_schema(changed(text, "shape = [2, 3]",
                                       std::string("shape = ") + shape)),
                testing::ElementsAre(".design.t.shape: none of anyOf"))
        << shape;
  }
  for (const char* bounds : {"[20]", "20", "[true, 3]"}) {
    EXPECT_THAT(against_schema(changed(text, "bounds = [20.0, 32.0]",
                                       std::string("bounds = ") + bounds)),
                testing::Not(testing::IsEmpty()))
        << bounds;
  }
}

TEST(JsonSchema, RefusesWhatTheReaderRefuses) {
  using testing::ElementsAre;
  EXPECT_THAT(against_schema(changed(strut(), "volume", "volme")),
              ElementsAre(".bodies.part: unknown volme"));
  EXPECT_THAT(against_schema(changed(strut(), "\"branch\"", "\"x\"")),
              ElementsAre(".films.skin.kind: enum"));
  EXPECT_THAT(against_schema(changed(strut(), "[0, 0, 0]", "[0, 0]")),
              ElementsAre(".curves.base.center: size"));
  EXPECT_THAT(against_schema(changed(strut(), "radius = 20", "radius = true")),
              ElementsAre(".curves.head.radius: type"));
  EXPECT_THAT(against_schema(strut() + "[analysis]\nadapt = 1\n"),
              ElementsAre(".analysis.adapt: type"));
  EXPECT_THAT(against_schema(changed(strut(), "title = \"A strut\"", "")),
              ElementsAre(": needs title"));
  EXPECT_THAT(against_schema(changed(strut(), "[materials", "[material")),
              testing::Contains(": none of anyOf"));
}

TEST(CaseTables, AreFoundByName) {
  EXPECT_EQ(reader::find_key(reader::case_table("bodies"), "volume")->dimension,
            Dimension::Volume);
  EXPECT_EQ(reader::find_key(reader::case_table("bodies"), "volme"), nullptr);
  EXPECT_THAT(reader::split_choices("a|bc|d"),
              testing::ElementsAre("a", "bc", "d"));
  EXPECT_THAT(reader::split_choices(""), testing::IsEmpty());
  EXPECT_TRUE(reader::is_later_table("regions"));
  EXPECT_FALSE(reader::is_later_table("walls"));
}

TEST(CaseSchema, TheReferenceIsCurrent) {
  EXPECT_THAT(file_text(MENISCUS_SOURCE_DIR "/docs/case-file.md"),
              testing::EndsWith(reader::schema_markdown()));
}

TEST(CaseSchema, TheFileForEditorsIsCurrent) {
  EXPECT_EQ(file_text(MENISCUS_SOURCE_DIR "/docs/case.schema.json"),
            reader::json_schema());
}

/// Each row has its own name, and keys that the table knows.
template <class Row>
void expect_rows_of(const std::string& table, const std::vector<Row>& rows,
                    std::vector<std::string> (*keys)(const Row&)) {
  std::set<std::string> names;
  for (const Row& row : rows) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(&case_data::row_of(row.kind), &row) << row.name;
    for (const std::string& key : keys(row)) {
      EXPECT_NE(reader::find_key(reader::case_table(table), key), nullptr)
          << table << ": " << row.name << " has " << key;
    }
  }
}

TEST(CaseKinds, HaveKeysThatTheirTableKnows) {
  expect_rows_of<case_data::ResponseRow>(
      "responses", case_data::response_kinds(),
      [](const case_data::ResponseRow& row) -> std::vector<std::string> {
        std::vector<std::string> keys = row.keys.needed;
        keys.insert(keys.end(), row.keys.optional.begin(),
                    row.keys.optional.end());
        return keys;
      });
  expect_rows_of<case_data::StudyRow>(
      "study", case_data::study_kinds(),
      [](const case_data::StudyRow& row) -> std::vector<std::string> {
        return row.keys;
      });
}

TEST(CaseKinds, NameTheirUsualMethod) {
  for (const case_data::StudyRow& row : case_data::study_kinds()) {
    EXPECT_THAT(row.methods, testing::Contains(row.usual_method)) << row.name;
  }
  std::vector<std::string> names;
  for (const case_data::StudyRow& row : case_data::study_kinds()) {
    names.emplace_back(row.name);
  }
  EXPECT_THAT(
      names,
      testing::IsSupersetOf(reader::split_choices(
          reader::find_key(reader::case_table("study"), "each")->choices)));
}

TEST(CaseKinds, AreToldAsTheReferenceTellsThem) {
  struct Row {
    const char* name;
    std::string_view doc;
  };
  const std::vector<Row> rows = {{"a", case_data::kWithNext},
                                 {"b", "both"},
                                 {"c", case_data::kSaidElsewhere},
                                 {"d", case_data::kWithNext},
                                 {"e", ""}};
  EXPECT_EQ(case_data::meanings_of(rows), "a, b: both; d, e");
  EXPECT_EQ(case_data::meanings_of(rows, {" (", ")", ", "}),
            "a, b (both), d, e");
  EXPECT_EQ(case_data::choices_of(rows), "a|b|c|d|e");
  EXPECT_STREQ(case_data::row_named(rows, "c").name, "c");
  EXPECT_EQ(reader::either_of({"a", "b", "c"}), "a, b or c");
}

TEST(ExportFormats, StandInTheDocs) {
  const std::string text = file_text(MENISCUS_SOURCE_DIR "/docs/files.md");
  for (const results::ExportFormat& format : results::export_formats()) {
    EXPECT_TRUE(text.find(std::string("| `") + format.name + "` |") !=
                    std::string::npos ||
                text.find(std::string("`--format ") + format.name + "`") !=
                    std::string::npos)
        << format.name;
  }
}

}  // namespace
}  // namespace meniscus::case_schema_test
