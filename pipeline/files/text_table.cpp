#include "pipeline/files/text_table.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

#include "core/units.h"

namespace meniscus::files {

namespace {

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) {
    return cell;
  }
  std::string text = "\"";
  for (const char c : cell) {
    text += c == '"' ? "\"\"" : std::string(1, c);
  }
  return text + "\"";
}

// Characters of UTF-8 text as a terminal counts them, near enough.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

/// Cuts a text into rows of cells.
class Cutter {
 public:
  explicit Cutter(const std::string& text) : text_(text) {
    if (text_.starts_with("\xef\xbb\xbf")) {
      at_ = 3;
    }
  }

  CsvRows cut() {
    while (at_ < text_.size()) {
      CsvRow row{.line = line_, .cells = {}};
      bool more = true;
      while (more) {
        row.cells.push_back(cell());
        more = at_ < text_.size() && text_[at_] == ',';
        ++at_;  // a comma or the end of the line
      }
      ++line_;
      if (row.cells.size() > 1 || !row.cells[0].empty()) {
        found_.rows.push_back(std::move(row));
      }
    }
    return std::move(found_);
  }

 private:
  bool ends_cell() const {
    return at_ >= text_.size() || text_[at_] == ',' || text_[at_] == '\n';
  }

  std::string cell() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) {
      ++at_;
    }
    if (at_ < text_.size() && text_[at_] == '"') {
      std::string inside = quoted_cell();
      while (!ends_cell()) {
        inside += text_[at_++];
      }
      return trimmed(inside);
    }
    std::string plain;
    while (!ends_cell()) {
      plain += text_[at_++];
    }
    return trimmed(plain);
  }

  std::string quoted_cell() {
    const int begun = line_;
    std::string inside;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        ++at_;
        if (at_ >= text_.size() || text_[at_] != '"') {
          return inside;
        }
      }
      line_ += text_[at_] == '\n' ? 1 : 0;
      inside += text_[at_];
    }
    found_.open_quote = begun;
    return inside;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
  CsvRows found_;
};

}  // namespace

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  const std::size_t last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::string csv_text(const std::vector<TextRow>& rows) {
  std::string text;
  for (const TextRow& row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (j > 0) {
        text += ',';
      }
      text += quoted(row[j]);
    }
    text += '\n';
  }
  return text;
}

std::string aligned_text(const std::vector<TextRow>& rows) {
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const TextRow& row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      widths[j] = std::max(widths[j], width_of(row[j]));
    }
  }
  std::string text;
  for (const TextRow& row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      text += (j == 0 ? "" : "  ") +
              std::string(widths[j] - width_of(row[j]), ' ') + row[j];
    }
    text += '\n';
  }
  return text;
}

namespace {

/// A number times `factor`, with six digits; any other text as it is.
std::string scaled(const std::string& cell, double factor) {
  double value = 0.0;
  const char* end = cell.data() + cell.size();
  const auto [at, error] = std::from_chars(cell.data(), end, value);
  return error == std::errc() && at == end && !cell.empty()
             ? fmt::format("{:.6g}", factor * value)
             : cell;
}

}  // namespace

void show_units(const std::map<std::string, std::string>& units,
                std::vector<TextRow>& rows) {
  for (std::size_t k = 0; !rows.empty() && k < rows[0].size(); ++k) {
    const auto unit = units.find(rows[0][k]);
    if (unit == units.end() || unit->second.empty()) {
      continue;
    }
    ShownUnit shown{1.0, unit->second};
    if (unit->second == "t" || unit->second == "lbf s2/in") {
      UnitSystem system;
      system.mass = unit->second;
      shown = system.shown(Dimension::Mass);
    }
    rows[0][k] += " [" + shown.unit + "]";
    for (std::size_t r = 1; r < rows.size() && shown.factor != 1.0; ++r) {
      if (k < rows[r].size()) {
        rows[r][k] = scaled(rows[r][k], shown.factor);
      }
    }
  }
}

namespace {

/// "t [mm]" of "t[1,2] [mm]"; empty for what is no element.
std::string vector_head(const std::string& head) {
  const std::size_t open = head.find('[');
  const std::size_t close = head.find(']');
  return open == 0 || close == std::string::npos || head[open - 1] == ' '
             ? ""
             : head.substr(0, open) + head.substr(close + 1);
}

/// "0.5 to 2" of the numbers among the cells.
std::string range_of(const TextRow& row, std::size_t first, std::size_t last) {
  std::string least;
  std::string largest;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t k = first; k < std::min(last, row.size()); ++k) {
    double value = 0.0;
    const char* end = row[k].data() + row[k].size();
    if (std::from_chars(row[k].data(), end, value).ptr != end ||
        row[k].empty()) {
      continue;
    }
    if (value < low) {
      low = value;
      least = row[k];
    }
    if (value > high) {
      high = value;
      largest = row[k];
    }
  }
  return least == largest ? least : least + " to " + largest;
}

}  // namespace

void join_elements(std::vector<TextRow>& rows) {
  for (std::size_t k = 0; !rows.empty() && k < rows[0].size(); ++k) {
    const std::string head = vector_head(rows[0][k]);
    std::size_t end = k + 1;
    while (!head.empty() && end < rows[0].size() &&
           vector_head(rows[0][end]) == head) {
      ++end;
    }
    if (head.empty()) {
      continue;
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      TextRow& row = rows[r];
      if (k < row.size()) {
        row[k] = r == 0 ? head : range_of(row, k, end);
        row.erase(row.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                  row.begin() +
                      static_cast<std::ptrdiff_t>(std::min(end, row.size())));
      }
    }
  }
}

CsvRows parse_csv(const std::string& text) { return Cutter(text).cut(); }

}  // namespace meniscus::files
