/// Curves that lie on each other are one curve for films and solids.
#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "core/math/union_find.h"
#include "evolve/curves/curve_contact.h"
#include "evolve/walls/rim_shape.h"
#include "pipeline/case_data/case_curves.h"

namespace meniscus::case_data {

namespace {

constexpr double kSameBox = 1e-3;  // of the size: corners of boxes, centres
constexpr int kPlaces = 64;

/// What tells most curves apart at once.
struct Outline {
  int curve = 0;
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
  double size = 0.0;
};

Outline outline_of(int index, const curves::CurveShape& shape) {
  const Points points = curves::points_at(
      shape,
      curves::sample_parameters(shape, curves::length_of(shape), kPlaces));
  Outline result{index, points[0], points[0], bounding_diagonal(points)};
  for (const Vec3& p : points) {
    result.low = result.low.cwiseMin(p);
    result.high = result.high.cwiseMax(p);
  }
  return result;
}

bool alike(const Outline& a, const Outline& b) {
  const double near = 10.0 * kSameBox * std::min(a.size, b.size);
  return (a.low - b.low).norm() <= near && (a.high - b.high).norm() <= near;
}

/// Outlines of the held curves, from the least x up.
std::vector<Outline> outlines_of(const Case& input,
                                 const std::vector<curves::Curve>& curves) {
  const std::set<std::string> held = held_curves(input);
  std::vector<Outline> result;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (held.contains(curves[c].name)) {
      result.push_back(outline_of(static_cast<int>(c), curves[c].shape));
    }
  }
  std::stable_sort(
      result.begin(), result.end(),
      [](const Outline& a, const Outline& b) { return a.low.x() < b.low.x(); });
  return result;
}

/// Per curve the first one that it lies on, itself where there is none.
std::vector<int> first_curves(const Case& input,
                              const std::vector<curves::Curve>& curves,
                              std::map<int, double>& distance) {
  const std::vector<Outline> outlines = outlines_of(input, curves);
  UnionFind alikes(curves.size());
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const Outline& a = outlines[i];
    for (std::size_t j = i + 1;
         j < outlines.size() &&
         outlines[j].low.x() <= a.low.x() + 10.0 * kSameBox * a.size;
         ++j) {
      const Outline& b = outlines[j];
      if (!alike(a, b)) {
        continue;
      }
      if (const auto off = curves::lie_on_each_other(curves[a.curve].shape,
                                                     curves[b.curve].shape)) {
        const int dropped =
            std::max(alikes.root(a.curve), alikes.root(b.curve));
        alikes.join(a.curve, b.curve);
        distance[dropped] = *off;
      }
    }
  }
  return alikes.roots();
}

/// The kept names in a list; a list that would have one twice is noted.
void rename(const std::map<std::string, std::string>& kept,
            const std::string& what, SourceLine line,
            std::vector<std::string>& names, CaseProblems& problems) {
  std::map<std::string, std::string> seen;
  for (std::string& name : names) {
    const auto at = kept.find(name);
    const std::string to = at == kept.end() ? name : at->second;
    const auto [other, is_new] = seen.emplace(to, name);
    if (!is_new && other->second != name) {
      problems.add(line, fmt::format("{} names the curves '{}' and '{}', which "
                                     "lie on each other and are one; move one, "
                                     "or take it out",
                                     what, other->second, name));
    }
    name = to;
  }
}

}  // namespace

std::set<std::string> held_curves(const Case& input) {
  std::set<std::string> held;
  for (const FilmEntry& film : input.films) {
    held.insert(film.spec.curves.begin(), film.spec.curves.end());
  }
  for (const CapEntry& cap : input.caps) {
    const std::vector<std::string> curves = cap.spec.curves();
    held.insert(curves.begin(), curves.end());
  }
  return held;
}

namespace {

/// True where curves in one place are free in part: they hold.
bool hold_if_one_holds(CurveEntry& one, CurveEntry& other) {
  const bool differ = one.free != other.free || !one.free_sides.empty() ||
                      !other.free_sides.empty();
  if (differ) {
    one.free = other.free = false;
    one.free_sides.clear();
    other.free_sides.clear();
  }
  return differ;
}

}  // namespace

void merge_curves(Case& input, CaseProblems& problems) {
  std::vector<std::string> found;
  std::vector<curves::Curve> curves;
  try {
    const VectorX design = initial_design(input);
    const CaseValues values(input, design, found);
    curves = found.empty() ? curves_of(input, values) : curves;
  } catch (const Error&) {
    return;  // told when the case's numbers are checked
  }
  if (!found.empty()) {
    return;
  }
  std::map<int, double> distance;
  const std::vector<int> first = first_curves(input, curves, distance);
  std::map<std::string, std::string> kept;
  const std::string unit = input.units.unit_of(Dimension::Length);
  for (std::size_t c = 0; c < first.size(); ++c) {
    if (first[c] == static_cast<int>(c)) {
      continue;
    }
    CurveEntry& one = input.curves[static_cast<std::size_t>(first[c])];
    CurveEntry& other = input.curves[c];
    input.merged.push_back({first[c], static_cast<int>(c)});
    kept[other.name] = one.name;
    input.remarks.push_back(fmt::format(
        "{}: curve '{}' lies on '{}' within {:.2g} {}: one curve, which films "
        "and solids know as '{}'{}",
        place(input, other.line), other.name, one.name,
        distance[static_cast<int>(c)], unit, one.name,
        hold_if_one_holds(one, other) ? "; it holds films, as one of the two "
                                        "is not free all around"
                                      : ""));
  }
  if (kept.empty()) {
    return;
  }
  for (FilmEntry& film : input.films) {
    rename(kept, "films." + film.spec.name, film.line, film.spec.curves,
           problems);
  }
  for (ShapeEntry& entry : input.shapes) {
    const walls::RimSplines* between =
        entry.shape != nullptr ? walls::rim_splines_of(*entry.shape) : nullptr;
    if (between != nullptr) {
      walls::RimSplines splines = *between;
      std::vector<std::string> names = {splines.first, splines.second};
      const std::size_t before = problems.size();
      rename(kept, "shapes." + entry.name, entry.line, names, problems);
      if (problems.size() == before) {
        splines.first = names[0];
        splines.second = names[1];
        entry.shape = walls::rim_splines(splines);
      }
    }
  }
  for (StepSolidEntry& solid : input.step_solids) {
    for (films::SolidSpec::Rim& rim : solid.spec.rims) {
      const auto at = kept.find(rim.curve);
      rim.curve = at == kept.end() ? rim.curve : at->second;
    }
  }
  for (CapEntry& cap : input.caps) {
    std::vector<std::string> names = cap.spec.curves();
    if (names.empty()) {
      continue;  // a plane of symmetry cuts it alone
    }
    rename(kept, "solids." + cap.spec.name, cap.line, names, problems);
    if (cap.is_file) {
      cap.spec.rims = std::move(names);
      continue;
    }
    const bool is_ring = !cap.spec.inner.empty();
    cap.spec.curve = names[0];
    cap.spec.inner = is_ring ? names[1] : "";
    cap.spec.more.assign(names.begin() + (is_ring ? 2 : 1), names.end());
  }
}

void check_merged(const Case& input, const EvaluatedCase& initial,
                  const EvaluatedCase& other, CaseProblems& problems) {
  const auto moved = [&](int curve) {
    const auto at = [&](const EvaluatedCase& inputs, double t) {
      return curves::point_at(
          inputs.film_system.curves[static_cast<std::size_t>(curve)].shape, t);
    };
    return at(initial, 0.0) != at(other, 0.0) ||
           at(initial, 0.3) != at(other, 0.3) ||
           at(initial, 0.7) != at(other, 0.7);
  };
  for (const MergedCurves& pair : input.merged) {
    const auto a = static_cast<std::size_t>(pair.kept);
    const auto b = static_cast<std::size_t>(pair.dropped);
    if ((moved(pair.kept) || moved(pair.dropped)) &&
        !curves::lie_on_each_other(other.film_system.curves[a].shape,
                                   other.film_system.curves[b].shape)) {
      problems.add(
          input.curves[b].line,
          fmt::format("curves '{}' and '{}' lie on each other at the initial "
                      "design and are one curve, but part where design "
                      "variables move them; let both follow the same "
                      "expressions, or keep them apart",
                      input.curves[a].name, input.curves[b].name));
    }
  }
}

}  // namespace meniscus::case_data
