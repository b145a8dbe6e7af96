#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

const std::vector<case_data::Named<walls::WallSide>>& wall_sides() {
  static const std::vector<case_data::Named<walls::WallSide>> sides = {
      {"both", walls::WallSide::Both},
      {"inside", walls::WallSide::Inside},
      {"outside", walls::WallSide::Outside}};
  return sides;
}

/// Films that the table's `films` names, each once.
std::vector<std::string> wall_films(CaseContext& context,
                                    const CaseTable& table,
                                    const case_data::Case& result,
                                    std::map<std::string, std::string>& taken) {
  const std::vector<std::string> known = case_data::film_names(result);
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

bool meet(const case_data::Case& input, const case_data::WallEntry& a,
          const case_data::WallEntry& b) {
  const std::vector<std::string> there = case_data::curves_of_wall(input, b);
  const std::vector<std::string> here = case_data::curves_of_wall(input, a);
  return std::any_of(here.begin(), here.end(), [&](const std::string& curve) {
    return std::find(there.begin(), there.end(), curve) != there.end();
  });
}

/// Walls whose films share a curve become one body, numbered by its first.
void find_regions(CaseContext& context, case_data::Case& result) {
  std::vector<case_data::WallEntry>& walls = result.walls;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    walls[k].region = static_cast<int>(k);
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (case_data::WallEntry& a : walls) {
      for (const case_data::WallEntry& b : walls) {
        if (b.region < a.region && meet(result, a, b)) {
          a.region = b.region;
          changed = true;
        }
      }
    }
  }
  std::map<int, int> number;
  std::map<int, const case_data::WallEntry*> first;
  for (case_data::WallEntry& wall : walls) {
    wall.region =
        number.try_emplace(wall.region, static_cast<int>(number.size()))
            .first->second;
    const case_data::WallEntry& other =
        *first.try_emplace(wall.region, &wall).first->second;
    if (other.material != wall.material) {
      context.problems.add(
          wall.line,
          fmt::format("walls.{} and walls.{} meet and so are one body, but "
                      "their materials differ; give both the same",
                      other.name, wall.name));
    }
  }
}

int material_of(CaseContext& context, const CaseTable& table,
                const case_data::Case& result) {
  const auto wanted = table.text("material");
  if (!wanted) {
    return case_data::kVoid;
  }
  std::vector<std::string> known;
  for (const case_data::MaterialEntry& material : result.materials) {
    if (material.name == *wanted) {
      return static_cast<int>(known.size());
    }
    known.push_back(material.name);
  }
  context.problems.unknown(table.line("material"), "material", *wanted, known);
  return case_data::kVoid;
}

}  // namespace

TableSpec wall_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "walls",
      true,
      TableNeed::Optional,
      "Films made solid by thickness. `meniscus evolve` reports the largest "
      "safe one and writes the closed surface",
      {{"films", K::Names, D::None, true,
        "the film, or several; where they share a curve they are joined"},
       {"thickness", K::Place, D::Length, true,
        "above 0; a number may follow the design, an expression of x, y, z "
        "may not"},
       {"material", K::Name, D::None, false,
        "of the wall; a run needs it, and walls that meet have one"},
       {"fillet", K::Constant, D::Length, false,
        "radius where three or more films meet, 0: sharp; half the thickness "
        "when left out"},
       {"side", K::Choice, D::None, false,
        "where the material lies: both sides of the film, all of it inside "
        "(towards the middle of the film's curves) or outside; both when left "
        "out",
        case_data::choices_of(wall_sides())}}};
}

void read_walls(CaseContext& context, const toml::table& root,
                case_data::Case& result) {
  std::map<std::string, std::string> taken;
  for (const CaseTable& table : named_tables(context, root, "walls")) {
    case_data::WallEntry wall{.name = table.name(), .line = table.line()};
    wall.films = wall_films(context, table, result, taken);
    wall.thickness =
        table.place_quantity("thickness").value_or(case_data::PlaceQuantity{});
    if (wall.thickness.of_place) {
      require_frozen(context, wall.thickness.quantity,
                     "a thickness of x, y, z");
    }
    wall.side = case_data::row_named(wall_sides(),
                                     table.choice("side").value_or("both"))
                    .value;
    wall.fillet = table.constant("fillet");
    if (wall.fillet && !(*wall.fillet >= 0.0)) {
      context.problems.add(table.line("fillet"),
                           fmt::format("{}.fillet is {:g}; it must not be "
                                       "below 0",
                                       table.path(), *wall.fillet));
    }
    wall.material = material_of(context, table, result);
    result.walls.push_back(std::move(wall));
  }
  find_regions(context, result);
}

}  // namespace meniscus::reader
