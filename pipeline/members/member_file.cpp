#include "pipeline/members/member_file.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/files/text_table.h"

namespace meniscus::members {

namespace {

constexpr std::size_t kLongestName = 80;

/// "design.fill" of the columns fill.lower and design.fill.upper.
std::string variable_of(const std::string& column) {
  const std::string name = column.substr(0, column.size() - 6);
  return name.find('.') == std::string::npos ? "design." + name : name;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  void read_head(const files::CsvRow& row);
  void read_row(const files::CsvRow& row);
  void add(int line, const std::string& message) {
    if (file_.problems.size() < kMostProblems) {
      file_.problems.push_back(fmt::format("{}:{}: {}", path_, line, message));
    }
  }
  MemberFile take() { return std::move(file_); }
  bool has_names() const { return name_ < head_.size(); }

 private:
  void add_overrides(const files::CsvRow& row, case_data::MemberEntry& member);

  const std::string& path_;
  MemberFile file_;
  std::vector<std::string> head_;
  std::size_t name_ = 0;  // its column
  std::set<std::string> seen_;
};

void Reader::read_head(const files::CsvRow& row) {
  head_ = row.cells;
  name_ = static_cast<std::size_t>(
      std::find(head_.begin(), head_.end(), "name") - head_.begin());
  if (!has_names()) {
    add(row.line,
        fmt::format("no column 'name' in the head row, which is '{}'; expected "
                    "'name' and the names of parameters, design variables or "
                    "keys, with commas between",
                    fmt::join(head_, ",")));
    return;
  }
  std::set<std::string> columns;
  for (const std::string& column : head_) {
    if (column.empty()) {
      add(row.line, "a column without a name in the head row");
    } else if (!columns.insert(column).second) {
      add(row.line, fmt::format("two columns '{}'; name each once", column));
    }
    for (const auto& [one, other] :
         {std::pair(".lower", ".upper"), std::pair(".upper", ".lower")}) {
      const std::string pair = column.ends_with(one)
                                   ? column.substr(0, column.size() - 6) + other
                                   : column;
      if (std::find(head_.begin(), head_.end(), pair) == head_.end()) {
        add(row.line, fmt::format("column '{}' needs a column '{}' beside it",
                                  column, pair));
      }
    }
  }
}

void Reader::add_overrides(const files::CsvRow& row,
                           case_data::MemberEntry& member) {
  std::map<std::string, std::string> lower;
  std::map<std::string, std::string> upper;
  for (std::size_t k = 0; k < head_.size(); ++k) {
    const std::string& column = head_[k];
    const std::string& cell = row.cells[k];
    if (k == name_ || cell.empty()) {
      continue;
    }
    if (column.ends_with(".lower")) {
      lower[variable_of(column)] = cell;
    } else if (column.ends_with(".upper")) {
      upper[variable_of(column)] = cell;
    } else {
      member.overrides.push_back(fmt::format("{}={}", column, cell));
    }
  }
  for (const auto& [key, least] : lower) {
    if (upper.count(key) == 0) {
      add(row.line, fmt::format("{}.upper is empty and {}.lower is not; give "
                                "both or neither",
                                key, key));
    } else {
      member.overrides.push_back(
          fmt::format("{}.bounds=[{}, {}]", key, least, upper[key]));
    }
  }
  for (const auto& [key, most] : upper) {
    if (lower.count(key) == 0) {
      add(row.line, fmt::format("{}.lower is empty and {}.upper is not; give "
                                "both or neither",
                                key, key));
    }
  }
}

void Reader::read_row(const files::CsvRow& row) {
  if (row.cells.size() != head_.size()) {
    add(row.line, fmt::format("{} cells in this row and {} in the head row; "
                              "put quotes around a cell that holds commas",
                              row.cells.size(), head_.size()));
    return;
  }
  case_data::MemberEntry member{.name = row.cells[name_],
                                .overrides = {},
                                .place = fmt::format("{}:{}", path_, row.line)};
  if (!is_member_name(member.name)) {
    add(row.line, fmt::format("'{}' is no name of a member; expected letters, "
                              "digits, _ and -",
                              member.name));
  } else if (!seen_.insert(member.name).second) {
    add(row.line,
        fmt::format("a second member '{}'; name each once", member.name));
  }
  add_overrides(row, member);
  file_.members.push_back(std::move(member));
}

}  // namespace

bool is_member_name(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName && name[0] != '-' &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                  (c >= '0' && c <= '9') || c == '_' || c == '-';
         });
}

MemberFile read_member_text(const std::string& text, const std::string& path) {
  const files::CsvRows csv = files::parse_csv(text);
  Reader reader(path);
  if (csv.open_quote > 0) {
    reader.add(csv.open_quote, "a quote that is never closed");
  } else if (csv.rows.size() < 2) {
    reader.add(1, "no members; expected a head row and a row for each member");
  } else {
    reader.read_head(csv.rows[0]);
    for (std::size_t k = 1; k < csv.rows.size() && reader.has_names(); ++k) {
      reader.read_row(csv.rows[k]);
    }
  }
  return reader.take();
}

MemberFile read_member_file(const std::string& path) {
  try {
    return read_member_text(read_file(path), path);
  } catch (const IoError& error) {
    return {.members = {}, .problems = {error.what()}};
  }
}

}  // namespace meniscus::members
