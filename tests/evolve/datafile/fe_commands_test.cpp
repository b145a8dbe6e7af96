// The command language, parsed only.
#include "evolve/datafile/fe_commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::fe_commands_test {
namespace {

using ::testing::StartsWith;
using Kind = datafile::FeStatement::Kind;

std::vector<datafile::FeStatement> parse(const std::string& text) {
  return datafile::parse_commands(text, "a.fe", 10);
}

std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "no error";
}

TEST(FeCommands, TellsLettersByCaseAndTakesTheirNumbers) {
  const auto all = parse("G -2; g 5\nr;u;V");
  ASSERT_EQ(all.size(), 5);
  EXPECT_EQ(all[0].name, "G");
  ASSERT_EQ(all[0].values.size(), 1);
  EXPECT_EQ(all[1].name, "g");
  EXPECT_EQ(all[1].values[0].number, 5.0);
  EXPECT_TRUE(all[3].values.empty());
  EXPECT_EQ(all[4].name, "V");
}

TEST(FeCommands, ParsesDefinitionsLoopsAndConditions) {
  const auto all = parse(R"(
gogo := { g 5; { u; V } 3; hessian }
adjust := {
  dvol := -body[1].pressure/slope;
  for ( ii := 1 ; ii <= 20; ii += 1 )
  { if abs(dvol) > .01 then dvol := (dvol < 0) ? -.01 : .01 else break;
    body[1].target += dvol;
  };
  foreach vertex[3].edge ee where ee.x > 0 do
    printf "%g\n", max(vertex, sqrt(x^2)) - sum(facet ff, ff.area);
  do { gogo } while 1;
  set vertex y  y+dvol*z/2 where on_constraint 1;
  unset vertex constraint 1;
  refine edges where on_constraint 1;
  define vertex attribute marker integer; addload datafilename;
  conj_grad off; ii++
}
adjust
)");
  ASSERT_EQ(all.size(), 3);
  EXPECT_EQ(all[0].kind, Kind::Define);
  EXPECT_EQ(all[0].body[1].values[0].number, 3.0);
  std::vector<Kind> kinds;
  for (const datafile::FeStatement& statement : all[1].body) {
    kinds.push_back(statement.kind);
  }
  EXPECT_EQ(kinds, (std::vector<Kind>{
                       Kind::Assign, Kind::For, Kind::Foreach, Kind::DoWhile,
                       Kind::Set, Kind::Unset, Kind::Elements, Kind::Attribute,
                       Kind::AddLoad, Kind::Toggle, Kind::Assign}));
  const datafile::FeStatement& loop = all[1].body[1];
  ASSERT_EQ(loop.body.size(), 3);
  EXPECT_EQ(loop.body[1].name, "+=");
  const datafile::FeStatement& choice = loop.body[2].body[0];
  EXPECT_EQ(choice.kind, Kind::If);
  EXPECT_EQ(choice.body.size(), 2);
  const datafile::FeStatement& set = all[1].body[4];
  EXPECT_EQ(set.name, "y");
  EXPECT_EQ(set.values.size(), 1);
  EXPECT_EQ(set.elements.where.size(), 1);
  EXPECT_EQ(all[1].body[2].elements.variable, "ee");
  EXPECT_EQ(all[2].kind, Kind::Call);
  EXPECT_EQ(all[2].place.line, 10 + 17);
}

TEST(FeCommands, RefusesWhatItDoesNotKnowByNameAndLine) {
  EXPECT_THAT(message_of("g 5\nhesian"),
              StartsWith("a.fe:11:1: command 'hesian' is not known or not "
                         "supported; is 'hessian' meant?"));
  EXPECT_THAT(message_of("gogo := { g 5"),
              StartsWith("a.fe:10:9: the block that starts here has no '}'"));
  EXPECT_THAT(message_of("if 1 g"), StartsWith("a.fe:10:6: 'then'"));
  EXPECT_THAT(message_of("shell \"rm\""), StartsWith("a.fe:10:"));
  EXPECT_THAT(message_of("x := "), StartsWith("a.fe:10:"));
  EXPECT_THAT(message_of(std::string(1000000, '{')),
              StartsWith("a.fe:10:101: commands are nested more"));
  EXPECT_THAT(message_of("aa := " + std::string(1000000, '(')),
              StartsWith("a.fe:10:"));
}

}  // namespace
}  // namespace meniscus::fe_commands_test
