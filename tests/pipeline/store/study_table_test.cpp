#include "pipeline/store/study_table.h"

#include <gtest/gtest.h>

namespace meniscus::study_table_test {
namespace {

std::vector<store::EvaluationRecord> two_records() {
  store::EvaluationRecord first;
  first.number = 1;
  first.phase = "start";
  first.input_names = {"support_x"};
  first.inputs = VectorX::Constant(1, 0.1);
  first.response_names = {"left, \"mean\"", "right"};
  first.responses.resize(2);
  first.responses << 1.0 / 3.0, 2.5;
  first.mismatch = 0.25;
  first.seconds = {{"film", 0.5}, {"fea", 1.0}};
  store::EvaluationRecord second;
  second.number = 2;
  second.phase = "step";
  second.input_names = {"support_x"};
  second.inputs = VectorX::Constant(1, 40.0);
  second.response_names = first.response_names;
  second.failure = Failure{FailureKind::FilmPinched, "neck, near\n\"left\""};
  return {first, second};
}

TEST(StudyTable, CsvQuotesAndKeepsEveryDigit) {
  EXPECT_EQ(store::history_csv(two_records()),
            "evaluation,support_x,\"left, \"\"mean\"\"\",right,mismatch,status,"
            "seconds,phase,message\n"
            "1,0.1,0.3333333333333333,2.5,0.25,ok,1.5,start,\n"
            "2,40,,,,film_pinched,0,step,\"neck, near\n\"\"left\"\"\"\n");
}

TEST(StudyTable, CsvOfNothingHasItsHead) {
  EXPECT_EQ(store::history_csv({}),
            "evaluation,mismatch,status,seconds,phase,message\n");
}

TEST(StudyTable, TextIsAligned) {
  const std::string text = store::study_table_text(two_records());
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  ASSERT_GE(lines.size(), 4U);
  EXPECT_EQ(lines[0].size(), lines[1].size());
  EXPECT_EQ(lines[0].size(), lines[2].size());
  EXPECT_EQ(lines[3].substr(0, 7), "2: neck");
}

}  // namespace
}  // namespace meniscus::study_table_test
