#include "pipeline/files/curve_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/outlier.h"
#include "pipeline/files/text_table.h"

namespace meniscus::files {

namespace {

constexpr std::size_t kMostProblems = 20;
constexpr std::size_t kMostPoints = 20000;
// From the last point to the first / the longest other step, of so many points
// or more: fewer may be corners.
constexpr double kGap = 3.0;
constexpr std::size_t kGapPoints = 8;
constexpr std::size_t kShown = 40;  // characters of a cell in a message

/// A finite number, all of the cell; a leading + is one's own.
std::optional<double> number_of(const std::string& cell) {
  const char* begin = cell.data();
  const char* end = begin + cell.size();
  begin += cell.starts_with('+') ? 1 : 0;
  double value = 0.0;
  const auto [at, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || at != end || begin == end ||
      !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

struct Column {
  std::size_t at = 0;
  double factor = 1.0;  // to case units
};

class Reader {
 public:
  Reader(const std::string& path, const UnitSystem& units)
      : path_(path), units_(units) {}

  void read(const CsvRows& csv);
  CurveFile take() { return std::move(file_); }
  void add(int line, const std::string& message) {
    if (file_.problems.size() < kMostProblems) {
      file_.problems.push_back(fmt::format("{}:{}: {}", path_, line, message));
    }
  }

 private:
  bool read_head(const CsvRow& row);
  void read_row(const CsvRow& row);
  void close();
  void warn_of_gap();

  const std::string& path_;
  const UnitSystem& units_;
  CurveFile file_;
  std::array<Column, 3> columns_;
  std::size_t width_ = 0;
  std::vector<int> lines_;  // of the points
};

/// "X [mm]" is column x in mm.
bool Reader::read_head(const CsvRow& row) {
  width_ = row.cells.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool found = false;
    for (std::size_t k = 0; k < width_; ++k) {
      const std::string& cell = row.cells[k];
      const std::size_t bracket = cell.find_first_of("[(");
      const std::string name = trimmed(cell.substr(0, bracket));
      if (name.size() != 1 ||
          std::tolower(static_cast<unsigned char>(name[0])) != "xyz"[axis]) {
        continue;
      }
      if (found) {
        add(row.line, fmt::format("two columns '{}'; name each once", name));
        return false;
      }
      found = true;
      columns_[axis].at = k;
      if (bracket != std::string::npos) {
        const std::size_t last = cell.find_last_of("])");
        const std::string unit =
            trimmed(cell.substr(bracket + 1, last - bracket - 1));
        try {
          columns_[axis].factor =
              parse_quantity("1 " + unit, Dimension::Length, units_);
        } catch (const InvalidInput& error) {
          add(row.line, fmt::format("column '{}': {}", cell, error.what()));
          return false;
        }
      }
    }
    if (!found) {
      add(row.line,
          fmt::format("no column '{}' in the head row, which is '{}'; expected "
                      "x, y and z, with commas between, and points below",
                      "xyz"[axis], fmt::join(row.cells, ",")));
      return false;
    }
  }
  return true;
}

void Reader::read_row(const CsvRow& row) {
  if (row.cells.size() != width_) {
    add(row.line, fmt::format("{} cells in this row and {} in the head row",
                              row.cells.size(), width_));
    return;
  }
  Vec3 point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& cell = row.cells[columns_[axis].at];
    const auto value = number_of(cell);
    if (!value) {
      add(row.line, fmt::format("column {} is '{}'; expected a number",
                                "xyz"[axis], cell.substr(0, kShown)));
      return;
    }
    point[static_cast<Eigen::Index>(axis)] = columns_[axis].factor * *value;
  }
  if (!file_.points.empty() && point == file_.points.back()) {
    add(row.line, "the same point as in the row above; take one out");
    return;
  }
  file_.points.push_back(point);
  lines_.push_back(row.line);
}

void Reader::close() {
  if (file_.points.size() > 1 && file_.points.front() == file_.points.back()) {
    file_.points.pop_back();
  }
  if (file_.problems.empty() && file_.points.size() < 3) {
    add(lines_.empty() ? 1 : lines_.back(),
        fmt::format("{} point{}; a closed curve needs three or more",
                    file_.points.size(), file_.points.size() == 1 ? "" : "s"));
  }
  if (const auto outlier = find_outlier(file_.points);
      outlier && file_.problems.empty()) {
    add(lines_[static_cast<std::size_t>(outlier->point)],
        outlier_text(*outlier, file_.points));
  }
  warn_of_gap();
}

void Reader::warn_of_gap() {
  const Points& points = file_.points;
  if (!file_.problems.empty() || points.size() < kGapPoints) {
    return;
  }
  double longest = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    longest = std::max(longest, (points[k] - points[k - 1]).norm());
  }
  const double gap = (points.front() - points.back()).norm();
  if (gap > kGap * longest) {
    file_.warning = fmt::format(
        "{}:{}: the curve does not come back to its first point: {:.4g} {} are "
        "left, and no other step is longer than {:.4g} {}; it is closed across "
        "that gap; are points missing?",
        path_, lines_.back(), gap, units_.length, longest, units_.length);
  }
}

void Reader::read(const CsvRows& csv) {
  if (csv.open_quote > 0) {
    add(csv.open_quote, "a quote that is never closed");
    return;
  }
  if (csv.rows.empty()) {
    add(1, "the file is empty; expected a head row x,y,z and points below");
    return;
  }
  if (csv.rows.size() > kMostPoints + 1) {  // the first is the head
    add(1, fmt::format("{} points; a boundary curve is sparse, and at most {} "
                       "are taken: thin them out",
                       csv.rows.size() - 1, kMostPoints));
    return;
  }
  if (!read_head(csv.rows[0])) {
    return;
  }
  for (std::size_t k = 1; k < csv.rows.size(); ++k) {
    read_row(csv.rows[k]);
  }
  close();
}

}  // namespace

CurveFile read_curve_text(const std::string& text, const std::string& path,
                          const UnitSystem& units) {
  Reader reader(path, units);
  reader.read(parse_csv(text));
  return reader.take();
}

}  // namespace meniscus::files
