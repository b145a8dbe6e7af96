#include <algorithm>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "pipeline/members/member_file.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

/// The value on one line, as --set takes it.
std::string text_of(const toml::node& node) {
  std::ostringstream stream;
  stream << toml::node_view<const toml::node>(node);
  std::string text = stream.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Tables within tables are dotted keys.
void add_overrides(const toml::table& table, const std::string& prefix,
                   case_data::MemberEntry& member) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      add_overrides(*inner, name + ".", member);
    } else {
      member.overrides.push_back(fmt::format("{}={}", name, text_of(node)));
    }
  }
}

void read_member_tables(CaseContext& context, const toml::table& table,
                        case_data::Case& result) {
  std::vector<std::pair<case_data::SourceLine, case_data::MemberEntry>> found;
  for (const auto& [key, node] : table) {
    const case_data::SourceLine line = context.line_of(node);
    const std::string name(key.str());
    const toml::table* values = node.as_table();
    if (values == nullptr) {
      context.problems.add(
          line, fmt::format("study.members.{} is {}; expected a table "
                            "[study.members.NAME] of values",
                            name, described(node)));
      continue;
    }
    if (!members::is_member_name(name)) {
      context.problems.add(line,
                           fmt::format("'{}' is no name of a member; expected "
                                       "letters, digits, _ and -",
                                       name));
    }
    case_data::MemberEntry member{
        .name = name,
        .overrides = {},
        .place = fmt::format("{}:{}", result.path, line)};
    add_overrides(*values, "", member);
    found.emplace_back(line, std::move(member));
  }
  // toml++ sorts by name; the table of results follows the file's order.
  std::stable_sort(
      found.begin(), found.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& entry : found) {
    result.study.members.push_back(std::move(entry.second));
  }
}

}  // namespace

std::string read_members(CaseContext& context, const CaseTable& study,
                         case_data::Case& result) {
  const std::string each = study.choice("each").value_or("minimize");
  const toml::node* node = study.node("members");
  if (node == nullptr) {
    context.problems.add(study.line(),
                         "a family needs members: [study.members.NAME] tables "
                         "or study.members = \"file.csv\"");
    return each;
  }
  if (const auto* file = node->as_string()) {
    const std::filesystem::path path =
        std::filesystem::path(result.path).parent_path() / file->get();
    if (!std::filesystem::is_regular_file(path)) {
      context.problems.add(
          study.line("members"),
          fmt::format("study.members: there is no file '{}'; expected a csv "
                      "file, its path relative to the case",
                      path.string()));
      return each;
    }
    members::MemberFile found = members::read_member_file(path.string());
    for (const std::string& problem : found.problems) {
      context.problems.add_text(problem);
    }
    result.study.members = std::move(found.members);
  } else if (const toml::table* table = node->as_table()) {
    read_member_tables(context, *table, result);
  } else {
    context.problems.add(
        study.line("members"),
        fmt::format("study.members is {}; expected tables [study.members.NAME] "
                    "or the path of a csv file",
                    described(*node)));
    return each;
  }
  if (result.study.members.empty() && context.problems.empty()) {
    context.problems.add(study.line("members"), "study.members is empty");
  }
  return each;
}

}  // namespace meniscus::reader
