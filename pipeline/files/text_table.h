/// Tables as text: csv files, and columns for people.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace meniscus::files {

using TextRow = std::vector<std::string>;

/// RFC 4180; cells in quotes where they hold a comma, a quote or an end of
/// line. Lines end with \n.
std::string csv_text(const std::vector<TextRow>& rows);

/// Columns flush right, two spaces between, as wide as the widest cell in
/// characters of UTF-8. Rows may be shorter than the first, not longer.
std::string aligned_text(const std::vector<TextRow>& rows);

/// For people: "mass" in the head line becomes "mass [kg]", and the numbers
/// below it are in that. `units`: of the cells as they are, by the names in the
/// head line; t is shown as kg, lbf s2/in as lb.
void show_units(const std::map<std::string, std::string>& units,
                std::vector<TextRow>& rows);

/// For people: columns "t[1,1] [mm]", "t[1,2] [mm]", ... of numbers become one,
/// "t [mm]", whose cells say from what to what.
void join_elements(std::vector<TextRow>& rows);

struct CsvRow {
  int line = 0;  // where it begins, from 1
  TextRow cells;
};

struct CsvRows {
  std::vector<CsvRow> rows;
  int open_quote = 0;  // the line of a quote that is never closed; 0: none
};

/// RFC 4180, blank lines left out, spaces about cells and a byte-order mark
/// dropped.
CsvRows parse_csv(const std::string& text);

/// Without the blanks around it.
std::string trimmed(const std::string& text);

}  // namespace meniscus::files
