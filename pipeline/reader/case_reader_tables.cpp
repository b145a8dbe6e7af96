#include "pipeline/reader/case_reader_tables.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_symmetry.h"

namespace meniscus::reader {

namespace {

void check_top(CaseContext& context, const toml::table& root) {
  const bool only_walls = (root.contains("walls") || root.contains("shells")) &&
                          !root.contains("bodies");
  std::vector<std::string> known;
  for (const TableSpec& spec : case_tables()) {
    const std::string name = spec.name;
    if (name.empty()) {
      for (const KeySpec& key : spec.keys) {
        known.emplace_back(key.key);
        if (key.required && !root.contains(key.key)) {
          context.problems.add(1, fmt::format("the file has no '{}' ({}); add "
                                              "it above the first table",
                                              key.key, key.doc));
        }
      }
    } else if (!is_entry_table(name)) {
      known.push_back(name);
      const bool needed = spec.need == TableNeed::Always ||
                          (spec.need == TableNeed::ForParts && !only_walls);
      if (needed && !root.contains(name)) {
        context.problems.add(
            1, fmt::format("the file has no [{}{}] ({}); add one", name,
                           spec.named_entries ? ".NAME" : "", spec.doc));
      }
    }
  }
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    if (is_later_table(name)) {
      context.problems.add(
          context.line_of(node),
          fmt::format("[{}] is not available in this version", name));
    } else if (std::find(known.begin(), known.end(), name) == known.end()) {
      context.problems.add(
          context.line_of(node),
          fmt::format("unknown {} '{}'{}", node.is_table() ? "table" : "key",
                      name, case_data::advice(name, known)));
    }
  }
}

void read_head(CaseContext& context, const toml::table& root,
               case_data::Case& result) {
  const toml::node* title = root.get("title");
  if (title != nullptr) {
    if (const auto* text = title->as_string()) {
      result.title = text->get();
    } else {
      context.problems.add(context.line_of(*title),
                           fmt::format("title is {}; expected text in quotes",
                                       described(*title)));
    }
  }
  context.units = *unit_system("mm-N-MPa");
  if (const toml::node* units = root.get("units")) {
    const auto* text = units->as_string();
    const auto system = unit_system(text == nullptr ? "" : text->get());
    if (system) {
      context.units = *system;
    } else {
      context.problems.add(
          context.line_of(*units),
          fmt::format("units is {}; expected one of {}", described(*units),
                      fmt::join(split_choices(
                                    find_key(case_table(""), "units")->choices),
                                ", ")));
    }
  }
  result.units = context.units;
}

bool is_name(const std::string& name) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !name.empty() && letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return letter(c) || (c >= '0' && c <= '9');
         });
}

/// How far rims of facets may lie off their curves, where it is not said.
void set_within(case_data::Case& result) {
  constexpr double kUsual = 0.25;  // of resolution.fea
  for (case_data::FilmEntry& film : result.films) {
    if (!(film.spec.within > 0.0)) {
      film.spec.within = kUsual * result.resolution.fea;
    }
  }
  for (case_data::CapEntry& cap : result.caps) {
    if (!(cap.spec.within > 0.0)) {
      cap.spec.within = kUsual * result.resolution.fea;
    }
  }
}

void read_resolution(CaseContext& context, const toml::table& root,
                     case_data::Case& result) {
  const auto table = single_table(context, root, "resolution");
  if (!table) {
    return;
  }
  const auto refuse = [&](const char* key, double edge) {
    context.problems.add(
        table->line(key),
        fmt::format("resolution.{} is {:g}; an edge length is above 0", key,
                    edge));
  };
  case_data::Resolution& resolution = result.resolution;
  const auto length = [&](const char* key, double otherwise) {
    const double edge = table->constant(key).value_or(otherwise);
    if (table->has(key) && !(edge > 0.0)) {
      refuse(key, edge);
    }
    return edge;
  };
  resolution.pop = table->flag("pop").value_or(false);
  resolution.keep_facets = table->flag("keep_facets").value_or(false);
  if (resolution.keep_facets && !case_data::has_facets(result)) {
    context.problems.add(table->line("keep_facets"),
                         "resolution.keep_facets: no film is of kind facets or "
                         "file; take it out");
  }
  const std::size_t before = context.problems.size();
  resolution.fea = length("fea", 0.0);
  resolution.film = length("film", resolution.fea / 2.0);
  for (const double edge : table->constants("export")) {
    if (!(edge > 0.0)) {
      refuse("export", edge);
    }
    resolution.export_edges.push_back(edge);
  }
  if (context.problems.size() == before && table->has("fea")) {
    case_data::nest_film(resolution, table->line("film"), context.problems);
  }
  set_within(result);
}

void read_process(CaseContext& context, const toml::table& root,
                  case_data::Case& result) {
  const auto table = single_table(context, root, "process");
  if (!table) {
    return;
  }
  result.process.name = table->text("name").value_or("");
  const double least = table->constant("smallest_feature").value_or(0.0);
  if (table->has("smallest_feature") && !(least > 0.0)) {
    context.problems.add(
        table->line("smallest_feature"),
        fmt::format("process.smallest_feature is {:g}; it is a length above 0",
                    least));
  }
  result.process.smallest_feature = least;
}

void read_symmetry(CaseContext& context, const toml::table& root,
                   case_data::Case& result) {
  const auto table = single_table(context, root, "symmetry");
  if (!table) {
    return;
  }
  for (const CaseTable& plane : table->tables("planes", "plane")) {
    const auto at = plane.constant_vector("at");
    const auto normal = plane.constant_vector("normal");
    if (normal && !(normal->norm() > 0.0)) {
      context.problems.add(plane.line("normal"),
                           "symmetry.planes: normal is 0; expected a direction "
                           "across the plane, away from what is drawn");
    } else if (at && normal) {
      result.symmetry.push_back({*at, normal->normalized(), plane.line()});
    }
  }
  case_data::check_planes(result, context.problems);
}

}  // namespace

void check_name(CaseContext& context, const std::string& name,
                const std::string& table, case_data::SourceLine line) {
  if (!is_name(name)) {
    context.problems.add(
        line, fmt::format("{}.{}: '{}' is no name; expected letters, digits "
                          "and _, no digit first",
                          table, name, name));
  }
}

double constant_above(CaseContext& context, const CaseTable& table,
                      const char* key, double above, double standard) {
  const double value = table.constant(key).value_or(standard);
  if (value > above) {
    return value;
  }
  context.problems.add(table.line(key),
                       fmt::format("{}.{} is {:g}; it must be above {:g}",
                                   table.path(), key, value, above));
  return standard;
}

std::vector<CaseTable> named_tables(CaseContext& context,
                                    const toml::table& root,
                                    const char* table) {
  std::vector<CaseTable> found;
  const toml::node* node = root.get(table);
  if (node == nullptr) {
    return found;
  }
  const toml::table* all = node->as_table();
  if (all == nullptr) {
    context.problems.add(context.line_of(*node),
                         fmt::format("{} is {}; expected tables [{}.NAME]",
                                     table, described(*node), table));
    return found;
  }
  std::set<std::string> made;
  for (const auto& [key, entry] : *all) {
    const std::string name(key.str());
    const std::string path = fmt::format("{}.{}", table, name);
    check_name(context, name, table, context.line_of(entry));
    if (const toml::table* inner = entry.as_table()) {
      const CaseTable whole(context, *inner, case_table(table), name, path);
      for (CaseTable& copy : whole.copies()) {
        if (!made.insert(copy.name()).second ||
            (copy.name() != name && all->contains(copy.name()))) {
          context.problems.add(whole.line("repeat"),
                               fmt::format("{} makes '{}', which is there "
                                           "already; rename one",
                                           path, copy.name()));
        }
        found.push_back(std::move(copy));
      }
    } else {
      context.problems.add(context.line_of(entry),
                           fmt::format("{} is {}; expected a table [{}]", path,
                                       described(entry), path));
    }
  }
  // toml++ sorts by name; people see, and models follow, the file's order.
  std::stable_sort(found.begin(), found.end(),
                   [](const CaseTable& a, const CaseTable& b) {
                     return a.line() < b.line();
                   });
  return found;
}

std::optional<CaseTable> single_table(CaseContext& context,
                                      const toml::table& root,
                                      const char* table) {
  const toml::node* node = root.get(table);
  if (node == nullptr) {
    return std::nullopt;
  }
  if (const toml::table* found = node->as_table()) {
    return CaseTable(context, *found, case_table(table), "", table);
  }
  context.problems.add(context.line_of(*node),
                       fmt::format("{} is {}; expected a table [{}]", table,
                                   described(*node), table));
  return std::nullopt;
}

void read_tables(const toml::table& root, const OverriddenNodes& overridden,
                 case_data::CaseProblems& problems, case_data::Case& result) {
  CaseContext context{.problems = problems, .overridden = overridden};
  check_top(context, root);
  read_head(context, root, result);
  read_names(context, root, result);
  read_start(context, root, result);
  read_symmetry(context, root, result);
  read_shapes(context, root, result);
  read_geometry(context, root, result);
  check_rim_shapes(context, result);
  read_walls(context, root, result);
  read_shells(context, root, result);
  read_fillets(context, root, result);
  read_fields(context, root, result);
  read_spines(context, root, result);
  read_resolution(context, root, result);
  read_process(context, root, result);
  read_analysis(context, root, result);
  case_data::apply_symmetry(result, context.problems);
  warn_of_unused(context, root, result);
}

}  // namespace meniscus::reader
