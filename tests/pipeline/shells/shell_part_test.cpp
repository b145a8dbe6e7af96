/// Loads of a case on a shell: their work, by places, thicknesses and numbers.
#include "pipeline/shells/shell_part.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/shells/shell_holds.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_part_test {
namespace {

using shell_shapes::MappedShell;
using shells::ShellPart;

/// A saddle over the unit square, film "skin" with the rims "foot" at t = 0 and
/// "side" at s = 0.
MappedShell saddle() {
  return shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {2.0 * s, t, 0.4 * s * t - 0.2 * s * s};
      },
      0.05, {.m = 3, .n = 2});
}

void set_mesh(const shell::ShellMesh& mesh, ShellPart& part) {
  part.mesh = mesh;
  part.skin.nodes = mesh.nodes;
}

void make_part(const MappedShell& drawn, ShellPart& part) {
  set_mesh(drawn.mesh, part);
  part.sections = {shell_shapes::isotropic(1e3, 0.3, 2.0)};
  part.skin.order = 2;
  part.skin.corner_count = static_cast<int>(drawn.mesh.nodes.size());
  part.skin.labels = {"skin"};
  for (const std::array<int, 6>& facet : drawn.mesh.facets) {
    part.skin.faces.insert(part.skin.faces.end(), facet.begin(), facet.end());
    part.skin.face_label.push_back(0);
  }
  part.rims["skin/rim:foot"] =
      drawn.edges([](double, double t) { return t < 1e-9; });
  part.rims["skin/rim:side"] =
      drawn.edges([](double s, double) { return s < 1e-9; });
}

/// All that a case may ask for, times `size`.
loads::LoadCase loads_of(double size) {
  loads::LoadCase load{.name = "all"};
  load.pressures = {{.surface = "skin", .pressure = 3.0 * size},
                    {.surface = "skin/back", .pressure = -1.0 * size}};
  load.forces = {{"skin/rim:foot", size * Vec3(1.0, -2.0, 0.5)},
                 {"skin", size * Vec3(0.3, 0.2, -1.0)},
                 {{"skin/rim:foot", "skin/rim:side"}, size * Vec3(2, 1, -3)}};
  load.pressures.push_back({.surface = "skin/rim:side", .pressure = size});
  load.tractions = {
      {.surface = "skin/back", .traction = size * Vec3(0.1, 0.4, -0.3)},
      {.surface = "skin/rim:foot", .traction = size * Vec3(4.0, -5.0, 3.0)}};
  load.remote_loads = {{.surfaces = "skin",
                        .point = Vec3(1.0, 0.5, 2.0),
                        .force = size * Vec3(0.2, -0.1, 0.4),
                        .moment = size * Vec3(-0.3, 0.2, 0.1)},
                       {.surfaces = {"skin/rim:side", "skin/rim:foot"},
                        .point = Vec3(0.5, 1.5, -1.0),
                        .force = size * Vec3(-0.4, 0.7, 0.1),
                        .moment = size * Vec3(0.6, -0.5, 0.9)}};
  load.gravity = size * Vec3(0.0, 0.5, -9.0);
  return load;
}

VectorX waves(std::size_t nodes, double phase) {
  VectorX u(static_cast<Eigen::Index>(6 * nodes));
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    u[i] = std::sin(phase + 0.7 * static_cast<double>(i));
  }
  return u;
}

double work(const ShellPart& part, const loads::LoadCase& load,
            const VectorX& v) {
  return v.dot(shell::nodal_forces(part.mesh, part.sections,
                                   shells::shell_actions(part, load).loads));
}

TEST(ShellPart, LoadsWorkOnTranslationsAsTheirSums) {
  const MappedShell drawn = saddle();
  ShellPart part;
  make_part(drawn, part);
  loads::LoadCase load = loads_of(1.0);
  load.pressures.clear();
  load.gravity.setZero();
  load.tractions.clear();
  const Vec3 total = load.forces[0].total + load.forces[1].total +
                     load.forces[2].total + load.remote_loads[0].force +
                     load.remote_loads[1].force;
  VectorX v =
      VectorX::Zero(static_cast<Eigen::Index>(6 * part.mesh.nodes.size()));
  for (Eigen::Index i = 0; i < v.size(); i += 6) {
    v.segment<3>(i) = Vec3(1.0, 2.0, -1.0);
  }
  EXPECT_NEAR(work(part, load, v), total.dot(Vec3(1.0, 2.0, -1.0)), 1e-10);
}

/// Along z, from either side.
TEST(ShellPart, PressuresPushOffTheirSide) {
  const MappedShell drawn = saddle();
  ShellPart part;
  make_part(drawn, part);
  VectorX up =
      VectorX::Zero(static_cast<Eigen::Index>(6 * part.mesh.nodes.size()));
  for (Eigen::Index i = 2; i < up.size(); i += 6) {
    up[i] = 1.0;
  }
  loads::LoadCase load{.name = "one"};
  load.pressures = {{.surface = "skin", .pressure = 1.0}};
  EXPECT_LT(work(part, load, up), -1.5);  // normals point up, over 2 x 1
  load.pressures[0].surface = "skin/back";
  EXPECT_GT(work(part, load, up), 1.5);
}

TEST(ShellPart, WorkMeetsDifferencesByPlacesAndThicknesses) {
  const MappedShell drawn = saddle();
  const loads::LoadCase load = loads_of(1.0);
  ShellPart part;
  make_part(drawn, part);
  part.cases.resize(1);
  part.cases[0].actions = shells::shell_actions(part, load);
  const std::size_t nodes = part.mesh.nodes.size();
  const VectorX v = waves(nodes, 0.3);
  const shell::ShellGradient here =
      shells::work_gradient(part, 0, v, VectorX::Zero(v.size()));
  const VectorX move = waves(nodes, 1.4);
  derivatives::Check check;
  for (std::size_t i = 0; i < nodes; ++i) {
    const Vec3 step = 0.05 * move.segment<3>(6L * static_cast<int>(i));
    check.exact += here.by_nodes[i].dot(step);
    check.scale += here.by_nodes[i].cwiseProduct(step).lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellPart moved;
    make_part(drawn, moved);
    shell::ShellMesh mesh = drawn.mesh;
    for (std::size_t i = 0; i < nodes; ++i) {
      mesh.nodes[i] += 0.05 * h * move.segment<3>(6L * static_cast<int>(i));
    }
    set_mesh(mesh, moved);
    return work(moved, load, v);
  });
  check = {};
  for (std::size_t f = 0; f < here.by_thickness.size(); ++f) {
    const Vec3 step = 0.02 * move.segment<3>(6L * static_cast<int>(f));
    check.exact += here.by_thickness[f].dot(step);
    check.scale += here.by_thickness[f].cwiseProduct(step).lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellPart other;
    make_part(drawn, other);
    for (std::size_t f = 0; f < other.mesh.thickness.size(); ++f) {
      other.mesh.thickness[f] +=
          0.02 * h * move.segment<3>(6L * static_cast<int>(f));
    }
    return work(other, load, v);
  });
}

/// Loads are linear in their numbers: the rate is the work of the rates.
TEST(ShellPart, WorkGrowsByTheLoadsRates) {
  const MappedShell drawn = saddle();
  ShellPart part;
  make_part(drawn, part);
  const VectorX v = waves(part.mesh.nodes.size(), 0.3);
  loads::LoadCase rates = loads_of(1.0);
  for (loads::RemoteLoad& remote : rates.remote_loads) {
    remote.point.setZero();  // it does not move
  }
  const double exact =
      work(part, loads_of(3.0), v) - work(part, loads_of(2.0), v);
  EXPECT_NEAR(shells::work_rate(part, loads_of(2.5), rates, v), exact,
              1e-9 * std::abs(exact));
}

TEST(ShellPart, SupportsHoldRimsAndFilms) {
  const MappedShell drawn = saddle();
  ShellPart part;
  make_part(drawn, part);
  loads::LoadCase load{.name = "held"};
  loads::Support rim{.surface = "skin/rim:foot", .fix_x = true};
  rim.fix_rotation = {false, true, false};
  load.supports = {rim};
  const auto held = shells::node_supports(part, load);
  EXPECT_EQ(held.size(),
            drawn.nodes([](double, double t) { return t < 1e-9; }).size());
  EXPECT_EQ(held[0].held,
            (std::array<bool, 6>{true, false, false, false, true, false}));
  load.supports[0].surface = "skin/back";
  EXPECT_EQ(shells::node_supports(part, load).size(), part.mesh.nodes.size());
  load.supports[0].surface = "skin/rim:none";
  EXPECT_THROW(shells::node_supports(part, load), InvalidInput);
}

}  // namespace
}  // namespace meniscus::shell_part_test
