#include "evolve/walls/wall_ends.h"

#include <algorithm>

namespace meniscus::walls {

namespace {

constexpr double kShiftReach = 3.0;  // x the shift
constexpr double kSquareEnd = 1e-3;  // of the offset: no shift

/// How far an end's point has left its offset along the film.
struct Shift {
  int vertex = 0;
  Vec3 by = Vec3::Zero();
  double reach = 0.0;  // [length]
};

Vec3 across(const Vec3& normal, const Vec3& by) {
  return by - normal.dot(by) * normal;
}

std::vector<Shift> find_shifts(const Sheet& sheet, const SheetEnds& ends,
                               const Points& side) {
  std::vector<Shift> shifts;
  for (int v = 0; v < static_cast<int>(ends.along.size()); ++v) {
    if (!ends.slides(v) || sheet.on_crease[v] != 0) {
      continue;
    }
    const Vec3 move = side[v] - sheet.film.points[v];
    const Vec3 by = across(ends.normals[v], move);
    if (by.norm() > kSquareEnd * move.norm()) {
      shifts.push_back({v, by, kShiftReach * by.norm()});
    }
  }
  return shifts;
}

}  // namespace

SheetEnds ends_of(const Sheet& sheet, const std::vector<Jet>& jets,
                  const WallPlanes& planes) {
  SheetEnds ends;
  for (std::size_t i = 0; i < jets.size() && !planes.at.empty(); ++i) {
    ends.along.push_back(planes.along(sheet.origin[i]));
    ends.normals.push_back(jets[i].normal);
  }
  return ends;
}

void make_room(const Sheet& sheet, const SheetEnds& ends, Points& side) {
  const std::vector<Shift> shifts = find_shifts(sheet, ends, side);
  const Points& x = sheet.film.points;
  auto own = shifts.begin();
  for (int v = 0; v < static_cast<int>(ends.along.size()); ++v) {
    if (own != shifts.end() && own->vertex == v) {
      ++own;
      continue;
    }
    const auto away = [&](const Shift& shift) {
      return (x[v] - x[shift.vertex]).norm() / shift.reach;
    };
    const auto nearest = std::min_element(
        shifts.begin(), shifts.end(),
        [&](const Shift& a, const Shift& b) { return away(a) < away(b); });
    if (nearest == shifts.end()) {
      return;
    }
    const Vec3 by = std::max(0.0, 1.0 - away(*nearest)) *
                    across(ends.normals[v], nearest->by);
    side[v] += ends.slides(v) ? Vec3(*ends.along[v] * by) : by;
  }
}

}  // namespace meniscus::walls
