// What a study's database says of films that join in another way.
#include "pipeline/store/topology_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/case_text.h"

namespace meniscus::topology_events_test {
namespace {

using testing::HasSubstr;

store::EvaluationRecord record(int number, double foot,
                               std::optional<FailureKind> kind) {
  store::EvaluationRecord record;
  record.number = number;
  record.inputs = VectorX::Constant(1, foot);
  if (kind) {
    record.failure = Failure{*kind, "told of " + std::to_string(number)};
  }
  return record;
}

TEST(TopologyEvents, TellOfTheNearestDesignOfEachKind) {
  const case_data::Case input =  // foot from 20 to 32, frozen at 25
      *reader::read_case_text(strut(), "case.toml").input;
  const std::vector<store::TopologyEvent> events = store::topology_events(
      input, {record(1, 25, {}), record(2, 31, FailureKind::FilmRejoins),
              record(3, 29, FailureKind::FilmRejoins),
              record(4, 26, FailureKind::FilmNotFound),
              record(5, 21, FailureKind::FilmPinched)});
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, FailureKind::FilmRejoins);
  EXPECT_EQ(events[0].designs, 2);
  EXPECT_EQ(events[0].evaluation, 3);
  EXPECT_EQ(events[0].design[0], 29.0);
  EXPECT_EQ(events[0].message, "told of 3");
  EXPECT_EQ(events[1].kind, FailureKind::FilmPinched);
  EXPECT_EQ(events[1].evaluation, 5);
  EXPECT_THAT(store::event_text(input, events[0]),
              HasSubstr("films join in another way at 2 designs, nearest to "
                        "the start at evaluation 3 (foot = 29"));
  EXPECT_TRUE(store::topology_events(input, {record(1, 25, {})}).empty());
}

}  // namespace
}  // namespace meniscus::topology_events_test
