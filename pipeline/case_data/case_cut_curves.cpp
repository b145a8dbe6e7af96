/// Curves that planes of symmetry cut.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/curve_cut.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/case_data/case_symmetry.h"

namespace meniscus::case_data {

namespace {

constexpr double kAlongPlane = 1e-9;  // of a force, or a wall's normal

bool is_across(const Reach& reach) {
  return reach.most > reach.rounding && reach.least < -reach.rounding;
}

bool holds_some(const std::set<std::string>& curves,
                const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return curves.count(name) > 0;
  });
}

/// One plane, and what it cuts at the initial design.
class CutCheck {
 public:
  CutCheck(const Case& input, std::size_t plane,
           const std::vector<curves::Curve>& initial, const CaseValues& values)
      : input_(input),
        number_(plane + 1),
        plane_(input.symmetry[plane]),
        initial_(initial),
        cut_(cut_by(plane_, initial)),
        values_(values) {}

  void run(const films::FilmSystem& system) {
    const std::set<std::string> held = held_curves(input_);
    for (std::size_t c = 0; c < system.curves.size(); ++c) {
      if (held.contains(system.curves[c].name)) {
        check_curve(system.curves[c], initial_[c]);
      }
    }
    check_holders();
    for (const FilletEntry& fillet : input_.fillets) {
      if (holds_some(cut_, fillet.curves)) {
        tell(fillet.line, "a fillet along a curve that", "take it out");
      }
    }
    const std::vector<std::string> surfaces = surfaces_at(input_, cut_);
    for (const LoadCaseEntry& load_case : input_.load_cases) {
      for (const LoadEntry& load : load_case.loads) {
        check_load(load, surfaces);
      }
    }
  }

 private:
  void add(SourceLine line, const std::string& text) {
    values_.problems().push_back(place(input_, line) + ": " + text);
  }

  void tell(SourceLine line, const char* what, const char* advice) {
    add(line,
        fmt::format("{} plane {} of symmetry cuts; {}", what, number_, advice));
  }

  SourceLine line_of(const std::string& curve) const {
    const auto entry =
        std::find_if(input_.curves.begin(), input_.curves.end(),
                     [&](const CurveEntry& c) { return c.name == curve; });
    return entry == input_.curves.end() ? plane_.line : entry->line;
  }

  void check_curve(const curves::Curve& curve, const curves::Curve& initial) {
    if (cut_.count(curve.name) == 0) {
      return;  // beyond the plane, it is told as such
    }
    const Reach reach = reach_of(plane_, curve);
    const std::vector<double> at =
        curves::crossings(curve.shape, plane_.at, plane_.normal);
    if (at.size() != 2) {
      add(line_of(curve.name),
          fmt::format("curve '{}' passes plane {} of symmetry at {} places of "
                      "its own; expected two, as a curve that is its own image "
                      "there has at every design, or a curve beside the plane",
                      curve.name, number_, at.size()));
      return;
    }
    const double now =
        curves::asymmetry(curve.shape, plane_.at, plane_.normal, at[0]);
    if (!(now <= reach.rounding)) {
      add(line_of(curve.name),
          fmt::format(
              "curve '{}' crosses plane {} of symmetry and is not its own "
              "image there: it is {:.4g} off; expected one that is (corners, "
              "points and parts too), or one beside the plane or in it",
              curve.name, number_, now));
    } else if (!stays(curve, initial, reach.rounding)) {
      add(line_of(curve.name),
          fmt::format("curve '{}' crosses plane {} of symmetry at other places "
                      "of its own than at the initial design; of a circle that "
                      "turns make an ellipse with 'axis' in the plane or "
                      "across it, let a spline begin in the plane",
                      curve.name, number_));
    }
  }

  /// Does the plane cut the curve where it cuts the initial one?
  bool stays(const curves::Curve& curve, const curves::Curve& initial,
             double rounding) const {
    const std::vector<double> at =
        curves::crossings(initial.shape, plane_.at, plane_.normal);
    return !at.empty() && curves::asymmetry(curve.shape, plane_.at,
                                            plane_.normal, at[0]) <= rounding;
  }

  void check_holders() {
    for (const FilmEntry& film : input_.films) {
      if (film.spec.kind == films::FilmKind::Facets &&
          holds_some(cut_, film.spec.curves)) {
        tell(film.line, "a film of given facets at a curve that",
             "draw the whole");
      }
    }
    for (const CapEntry& cap : input_.caps) {
      if (!holds_some(cut_, cap.spec.curves())) {
        continue;
      }
      if (cap.is_file) {
        tell(cap.line, "a solid of given faces at a curve that",
             "draw the whole");
      } else if (cap.wetted && cap.symmetry < 0 && !is_own_image(*cap.wetted)) {
        tell(cap.line,
             "a solid that is wetted on a bent or slanting wall, at a curve "
             "that",
             "expected a plane at right angles to it, or draw the whole");
      }
    }
  }

  bool is_own_image(const WettedWall& wall) const {
    if (wall.kind != films::WallKind::Plane) {
      return false;
    }
    const Vec3 normal = values_.at(wall.normal);
    return std::abs(plane_.normal.dot(normal)) <= kAlongPlane * normal.norm();
  }

  /// Forces through points, by pins and with moments are shared out over a half
  /// otherwise than over the whole.
  void check_load(const LoadEntry& load,
                  const std::vector<std::string>& surfaces) {
    const auto among = [&](const loads::Surfaces& names) {
      return std::any_of(names.begin(), names.end(), [&](const auto& name) {
        return std::find(surfaces.begin(), surfaces.end(), name) !=
               surfaces.end();
      });
    };
    if (!among(load.surfaces) && !among(load.thread)) {
      return;
    }
    if (load.kind == LoadKind::Remote || load.kind == LoadKind::Preload ||
        load.by != LoadPath::Spread) {
      tell(load.line,
           "a moment, a preload or a force with 'at' or 'by' on a surface that",
           "give the part's share of a 'force' alone, or draw the whole");
      return;
    }
    if (load.kind == LoadKind::Force) {
      const Vec3 force = values_.at(load.vector);
      if (std::abs(plane_.normal.dot(force)) > kAlongPlane * force.norm()) {
        tell(load.line, "a force across it on a surface that",
             "expected one along the plane");
      }
    }
  }

  const Case& input_;
  std::size_t number_;
  const SymmetryPlane& plane_;
  const std::vector<curves::Curve>& initial_;
  std::set<std::string> cut_;
  const CaseValues& values_;
};

}  // namespace

std::vector<curves::Curve> curves_at_start(const Case& input) {
  std::vector<std::string> found;
  try {
    const CaseValues values(input, initial_design(input), found);
    std::vector<curves::Curve> curves = curves_of(input, values);
    return found.empty() ? curves : std::vector<curves::Curve>();
  } catch (const Error&) {
    return {};
  }
}

std::set<std::string> cut_by(const SymmetryPlane& plane,
                             const std::vector<curves::Curve>& curves) {
  std::set<std::string> result;
  for (const curves::Curve& curve : curves) {
    if (is_across(reach_of(plane, curve))) {
      result.insert(curve.name);
    }
  }
  return result;
}

std::vector<std::string> surfaces_at(const Case& input,
                                     const std::set<std::string>& curves) {
  std::vector<std::string> result;
  for (const FilmEntry& film : input.films) {
    if (holds_some(curves, film.spec.curves)) {
      result.push_back(film.spec.name);
    }
  }
  for (const CapEntry& cap : input.caps) {
    if (holds_some(curves, cap.spec.curves())) {
      result.push_back(cap.spec.name);
    }
  }
  return result;
}

void check_cut_curves(const Case& input, const films::FilmSystem& system,
                      const CaseValues& values) {
  const std::vector<curves::Curve> initial = curves_at_start(input);
  if (initial.size() != system.curves.size()) {
    return;  // told there
  }
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    CutCheck(input, p, initial, values).run(system);
  }
}

}  // namespace meniscus::case_data
