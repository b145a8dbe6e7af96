#include "evolve/walls/wall_ends.h"

#include <algorithm>

namespace meniscus::walls {

namespace {

constexpr double kShiftReach = 3.0;  // x the larger shift
constexpr double kSquare = 1e-3;     // of the thickness: no shift

/// How far an end's points have left their offsets along the film.
struct Shift {
  int vertex = 0;
  Vec3 front, back;
  double reach = 0.0;  // [length]
};

Vec3 along_film(const Jet& jet, const Vec3& by) {
  return by - jet.normal.dot(by) * jet.normal;
}

std::vector<Shift> find_shifts(const Sheet& sheet, const std::vector<Jet>& jets,
                               const SheetEnds& ends,
                               const OffsetSides& sides) {
  std::vector<Shift> shifts;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (!ends[i] || sheet.on_crease[i] != 0) {
      continue;
    }
    const Vec3& x = sheet.film.points[i];
    const Vec3 front = along_film(jets[i], sides.front[i] - x);
    const Vec3 back = along_film(jets[i], sides.back[i] - x);
    const double larger = std::max(front.norm(), back.norm());
    if (larger > kSquare * (sides.front[i] - sides.back[i]).norm()) {
      shifts.push_back(
          {static_cast<int>(i), front, back, kShiftReach * larger});
    }
  }
  return shifts;
}

}  // namespace

void make_room(const Sheet& sheet, const std::vector<Jet>& jets,
               const SheetEnds& ends, OffsetSides& sides) {
  const std::vector<Shift> shifts = find_shifts(sheet, jets, ends, sides);
  const Points& x = sheet.film.points;
  for (std::size_t i = 0; i < ends.size() && !shifts.empty(); ++i) {
    if (ends[i]) {
      continue;
    }
    const auto away = [&](const Shift& shift) {
      return (x[i] - x[shift.vertex]).norm() / shift.reach;
    };
    const Shift& nearest = *std::min_element(
        shifts.begin(), shifts.end(),
        [&](const Shift& a, const Shift& b) { return away(a) < away(b); });
    const double share = std::max(0.0, 1.0 - away(nearest));
    sides.front[i] += share * along_film(jets[i], nearest.front);
    sides.back[i] += share * along_film(jets[i], nearest.back);
  }
}

}  // namespace meniscus::walls
