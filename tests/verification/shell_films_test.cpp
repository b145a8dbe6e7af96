/// Section 4 of the paper by shells on the films' own facets: a film of
/// constant mean curvature H under the pressure 2 H s and the edge traction s
/// carries one stress, as thin as it is (by solids: uniform_stress_test.cpp).
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/edge_key.h"
#include "evolve/frozen/film_model.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "pipeline/reader/case_reader.h"

namespace meniscus::shell_films_test {
namespace {

constexpr const char* kCase =
    MENISCUS_SOURCE_DIR "/cases/constant_mean_curvature/case.toml";
constexpr double kEdge = 1.5;      // [mm]
constexpr double kStress = 1.0;    // s / t [MPa]
constexpr double kUniform = 5e-4;  // of the plane, at any thickness
constexpr double kOrderBand = 0.35;

/// The facets of one film of a surface, nodes numbered anew.
shell::ShellMesh film_of(const QuadraticSurface& surface,
                         const std::string& film, double thickness) {
  QuadraticSurface part;
  std::map<int, int> corner;
  std::map<int, int> edge;
  const int label = surface.base.label_of(film);
  for (std::size_t f = 0; f < surface.base.facets.size(); ++f) {
    if (surface.base.facet_label[f] != label) {
      continue;
    }
    Triangle corners;
    Triangle edges;
    for (int k = 0; k < 3; ++k) {
      const int c = surface.base.facets[f][k];
      const auto [at, fresh] =
          corner.try_emplace(c, static_cast<int>(part.base.points.size()));
      if (fresh) {
        part.base.points.push_back(surface.base.points[c]);
      }
      corners[k] = at->second;
      const int e = surface.facet_edges[f][k];
      const auto [where, new_edge] =
          edge.try_emplace(e, static_cast<int>(part.mid.size()));
      if (new_edge) {
        part.mid.push_back(surface.mid[e]);
      }
      edges[k] = where->second;
    }
    part.base.facets.push_back(corners);
    part.facet_edges.push_back(edges);
  }
  const auto corners = static_cast<Eigen::Index>(part.base.points.size());
  return shell::shell_mesh(part, VectorX::Constant(corners, thickness));
}

/// The paper's load: pressure on the film, and every edge of one facet alone
/// pulled along its conormal.
shell::ShellLoads paper_load(const shell::ShellMesh& mesh, double pressure,
                             double thickness) {
  std::map<Edge, int> uses;
  for (const auto& f : mesh.facets) {
    for (int e = 0; e < 3; ++e) {
      ++uses[edge_key(f[e], f[(e + 1) % 3])];
    }
  }
  shell::ShellLoads loads;
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    const auto& n = mesh.facets[f];
    loads.pressures.push_back(
        {f, pressure * kStress * thickness, shell::WallSide::Middle});
    for (int e = 0; e < 3; ++e) {
      if (uses.at(edge_key(n[e], n[(e + 1) % 3])) == 1) {
        loads.pulls.push_back({f, e, kStress * thickness});
      }
    }
  }
  return loads;
}

/// Standard deviation over mean of von Mises stress at both faces.
double variation(const shell::ShellMesh& mesh, double pressure,
                 double thickness) {
  element::Material aluminium{"aluminium", 71700.0, 0.33, 2.8e-9, {}};
  const std::vector<shell::Section> sections = {{{{{aluminium}}}}};
  const shell::ShellLoads loads = paper_load(mesh, pressure, thickness);
  // Loads balance: one node held bears next to nothing.
  const std::vector<shell::NodeSupport> supports = {
      {.node = 0, .held = {true, true, true, true, true, true}}};
  const shell::ShellSystem system(mesh, sections, supports);
  const shell::ShellSolution solution = system.solve(loads);
  const Vec3 force = solution.reaction.head<3>();
  EXPECT_LT(force.norm(),
            1e-3 * shell::nodal_forces(mesh, sections, loads).lpNorm<1>());
  const auto stress = shell::averaged_stress(
      mesh, shell::shell_stress(mesh, sections, loads, solution.displacement));
  double weight = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t f = 0; f < stress.size(); ++f) {
    const Vec3& o = mesh.nodes[mesh.facets[f][0]];
    const double area = (mesh.nodes[mesh.facets[f][1]] - o)
                            .cross(mesh.nodes[mesh.facets[f][2]] - o)
                            .norm();
    for (const shell::WallStress& wall : stress[f]) {
      for (const auto& s : {wall.negative, wall.positive}) {
        const double value = element::von_mises(s);
        weight += area;
        sum += area * value;
        squares += area * value * value;
      }
    }
  }
  const double mean = sum / weight;
  EXPECT_NEAR(mean / kStress, 1.0, 0.05);
  return std::sqrt(std::max(0.0, squares / weight - mean * mean)) / mean;
}

struct Film {
  const char* name;
  const char* body;  // whose pressure it stands
};

/// At 1 mm the films' own facets show: what their places err by bends a wall
/// the more the thinner it is.
TEST(ShellFilms, StressOfConstantMeanCurvatureEvensOutWithThickness) {
  const case_data::Case input = reader::read_case(kCase);
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      inputs.film_system, {.edge = kEdge, .refinements = 1});
  ASSERT_FALSE(model.reference().failure);
  const QuadraticSurface surface = model.surface(model.reference().points);
  for (const Film& film : {Film{"plane", "foot"},
                           {"catenoid", "foot"},
                           {"cylinder", "shaft"},
                           {"unduloid", "neck"},
                           {"nodoid", "bulge"},
                           {"sphere", "dome"}}) {
    SCOPED_TRACE(film.name);
    double pressure = 0.0;
    for (const settle::BodyState& body : model.reference().report.bodies) {
      if (body.name == film.body) {
        pressure = body.pressure;
      }
    }
    std::vector<double> found;
    for (const double t : {4.0, 2.0}) {
      found.push_back(variation(film_of(surface, film.name, t), pressure, t));
    }
    std::cout << fmt::format("{}: {:.5f} {:.5f}\n", film.name, found[0],
                             found[1]);
    if (std::string(film.name) == "plane") {
      EXPECT_LT(found[0], kUniform);
      EXPECT_LT(found[1], kUniform);
    } else {
      EXPECT_NEAR(std::log2(found[0] / found[1]), 1.0, kOrderBand);
    }
  }
}

}  // namespace
}  // namespace meniscus::shell_films_test
