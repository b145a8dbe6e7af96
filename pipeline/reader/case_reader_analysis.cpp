#include <algorithm>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

const std::vector<case_data::Named<equations::SolverKind>>& solver_kinds() {
  static const std::vector<case_data::Named<equations::SolverKind>> kinds = {
      {"auto", equations::SolverKind::Automatic},
      {"cholmod", equations::SolverKind::Cholesky},
      {"p-multigrid", equations::SolverKind::Multigrid},
      {"petsc", equations::SolverKind::Distributed}};
  return kinds;
}

/// After the eigenvalues that are asked for.
void read_solver(CaseContext& context, const CaseTable& table,
                 case_data::AnalysisEntry& analysis) {
  if (const auto kind = table.choice("solver")) {
    analysis.solver = case_data::row_named(solver_kinds(), *kind).value;
  }
  if (analysis.solver != equations::SolverKind::Distributed) {
    if (table.has("processes")) {
      context.problems.add(table.line("processes"),
                           "analysis.processes belongs to solver = \"petsc\"; "
                           "take it out, or choose that solver");
    }
    return;
  }
  analysis.processes =
      table.integer_within("processes", 1, equations::kMostProcesses)
          .value_or(analysis.processes);
  for (const auto& [key, asked] :
       {std::pair("frequencies", analysis.frequencies > 0),
        std::pair("buckling", analysis.buckling.value_or(0) > 0)}) {
    if (asked) {
      context.problems.add(
          table.line(key),
          fmt::format("analysis.{} needs the matrix in one process, and solver "
                      "= \"petsc\" spreads it; choose another solver or take "
                      "it out",
                      key));
    }
  }
}

double above_zero(CaseContext& context, const CaseTable& table,
                  const char* key) {
  const auto value = table.constant(key);
  if (value && !(*value > 0.0)) {
    context.problems.add(table.line(key),
                         fmt::format("{}.{} is {:g}; it must be above 0",
                                     table.path(), key, *value));
  }
  return value.value_or(0.0);
}

stress::ExclusionZone::Box read_box(CaseContext& context,
                                    const CaseTable& table) {
  const std::size_t before = context.problems.size();
  const stress::ExclusionZone::Box box{
      table.constant_vector("low").value_or(Vec3::Zero()),
      table.constant_vector("high").value_or(Vec3::Zero())};
  if (context.problems.size() == before &&
      !((box.high - box.low).minCoeff() > 0.0)) {
    context.problems.add(
        table.line("low"),
        fmt::format("{}: the box from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) "
                    "is empty; each coordinate of high must be above that of "
                    "low",
                    table.path(), box.low.x(), box.low.y(), box.low.z(),
                    box.high.x(), box.high.y(), box.high.z()));
  }
  return box;
}

/// The one of the three kinds whose keys are all there, and no others.
std::string zone_kind_of(CaseContext& context, const CaseTable& table) {
  static constexpr std::array<std::array<const char*, 2>, 3> kinds = {
      {{"near", "distance"}, {"center", "radius"}, {"low", "high"}}};
  std::string found;
  int keys = 0;
  for (const auto& [first, second] : kinds) {
    keys += (table.has(first) ? 1 : 0) + (table.has(second) ? 1 : 0);
    if (table.has(first) && table.has(second)) {
      found = first;
    }
  }
  if (found.empty() || keys != 2) {
    context.problems.add(
        table.line(),
        fmt::format("{}: a zone is near a surface within a distance, a ball "
                    "with center and radius, or a box from low to high; "
                    "expected the two keys of one",
                    table.path()));
    return "";
  }
  return found;
}

case_data::ExclusionEntry read_zone(CaseContext& context,
                                    const CaseTable& table,
                                    const case_data::Case& result) {
  case_data::ExclusionEntry entry{.line = table.line()};
  const std::string kind = zone_kind_of(context, table);
  if (kind == "near") {
    entry.zone.surface = surface_on(context, table, result, "near");
    entry.zone.distance = above_zero(context, table, "distance");
  } else if (kind == "center") {
    entry.zone.ball = stress::ExclusionZone::Ball{
        table.constant_vector("center").value_or(Vec3::Zero()),
        above_zero(context, table, "radius")};
  } else if (kind == "low") {
    entry.zone.box = read_box(context, table);
  }
  return entry;
}

/// What stress figures leave out.
void read_zones(CaseContext& context, const CaseTable& table,
                case_data::Case& result) {
  for (const CaseTable& zone : table.tables("exclude", "exclude")) {
    case_data::ExclusionEntry entry = read_zone(context, zone, result);
    entry.key =
        fmt::format("{}[{}]", zone.path(), result.analysis.exclude.size());
    result.analysis.exclude.push_back(std::move(entry));
  }
}

void read_analysis_table(CaseContext& context, const toml::table& root,
                         case_data::Case& result) {
  const auto table = single_table(context, root, "analysis");
  if (!table) {
    return;
  }
  constexpr int most = case_data::AnalysisEntry::kMostModes;
  case_data::AnalysisEntry& analysis = result.analysis;
  analysis.adapt = table->flag("adapt").value_or(false);
  read_zones(context, *table, result);
  analysis.frequencies =
      table->integer_within("frequencies", 0, most).value_or(0);
  analysis.buckling = table->integer_within("buckling", 0, most);
  read_solver(context, *table, analysis);
  analysis.supports_of = index_of_held(context, *table, result, "supports_of");
  if (result.load_cases.empty() && context.problems.empty()) {
    context.problems.add(table->line(),
                         "analysis needs a load case: its supports and loads");
  }
}

}  // namespace

TableSpec analysis_table() {
  using D = Dimension;
  using K = KeyType;
  return {
      "analysis",
      false,
      TableNeed::Optional,
      "How the part is analysed, what counts of it, vibration and buckling",
      {{"adapt", K::Flag, D::None, false,
        "one round of adaptive refinement of the frozen model: elements and "
        "surface are halved where that should leave 40 % of the estimated "
        "error at the initial design, with the fewest elements; false when "
        "left out"},
       {"exclude", K::Zones, D::None, false,
        "zones that stress figures leave out: peaks, safety factors, "
        "distributions and max_von_mises responses. Elements whose centre is "
        "in one at the initial design, for every design; of peaks nodes in "
        "one, too"},
       {"solver", K::Choice, D::None, false,
        "of the linear systems: auto chooses by size between cholmod (a "
        "factor) and p-multigrid (conjugate gradients); petsc: in processes "
        "of its own, for parts that outgrow one machine; auto when left out",
        case_data::choices_of(solver_kinds())},
       {"processes", K::Integer, D::None, false,
        "of solver = \"petsc\": how many share the part; 2 when left out"},
       {"frequencies", K::Integer, D::None, false,
        "how many natural frequencies, lowest first; none when left out"},
       {"supports_of", K::Name, D::None, false,
        "of frequencies: the load case whose supports and springs hold the "
        "part, or free: not held; the first load case when left out"},
       {"buckling", K::Integer, D::None, false,
        "how many buckling factors per load case, smallest first; 0: none; "
        "the first to three digits when left out"}}};
}

void read_analysis(CaseContext& context, const toml::table& root,
                   case_data::Case& result) {
  read_load_cases(context, root, result);
  read_analysis_table(context, root, result);
  read_responses(context, root, result);
  read_study(context, root, result);
}

}  // namespace meniscus::reader
