#include "pipeline/results/imported_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/touching_bodies.h"
#include "core/heed_stop.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tetrahedralize.h"
#include "pipeline/files/part_file.h"
#include "pipeline/forward/work_estimate.h"
#include "pipeline/results/even_surface.h"
#include "pipeline/results/face_list.h"

namespace meniscus::results {

namespace {

// Longest edge over the wanted one: halves of it are not below two thirds.
constexpr double kLongestEdge = 4.0 / 3.0;
// The faces are known to a fiftieth of this part of an edge.
constexpr double kShapeInEdges = 0.15;
// x the run's own part: a centimetre for a millimetre is above it.
constexpr double kMostLarger = 5.0;

constexpr const char* kNameless = "unnamed";  // as readers call it

/// The facet's parts where some of its edges have a point half way (-1: none),
/// which stand at (01), (12), (20).
std::vector<Triangle> parts_of(const Triangle& t, std::array<int, 3> mid) {
  const auto count =
      std::count_if(mid.begin(), mid.end(), [](int m) { return m >= 0; });
  // Turned so that the edges with points come first.
  int turn = 0;
  while (count > 0 && count < 3 &&
         !(mid[static_cast<std::size_t>(turn)] >= 0 &&
           mid[static_cast<std::size_t>((turn + 2) % 3)] < 0)) {
    ++turn;
  }
  const auto corner = [&](int k) {
    return t[static_cast<std::size_t>((turn + k) % 3)];
  };
  const auto half = [&](int k) {
    return mid[static_cast<std::size_t>((turn + k) % 3)];
  };
  switch (count) {
    case 0:
      return {t};
    case 1:
      return {{corner(0), half(0), corner(2)}, {half(0), corner(1), corner(2)}};
    case 2:
      return {{half(0), corner(1), half(1)},
              {corner(0), half(0), half(1)},
              {corner(0), half(1), corner(2)}};
    default:
      return {{corner(0), half(0), half(2)},
              {half(0), corner(1), half(1)},
              {half(2), half(1), corner(2)},
              {half(0), half(1), half(2)}};
  }
}

/// Each surface that a load or support of the run names.
std::set<std::string> surfaces_used(const case_data::EvaluatedCase& numbers) {
  std::set<std::string> used;
  for (const loads::LoadCase& load_case : numbers.load_cases) {
    const auto add = [&](const auto& entries) {
      for (const auto& entry : entries) {
        used.insert(entry.surface);
      }
    };
    add(load_case.supports);
    const auto add_together = [&](const auto& entries) {
      for (const auto& entry : entries) {
        used.insert(entry.surfaces.begin(), entry.surfaces.end());
      }
    };
    add_together(load_case.forces);
    add(load_case.pressures);
    add(load_case.tractions);
    add_together(load_case.remote_loads);
    add_together(load_case.bearings);
    add_together(load_case.pins);
    add(load_case.springs);
  }
  return used;
}

void check_names(const SurfaceMesh& surface,
                 const case_data::EvaluatedCase& numbers,
                 const std::string& path, const std::string& length_unit) {
  for (const std::string& name : surfaces_used(numbers)) {
    if (surface.label_of(name) < 0) {
      const bool nameless =
          surface.labels.size() == 1 && surface.labels[0] == kNameless;
      throw InvalidInput(fmt::format(
          "{}: no face '{}', which the run's loads and supports name; "
          "say which it is (--face {}=FACE), or write its facets as `solid {}` "
          "of an ASCII STL file or as group `g {}` of an OBJ file; {}",
          path, name, name, name, name,
          nameless ? "the file has no names (binary STL never has)"
                   : "there are\n" + face_list(surface, length_unit)));
    }
  }
}

SurfaceMesh renamed(SurfaceMesh surface, const FaceNames& names,
                    const std::string& path, const std::string& length_unit) {
  for (const auto& [face, name] : names) {
    const int label = surface.label_of(face);
    if (label < 0) {
      throw InvalidInput(
          fmt::format("{}: no face '{}' (--face {}={}); there are\n{}", path,
                      face, name, face, face_list(surface, length_unit)));
    }
    surface.labels[static_cast<std::size_t>(label)] = name;
  }
  return surface;
}

/// Labels of the facets beside each edge; twice the same where one face goes on
/// across it.
std::vector<Edge> labels_beside(const SurfaceMesh& surface,
                                std::size_t edge_count,
                                const std::vector<Triangle>& facet_edges) {
  std::vector<Edge> labels(edge_count, Edge{-1, -1});
  for (std::size_t f = 0; f < facet_edges.size(); ++f) {
    const int label = surface.facet_label[f];
    for (const int e : facet_edges[f]) {
      Edge& beside = labels[static_cast<std::size_t>(e)];
      beside = {beside[0] < 0 ? label : beside[0], label};
    }
  }
  return labels;
}

/// How many facets with_short_edges() leaves, somewhat more rather than less.
std::size_t facets_with_short_edges(const SurfaceMesh& surface,
                                    double longest) {
  constexpr double kShorter = 2.0;  // halves are up to half as long
  const double equilateral = 0.25 * std::sqrt(3.0) * longest * longest;
  double sides = 0.0;
  for (const Triangle& t : surface.facets) {
    for (std::size_t k = 0; k < 3; ++k) {
      sides += (surface.points[static_cast<std::size_t>(t[(k + 1) % 3])] -
                surface.points[static_cast<std::size_t>(t[k])])
                   .norm();
    }
  }
  constexpr double kMost = 1e12;
  return surface.facets.size() +
         static_cast<std::size_t>(std::min(
             kMost,
             kShorter * surface_area(surface) / equilateral + sides / longest));
}

/// Ten-node elements, their outer mid-sides on `shape`.
TetMesh filled(const SurfaceMesh& surface, const PartShape* shape, double edge,
               const std::string& path, Monitor* monitor) {
  const mesh_tet::Tetrahedralization linear =
      mesh_tet::tetrahedralize(surface, {.edge = edge, .monitor = monitor});
  if (linear.failure) {
    throw MeshError(fmt::format("{}: it cannot be filled with elements: {}",
                                path, linear.failure->message));
  }
  QuadraticSurface quadratic;
  quadratic.base = surface;
  list_edges(surface.facets, quadratic.edges, quadratic.facet_edges);
  const std::vector<Edge> labels =
      labels_beside(surface, quadratic.edges.size(), quadratic.facet_edges);
  for (std::size_t k = 0; k < quadratic.edges.size(); ++k) {
    const auto [i, j] = quadratic.edges[k];
    const Vec3& a = surface.points[static_cast<std::size_t>(i)];
    const Vec3& b = surface.points[static_cast<std::size_t>(j)];
    quadratic.mid.push_back(shape != nullptr ? shape->middle(a, b, labels[k])
                                             : Vec3(0.5 * (a + b)));
  }
  return mesh_tet::make_quadratic(linear.mesh, quadratic);
}

}  // namespace

void require_like_size(const Points& points, const Points& own,
                       const std::string& path,
                       const std::string& length_unit) {
  const double size = bounding_diagonal(points);
  const double expected = bounding_diagonal(own);
  if (size > kMostLarger * expected || kMostLarger * size < expected) {
    throw InvalidInput(fmt::format(
        "{}: the part is {:.4g} {} across, the run's own {:.4g} {}; is the "
        "file's unit {}, as it was read, or is a point of it wrong?",
        path, size, length_unit, expected, length_unit, length_unit));
  }
}

SurfaceMesh with_short_edges(SurfaceMesh surface, double longest,
                             const PartShape* shape) {
  while (true) {
    heed_stop("mesh");
    std::vector<Edge> edges;
    std::vector<Triangle> facet_edges;
    list_edges(surface.facets, edges, facet_edges);
    const std::vector<Edge> labels =
        labels_beside(surface, edges.size(), facet_edges);
    std::vector<int> half(edges.size(), -1);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const Vec3 a = surface.points[static_cast<std::size_t>(edges[e][0])];
      const Vec3 b = surface.points[static_cast<std::size_t>(edges[e][1])];
      if ((b - a).norm() > longest) {
        half[e] = static_cast<int>(surface.points.size());
        surface.points.push_back(shape != nullptr
                                     ? shape->middle(a, b, labels[e])
                                     : Vec3(0.5 * (a + b)));
      }
    }
    SurfaceMesh next{.points = std::move(surface.points),
                     .facets = {},
                     .facet_label = {},
                     .labels = surface.labels};
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
      std::array<int, 3> mid{};
      for (std::size_t k = 0; k < 3; ++k) {
        mid[k] = half[static_cast<std::size_t>(facet_edges[f][k])];
      }
      for (const Triangle& part : parts_of(surface.facets[f], mid)) {
        next.facets.push_back(part);
        next.facet_label.push_back(surface.facet_label[f]);
        if (!surface.facet_bodies.empty()) {
          next.facet_bodies.push_back(surface.facet_bodies[f]);
        }
      }
    }
    const bool done = next.facets.size() == surface.facets.size();
    surface = std::move(next);
    if (done) {
      return surface;
    }
  }
}

PartFigures imported_part_figures(const std::filesystem::path& path,
                                  const RunPart& run, const FaceNames& names,
                                  Monitor* monitor,
                                  forward::EvaluationFields* kept) {
  const Heeding heeding(monitor);
  const std::vector<case_data::BodyEntry> bodies =
      case_data::solid_bodies(run.input);
  if (std::any_of(bodies.begin(), bodies.end(),
                  [&](const case_data::BodyEntry& body) {
                    return body.material != bodies.front().material;
                  })) {
    throw InvalidInput(fmt::format(
        "{}: the run has {} bodies of several materials; a part from a file is "
        "of one material, and which is not known",
        path.string(), bodies.size()));
  }
  const double edge = run.input.resolution.fea;
  const auto read = [&](double size) {
    return files::read_part_file(
        path,
        {.unit = run.input.units.length, .edge = size, .monitor = monitor});
  };
  const double longest = kLongestEdge * edge;
  SurfaceMesh own = with_own_bodies(
      renamed(read(edge), names, path.string(), run.input.units.length));
  check_names(own, run.fields.inputs, path.string(), run.input.units.length);
  require_like_size(own.points, run.fields.mesh.nodes, path.string(),
                    run.input.units.length);
  forward::require_work(
      forward::estimate_work(enclosed_volume(own),
                             facets_with_short_edges(own, longest), edge),
      edge);
  std::unique_ptr<PartShape> shape;
  if (files::has_curved_faces(path)) {
    shape = std::make_unique<PartShape>(read(kShapeInEdges * edge));
  }
  if (shape != nullptr) {
    own = with_own_bodies(even_surface(own, edge, *shape));
  }
  const SurfaceMesh surface =
      with_short_edges(std::move(own), longest, shape.get());
  forward::EvaluationFields fields;
  fields.inputs = run.fields.inputs;
  fields.inputs.materials.assign(static_cast<std::size_t>(body_count(surface)),
                                 run.fields.inputs.materials.front());
  fields.mesh = filled(surface, shape.get(), edge, path.string(), monitor);
  fields.exclusion = forward::choose_exclusion(run.input, fields.mesh,
                                               forward::EmptyZones::Allowed);
  const elastic::ElasticModel elasticity(
      fields.mesh, fields.inputs.materials, fields.inputs.load_cases,
      {.solver = run.input.analysis.solver,
       .processes = run.input.analysis.processes,
       .monitor = monitor});
  fields.solution = elasticity.base_solution();
  if (fields.solution.failure) {
    throw SolverError(path.string() + ": " + fields.solution.failure->message);
  }
  PartFigures figures = part_figures(path.string(), fields);
  if (kept != nullptr) {
    *kept = std::move(fields);
  }
  return figures;
}

}  // namespace meniscus::results
