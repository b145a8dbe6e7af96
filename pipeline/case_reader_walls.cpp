#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "pipeline/case_checks.h"
#include "pipeline/case_reader_tables.h"

namespace meniscus {

namespace {

/// Films that the table's `films` names, each once.
std::vector<std::string> wall_films(CaseContext& context,
                                    const CaseTable& table, const Case& result,
                                    std::map<std::string, std::string>& taken) {
  const std::vector<std::string> known = film_names(result);
  std::vector<std::string> films;
  for (const std::string& film : table.names("films")) {
    const auto at = taken.find(film);
    if (std::find(known.begin(), known.end(), film) == known.end()) {
      context.problems.unknown(table.line("films"), "film", film, known);
    } else if (at != taken.end()) {
      context.problems.add(
          table.line("films"),
          fmt::format("{}.films names '{}', of which '{}' is made already; a "
                      "film has one wall",
                      table.path(), film, at->second));
    } else {
      taken[film] = table.name();
      films.push_back(film);
    }
  }
  return films;
}

}  // namespace

void read_walls(CaseContext& context, const toml::table& root, Case& result) {
  static const std::map<std::string, WallSide> sides = {
      {"both", WallSide::Both},
      {"inside", WallSide::Inside},
      {"outside", WallSide::Outside}};
  std::map<std::string, std::string> taken;
  for (const CaseTable& table : named_tables(context, root, "walls")) {
    WallEntry wall{.name = table.name(), .line = table.line()};
    wall.films = wall_films(context, table, result, taken);
    wall.thickness =
        table.place_quantity("thickness").value_or(PlaceQuantity{});
    wall.side = sides.at(table.choice("side").value_or("both"));
    result.walls.push_back(std::move(wall));
  }
}

}  // namespace meniscus
