#include "pipeline/step_parts/export_step.h"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "cad/solid/film_mesh.h"
#include "cad/solid/film_solid.h"
#include "cad/solid/mesh_parts.h"
#include "cad/step/step_writer.h"
#include "core/error.h"
#include "evolve/films/solid_frame.h"
#include "evolve/frozen/film_model.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/forward/fillets.h"
#include "pipeline/step_parts/rim_pieces.h"
#include "pipeline/step_parts/step_figures.h"

namespace meniscus::step_parts {

namespace {

constexpr std::size_t kMostPlanes = 200;  // of a solid from a file
constexpr double kFlatRing = 1e-7;        // of the part's size

/// Its rim leaves the curve.
bool is_rounded(const films::FilmSystem& system, const std::string& curve) {
  return std::any_of(system.fillets.begin(), system.fillets.end(),
                     [&](const films::FilletSpec& fillet) {
                       return fillet.curve == curve && fillet.radius > 0.0;
                     });
}

std::vector<solid::NamedRim> rims_of(const films::FilmSystem& system,
                                     const frozen::FilmModel& model) {
  std::vector<solid::NamedRim> rims;
  for (const curves::Curve& curve : system.curves) {
    std::vector<solid::RimPiece> pieces = rim_pieces(curve.shape);
    if (!pieces.empty() && !is_rounded(system, curve.name)) {
      rims.push_back({curve.name, solid::RimCurve(std::move(pieces)),
                      model.rim(curve.name)});
    }
  }
  return rims;
}

/// The corners of a curve of straight sides; 0 for others.
std::size_t corners_of(const films::FilmSystem& system,
                       const std::string& name) {
  std::vector<solid::RimPiece> pieces;
  for (const curves::Curve& curve : system.curves) {
    if (curve.name == name) {
      pieces = rim_pieces(curve.shape);
    }
  }
  const bool straight = std::all_of(
      pieces.begin(), pieces.end(), [](const solid::RimPiece& piece) {
        return std::holds_alternative<solid::StraightLine>(piece.curve);
      });
  return straight ? pieces.size() : 0;
}

/// Of how many plane faces the solid may be: a ring between polygons of one on
/// each side of either; where a side is twisted there are more facets.
std::size_t most_planes(const films::CapSpec& cap,
                        const films::FilmSystem& system) {
  if (cap.start) {
    return kMostPlanes;
  }
  const std::size_t outer = corners_of(system, cap.curve);
  const std::size_t inner = corners_of(system, cap.inner);
  return outer > 0 && inner > 0 ? outer + inner : 0;
}

std::size_t plane_count(const SurfaceMesh& mesh, int label) {
  const std::vector<std::vector<int>> parts = solid::connected_parts(
      mesh, [&](int facet, int other, const Edge& /*edge*/) {
        return solid::is_crease(mesh, facet, other);
      });
  return static_cast<std::size_t>(std::count_if(
      parts.begin(), parts.end(), [&](const std::vector<int>& part) {
        return mesh.facet_label[part[0]] == label;
      }));
}

/// Plane faces: disks, sides, rings between polygons or between curves of one
/// plane, few facets of a file; other rings are ruled.
bool is_flat(const films::CapSpec& cap, const films::FilmSystem& system,
             const SurfaceMesh& mesh) {
  const int label = mesh.label_of(cap.name);
  if (cap.solid >= 0) {
    return std::holds_alternative<ExactPlane>(
        system.solids[cap.solid].shape->faces[cap.face].surface);
  }
  if ((cap.inner.empty() && !cap.start && !cap.ruled) || label < 0) {
    return true;
  }
  const std::size_t planes = most_planes(cap, system);
  if (planes > 0 && plane_count(mesh, label) <= planes) {
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
                                 return cap.name == label &&
                                        is_flat(cap, system, mesh);
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

/// The one rim of a surface, in the direction of its facets; empty where it has
/// several.
Points rim_of(const SurfaceMesh& mesh, int label) {
  std::map<int, int> next;
  std::map<Edge, int> runs;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3 && mesh.facet_label[f] == label; ++k) {
      runs[{mesh.facets[f][k], mesh.facets[f][(k + 1) % 3]}] = 1;
    }
  }
  for (const auto& [run, count] : runs) {
    if (runs.count({run[1], run[0]}) == 0) {
      next[run[0]] = run[1];
    }
  }
  Points rim;
  for (auto at = next.begin(); at != next.end();) {
    rim.push_back(mesh.points[at->first]);
    const int to = at->second;
    next.erase(at);
    at = next.find(to);
  }
  return next.empty() ? rim : Points();
}

/// Throws InvalidInput, naming the face.
void require_plane_wetted_faces(const films::FilmSystem& system) {
  for (const films::CapSpec& cap : system.caps) {
    if (cap.wall && cap.wall->bent()) {
      throw InvalidInput(fmt::format(
          "step: the face that '{}' wets is not plane, and smooth STEP has no "
          "such faces in this version; take --format step-faceted, or stl, "
          "3mf, obj",
          cap.name));
    }
  }
}

/// The system held where its films rest in `model`: the curves that films slid
/// from are splines through their rims, walls are caps. Throws InvalidInput for
/// a wetted face with holes, whose rims could be taken for each other.
films::FilmSystem held_where_it_slid(films::FilmSystem system,
                                     const frozen::FilmModel& model) {
  const SurfaceMesh mesh = model.fine_mesh(model.reference().points);
  for (films::CapSpec& cap : system.caps) {
    if (!cap.wall) {
      continue;
    }
    Points rim = rim_of(mesh, mesh.label_of(cap.name));
    if (rim.empty() || !cap.more.empty()) {
      throw InvalidInput(fmt::format(
          "the face that '{}' wets has several rims, which smooth STEP faces "
          "cannot follow yet; write it with facets",
          cap.name));
    }
    for (curves::Curve& curve : system.curves) {
      if (curve.name == cap.curve) {
        curve.shape = curves::Spline{std::move(rim)};
        break;
      }
    }
    cap.wall.reset();
  }
  return system;
}

/// Faces of STEP solids where the design has them.
std::vector<solid::ExactFaces> exact_faces_of(const films::FilmSystem& system) {
  std::vector<solid::ExactFaces> result;
  for (std::size_t s = 0; s < system.solids.size(); ++s) {
    solid::ExactFaces& exact = result.emplace_back();
    exact.shape = films::shape_at(system.solids[s], system.curves);
    for (const films::CapSpec& cap : system.caps) {
      if (cap.solid == static_cast<int>(s)) {
        exact.faces.push_back(cap.face);
        exact.names.push_back(cap.name);
      }
    }
  }
  return result;
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

/// ", 7 faces of STEP solids"; empty: none.
std::string faces_text(const solid::Brep& brep) {
  std::size_t faces = 0;
  for (const solid::ExactFaces& exact : brep.exact) {
    faces += exact.faces.size();
  }
  return faces == 0 ? ""
                    : fmt::format(", {} face{} of STEP solids", faces,
                                  faces == 1 ? "" : "s");
}

}  // namespace

solid::Brep whole_solid(solid::Brep brep, const StepExport& options) {
  for (const step::MirrorPlane& plane : options.mirrors) {
    brep = step::with_mirror_image(brep, plane, case_data::image_name);
  }
  return brep;
}

void export_step(const std::filesystem::path& file,
                 const films::FilmSystem& system, const StepExport& options) {
  if (!options.faceted) {
    require_plane_wetted_faces(system);
  }
  frozen::FilmModel model = settled(system, options.edge);
  const auto rounded = [&](const frozen::FilmModel& settled) {
    return settled.boundary(
        forward::rounded_anew(system, settled, settled.reference().points));
  };
  SurfaceMesh mesh = rounded(model);
  const step::StepOptions names{
      .name = options.title, .unit = options.unit, .monitor = options.monitor};
  if (options.faceted) {
    step::write_step(file, whole_solid(solid::faceted_solid(mesh), options),
                     names);
    return;
  }
  const films::FilmSystem held = held_where_it_slid(system, model);
  model =
      settled(for_smooth_films(held, model.boundary(model.reference().points)),
              options.edge);
  mesh = rounded(model);
  solid::FilmSolidInput input{mesh, rims_of(held, model), {}, {}, options.edge};
  for (const films::CapSpec& cap : held.caps) {
    if (cap.solid >= 0) {
      input.exact.push_back(cap.name);
      continue;
    }
    if (is_flat(cap, held, mesh)) {
      input.caps.push_back(cap.name);
    }
    if (!cap.inner.empty() || cap.start || cap.ruled) {
      input.creased.push_back(cap.name);
    }
  }
  solid::FilmSolid solid = solid::film_solid(input);
  solid.brep.exact = exact_faces_of(system);
  solid.brep = whole_solid(std::move(solid.brep), options);
  tell_step(options, solid.report, faces_text(solid.brep), 1,
            step::write_step(file, solid.brep, names));
}

}  // namespace meniscus::step_parts
