#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace meniscus::result_json_test
