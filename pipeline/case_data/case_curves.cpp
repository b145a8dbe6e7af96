#include "pipeline/case_data/case_curves.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/curves/curve_contact.h"
#include "evolve/films/joined_sides.h"
#include "evolve/films/shared_sides.h"
#include "evolve/start/disk_fill.h"
#include "pipeline/case_data/case_features.h"
#include "pipeline/case_data/design_vectors.h"

namespace meniscus::case_data {

namespace {

Points points_of(const CurveEntry& entry, const CaseValues& values) {
  Points points;
  points.reserve(entry.points.size() + entry.fixed_points.size());
  for (const PathPoint& point : entry.points) {
    points.push_back(values.at(point.at));
  }
  for (const Vec3& point : entry.fixed_points) {
    points.push_back(values.are_rates() ? Vec3(Vec3::Zero()) : point);
  }
  return points;
}

curves::Polyline polyline_of(const CurveEntry& entry,
                             const CaseValues& values) {
  curves::Polyline result;
  for (const PathPoint& point : entry.points) {
    if (point.through) {
      result.via.back() = values.at(point.at);
    } else {
      result.corners.push_back(values.at(point.at));
      result.via.emplace_back();
    }
  }
  return result;
}

curves::CurveCopy copy_of(const CurveEntry& entry,
                          const std::vector<curves::Curve>& above,
                          const CaseValues& values) {
  const CopyEntry& copy = entry.copy;
  curves::CurveCopy result;
  result.of = std::make_shared<const curves::Curve>(
      above[static_cast<std::size_t>(copy.of)]);
  if (copy.offset) {
    result.offset = values.at(*copy.offset);
  }
  result.scale = values.at(copy.scale);
  if (copy.mirror) {
    result.mirror = values.at(*copy.mirror);
  }
  result.angle = values.at(copy.angle);
  result.axis = values.at(entry.axis);
  result.about = values.at(copy.about);
  result.move = values.at(copy.move);
  return result;
}

curves::CurveShape shape_of(const CurveEntry& curve,
                            const std::vector<curves::Curve>& above,
                            const CaseValues& values) {
  switch (curve.kind) {
    case CurveKind::Circle:
      return curves::Circle{values.at(curve.center), values.at(curve.normal),
                            values.at(curve.radius)};
    case CurveKind::Ellipse:
      return curves::Ellipse{values.at(curve.center), values.at(curve.normal),
                             values.at(curve.axis), values.at(curve.radius_1),
                             values.at(curve.radius_2)};
    case CurveKind::Rectangle:
      return curves::Rectangle{
          values.at(curve.center), values.at(curve.normal),
          values.at(curve.axis),   values.at(curve.width),
          values.at(curve.height), values.at(curve.corner_radius)};
    case CurveKind::Spline:
      return curves::Spline{points_of(curve, values)};
    case CurveKind::Polyline:
      return polyline_of(curve, values);
    case CurveKind::Copy:
      return copy_of(curve, above, values);
    case CurveKind::Polygon:
    case CurveKind::OfFeature:
      break;
  }
  return curves::Polygon{points_of(curve, values)};
}

/// The values of what a curve that is none is made of.
std::string where(const CurveEntry& entry, const CaseValues& values) {
  std::vector<QuantityVector> points;
  points.reserve(entry.points.size());
  for (const PathPoint& point : entry.points) {
    points.push_back(point.at);
  }
  const CopyEntry& copy = entry.copy;
  return values.where(entry.center, entry.normal, entry.axis, entry.radius,
                      entry.radius_1, entry.radius_2, entry.width, entry.height,
                      entry.corner_radius, points,
                      copy.offset.value_or(Quantity{}), copy.scale,
                      copy.mirror.value_or(QuantityVector{}), copy.angle,
                      copy.about, copy.move);
}

bool may_meet_itself(const CurveEntry& entry) {
  return entry.kind == CurveKind::Polygon || entry.kind == CurveKind::Spline ||
         entry.kind == CurveKind::Polyline || entry.copy.offset.has_value();
}

/// Refuses what is no curve, and one that crosses itself.
void check(const CurveEntry& entry, const curves::Curve& curve) {
  curves::validate(curve);
  if (!may_meet_itself(entry)) {
    return;
  }
  if (const auto at = curves::meets_itself(curve.shape)) {
    throw InvalidInput(fmt::format(
        "curve '{}': crosses or touches itself near ({:.4g}, {:.4g}, {:.4g}); "
        "no film can start there: {}",
        curve.name, at->x(), at->y(), at->z(),
        entry.copy.offset ? "offset it less"
                          : "points must follow each other around the curve"));
  }
}

}  // namespace

bool have_equal_shapes(const std::vector<curves::Curve>& a,
                       const std::vector<curves::Curve>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const curves::Curve& one, const curves::Curve& other) {
                      return curves::are_equal(one.shape, other.shape);
                    });
}

std::vector<curves::Curve> curves_of(const Case& input,
                                     const CaseValues& values) {
  std::vector<curves::Curve> result;
  result.reserve(input.curves.size());
  std::vector<char> bad;  // copies of those are no news
  const std::size_t no_problems = values.problems().size();
  if (!values.are_rates()) {
    check_features(input, values);
  }
  const bool features_bad = values.problems().size() > no_problems;
  const auto of_features = feature_curves(input, values);
  for (const CurveEntry& entry : input.curves) {
    const std::size_t before = values.problems().size();
    if (entry.kind == CurveKind::Copy &&
        bad[static_cast<std::size_t>(entry.copy.of)] != 0) {
      const auto of = static_cast<std::size_t>(entry.copy.of);
      result.push_back({entry.name, result[of].shape});
      bad.push_back(1);
      continue;
    }
    curves::Curve curve{entry.name,
                        entry.kind == CurveKind::OfFeature
                            ? of_features[entry.feature][entry.of_feature]
                            : shape_of(entry, result, values)};
    if (entry.kind == CurveKind::OfFeature && features_bad) {
      result.push_back(std::move(curve));  // told already
      bad.push_back(1);
      continue;
    }
    if (!values.are_rates() && values.problems().size() == before) {
      try {
        check(entry, curve);
      } catch (const InvalidInput& error) {
        values.problems().push_back(
            fmt::format("{}: {}{}", place(input, entry.line), error.what(),
                        where(entry, values)));
      }
    }
    bad.push_back(values.problems().size() > before ? 1 : 0);
    result.push_back(std::move(curve));
  }
  if (!values.are_rates() && !features_bad) {
    check_feature_rims(input, result, values);
  }
  return result;
}

namespace {

constexpr int kAround = 64;  // places on a curve

Points rim_places(const curves::CurveShape& shape) {
  std::vector<double> t(kAround);
  for (int k = 0; k < kAround; ++k) {
    t[static_cast<std::size_t>(k)] = static_cast<double>(k) / kAround;
  }
  return curves::points_at(shape, t);
}

/// Faces of several planes may have one name.
bool share_plane(const curves::CurveShape& one,
                 const curves::CurveShape& other) {
  constexpr double kOffPlane = 1e-6;  // of the size
  const Points a = rim_places(one);
  const Points b = rim_places(other);
  const Vec3 normal = polygon_area_vector(a).normalized();
  const double off = kOffPlane * (bounding_diagonal(a) + bounding_diagonal(b));
  const auto lies = [&](const Vec3& p) {
    return std::abs(normal.dot(p - a[0])) <= off;
  };
  return std::all_of(a.begin(), a.end(), lies) &&
         std::all_of(b.begin(), b.end(), lies);
}

/// The plane face that ends at both curves; empty: none does.
std::string face_with(const films::FilmSystem& system, const curves::Curve& a,
                      const curves::Curve& b) {
  for (const films::CapSpec& cap : system.caps) {
    const std::vector<std::string>& rims = cap.more;
    if (std::find(rims.begin(), rims.end(), a.name) != rims.end() &&
        std::find(rims.begin(), rims.end(), b.name) != rims.end() &&
        share_plane(a.shape, b.shape)) {
      return cap.name;
    }
  }
  return "";
}

}  // namespace

void check_meetings(const Case& input, const films::FilmSystem& system,
                    const CaseValues& values) {
  const films::SharedRims shared(system.curves);
  std::vector<std::size_t> rims;  // what holds a film or a cap
  std::vector<const curves::CurveShape*> shapes;
  for (std::size_t c = 0; c < system.curves.size(); ++c) {
    const std::string& name = system.curves[c].name;
    const bool held =
        std::any_of(system.films.begin(), system.films.end(),
                    [&](const films::FilmSpec& film) {
                      return std::find(film.curves.begin(), film.curves.end(),
                                       name) != film.curves.end();
                    }) ||
        std::any_of(system.caps.begin(), system.caps.end(),
                    [&](const films::CapSpec& cap) {
                      const std::vector<std::string> at = cap.curves();
                      return std::find(at.begin(), at.end(), name) != at.end();
                    });
    if (held) {
      rims.push_back(c);
      shapes.push_back(&system.curves[c].shape);
    }
  }
  for (const curves::CurveMeeting& meeting : curves::meetings_of(shapes)) {
    const std::size_t a = rims[static_cast<std::size_t>(meeting.first)];
    const std::size_t b = rims[static_cast<std::size_t>(meeting.second)];
    if (shared.shares(static_cast<int>(a)) &&
        shared.shares(static_cast<int>(b))) {
      continue;  // faces that join: check_sides() looks at them
    }
    if (films::may_meet(system, static_cast<int>(a), static_cast<int>(b))) {
      continue;  // a film ends on another there
    }
    const Vec3& at = meeting.place;
    const std::string face =
        face_with(system, system.curves[a], system.curves[b]);
    const std::string of_second = where(input.curves[b], values);
    values.problems().push_back(fmt::format(
        "{}: curves '{}' and '{}' meet near ({:.4g}, {:.4g}, {:.4g}){}; {}",
        place(input, input.curves[b].line), input.curves[a].name,
        input.curves[b].name, at.x(), at.y(), at.z(),
        of_second.empty() ? where(input.curves[a], values) : of_second,
        face.empty() ? "films join where they name the same curve, other "
                       "curves must keep apart"
                     : fmt::format("these rims of '{}' have merged: keep them "
                                   "apart, or draw one curve around both",
                                   face)));
  }
}

namespace {

/// How two closed curves of one plane that do not cross lie.
enum class Nesting { Beside, Within, Around };

/// Does the loop wind around the point, both in a plane?
bool winds_around(const Points& loop, const Vec3& at) {
  const Vec3 normal = polygon_area_vector(loop).normalized();
  double turned = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3 from = loop[k] - at;
    const Vec3 to = loop[(k + 1) % loop.size()] - at;
    turned += std::atan2(normal.dot(from.cross(to)), from.dot(to));
  }
  return std::abs(turned) > EIGEN_PI;
}

Nesting nesting_of(const curves::CurveShape& one,
                   const curves::CurveShape& other) {
  const Points a = rim_places(one);
  const Points b = rim_places(other);
  if (winds_around(b, a[0])) {
    return Nesting::Within;
  }
  return winds_around(a, b[0]) ? Nesting::Around : Nesting::Beside;
}

class NestingCheck {
 public:
  NestingCheck(const Case& input, const std::vector<curves::Curve>& initial,
               const std::vector<curves::Curve>& now, const VectorX& design,
               std::vector<std::string>& problems)
      : input_(input),
        initial_(initial),
        now_(now),
        design_(design),
        shared_(now),
        problems_(problems) {}

  void run(const films::CapSpec& cap) {
    for (std::size_t i = 0; i < cap.more.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        compare(cap, index_of(cap.more[j]), index_of(cap.more[i]));
      }
    }
  }

 private:
  std::size_t index_of(const std::string& curve) const {
    const auto at =
        std::find_if(now_.begin(), now_.end(),
                     [&](const curves::Curve& c) { return c.name == curve; });
    return static_cast<std::size_t>(at - now_.begin());
  }

  void compare(const films::CapSpec& cap, std::size_t a, std::size_t b) {
    if (a == now_.size() || b == now_.size() ||
        (shared_.shares(static_cast<int>(a)) &&
         shared_.shares(static_cast<int>(b))) ||
        !share_plane(now_[a].shape, now_[b].shape)) {
      return;  // faces that join, or of other planes
    }
    const Nesting found = nesting_of(now_[a].shape, now_[b].shape);
    if (found == nesting_of(initial_[a].shape, initial_[b].shape)) {
      return;
    }
    const auto& [inner, outer] =
        found == Nesting::Around ? std::pair(b, a) : std::pair(a, b);
    problems_.push_back(fmt::format(
        "{}: curves '{}' and '{}', rims of '{}', have merged on the way from "
        "the initial design: '{}' lies {} '{}' at {}; keep them apart",
        place(input_, input_.curves[b].line), now_[a].name, now_[b].name,
        cap.name, now_[inner].name,
        found == Nesting::Beside ? "beside" : "within", now_[outer].name,
        design_text(input_, design_)));
  }

  const Case& input_;
  const std::vector<curves::Curve>& initial_;
  const std::vector<curves::Curve>& now_;
  const VectorX& design_;
  films::SharedRims shared_;
  std::vector<std::string>& problems_;
};

}  // namespace

void check_nesting(const Case& input, const films::FilmSystem& system,
                   const std::vector<curves::Curve>& first,
                   const VectorX& design, std::vector<std::string>& problems) {
  const bool may_nest = std::any_of(
      system.caps.begin(), system.caps.end(),
      [](const films::CapSpec& cap) { return cap.more.size() > 1; });
  if (!may_nest || have_equal_shapes(first, system.curves)) {
    return;
  }
  NestingCheck check(input, first, system.curves, design, problems);
  for (const films::CapSpec& cap : system.caps) {
    if (cap.wall) {
      continue;  // films slide there, and curves hold nothing
    }
    check.run(cap);
  }
}

}  // namespace meniscus::case_data
