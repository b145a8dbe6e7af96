#include "pipeline/results/export_step.h"

#include <algorithm>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "cad/solid/bulge_volume.h"
#include "cad/solid/film_solid.h"
#include "cad/step/step_writer.h"
#include "core/error.h"
#include "evolve/curves/curve_shape.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::results {

namespace {

constexpr double kMostDeviation = 0.1;  // of the film's edge: else a warning
constexpr double kMostBreak = 1.0;      // [degree]
constexpr double kFlatRing = 1e-7;      // of the part's size
constexpr double kFullTurn = 2.0 * std::numbers::pi;

solid::RimPiece line_piece(const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  return {solid::StraightLine{from, way.normalized()}, 0.0, way.norm()};
}

std::vector<solid::RimPiece> pieces_of(const curves::Circle& circle) {
  const auto frame = curves::curve_shape::frame_of(circle);
  return {{solid::EllipseCurve{circle.center, circle.radius * frame.u,
                               circle.radius * frame.v},
           0.0, kFullTurn}};
}

std::vector<solid::RimPiece> pieces_of(const curves::Ellipse& ellipse) {
  const auto frame = curves::curve_shape::frame_of(ellipse);
  return {{solid::EllipseCurve{ellipse.center, ellipse.radius_1 * frame.u,
                               ellipse.radius_2 * frame.v},
           0.0, kFullTurn}};
}

std::vector<solid::RimPiece> pieces_of(const curves::Rectangle& box) {
  const auto frame = curves::curve_shape::frame_of(box);
  const double r = box.corner_radius;
  std::vector<solid::RimPiece> pieces;
  const auto at = [&](double a, double b) {
    return Vec3(box.center + a * frame.u + b * frame.v);
  };
  // Counter-clockwise from the right side, as evolve/curves/curve has it.
  const double w = 0.5 * box.width;
  const double h = 0.5 * box.height;
  const std::array<solid::Vec2, 4> from{
      solid::Vec2(w, r - h), solid::Vec2(w - r, h), solid::Vec2(-w, h - r),
      solid::Vec2(r - w, -h)};
  const std::array<solid::Vec2, 4> to{
      solid::Vec2(w, h - r), solid::Vec2(r - w, h), solid::Vec2(-w, r - h),
      solid::Vec2(w - r, -h)};
  const std::array<solid::Vec2, 4> middle{
      solid::Vec2(w - r, h - r), solid::Vec2(r - w, h - r),
      solid::Vec2(r - w, r - h), solid::Vec2(w - r, r - h)};
  for (int k = 0; k < 4; ++k) {
    pieces.push_back(
        line_piece(at(from[k][0], from[k][1]), at(to[k][0], to[k][1])));
    if (r > 0.0) {
      const double start = 0.25 * kFullTurn * k;
      pieces.push_back({solid::EllipseCurve{at(middle[k][0], middle[k][1]),
                                            r * frame.u, r * frame.v},
                        start, start + 0.25 * kFullTurn});
    }
  }
  return pieces;
}

std::vector<solid::RimPiece> pieces_of(const curves::Polygon& polygon) {
  std::vector<solid::RimPiece> pieces;
  const std::size_t n = polygon.points.size();
  for (std::size_t k = 0; k < n; ++k) {
    pieces.push_back(
        line_piece(polygon.points[k], polygon.points[(k + 1) % n]));
  }
  return pieces;
}

/// Other kinds: none, a spline goes through the film's own points.
template <class Shape>
std::vector<solid::RimPiece> pieces_of(const Shape& /*shape*/) {
  return {};
}

std::vector<solid::NamedRim> rims_of(const films::FilmSystem& system,
                                     const frozen::FilmModel& model) {
  std::vector<solid::NamedRim> rims;
  for (const curves::Curve& curve : system.curves) {
    std::vector<solid::RimPiece> pieces = std::visit(
        [](const auto& shape) { return pieces_of(shape); }, curve.shape);
    if (!pieces.empty()) {
      rims.push_back({curve.name, solid::RimCurve(std::move(pieces)),
                      model.rim(curve.name)});
    }
  }
  return rims;
}

/// A disk, or a ring between curves of one plane; other rings are ruled.
bool is_flat(const films::CapSpec& cap, const SurfaceMesh& mesh) {
  const int label = mesh.label_of(cap.name);
  if (cap.inner.empty() || label < 0) {
    return true;
  }
  Vec3 normal = Vec3::Zero();
  std::vector<int> vertices;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      normal += area_vector2(mesh, static_cast<int>(f));
      const Triangle& t = mesh.facets[f];
      vertices.insert(vertices.end(), t.begin(), t.end());
    }
  }
  // Around a bore the areas cancel, and their sum has any direction.
  normal.normalize();
  const double most = kFlatRing * bounding_diagonal(mesh.points);
  return std::all_of(vertices.begin(), vertices.end(), [&](int v) {
    return std::abs(normal.dot(mesh.points[v] - mesh.points[vertices[0]])) <=
           most;
  });
}

/// Volumes are those of flat facets, and the smooth film encloses more where
/// it bulges: the same system with each body's volume so much less.
films::FilmSystem for_smooth_films(films::FilmSystem system,
                                   const SurfaceMesh& mesh) {
  std::vector<char> flat;
  flat.reserve(mesh.labels.size());
  for (const std::string& label : mesh.labels) {
    flat.push_back(std::any_of(system.caps.begin(), system.caps.end(),
                               [&](const films::CapSpec& cap) {
                                 return cap.name == label && is_flat(cap, mesh);
                               })
                       ? 1
                       : 0);
  }
  const std::vector<double> bulges = solid::bulge_volumes(mesh, flat);
  const auto bodies_of = [&](const std::string& surface) {
    return std::count_if(system.bodies.begin(), system.bodies.end(),
                         [&](const films::BodySpec& b) {
                           return std::count(b.enclosed_by.begin(),
                                             b.enclosed_by.end(), surface) > 0;
                         });
  };
  for (films::BodySpec& body : system.bodies) {
    for (const std::string& surface : body.enclosed_by) {
      const int label = mesh.label_of(surface);
      if (body.volume && label >= 0 && bodies_of(surface) == 1) {
        *body.volume -= (body.is_void ? -1.0 : 1.0) * bulges[label];
      }
    }
  }
  return system;
}

frozen::FilmModel settled(const films::FilmSystem& system, double edge) {
  frozen::FilmModel model =
      frozen::FilmModel::freeze(system, {.edge = edge, .refinements = 0});
  if (model.reference().failure) {
    throw MeshError(fmt::format("no film at edge {:g}: {}", edge,
                                model.reference().failure->message));
  }
  return model;
}

std::string number_of(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void tell(const StepExport& options, const solid::FilmSolidReport& film,
          const step::StepReport& step) {
  Monitor& monitor =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  const std::string& unit = options.unit;
  monitor.log(
      Severity::Info,
      fmt::format("{}, {}, {}, {}; valid closed solid of {:.6g} {}3",
                  number_of(film.patches, "B-spline face"),
                  number_of(film.planes, "plane"),
                  number_of(film.cylinders, "cylinder"),
                  number_of(film.spheres, "sphere"), step.volume, unit));
  for (const solid::SimpleFace& face : film.simple) {
    monitor.log(Severity::Info,
                fmt::format("{} is a {}{}; the film leaves it by {:.2g} {} at "
                            "most ({:.2g} of its edge)",
                            face.film, face.shape,
                            face.shape == "plane" ? "" : " " + unit, face.off,
                            unit, face.off / options.edge));
  }
  monitor.log(
      Severity::Info,
      fmt::format(
          "gap at edges {:.2g} {} at most; film to faces {:.2g} {}, faces "
          "to film {:.2g} {} ({:.2g} of its edge)",
          film.gap, unit, film.film_to_solid, unit, film.solid_to_film, unit,
          std::max(film.film_to_solid, film.solid_to_film) / options.edge));
  monitor.log(
      Severity::Info,
      fmt::format("tangent breaks between faces of one film {:.2g} "
                  "degrees at most{}",
                  film.tangent_break,
                  film.break_film.empty()
                      ? ""
                      : fmt::format(", in {} at ({:.4g}, {:.4g}, "
                                    "{:.4g})",
                                    film.break_film, film.break_place[0],
                                    film.break_place[1], film.break_place[2])));
}

}  // namespace

void export_step(const std::filesystem::path& file,
                 const films::FilmSystem& system, const StepExport& options) {
  frozen::FilmModel model = settled(system, options.edge);
  SurfaceMesh mesh = model.boundary(model.reference().points);
  const step::StepOptions names{.name = options.title, .unit = options.unit};
  if (options.faceted) {
    step::write_step(file, solid::faceted_solid(mesh), names);
    return;
  }
  model = settled(for_smooth_films(system, mesh), options.edge);
  mesh = model.boundary(model.reference().points);
  solid::FilmSolidInput input{mesh, rims_of(system, model), {}, options.edge};
  for (const films::CapSpec& cap : system.caps) {
    if (is_flat(cap, mesh)) {
      input.caps.push_back(cap.name);
    }
  }
  const solid::FilmSolid solid = solid::film_solid(input);
  tell(options, solid.report, step::write_step(file, solid.brep, names));
}

}  // namespace meniscus::results
