#include "pipeline/store/study_table.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/files/named_values.h"

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

store::EvaluationRecord record_of_vector() {
  store::EvaluationRecord record;
  record.number = 1;
  record.phase = "start";
  record.input_names = {"a", "t[1,1]", "t[1,2]", "t[2,1]", "t[2,2]"};
  record.inputs.resize(5);
  record.inputs << 7, 0.5, -3, 12, 4;
  record.response_names = {"mass"};
  record.responses = VectorX::Constant(1, 1.0);
  return record;
}

TEST(StudyTable, CsvHasAColumnForEachElementAndPeopleOneForAll) {
  const std::string csv = store::history_csv({record_of_vector()});
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "evaluation,a,\"t[1,1]\",\"t[1,2]\",\"t[2,1]\",\"t[2,2]\",mass,"
            "mismatch,status,seconds,phase,message");
  const std::string text =
      store::study_table_text({record_of_vector()}, {{"a", "mm"},
                                                     {"t[1,1]", "mm"},
                                                     {"t[1,2]", "mm"},
                                                     {"t[2,1]", "mm"},
                                                     {"t[2,2]", "mm"}});
  EXPECT_EQ(text,
            "evaluation  a [mm]    t [mm]  mass  mismatch  status  seconds  "
            "phase\n"
            "         1       7  -3 to 12     1                ok        0  "
            "start\n");
}

TEST(NamedValues, NestTheElementsOfVectors) {
  const store::EvaluationRecord record = record_of_vector();
  const nlohmann::ordered_json json =
      files::named_json(record.input_names, record.inputs);
  EXPECT_EQ(json.dump(), R"({"a":7.0,"t":[[0.5,-3.0],[12.0,4.0]]})");
  for (std::size_t k = 0; k < record.input_names.size(); ++k) {
    const auto* value = files::find_named(json, record.input_names[k]);
    ASSERT_NE(value, nullptr);
    EXPECT_EQ(value->get<double>(),
              record.inputs[static_cast<Eigen::Index>(k)]);
  }
  for (const char* name :
       {"b", "t[3,1]", "t[1,3]", "t[1,1,1]", "a[1]", "t[0,1]", "t[", "u[1]"}) {
    EXPECT_EQ(files::find_named(json, name), nullptr) << name;
  }
  EXPECT_TRUE(files::find_named(json, "t[1]")->is_array());
  EXPECT_EQ(files::find_named(nlohmann::ordered_json(3), "t"), nullptr);
  EXPECT_EQ(files::named_json({"a"}, VectorX()).dump(), "{}");
}

}  // namespace
}  // namespace meniscus::study_table_test
