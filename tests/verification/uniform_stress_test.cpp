/// Section 4 of the paper on the films of cases/constant_mean_curvature: a
/// shell of constant mean curvature H under the pressure 2 H s and the edge
/// traction s carries the same stress everywhere, as thin as it is; and what
/// another load makes of that.
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "evolve/frozen/film_model.h"
#include "fea/elastic/elasticity.h"
#include "fea/element/point_stress.h"
#include "fea/stress/stress_uniformity.h"
#include "pipeline/reader/case_reader.h"
#include "tests/support/film_shell.h"

namespace meniscus::uniform_stress_test {
namespace {

constexpr const char* kCase =
    MENISCUS_SOURCE_DIR "/cases/constant_mean_curvature/case.toml";
constexpr double kStress = 1.0;  // s / t [MPa]
constexpr double kEdges = 1.25;  // edge of the facets, in thicknesses
// Of the plane, uniform at any thickness: elements curved along its rims are
// not integrated exactly by four points.
constexpr double kUniform = 5e-4;
constexpr double kOrder = 1.0;       // of the variation in the thickness
constexpr double kOrderBand = 0.35;  // elements of the size of the thickness

const element::Material kAluminium{.name = "aluminium",
                                   .youngs_modulus = 71700.0,
                                   .poisson_ratio = 0.33,
                                   .density = 2.8e-9};

/// The films of the case at one edge length.
struct Films {
  QuadraticSurface surface;
  settle::FilmReport report;
};

Films films_at(double edge) {
  const case_data::Case input = reader::read_case(kCase);
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      inputs.film_system, {.edge = edge, .refinements = 1});
  EXPECT_FALSE(model.reference().failure) << model.reference().report.verdict;
  return {model.surface(model.reference().points), model.reference().report};
}

double pressure_of(const Films& films, const std::string& body) {
  for (const settle::BodyState& state : films.report.bodies) {
    if (state.name == body) {
      return state.pressure;  // 2 T H with the tension T = 1 N/mm
    }
  }
  ADD_FAILURE() << "no body " << body;
  return 0.0;
}

struct Shell {
  std::string film;
  std::string body;  // whose pressure it stands
  double middle;     // height between its rims [mm]; rims of the plane differ
                     // by radius
};

TetMesh mesh_of(const Films& films, const Shell& shell, double thickness) {
  return test_films::film_shell(
      films.surface, {.film = shell.film,
                      .thickness = thickness,
                      .rim = [&](const Vec3& p) -> std::string {
                        if (shell.film == "plane") {
                          return std::hypot(p.x(), p.y()) < 30.0 ? "low"
                                                                 : "high";
                        }
                        return p.z() < shell.middle ? "low" : "high";
                      }});
}

/// Springs so soft that they only keep the shell from floating off: a millionth
/// of the pressure at the displacement of the free shell.
std::vector<loads::SpringBed> floating(double thickness) {
  const double soft = 1e-6 * kAluminium.youngs_modulus * thickness / 400.0;
  return {{.surface = "front", .components = Vec3::Constant(soft)}};
}

stress::Uniformity stress_under(const TetMesh& mesh,
                                const loads::LoadCase& load_case) {
  const elastic::ElasticModel model(mesh, {kAluminium}, {load_case});
  const equations::ElasticSolution& solution = model.base_solution();
  EXPECT_FALSE(solution.failure);
  return stress::stress_uniformity(
             mesh, {kAluminium},
             element::point_stress(mesh, {kAluminium},
                                   solution.displacements[0]))
      .von_mises;
}

/// Pressure 2 H s inside and traction s along the conormals of both rims.
loads::LoadCase paper_load(const TetMesh& mesh, double pressure,
                           double thickness) {
  loads::LoadCase load_case;
  load_case.name = "paper";
  load_case.springs = floating(thickness);
  if (std::abs(pressure) > 1e-9) {
    load_case.pressures.push_back(
        {.surface = "back", .pressure = pressure * kStress * thickness});
  }
  for (const char* rim : {"low", "high"}) {
    for (const std::string& label : mesh.labels) {
      if (label == rim) {
        load_case.pressures.push_back({.surface = rim, .pressure = -kStress});
      }
    }
  }
  return load_case;
}

const std::vector<Shell>& shells() {
  static const std::vector<Shell> all = {
      {"plane", "foot", 0.0},      {"catenoid", "foot", 20.0},
      {"cylinder", "shaft", 55.0}, {"unduloid", "neck", 97.6},
      {"nodoid", "bulge", 137.7},  {"sphere", "dome", 200.0},
  };
  return all;
}

/// The low rim clamped, a force on what is far from it.
loads::LoadCase cantilever(const Shell& shell, const Vec3& force) {
  loads::LoadCase load_case;
  load_case.name = "another";
  load_case.supports = {{"low", true, true, true}};
  load_case.forces = {{shell.film == "sphere" ? "front" : "high", force}};
  return load_case;
}

/// The paper's pressure, but the rims clamped in place of the traction.
loads::LoadCase clamped(const TetMesh& mesh, double pressure,
                        double thickness) {
  loads::LoadCase load_case;
  load_case.name = "clamped";
  for (const char* rim : {"low", "high"}) {
    if (mesh.label_of(rim) >= 0) {
      load_case.supports.push_back({rim, true, true, true});
    }
  }
  load_case.pressures = {
      {.surface = "back", .pressure = pressure * kStress * thickness}};
  return load_case;
}

std::string figures(const stress::Uniformity& stress) {
  return fmt::format(
      "mean {:8.4f} MPa, variation {:.5f}, Gini {:.4f}, p95/p50 {:.4f}, "
      "peak/mean {:.4f}",
      stress.mean, stress.coefficient_of_variation, stress.gini,
      stress.p95_over_p50, stress.peak_over_mean);
}

/// Variation of von Mises stress over each shell's whole volume, by thickness.
std::vector<std::vector<double>> variations(
    const std::vector<double>& thicknesses) {
  std::vector<std::vector<double>> result(shells().size());
  for (const double thickness : thicknesses) {
    const Films films = films_at(kEdges * thickness);
    for (std::size_t k = 0; k < shells().size(); ++k) {
      const Shell& shell = shells()[k];
      const TetMesh mesh = mesh_of(films, shell, thickness);
      const stress::Uniformity stress = stress_under(
          mesh, paper_load(mesh, pressure_of(films, shell.body), thickness));
      result[k].push_back(stress.coefficient_of_variation);
      EXPECT_NEAR(stress.mean, kStress, 0.1 * thickness * kStress);
      fmt::print("  {:9} t {:3g} mm, {:6} elements: {}\n", shell.film,
                 thickness, mesh.element_count(), figures(stress));
    }
  }
  return result;
}

TEST(UniformStress, VariationFallsWithTheThickness) {
  std::vector<double> thicknesses = {4.0, 2.0};
  if (std::getenv("MENISCUS_THIN_SHELLS") != nullptr) {
    thicknesses.push_back(1.0);
  }
  const std::vector<std::vector<double>> variation = variations(thicknesses);
  for (std::size_t k = 0; k < shells().size(); ++k) {
    for (std::size_t j = 0; j < thicknesses.size(); ++j) {
      if (shells()[k].film == "plane") {
        EXPECT_LT(variation[k][j], kUniform);
      } else if (j > 0) {
        EXPECT_NEAR(std::log2(variation[k][j - 1] / variation[k][j]), kOrder,
                    kOrderBand)
            << shells()[k].film;
      }
    }
  }
}

/// What is left of it under loads that the shell was not made for.
TEST(UniformStress, IsOfThatLoadAlone) {
  constexpr double kThickness = 2.0;
  const Films films = films_at(kEdges * kThickness);
  for (const Shell& shell : shells()) {
    const TetMesh mesh = mesh_of(films, shell, kThickness);
    const double pressure = pressure_of(films, shell.body);
    const double paper =
        stress_under(mesh, paper_load(mesh, pressure, kThickness))
            .coefficient_of_variation;
    const auto told = [&](const char* load, const loads::LoadCase& load_case) {
      const stress::Uniformity stress = stress_under(mesh, load_case);
      fmt::print("  {:9} {:9}: {}\n", shell.film, load, figures(stress));
      return stress.coefficient_of_variation;
    };
    if (std::abs(pressure) > 1e-9) {
      EXPECT_GT(told("clamped", clamped(mesh, pressure, kThickness)), paper);
    }
    told("pulled", cantilever(shell, Vec3(0.0, 0.0, 100.0)));
    EXPECT_GT(told("sideways", cantilever(shell, Vec3(100.0, 0.0, 0.0))),
              3.0 * paper);
  }
}

}  // namespace
}  // namespace meniscus::uniform_stress_test
