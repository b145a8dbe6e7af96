// Rings are ruled: bands between random curves, and what refinement makes of
// them.
#include "evolve/start/band_rows.h"

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/geometry/edge_key.h"
#include "evolve/films/edge_marks.h"
#include "evolve/films/triangle_shape.h"
#include "evolve/groom/refine.h"

namespace meniscus::band_rows_test {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

class RandomCurves {
 public:
  explicit RandomCurves(unsigned seed) : random_(seed) {}

  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int one_of(int count) {
    return std::uniform_int_distribution<int>(0, count - 1)(random_);
  }
  Vec3 tilted(double most) {
    return {within(-most, most), within(-most, most), 1.0};
  }

  /// Around the z axis at height z; either way around.
  curves::CurveShape curve(int kind, double z) {
    const double way = one_of(2) == 0 ? 1.0 : -1.0;
    const Vec3 center(within(-0.1, 0.1), within(-0.1, 0.1), z);
    const Vec3 normal = way * tilted(0.2);
    const double size = within(0.8, 1.2);
    switch (kind) {
      case 0:
        return curves::Circle{center, normal, size};
      case 1:
        return curves::Ellipse{center, normal, Vec3::UnitX(), size,
                               size * within(0.6, 1.0)};
      case 2:
        return curves::Rectangle{center,     normal,     Vec3::UnitX(),
                                 2.0 * size, 1.6 * size, 0.0};
      case 3:
        return curves::Rectangle{center,     normal,     Vec3::UnitX(),
                                 2.0 * size, 1.6 * size, 0.3 * size};
      default:
        break;
    }
    Points points;
    const int corners = 5 + one_of(4);
    for (int k = 0; k < corners; ++k) {
      const double angle = way * kWholeTurn * k / corners;
      points.emplace_back(size * std::cos(angle), size * std::sin(angle),
                          z + within(-0.1, 0.1));
    }
    if (kind == 4) {
      return curves::Polygon{points};
    }
    return curves::Spline{points};
  }

 private:
  std::mt19937 random_;
};

/// A complex of the ring alone.
films::FilmComplex ring_between(const curves::CurveShape& low,
                                const curves::CurveShape& high, double edge) {
  films::FilmComplex complex;
  complex.curves = {{"low", low}, {"high", high}};
  complex.mesh.labels = {"ring"};
  complex.surfaces = {{.name = "ring", .liquid = false, .band = 0}};
  complex.bands = {films::match_band(complex.curves, 0, 1)};
  std::vector<start::BandRim> rims;
  for (int c = 0; c < 2; ++c) {
    const std::vector<double> t =
        curves::sample_parameters(complex.curves[c].shape, edge);
    start::BandRim& rim = rims.emplace_back();
    rim.points = curves::points_at(complex.curves[c].shape, t);
    for (const double at : t) {
      complex.vertices.push_back(
          {.kind = films::VertexKind::OnCurve, .curve = c, .t = at});
      rim.t.push_back(c == 0 ? at : complex.bands[0].partner_of_inner(at));
    }
  }
  const start::BandFilling filling = start::fill_band(
      complex.bands[0], complex.curves, rims[0], rims[1], edge);
  complex.mesh.points = filling.mesh.points;
  complex.mesh.facets = filling.mesh.facets;
  complex.mesh.facet_label.assign(filling.mesh.facets.size(), 0);
  for (const films::BandPlace& place : filling.between) {
    complex.vertices.push_back({.kind = films::VertexKind::OnBand,
                                .curve = 0,
                                .t = place.t,
                                .share = place.share});
  }
  return complex;
}

/// Every edge in two facets, but those of the two rims in one.
void expect_band(const films::FilmComplex& complex) {
  std::map<Edge, int> uses;
  for (const Triangle& t : complex.mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      ++uses[edge_key(t[k], t[(k + 1) % 3])];
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : uses) {
    ASSERT_LE(count, 2);
    if (count == 1) {
      ++open;
      EXPECT_EQ(complex.vertices[edge[0]].kind, films::VertexKind::OnCurve);
      EXPECT_EQ(complex.vertices[edge[0]].curve,
                complex.vertices[edge[1]].curve);
    }
  }
  const auto on_rims = static_cast<std::size_t>(
      std::count_if(complex.vertices.begin(), complex.vertices.end(),
                    [](const films::ComplexVertex& v) {
                      return v.kind == films::VertexKind::OnCurve;
                    }));
  EXPECT_EQ(open, on_rims);
  EXPECT_EQ(complex.mesh.points.size() + complex.mesh.facets.size(),
            uses.size());  // an annulus
}

double smallest_angle_of(const films::FilmComplex& complex) {
  double least = 10.0;
  for (const Triangle& t : complex.mesh.facets) {
    least = std::min(least, films::smallest_angle(complex.mesh.points[t[0]],
                                                  complex.mesh.points[t[1]],
                                                  complex.mesh.points[t[2]]));
  }
  return least;
}

/// How far the vertices between the rims are off every line of the band.
double off_band(const films::FilmComplex& complex) {
  double most = 0.0;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].kind != films::VertexKind::OnBand) {
      continue;
    }
    const Vec3& at = complex.mesh.points[v];
    const films::BandPlace place =
        films::nearest_on_band(complex.bands[0], complex.curves, at);
    most =
        std::max(most, (films::point_on_band(complex.bands[0], complex.curves,
                                             place.t, place.share) -
                        at)
                           .norm());
  }
  return most;
}

TEST(BandRows, RandomBandsLieOnTheirLinesRefinedToo) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomCurves random(seed);
    const int low = random.one_of(6);
    const int high = random.one_of(3) == 0 ? random.one_of(6) : low;
    const curves::CurveShape below = random.curve(low, 0.0);
    const curves::CurveShape above =
        random.curve(high, random.within(0.4, 3.0));
    const films::FilmComplex ring =
        ring_between(below, above, random.within(0.15, 0.4));
    expect_band(ring);
    EXPECT_LT(off_band(ring), 1e-6);
    EXPECT_GT(smallest_angle_of(ring), 0.1);
    const films::FilmComplex fine = groom::refine(ring).complex;
    expect_band(fine);
    EXPECT_LT(off_band(fine), 1e-6);
    EXPECT_GT(smallest_angle_of(fine), 0.08);
  }
}

// Whatever their frames: a long bore, its mouths facing each other.
TEST(BandRows, EqualCirclesMakeACylinder) {
  RandomCurves random(7);
  for (int k = 0; k < 20; ++k) {
    const Vec3 axis = random.tilted(0.9).normalized();
    const double radius = random.within(0.5, 2.0);
    const double length = radius * random.within(0.2, 20.0);
    const films::FilmComplex ring = ring_between(
        curves::Circle{Vec3::Zero(), -axis, radius},
        curves::Circle{length * axis, axis, radius}, random.within(0.2, 0.8));
    const films::FilmComplex fine = groom::refine(ring).complex;
    for (const Vec3& p : fine.mesh.points) {
      EXPECT_NEAR((p - p.dot(axis) * axis).norm(), radius, 1e-12 * radius);
    }
    EXPECT_GT(smallest_angle_of(ring), 0.4);
  }
}

// A hole beside the edge of its plate: isotropic facets in the plane.
TEST(BandRows, EccentricHolesStayInTheirPlane) {
  const films::FilmComplex ring =
      ring_between(curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 2.0},
                   curves::Circle{Vec3(1.2, 0, 0), Vec3::UnitZ(), 0.5}, 0.2);
  for (const Vec3& p : ring.mesh.points) {
    EXPECT_NEAR(p.z(), 0.0, 1e-12);
  }
  EXPECT_NEAR(surface_area(ring.mesh), 0.5 * kWholeTurn * 3.75, 0.06);
  EXPECT_GT(smallest_angle_of(ring), 0.3);
}

}  // namespace
}  // namespace meniscus::band_rows_test
