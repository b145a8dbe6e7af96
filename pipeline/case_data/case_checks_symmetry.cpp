/// Checks that what a case draws, loads and asks fits its planes of symmetry.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "core/geometry/surface_mesh.h"
#include "evolve/curves/curve_place.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/case_wetted.h"

namespace meniscus::case_data {

namespace {

constexpr double kDirection = 1e-9;   // of a direction's length
constexpr double kOnPlane = 1e-9;     // of the part's size
constexpr double kRoundedOff = 1e-9;  // of the curve's size
constexpr int kPiecesOfCurve = 48;

/// The parameter between `a` and `b` at which the curve lies farthest beyond
/// the plane, by golden section.
double farthest_between(const SymmetryPlane& plane, const curves::Curve& curve,
                        double a, double b) {
  constexpr int kSteps = 40;
  const double share = 2.0 - std::numbers::phi;
  const auto off = [&](double t) {
    return beyond(plane, curves::point_at(curve.shape, t - std::floor(t)));
  };
  for (int k = 0; k < kSteps; ++k) {
    const double c = a + share * (b - a);
    const double d = b - share * (b - a);
    if (off(c) > off(d)) {
      b = d;
    } else {
      a = c;
    }
  }
  return 0.5 * (a + b);
}

}  // namespace

Reach reach_of(const SymmetryPlane& plane, const curves::Curve& curve) {
  // Corners are among these.
  const std::vector<double> t = curves::sample_parameters(
      curve.shape, curves::length_of(curve.shape) / kPiecesOfCurve);
  const Points points = curves::points_at(curve.shape, t);
  Reach result{.least = beyond(plane, points[0]),
               .most = beyond(plane, points[0]),
               .farthest = points[0],
               .rounding = kRoundedOff * bounding_diagonal(points)};
  std::size_t at = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double off = beyond(plane, points[k]);
    result.least = std::min(result.least, off);
    if (off > result.most) {
      result.most = off;
      result.farthest = points[k];
      at = k;
    }
  }
  // Smooth curves have their highest place between two of them.
  const double best =
      farthest_between(plane, curve, at > 0 ? t[at - 1] : t.back() - 1.0,
                       at + 1 < t.size() ? t[at + 1] : t.front() + 1.0);
  const Vec3 place = curves::point_at(curve.shape, best - std::floor(best));
  if (beyond(plane, place) > result.most) {
    result.most = beyond(plane, place);
    result.farthest = place;
  }
  return result;
}

namespace {

const curves::Curve* curve_named(const std::vector<curves::Curve>& curves,
                                 const std::string& name) {
  const auto at =
      std::find_if(curves.begin(), curves.end(),
                   [&](const curves::Curve& c) { return c.name == name; });
  return at == curves.end() ? nullptr : &*at;
}

/// `cut`: by plane, the curves that it cuts at the initial design.
void check_curve(const Case& input, const std::string& name, bool of_film,
                 const std::vector<std::set<std::string>>& cut,
                 const films::FilmSystem& system, const CaseValues& values) {
  const curves::Curve* curve = curve_named(system.curves, name);
  const auto entry =
      std::find_if(input.curves.begin(), input.curves.end(),
                   [&](const CurveEntry& c) { return c.name == name; });
  if (curve == nullptr || entry == input.curves.end()) {
    return;
  }
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    const Reach reach = reach_of(input.symmetry[p], *curve);
    const Vec3& at = reach.farthest;
    if (cut[p].contains(name)) {
      continue;  // check_cut_curves()
    }
    if (reach.most > reach.rounding) {
      values.problems().push_back(fmt::format(
          "{}: curve '{}' is {:.4g} beyond plane {} of symmetry at ({:.4g}, "
          "{:.4g}, {:.4g}); draw the side that its normal points away from, "
          "and what crosses it so that it does at every design",
          place(input, entry->line), name, reach.most, p + 1, at.x(), at.y(),
          at.z()));
      return;
    }
    // Faces may have sides and corners in the plane.
    const bool apart =
        of_film || curves::corner_parameters(curve->shape).empty();
    if (apart && reach.most >= -reach.rounding && !reach.is_in_plane() &&
        !is_cell(input, name)) {
      values.problems().push_back(fmt::format(
          "{}: curve '{}'{} touches plane {} of symmetry at ({:.4g}, {:.4g}, "
          "{:.4g}); expected it beside the plane or in it",
          place(input, entry->line), name,
          of_film ? ", which holds a film," : "", p + 1, at.x(), at.y(),
          at.z()));
      return;
    }
  }
}

void check_curves_of(const Case& input, const films::FilmSystem& system,
                     const CaseValues& values) {
  std::set<std::string> of_films;
  for (const films::FilmSpec& film : system.films) {
    of_films.insert(film.curves.begin(), film.curves.end());
  }
  std::vector<std::set<std::string>> cut;
  const std::vector<curves::Curve> initial = curves_at_start(input);
  for (const SymmetryPlane& plane : input.symmetry) {
    cut.push_back(cut_by(plane, initial));
  }
  for (const std::string& curve : held_curves(input)) {
    check_curve(input, curve, of_films.contains(curve), cut, system, values);
  }
}

/// Rims of facets may be so far off their curves.
void check_facets(const Case& input, const std::string& name,
                  const films::StartFacets* start, double within,
                  SourceLine line, const CaseValues& values) {
  for (std::size_t p = 0; start != nullptr && p < input.symmetry.size(); ++p) {
    for (const Vec3& point : start->points) {
      const double off = beyond(input.symmetry[p], point);
      if (off > within) {
        values.problems().push_back(fmt::format(
            "{}: a vertex of '{}' is {:.4g} beyond plane {} of symmetry, at "
            "({:.4g}, {:.4g}, {:.4g}); draw the side that its normal points "
            "away from",
            place(input, line), name, off, p + 1, point.x(), point.y(),
            point.z()));
        return;
      }
    }
  }
}

/// Solids that lie in a plane at the initial design do so at every one.
void check_cut_faces(const Case& input, const films::FilmSystem& system,
                     const CaseValues& values) {
  for (const CapEntry& cap : input.caps) {
    if (cap.symmetry < 0) {
      continue;
    }
    const auto p = static_cast<std::size_t>(cap.symmetry);
    for (const std::string& name : cap.spec.curves()) {
      const curves::Curve* curve = curve_named(system.curves, name);
      if (curve != nullptr &&
          !reach_of(input.symmetry[p], *curve).is_in_plane()) {
        values.problems().push_back(fmt::format(
            "{}: curve '{}' of '{}' leaves plane {} of symmetry, in which it "
            "lies at the initial design; expected it there for every design",
            place(input, cap.line), name, cap.spec.name, p + 1));
      }
    }
  }
}

double size_of(const std::vector<curves::Curve>& curves) {
  constexpr int kPlaces = 16;
  Points places;
  for (const curves::Curve& curve : curves) {
    for (int k = 0; k < kPlaces; ++k) {
      places.push_back(
          curves::point_at(curve.shape, static_cast<double>(k) / kPlaces));
    }
  }
  return bounding_diagonal(places);
}

/// A direction in the plane, or across it.
struct Lie {
  bool in_plane = false;
  bool across = false;
};

Lie lie_of(const SymmetryPlane& plane, const Vec3& direction) {
  const double length = direction.norm();
  const double along = std::abs(plane.normal.dot(direction));
  return {along <= kDirection * length,
          (direction - plane.normal.dot(direction) * plane.normal).norm() <=
              kDirection * length};
}

/// About an axis: it lies in the plane or across it.
bool is_own_image(const SymmetryPlane& plane, const Vec3& axis,
                  const std::optional<Vec3>& through, double size) {
  const Lie lie = lie_of(plane, axis);
  return lie.across || (lie.in_plane && through &&
                        std::abs(beyond(plane, *through)) <= kOnPlane * size);
}

void check_load(const Case& input, const LoadEntry& load,
                const CaseValues& values, double size) {
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    const SymmetryPlane& plane = input.symmetry[p];
    if (load.kind == LoadKind::Gravity &&
        !lie_of(plane, values.at(load.vector)).in_plane) {
      values.problems().push_back(fmt::format(
          "{}: gravity across plane {} of symmetry pulls both sides one way, "
          "which is not symmetric; expected it along the plane",
          place(input, load.line), p + 1));
    }
    if (load.kind == LoadKind::Spin &&
        !is_own_image(plane, values.at(load.vector), values.at(load.at),
                      size)) {
      values.problems().push_back(fmt::format(
          "{}: a spin about an axis that is not symmetric about plane {} of "
          "symmetry; expected one that lies in the plane or is normal to it",
          place(input, load.line), p + 1));
    }
  }
}

void check_response(const Case& input, const ResponseEntry& response,
                    const ResponseInputs& numbers, double size,
                    const CaseValues& values) {
  const auto refuse = [&](std::size_t plane, const char* expected) {
    values.problems().push_back(fmt::format(
        "{}: responses.{} is of the whole, and its direction is not symmetric "
        "about plane {} of symmetry; expected {}",
        place(input, response.line), response.name, plane + 1, expected));
  };
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    const SymmetryPlane& plane = input.symmetry[p];
    std::optional<Vec3> through;
    if (response.point) {
      through = numbers.point;
    }
    switch (response.kind) {
      case ResponseKind::CentreOfMass:
      case ResponseKind::Overhang:
      case ResponseKind::Draft:
        if (!lie_of(plane, numbers.direction).in_plane) {
          refuse(p, "one along the plane");
        }
        break;
      case ResponseKind::Inertia:
        if (!is_own_image(plane, numbers.direction, through, size)) {
          refuse(p,
                 "an axis normal to it, or one in it 'through' a point of the "
                 "plane");
        }
        break;
      default:
        break;
    }
  }
}

bool is_same(const films::Spheroid& a, const films::Spheroid& b) {
  constexpr double kSame = 1e-9;
  return a.axis.normalized().cross(b.axis.normalized()).norm() < kSame &&
         std::abs(a.along - b.along) < kSame * a.along &&
         std::abs(a.across - b.across) < kSame * a.across;
}

bool is_mirrored(const films::DropShape& shape, const Vec3& normal) {
  const Vec3 n = normal.normalized();
  films::DropShape images = shape;
  for (const films::Spheroid& part : shape) {
    const films::Spheroid image{part.axis - 2.0 * n.dot(part.axis) * n,
                                part.along, part.across};
    const auto at = std::find_if(
        images.begin(), images.end(),
        [&](const films::Spheroid& other) { return is_same(image, other); });
    if (at == images.end()) {
      return false;
    }
    images.erase(at);
  }
  return true;
}

/// A film's image has the same tension.
void check_drops(const Case& input, const films::FilmSystem& system,
                 const CaseValues& values) {
  for (std::size_t k = 0; k < input.films.size(); ++k) {
    for (const SymmetryPlane& plane : input.symmetry) {
      if (!is_mirrored(system.films[k].drop_shape, plane.normal)) {
        values.problems().push_back(fmt::format(
            "{}: the `drop` of film '{}' is not symmetric about the plane "
            "across ({:g}, {:g}, {:g}): each spheroid needs its image there "
            "too, or an axis in the plane or across it",
            place(input, input.films[k].line), system.films[k].name,
            plane.normal.x(), plane.normal.y(), plane.normal.z()));
      }
    }
  }
}

}  // namespace

void check_symmetry(const Case& input, const EvaluatedCase& inputs,
                    const CaseValues& values) {
  if (input.symmetry.empty()) {
    return;
  }
  const std::size_t before = values.problems().size();
  const films::FilmSystem& system = inputs.film_system;
  check_curves_of(input, system, values);
  check_cut_curves(input, system, values);
  for (std::size_t k = 0; k < input.films.size(); ++k) {
    check_facets(input, system.films[k].name, system.films[k].start.get(),
                 system.films[k].within, input.films[k].line, values);
  }
  for (std::size_t k = 0; k < input.caps.size(); ++k) {
    check_facets(input, system.caps[k].name, system.caps[k].start.get(),
                 system.caps[k].within, input.caps[k].line, values);
  }
  if (values.problems().size() > before) {
    return;  // what lies where is no news then
  }
  check_cut_faces(input, system, values);
  check_drops(input, system, values);
  const double size = size_of(system.curves);
  for (const LoadCaseEntry& load_case : input.load_cases) {
    for (const LoadEntry& load : load_case.loads) {
      check_load(input, load, values, size);
    }
  }
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    check_response(input, input.responses[k], inputs.responses[k], size,
                   values);
  }
}

}  // namespace meniscus::case_data
