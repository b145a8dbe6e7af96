#include "pipeline/case_data/case_sides.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "evolve/films/shared_sides.h"
#include "pipeline/case_data/case_checks.h"

namespace meniscus::case_data {

namespace {

using SideName = std::pair<int, int>;  // curve, side

std::string text(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

/// The first of the shared sides that one is the same as.
std::map<SideName, SideName> first_of(
    const std::vector<films::SharedSide>& shared) {
  std::map<SideName, SideName> first;
  for (const films::SharedSide& side : shared) {
    const SideName known(side.first_curve, side.first_side);
    const auto at = first.find(known);
    first.emplace(SideName(side.second_curve, side.second_side),
                  at == first.end() ? known : at->second);
  }
  return first;
}

std::vector<std::string> curves_of_surface(const films::FilmSystem& system,
                                           const std::string& name) {
  for (const films::CapSpec& cap : system.caps) {
    if (cap.name == name) {
      return cap.curves();
    }
  }
  for (const films::FilmSpec& film : system.films) {
    if (film.name == name) {
      return film.curves;
    }
  }
  return {};
}

using SurfacesAtSides = std::map<SideName, std::vector<std::string>>;

/// Surfaces of the body at each side of the polygons that bound them.
SurfacesAtSides surfaces_at_sides(const films::FilmSystem& system,
                                  const films::BodySpec& body,
                                  const std::map<SideName, SideName>& first) {
  SurfacesAtSides result;
  for (const std::string& surface : body.enclosed_by) {
    for (const std::string& name : curves_of_surface(system, surface)) {
      for (int c = 0; c < static_cast<int>(system.curves.size()); ++c) {
        const curves::Curve& curve = system.curves[static_cast<std::size_t>(c)];
        const auto* polygon = std::get_if<curves::Polygon>(&curve.shape);
        if (curve.name != name || polygon == nullptr) {
          continue;
        }
        for (int k = 0; k < static_cast<int>(polygon->points.size()); ++k) {
          const auto at = first.find({c, k});
          result[at == first.end() ? SideName(c, k) : at->second].push_back(
              surface);
        }
      }
    }
  }
  return result;
}

/// The caps outside the body, by the sides that they end at.
SurfacesAtSides caps_beside(const films::FilmSystem& system,
                            const films::BodySpec& body,
                            const std::map<SideName, SideName>& first) {
  films::BodySpec others;
  for (const films::CapSpec& cap : system.caps) {
    if (std::find(body.enclosed_by.begin(), body.enclosed_by.end(), cap.name) ==
        body.enclosed_by.end()) {
      others.enclosed_by.push_back(cap.name);
    }
  }
  return surfaces_at_sides(system, others, first);
}

/// "the side from A to B of curve 'c' ...": the first of one curve's sides that
/// are open, with `surfaces` there, how many there are, and what to do.
std::string open_sides_text(const films::FilmSystem& system,
                            const std::vector<SideName>& sides,
                            const std::vector<std::string>& surfaces,
                            const SurfacesAtSides& beside) {
  const curves::Curve& curve =
      system.curves[static_cast<std::size_t>(sides.front().first)];
  const Points& corners = std::get<curves::Polygon>(curve.shape).points;
  const auto k = static_cast<std::size_t>(sides.front().second);
  const std::string more =
      sides.size() == 1
          ? ""
          : fmt::format(" and {} more of its sides", sides.size() - 1);
  const auto face = beside.find(sides.front());
  return fmt::format(
      "the side from {} to {} of curve '{}'{}: {} of its surfaces meet{} there "
      "({}), expected two; {}faces join where both polygons have the same two "
      "corners next to each other: add a corner where a face ends amid a side",
      text(corners[k]), text(corners[(k + 1) % corners.size()]), curve.name,
      more, surfaces.size(), surfaces.size() == 1 ? "s" : "",
      fmt::join(surfaces, ", "),
      face == beside.end()
          ? ""
          : fmt::format("add '{}' to enclosed_by, or: ", face->second.front()));
}

}  // namespace

bool may_join_by_sides(const Case& input, const std::string& curve) {
  std::set<std::string> polygons;  // across which there are caps
  for (const CapEntry& cap : input.caps) {
    for (const std::string& name : cap.spec.curves()) {
      if (std::any_of(input.curves.begin(), input.curves.end(),
                      [&](const CurveEntry& entry) {
                        return entry.name == name &&
                               entry.kind == CurveKind::Polygon;
                      })) {
        polygons.insert(name);
      }
    }
  }
  return polygons.count(curve) != 0 && polygons.size() > 2;
}

void check_sides(const Case& input, const films::FilmSystem& system,
                 const CaseValues& values) {
  const std::map<SideName, SideName> first =
      first_of(films::shared_sides(system.curves));
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    if (has_facets(input, input.bodies[b])) {
      continue;  // facets may join elsewhere than on curves: check_start()
    }
    const auto at_sides = surfaces_at_sides(system, system.bodies[b], first);
    std::map<int, std::vector<SideName>> open;  // by curve
    for (const auto& [side, surfaces] : at_sides) {
      if (surfaces.size() != 2) {
        open[side.first].push_back(side);
      }
    }
    for (const auto& [curve, sides] : open) {
      values.problems().push_back(fmt::format(
          "{}: body '{}' is not closed at {}",
          place(input, input.bodies[b].enclosure_line), system.bodies[b].name,
          open_sides_text(system, sides, at_sides.at(sides.front()),
                          caps_beside(system, system.bodies[b], first))));
    }
  }
}

}  // namespace meniscus::case_data
