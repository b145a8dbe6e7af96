#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/results/family_table.h"
#include "pipeline/results/results.h"
#include "tests/support/case_text.h"

namespace meniscus::result_json_test {
namespace {

// JSON has no NaN and no infinity; readers stop at them.
TEST(ResultJson, TellsUnknownNumbersAsNull) {
  const case_data::Case input =
      *reader::read_case_text(strut(), "case.toml").input;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double huge = std::numeric_limits<double>::infinity();
  study::RunResult result;
  result.best.emplace();
  result.best->design = VectorX::Constant(1, 25.0);
  result.best->responses = VectorX::Constant(2, nan);
  result.best->film.min_eigenvalue = nan;
  result.best->fea.residual = huge;
  result.objective = nan;
  result.constraints = {{.name = "sway", .value = huge, .bound = 1e-3}};
  result.response_errors = VectorX::Constant(2, -huge);
  result.element_errors.emplace();
  result.element_errors->energy = nan;
  result.element_errors->responses = VectorX::Constant(2, nan);
  result.stress = {{.load_case = "service", .max_von_mises = nan}};
  const std::string text = results::result_json(input, result, "0").dump(2);
  for (const char* bad : {"nan", "NaN", "inf", "Inf"}) {
    EXPECT_EQ(text.find(std::string(" ") + bad), std::string::npos) << text;
  }
  const auto json = nlohmann::json::parse(text);  // strict
  EXPECT_TRUE(json["responses"]["sway"].is_null());
  EXPECT_TRUE(json["response_errors"]["mass"].is_null());
  EXPECT_TRUE(json["film"]["min_eigenvalue"].is_null());
  EXPECT_TRUE(json["stress"]["service"]["max_von_mises"].is_null());
}

TEST(ResultJson, HasVectorsAsNestedArraysAndPeopleOneRow) {
  const case_data::Case input = case_of(petal_strut());
  study::RunResult result;
  result.best.emplace();
  result.best->design.resize(6);
  result.best->design << 20, 21, 22, 23, 32, 32;
  result.best->responses = VectorX::Constant(2, 1.0);
  result.design_errors.resize(6);
  result.design_errors << 0.5, 0.25, 1, 2, 0.125, 0.75;
  result.start = result.best;
  const auto json = results::result_json(input, result, "0");
  const auto nested = nlohmann::json::parse("[[20, 21, 22], [23, 32, 32]]");
  EXPECT_EQ(json["parameters"]["t"], nested);
  EXPECT_EQ(json["start"]["parameters"]["t"], nested);
  EXPECT_EQ(json["parameter_errors"]["t"][1][0], 2.0);
  EXPECT_EQ(json["parameters"]["load"], 1000.0);
  const std::string text = results::result_text(input, result);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "  t [2 x 3]            20 to 32, mean 25  +- up to 2   1 at their "
            "lower bound   2 at their upper bound");
  // A family's table reads it back.
  const results::FamilyRow row = results::family_row(input, json);
  ASSERT_EQ(row.design.size(), 6U);
  EXPECT_EQ(row.design[4].first, "t[2,2]");
  EXPECT_EQ(row.design[4].second, 32.0);
  EXPECT_EQ(row.at_bound,
            (std::vector<std::string>{"t (1 lower)", "t (2 upper)"}));
  results::FamilyResult family;
  family.rows = {row};
  EXPECT_EQ(
      results::family_json(input, family, "0")["members"][0]["design"]["t"],
      nested);
  const std::string table =
      results::family_table_text(results::family_csv(family.rows));
  EXPECT_NE(table.find("20 to 32"), std::string::npos) << table;
  EXPECT_EQ(table.find("t[1,1]"), std::string::npos) << table;
}

}  // namespace
}  // namespace meniscus::result_json_test
