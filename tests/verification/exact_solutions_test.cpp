/// Orders of convergence and stress concentrations on exact solutions.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fea/stress/averaged_stress.h"
#include "fea/stress/patch_recovery.h"
#include "fea/stress/peak_stress.h"
#include "tests/support/exact_elasticity.h"
#include "tests/support/mapped_shapes.h"
#include "tests/support/parts.h"

namespace meniscus::exact_solutions_test {
namespace {

// Measured orders may fall short of theory by this on meshes that are not yet
// fine.
constexpr double kOrderSlack = 0.25;

loads::Support held_x(const char* s) { return {s, true, false, false}; }
loads::Support held_y(const char* s) { return {s, false, true, false}; }
loads::Support held_z(const char* s) { return {s, false, false, true}; }

VectorX solve(const TetMesh& mesh, const element::Material& material,
              loads::LoadCase load_case) {
  load_case.name = "exact";
  const elastic::ElasticModel model(mesh, {material}, {load_case});
  EXPECT_FALSE(model.base_solution().failure);
  return model.base_solution().displacements[0];
}

int node_at(const TetMesh& mesh, const Vec3& x) {
  int best = 0;
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    if ((mesh.nodes[i] - x).norm() < (mesh.nodes[best] - x).norm()) {
      best = i;
    }
  }
  return best;
}

struct Orders {
  double l2 = 0.0;
  double energy = 0.0;
};

/// Solves at n, 2 n, ... and returns the last observed orders.
Orders observe(const char* name, const exact::Field& field,
               const std::vector<int>& sizes,
               const std::function<TetMesh(int)>& mesh_of,
               const std::function<loads::LoadCase(const TetMesh&)>& load_of) {
  exact::Norms last;
  Orders orders;
  for (const int n : sizes) {
    const TetMesh mesh = mesh_of(n);
    const VectorX u = solve(mesh, field.material(), load_of(mesh));
    const exact::Norms norms = exact::error_norms(mesh, field, u);
    if (last.l2 > 0.0) {
      orders = {std::log2(last.l2 / norms.l2),
                std::log2(last.energy / norms.energy)};
    }
    std::cout << fmt::format(
        "{} n {}: {} elements, L2 {:.2e} (order {:.2f}), energy {:.2e} (order "
        "{:.2f})\n",
        name, n, mesh.element_count(), norms.l2 / norms.l2_exact, orders.l2,
        norms.energy / norms.energy_exact, orders.energy);
    last = norms;
  }
  return orders;
}

/// 0 on the plane x = 0, which is held.
exact::Field smooth_field() {
  return {parts::steel(), [](const exact::DualVec& x) -> exact::DualVec {
            const exact::Dual g =
                1e-3 * sin(2.0 * x[0]) * cos(1.5 * x[1]) * exp(0.5 * x[2]);
            return {g, -0.7 * g, 0.4 * g};
          }};
}

class Manufactured : public testing::TestWithParam<int> {};

TEST_P(Manufactured, ErrorsFallAtTheirOrders) {
  const int p = GetParam();
  const exact::Field field = smooth_field();
  const Orders orders = observe(
      p == 1 ? "manufactured, four-node" : "manufactured, ten-node", field,
      p == 1 ? std::vector<int>{4, 8, 16} : std::vector<int>{2, 4, 8},
      [p](int n) {
        const TetMesh mesh = parts::distorted_brick({1.0, 1.0, 1.0}, n);
        return p == 1 ? mesh : shapes::straight_quadratic(mesh);
      },
      [&](const TetMesh& mesh) {
        loads::LoadCase load{.supports = {parts::hold("x0")}};
        load.nodal = exact::loads(mesh, field, {"x1", "y0", "y1", "z0", "z1"},
                                  exact::BodyForce::Included);
        return load;
      });
  EXPECT_NEAR(orders.l2, p + 1.0, kOrderSlack);
  EXPECT_NEAR(orders.energy, p, kOrderSlack);
}
INSTANTIATE_TEST_SUITE_P(Orders, Manufactured, testing::Values(1, 2));

/// The same mesh with mid-side nodes in the middle of straight edges.
TetMesh straightened(TetMesh mesh) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (int m = 0; m < 6; ++m) {
      mesh.nodes[ids[4 + m]] = 0.5 * (mesh.nodes[ids[kTetEdges[m][0]]] +
                                      mesh.nodes[ids[kTetEdges[m][1]]]);
    }
  }
  return mesh;
}

loads::LoadCase sphere_pressure(const TetMesh& /*mesh*/) {
  return {.supports = {held_x("x0"), held_y("y0"), held_z("z0")},
          .pressures = {{.surface = "inner", .pressure = 100.0}}};
}

TEST(ThickSphere, CurvedElementsKeepTheirOrdersStraightOnesDoNot) {
  const exact::Field field =
      exact::thick_sphere(parts::steel(), 1.0, 2.0, 100.0);
  const auto shell = [](int n) { return shapes::octant_shell(1.0, 2.0, n, n); };
  const Orders curved = observe("thick sphere, curved", field, {4, 8, 16},
                                shell, sphere_pressure);
  EXPECT_NEAR(curved.l2, 3.0, kOrderSlack);
  EXPECT_NEAR(curved.energy, 2.0, kOrderSlack);
  const Orders straight = observe(
      "thick sphere, straight", field, {4, 8, 16},
      [&](int n) { return straightened(shell(n)); }, sphere_pressure);
  EXPECT_NEAR(straight.l2, 2.0, kOrderSlack);
}

TEST(ThickSphere, HoopStressesConverge) {
  const double p = 100.0;
  double last = 0.0;
  for (const int n : {4, 8}) {
    const TetMesh mesh = shapes::octant_shell(1.0, 2.0, 2 * n, n);
    const VectorX u = solve(mesh, parts::steel(), sphere_pressure(mesh));
    const stress::StressField stress =
        stress::recover_stress(mesh, {parts::steel()}, u);
    const double inside =
        stress.nodal[node_at(mesh, {1.0, 0.0, 0.0})][1] / (p * 5.0 / 7.0) - 1.0;
    const double outside =
        stress.nodal[node_at(mesh, {2.0, 0.0, 0.0})][1] / (p * 3.0 / 14.0) -
        1.0;
    std::cout << fmt::format(
        "thick sphere n {}: hoop stress off by {:.2e} inside, {:.2e} outside\n",
        n, inside, outside);
    const double error = std::max(std::abs(inside), std::abs(outside));
    if (n == 8) {
      EXPECT_LT(error, 0.01);
      EXPECT_GT(last / error, 3.0);  // order 2 at least
    }
    last = error;
  }
}

/// A concentrated stress at a place against its exact value as meshes refine.
struct Peak {
  const char* name;
  exact::Field field;
  TetMesh (*mesh)(int n);
  std::vector<loads::Support> supports;
  Vec3 place;
  int component;
  double exact;  // [pressure]
};

void expect_peak(const Peak& peak) {
  double last = 0.0;
  for (const int n : {2, 4, 8}) {
    const TetMesh mesh = peak.mesh(n);
    loads::LoadCase load{.supports = peak.supports};
    load.nodal =
        exact::loads(mesh, peak.field, {"outer"}, exact::BodyForce::None);
    const VectorX u = solve(mesh, parts::steel(), load);
    const element::PointStress points =
        element::point_stress(mesh, {parts::steel()}, u);
    const int node = node_at(mesh, peak.place);
    const double found =
        stress::nodal_stress(mesh, stress::recover_by_patches(mesh, points))
            .nodal[node][peak.component];
    const double averaged =
        stress::nodal_stress(mesh, stress::average_extrapolations(mesh, points))
            .nodal[node][peak.component];
    const double error = std::abs(found / peak.exact - 1.0);
    std::cout << fmt::format(
        "{} n {}: {} elements, peak {:.4f} (averages {:.4f}), exact {:.4f}\n",
        peak.name, n, mesh.element_count(), found, averaged, peak.exact);
    if (n == 8) {
      EXPECT_LT(error, 0.01);
      EXPECT_GT(last / error, 2.0);  // order 1 at least
    }
    last = error;
  }
}

TEST(StressConcentration, OfAHoleInAPlateIsThree) {
  expect_peak({"hole in a plate",
               exact::hole_in_plate(parts::steel(), 1.0, 1.0),
               [](int n) {
                 return shapes::quarter_ring(1.0, 4.0, 1.0, 2 * n, 2 * n, n);
               },
               {held_x("x0"), held_y("y0"), held_z("z0"), held_z("z1")},
               {0.0, 1.0, 0.0},
               0,
               3.0});
}

TEST(StressConcentration, OfASphericalCavityIsGoodiers) {
  const double nu = parts::steel().poisson_ratio;
  expect_peak(
      {"spherical cavity",
       exact::spherical_cavity(parts::steel(), 1.0),
       [](int n) { return shapes::octant_shell(1.0, 4.0, 2 * n, 2 * n); },
       {held_x("x0"), held_y("y0"), held_z("z0")},
       {1.0, 0.0, 0.0},
       2,
       (27.0 - 15.0 * nu) / (2.0 * (7.0 - 5.0 * nu))});
}

/// Inner corners moved at random by up to `share` of their shortest edge, edges
/// between them straight: as uneven as a filled part's elements.
TetMesh jittered(TetMesh mesh, double share, unsigned seed) {
  std::vector<char> outer(mesh.nodes.size(), 0);
  for (int f = 0; f < mesh.face_count(); ++f) {
    for (const int v : mesh.face(f)) {
      outer[v] = 1;
    }
  }
  std::vector<double> shortest(mesh.nodes.size(), 1e300);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (const auto& [a, b] : kTetEdges) {
      const double length = (mesh.nodes[ids[a]] - mesh.nodes[ids[b]]).norm();
      shortest[ids[a]] = std::min(shortest[ids[a]], length);
      shortest[ids[b]] = std::min(shortest[ids[b]], length);
    }
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-share, share);
  Points moves(mesh.nodes.size(), Vec3::Zero());
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v) {
    if (outer[v] == 0 && shortest[v] < 1e300) {
      moves[v] =
          shortest[v] * Vec3(within(random), within(random), within(random));
    }
  }
  TetMesh moved = mesh;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (int k = 0; k < 4; ++k) {
      moved.nodes[ids[k]] = mesh.nodes[ids[k]] + moves[ids[k]];
    }
    for (int m = 0; m < 6; ++m) {
      if (outer[ids[4 + m]] == 0) {
        moved.nodes[ids[4 + m]] =
            mesh.nodes[ids[4 + m]] +
            0.5 * (moves[ids[kTetEdges[m][0]]] + moves[ids[kTetEdges[m][1]]]);
      }
    }
  }
  return moved;
}

/// Largest von Mises stresses over the exact one, on meshes with moved nodes.
struct ReadingShares {
  std::vector<double> recovered, averaged, points, safe;

  static std::string text(const std::vector<double>& shares) {
    const auto [low, high] = std::minmax_element(shares.begin(), shares.end());
    return fmt::format("{:.3f} to {:.3f}", *low, *high);
  }
};

ReadingShares read_peaks(const exact::Field& field, const char* loaded,
                         const std::function<TetMesh(unsigned)>& mesh_of,
                         const loads::LoadCase& held, double exact_peak) {
  ReadingShares shares;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const TetMesh mesh = mesh_of(seed);
    loads::LoadCase load = held;
    load.nodal = exact::loads(mesh, field, {loaded}, exact::BodyForce::None);
    const VectorX u = solve(mesh, parts::steel(), load);
    const element::PointStress points =
        element::point_stress(mesh, {parts::steel()}, u);
    const stress::PeakReadings peaks = stress::peak_readings(
        {mesh, stress::recover_by_patches(mesh, points),
         stress::average_extrapolations(mesh, points), points});
    shares.recovered.push_back(peaks.recovered.von_mises / exact_peak);
    shares.averaged.push_back(peaks.averaged.von_mises / exact_peak);
    shares.points.push_back(peaks.points.von_mises / exact_peak);
    shares.safe.push_back(peaks.largest().von_mises / exact_peak);
  }
  return shares;
}

void expect_readings(const char* name, const ReadingShares& shares,
                     double least_safe) {
  std::cout << fmt::format(
      "{}: recovered {}, averaged {}, points {} of the exact peak\n", name,
      ReadingShares::text(shares.recovered),
      ReadingShares::text(shares.averaged), ReadingShares::text(shares.points));
  EXPECT_GE(*std::min_element(shares.safe.begin(), shares.safe.end()),
            least_safe);
}

// Kirsch's peak is uniaxial, 3: it is the von Mises stress too.
TEST(PeakReadings, OfAHoleOnUnevenMeshes) {
  for (const int n : {2, 4}) {
    const ReadingShares shares = read_peaks(
        exact::hole_in_plate(parts::steel(), 1.0, 1.0), "outer",
        [&](unsigned seed) {
          return jittered(shapes::quarter_ring(1.0, 4.0, 1.0, 2 * n, 2 * n, n),
                          0.25, seed);
        },
        {.supports = {held_x("x0"), held_y("y0"), held_z("z0"), held_z("z1")}},
        3.0 * std::sqrt(1.0 - 0.3 + 0.09));  // held along z: nu s in the plane
    expect_readings(n == 2 ? "hole, coarse" : "hole", shares, 1.0);
  }
}

// The curved beam of every text book, outer radius 1.5 times the inner. Nothing
// holds it along x but springs that carry no force.
TEST(PeakReadings, OfACurvedBeamOnUnevenMeshes) {
  constexpr double kInner = 2.0;
  constexpr double kOuter = 3.0;
  const exact::Field ring =
      exact::bent_ring(parts::steel(), kInner, kOuter, 1.0);
  const double around = ring.at({kInner, 0.0, 0.0}).stress[1];
  for (const int n : {2, 4}) {
    loads::LoadCase held{
        .supports = {held_y("y0"), held_z("z0"), held_z("z1")}};
    held.springs.push_back({"y0", Vec3(1e-3, 0.0, 0.0)});
    const ReadingShares shares = read_peaks(
        ring, "x0",
        [&](unsigned seed) {
          return jittered(
              shapes::quarter_ring(kInner, kOuter, 0.5, n, 4 * n, n), 0.25,
              seed);
        },
        held, std::abs(around) * std::sqrt(1.0 - 0.3 + 0.09));
    expect_readings(n == 2 ? "curved beam, coarse" : "curved beam", shares,
                    1.0);
  }
}

// Goodier's, with the stress around the equator: s_z and s_phi.
TEST(PeakReadings, OfACavityOnUnevenMeshes) {
  const double nu = parts::steel().poisson_ratio;
  const double along = (27.0 - 15.0 * nu) / (2.0 * (7.0 - 5.0 * nu));
  const double around = (15.0 * nu - 3.0) / (2.0 * (7.0 - 5.0 * nu));
  const double exact =
      std::sqrt(along * along + around * around - along * around);
  for (const int n : {2, 4}) {
    const ReadingShares shares = read_peaks(
        exact::spherical_cavity(parts::steel(), 1.0), "outer",
        [&](unsigned seed) {
          return jittered(shapes::octant_shell(1.0, 4.0, 2 * n, 2 * n), 0.12,
                          seed);
        },
        {.supports = {held_x("x0"), held_y("y0"), held_z("z0")}}, exact);
    expect_readings(n == 2 ? "cavity, coarse" : "cavity", shares, 1.0);
  }
}

}  // namespace
}  // namespace meniscus::exact_solutions_test
