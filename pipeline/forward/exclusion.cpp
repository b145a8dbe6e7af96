#include "pipeline/forward/exclusion.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace meniscus::forward {

namespace {

using Json = nlohmann::ordered_json;

std::string text(const Vec3& x) {
  return fmt::format("({:g}, {:g}, {:g})", x.x(), x.y(), x.z());
}

std::string where(const stress::ExclusionZone& zone, const std::string& unit) {
  if (zone.ball) {
    return fmt::format("within {:g} {} of {}", zone.ball->radius, unit,
                       text(zone.ball->center));
  }
  if (zone.box) {
    return fmt::format("from {} to {}", text(zone.box->low),
                       text(zone.box->high));
  }
  return fmt::format("within {:g} {} of '{}'", zone.distance, unit,
                     zone.surface);
}

ExclusionShare share(const TetMesh& mesh, const std::vector<char>& excluded,
                     std::string where) {
  ExclusionShare result{.where = std::move(where)};
  double all = 0.0;
  double out = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double volume = corner_volume(mesh, e);
    all += volume;
    if (excluded[static_cast<std::size_t>(e)] != 0) {
      ++result.elements;
      out += volume;
    }
  }
  result.volume_share = out / all;
  return result;
}

Json share_json(const ExclusionShare& share) {
  return {{"where", share.where},
          {"elements", share.elements},
          {"volume_share", share.volume_share}};
}

}  // namespace

Exclusion choose_exclusion(const case_data::Case& input, const TetMesh& mesh,
                           EmptyZones empty) {
  Exclusion result;
  const auto& entries = input.analysis.exclude;
  if (entries.empty()) {
    return result;
  }
  std::vector<stress::ExclusionZone> zones;
  for (const case_data::ExclusionEntry& entry : entries) {
    zones.push_back(entry.zone);
    result.zones.push_back(
        share(mesh, stress::excluded_by(mesh, {entry.zone}).element,
              where(entry.zone, input.units.length)));
    if (empty == EmptyZones::Refused && result.zones.back().elements == 0) {
      throw InvalidInput(fmt::format(
          "{}: {}: no element has its centre {}; make the zone larger or "
          "shorten resolution.fea",
          case_data::place(input, entry.line), entry.key,
          result.zones.back().where));
    }
  }
  result.what = stress::excluded_by(mesh, zones);
  result.all = share(mesh, result.what.element, "all zones");
  if (result.all.elements == mesh.element_count()) {
    const std::size_t largest = static_cast<std::size_t>(
        std::max_element(result.zones.begin(), result.zones.end(),
                         [](const ExclusionShare& a, const ExclusionShare& b) {
                           return a.elements < b.elements;
                         }) -
        result.zones.begin());
    throw InvalidInput(fmt::format(
        "{}: {}: the zones leave no element to count ({} of {} are {}); make "
        "them smaller",
        case_data::place(input, entries[largest].line), entries[largest].key,
        result.zones[largest].elements, mesh.element_count(),
        result.zones[largest].where));
  }
  return result;
}

Json exclusion_json(const Exclusion& exclusion) {
  Json zones = Json::array();
  for (const ExclusionShare& zone : exclusion.zones) {
    zones.push_back(share_json(zone));
  }
  return {{"elements", exclusion.all.elements},
          {"volume_share", exclusion.all.volume_share},
          {"zones", zones}};
}

}  // namespace meniscus::forward
