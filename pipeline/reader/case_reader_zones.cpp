#include <fmt/format.h>

#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

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

}  // namespace

void read_zones(CaseContext& context, const CaseTable& table,
                case_data::Case& result) {
  for (const CaseTable& zone : table.tables("exclude", "exclude")) {
    case_data::ExclusionEntry entry = read_zone(context, zone, result);
    entry.key =
        fmt::format("{}[{}]", zone.path(), result.analysis.exclude.size());
    result.analysis.exclude.push_back(std::move(entry));
  }
}

}  // namespace meniscus::reader
