/// cases/constant_mean_curvature: each of its six films against its closed
/// form, vertex by vertex, as nested refinements halve the facets.
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "evolve/frozen/film_model.h"
#include "pipeline/reader/case_reader.h"
#include "tests/support/delaunay_curves.h"
#include "tests/verification/film_cases.h"

namespace meniscus::constant_mean_curvature_test {
namespace {

using std::numbers::pi;

constexpr const char* kCase =
    MENISCUS_SOURCE_DIR "/cases/constant_mean_curvature/case.toml";
constexpr double kEdge = 8.0;  // of the coarsest film [mm]
constexpr int kLevels = 3;
constexpr double kOrder = 2.0;
constexpr double kOrderBand = 0.25;  // what two halvings resolve of an order
constexpr double kExact = 1e-9;      // of what is exact on flat facets [mm]

struct Exact {
  std::string film;
  std::string body;
  double area = 0.0;                            // [mm2]
  double pressure = 0.0;                        // [MPa], tension 1 N/mm
  std::function<double(const Vec3&)> distance;  // from the film [mm]
};

double radius_of(const Vec3& p) { return std::hypot(p.x(), p.y()); }

std::vector<Exact> exact_films() {
  const test_films::Catenoid foot = test_films::catenoid(40.0, 40.0);
  const test_films::Meridian neck =
      test_films::delaunay_meridian(14.0, 0.05, 28.404561080364);
  const test_films::Meridian bulge =
      test_films::delaunay_meridian(26.0, 0.1, 14.328593303765);
  const double collar = 70.0;
  const double girdle = collar + 2.0 * neck.rim().z;
  const double crown = girdle + 2.0 * bulge.rim().z;
  const auto meridian = [](const test_films::Meridian& m, double bottom) {
    return [m, bottom](const Vec3& p) {
      return m.distance(radius_of(p), std::abs(p.z() - bottom - m.rim().z));
    };
  };
  return {
      {"catenoid", "foot", foot.area, 0.0,
       [foot](const Vec3& p) {
         const double z = (p.z() - 20.0) / foot.waist;
         return (radius_of(p) - foot.waist * std::cosh(z)) / std::cosh(z);
       }},
      {"plane", "foot", pi * (1600.0 - 400.0), 0.0,
       [](const Vec3& p) { return p.z() - 40.0; }},
      {"cylinder", "shaft", 2.0 * pi * 20.0 * 30.0, 1.0 / 20.0,
       [](const Vec3& p) { return radius_of(p) - 20.0; }},
      {"unduloid", "neck", neck.area, neck.pressure, meridian(neck, collar)},
      {"nodoid", "bulge", bulge.area, bulge.pressure, meridian(bulge, girdle)},
      {"sphere", "dome", 2.0 * pi * 400.0, 0.1,
       [crown](const Vec3& p) {
         return (p - Vec3(0.0, 0.0, crown)).norm() - 20.0;
       }},
  };
}

/// Of one film over the levels.
struct Errors {
  std::vector<double> profile;   // root mean square over vertices [mm]
  std::vector<double> area;      // relative
  std::vector<double> pressure;  // relative, of the sphere's for pressure 0
};

double profile_error(const SurfaceMesh& mesh, const Exact& exact) {
  const int label = mesh.label_of(exact.film);
  std::vector<char> in_film(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == label) {
      for (const int v : mesh.facets[f]) {
        in_film[v] = 1;
      }
    }
  }
  double sum = 0.0;
  int count = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (in_film[v] != 0) {
      sum += std::pow(exact.distance(mesh.points[v]), 2);
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

void expect_order(const std::string& what, const std::vector<double>& errors,
                  bool is_exact) {
  std::string text;
  for (const double error : errors) {
    text += fmt::format(" {:.2e}", error);
    if (is_exact) {
      EXPECT_LT(std::abs(error), kExact) << what;
    }
  }
  if (!is_exact) {
    for (const double rate : test_films::rates(errors)) {
      EXPECT_NEAR(rate, kOrder, kOrderBand) << what << text;
      text += fmt::format(" order {:.2f}", rate);
    }
  }
  fmt::print("  {}:{}\n", what, text);
}

TEST(ConstantMeanCurvature, EachFilmIsItsClosedForm) {
  const std::vector<Exact> exact = exact_films();
  std::vector<Errors> errors(exact.size());
  const case_data::Case input = reader::read_case(kCase);
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  for (int level = 0; level < kLevels; ++level) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        inputs.film_system, {.edge = kEdge, .refinements = level});
    const settle::FilmState& film = model.reference();
    ASSERT_FALSE(film.failure) << film.report.verdict;
    EXPECT_EQ(film.report.index, 0);
    const SurfaceMesh mesh = model.fine_mesh(film.points);
    for (std::size_t k = 0; k < exact.size(); ++k) {
      errors[k].profile.push_back(profile_error(mesh, exact[k]));
      errors[k].area.push_back(
          surface_area(mesh, mesh.label_of(exact[k].film)) / exact[k].area -
          1.0);
      for (const settle::BodyState& body : film.report.bodies) {
        if (body.name == exact[k].body) {
          errors[k].pressure.push_back((body.pressure - exact[k].pressure) /
                                       0.1);
        }
      }
    }
  }
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const bool flat = exact[k].film == "plane";
    expect_order(exact[k].film + " profile [mm]", errors[k].profile, flat);
    expect_order(exact[k].film + " area", errors[k].area, false);
    expect_order(exact[k].film + " pressure", errors[k].pressure,
                 exact[k].pressure == 0.0);
  }
}

}  // namespace
}  // namespace meniscus::constant_mean_curvature_test
