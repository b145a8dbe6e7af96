#include "pipeline/members/member_file.h"

#include <gtest/gtest.h>

#include "pipeline/files/text_table.h"

namespace meniscus::member_file_test {
namespace {

using Texts = std::vector<std::string>;

TEST(TextTable, CsvComesBackAsItWas) {
  const std::vector<files::TextRow> rows = {
      {"name", "what"}, {"a", "x, \"y\"\nz"}, {"", "last"}};
  const files::CsvRows found = files::parse_csv(files::csv_text(rows));
  ASSERT_EQ(found.rows.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(found.rows[k].cells, rows[k]);
  }
  EXPECT_EQ(found.rows[2].line, 4);  // a cell before it has two lines
  EXPECT_EQ(found.open_quote, 0);
}

TEST(TextTable, OddFilesAreRead) {
  const files::CsvRows found =
      files::parse_csv("\xef\xbb\xbf a , \"b\"\r\n\r\n,\n1,2,");
  ASSERT_EQ(found.rows.size(), 3U);
  EXPECT_EQ(found.rows[0].cells, Texts({"a", "b"}));
  EXPECT_EQ(found.rows[1].cells, Texts({"", ""}));
  EXPECT_EQ(found.rows[2].cells, Texts({"1", "2", ""}));
  EXPECT_TRUE(files::parse_csv("").rows.empty());
  EXPECT_EQ(files::parse_csv("a\nb,\"c\n").open_quote, 2);
}

TEST(TextTable, ColumnsAlignByCharacters) {
  EXPECT_EQ(files::aligned_text({{"a", "bc"}, {"\xc3\xa4\xc3\xb6", "1"}}),
            " a  bc\n\xc3\xa4\xc3\xb6   1\n");
}

TEST(MemberFile, RowsBecomeOverrides) {
  const members::MemberFile file = members::read_member_text(
      "name,length,design.fill.lower,design.fill.upper,\"loads\"\n"
      "a,60,,,\nb-2,70 mm,0.9,1.4,\"[1, 2]\"\n",
      "m.csv");
  EXPECT_EQ(file.problems, Texts());
  ASSERT_EQ(file.members.size(), 2U);
  EXPECT_EQ(file.members[0].overrides, Texts({"length=60"}));
  EXPECT_EQ(file.members[1].name, "b-2");
  EXPECT_EQ(
      file.members[1].overrides,
      Texts({"length=70 mm", "loads=[1, 2]", "design.fill.bounds=[0.9, 1.4]"}));
  EXPECT_EQ(file.members[1].place, "m.csv:3");
}

TEST(MemberFile, OneBoundAloneIsToldByLine) {
  const members::MemberFile file =
      members::read_member_text("name,f.lower,f.upper\na,1,\nb,,2\n", "m.csv");
  ASSERT_EQ(file.problems.size(), 2U);
  EXPECT_EQ(file.problems[0].substr(0, 8), "m.csv:2:");
  EXPECT_EQ(file.problems[1].substr(0, 8), "m.csv:3:");
}

TEST(MemberFile, NamesMakeFolders) {
  EXPECT_TRUE(members::is_member_name("s60_far-2"));
  for (const char* name : {"", "-a", "a/b", "..", "a b", "\xc3\xa4"}) {
    EXPECT_FALSE(members::is_member_name(name)) << name;
  }
  EXPECT_FALSE(members::is_member_name(std::string(81, 'a')));
}

}  // namespace
}  // namespace meniscus::member_file_test
