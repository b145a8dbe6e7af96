/// Curves of STEP files as the text that a case keeps.
#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "core/error.h"
#include "pipeline/files/step_curve.h"

namespace meniscus::files {

namespace {

std::string row(const char* what, const Vec3& p) {
  return fmt::format("{},{},{},{}\n", what, p[0], p[1], p[2]);
}

}  // namespace

std::string step_curve_text(const StepCurve& curve) {
  std::string text = fmt::format("# {}\nwhat,x,y,z\n", curve.description);
  if (const auto* circle = std::get_if<curves::Circle>(&curve.shape)) {
    text += row("center", circle->center) + row("normal", circle->normal) +
            row("radius", {circle->radius, 0.0, 0.0});
  } else if (const auto* ellipse = std::get_if<curves::Ellipse>(&curve.shape)) {
    text += row("center", ellipse->center) + row("normal", ellipse->normal) +
            row("axis", ellipse->axis) +
            row("radii", {ellipse->radius_1, ellipse->radius_2, 0.0});
  } else if (const auto* spline = std::get_if<curves::Spline>(&curve.shape)) {
    for (const Vec3& p : spline->points) {
      text += row("point", p);
    }
  } else if (const auto* line = std::get_if<curves::Polyline>(&curve.shape)) {
    for (std::size_t k = 0; k < line->corners.size(); ++k) {
      text += row("corner", line->corners[k]);
      if (line->via[k]) {
        text += row("through", *line->via[k]);
      }
    }
  }
  return text;
}

namespace {

/// A row "what,x,y,z".
bool read_row(std::string_view text, std::string& what, Vec3& p) {
  std::size_t at = text.find(',');
  what = text.substr(0, at);
  for (int axis = 0; axis < 3; ++axis) {
    if (at == std::string_view::npos) {
      return false;
    }
    text.remove_prefix(at + 1);
    at = text.find(',');
    const std::string_view cell = text.substr(0, at);
    const char* end = cell.data() + cell.size();
    const auto [rest, error] = std::from_chars(cell.data(), end, p[axis]);
    if (error != std::errc() || rest != end) {
      return false;
    }
  }
  return true;
}

}  // namespace

StepCurve read_step_curve_text(const std::string& text) {
  StepCurve result;
  curves::Circle circle;
  curves::Ellipse ellipse;
  curves::Spline spline;
  curves::Polyline line;
  bool round = false;
  bool good = text.starts_with("# ");
  for (std::size_t at = 0; good && at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view all(text);
    const std::string_view here = all.substr(at, end - at);
    at = end + 1;
    if (here.starts_with("# ")) {
      result.description = here.substr(2);
      continue;
    }
    if (here == "what,x,y,z") {
      continue;
    }
    std::string what;
    Vec3 p;
    good = read_row(here, what, p);
    if (what == "center") {
      circle.center = ellipse.center = p;
    } else if (what == "normal") {
      circle.normal = ellipse.normal = p;
    } else if (what == "axis") {
      ellipse.axis = p;
    } else if (what == "radius") {
      circle.radius = p[0];
      round = true;
    } else if (what == "radii") {
      ellipse.radius_1 = p[0];
      ellipse.radius_2 = p[1];
    } else if (what == "point") {
      spline.points.push_back(p);
    } else if (what == "corner") {
      line.corners.push_back(p);
      line.via.emplace_back();
    } else if (what == "through" && !line.via.empty()) {
      line.via.back() = p;
    } else {
      good = false;
    }
  }
  if (!good) {
    throw InvalidInput(
        "the case holds a curve of a STEP file that cannot be "
        "read");
  }
  if (round) {
    result.shape = circle;
  } else if (!spline.points.empty()) {
    result.shape = std::move(spline);
  } else if (!line.corners.empty()) {
    result.shape = std::move(line);
  } else {
    result.shape = ellipse;
  }
  return result;
}

}  // namespace meniscus::files
