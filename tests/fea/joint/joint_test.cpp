#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/joint/edge_tie.h"
#include "fea/joint/joint_system.h"
#include "fea/joint/tie_motion.h"
#include "fea/loads/loads.h"
#include "fea/shell/shell_loads.h"
#include "tests/support/derivatives.h"
#include "tests/support/parts.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::joint_test {
namespace {

using namespace joint;  // NOLINT: the room under test
using shell_shapes::MappedShell;

constexpr double kModulus = 1000.0;

/// A block from x = -length to 0, `width` along y, and a plate that goes on
/// from the middle of its end; z from -thickness/2 to thickness/2.
struct Bar {
  double length = 4.0;  // of each half
  double width = 1.0;
  double thickness = 0.5;
  double poisson = 0.0;
  int along = 4;
  int across = 1;
  int through = 2;
};

TetMesh block_of(const Bar& bar) {
  TetMesh mesh = shapes::straight_quadratic(
      shapes::brick({bar.length, bar.width, bar.thickness}, bar.along,
                    bar.across, bar.through));
  for (Vec3& x : mesh.nodes) {
    x -= Vec3(bar.length, 0.0, 0.5 * bar.thickness);
  }
  return mesh;
}

MappedShell plate_of(const Bar& bar, double turn = 0.0) {
  return shell_shapes::mapped_shell(
      [&](double s, double t) -> Vec3 {
        return {bar.length * s, bar.width * t, turn * bar.length * s * s};
      },
      bar.thickness, {.m = bar.along, .n = bar.across});
}

std::vector<shell::Section> section_of(const Bar& bar) {
  return {shell_shapes::isotropic(kModulus, bar.poisson, 1.0)};
}

std::vector<element::Material> material_of(const Bar& bar) {
  return {{"stuff", kModulus, bar.poisson, 1.0, {}}};
}

VectorX rigid_of(const Points& places, const Vec3& move, const Vec3& turn,
                 bool six) {
  const int size = six ? 6 : 3;
  VectorX u(size * std::ssize(places));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(size * i);
    u.segment<3>(at) = move + turn.cross(places[i]);
    if (six) {
      u.segment<3>(at + 3) = turn;
    }
  }
  return u;
}

/// The shell's six numbers at tied nodes, of the solid's displacements and
/// the turns that `six` has there.
VectorX tied_of(const EdgeTie& tie, const Points& solid, const Points& shell,
                const VectorX& u, const VectorX& six) {
  VectorX result = six;
  const std::vector<TieRow> rows = tie_rows(tie, solid, shell);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const TieRow& row = rows[k];
    const double turn =
        tie.nodes[k].axes.col(2).dot(six.segment<3>(6L * row.node + 3));
    shell::Six own = row.by_turn * turn;
    for (std::size_t n = 0; n < row.solid.size(); ++n) {
      own += row.by_solid[n] * u.segment<3>(3L * row.solid[n]);
    }
    result.segment<6>(6L * row.node) = own;
  }
  return result;
}

Points moved(Points places, double phase, double t) {
  for (Vec3& x : places) {
    x += t * derivatives::wave(x, phase);
  }
  return places;
}

VectorX six_waves(const Points& places, double phase) {
  VectorX v(6 * std::ssize(places));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    v.segment<3>(at) = derivatives::wave(places[i], phase);
    v.segment<3>(at + 3) = derivatives::wave(places[i], phase + 1.0);
  }
  return v;
}

TEST(EdgeTie, FindsTheEdgeThatLiesOnTheSolid) {
  const Bar bar{.across = 3};
  const MappedShell plate = plate_of(bar);
  const EdgeTie tie = tie_edges(block_of(bar), plate.mesh, section_of(bar));
  const std::vector<int> there =
      plate.nodes([](double s, double) { return s < 1e-9; });
  ASSERT_EQ(tie.nodes.size(), there.size());
  for (std::size_t k = 0; k < there.size(); ++k) {
    EXPECT_EQ(tie.nodes[k].node, there[k]);
    // The wall's normal is what the fibres do not turn about.
    EXPECT_NEAR(std::abs(tie.nodes[k].axes(2, 2)), 1.0, 1e-12);
  }
  MappedShell away = plate;
  for (Vec3& x : away.mesh.nodes) {
    x.x() += 0.2 * bar.thickness;
  }
  EXPECT_TRUE(
      tie_edges(block_of(bar), away.mesh, section_of(bar)).nodes.empty());
}

TEST(EdgeTie, FollowsRigidMotionsAtAnyPlaces) {
  const Bar bar{.across = 2};
  const TetMesh solid = block_of(bar);
  const MappedShell plate = plate_of(bar, 0.2);
  const EdgeTie tie = tie_edges(solid, plate.mesh, section_of(bar));
  const Points x = moved(solid.nodes, 0.3, 0.1);
  const Points X = moved(plate.mesh.nodes, 0.5, 0.1);
  const Vec3 move(0.3, -0.2, 0.7);
  const Vec3 turn(-0.4, 0.9, 0.5);
  const VectorX six = rigid_of(X, move, turn, true);
  const VectorX tied = tied_of(tie, x, X, rigid_of(x, move, turn, false), six);
  EXPECT_LT((tied - six).lpNorm<Eigen::Infinity>(), 1e-11);
}

TEST(EdgeTie, PassesWhatIsQuadraticAlongTheEdge) {
  const Bar bar{.across = 2};
  const TetMesh solid = block_of(bar);
  const MappedShell plate = plate_of(bar);
  const EdgeTie tie = tie_edges(solid, plate.mesh, section_of(bar));
  VectorX u(3 * std::ssize(solid.nodes));
  const auto place = [](double y) {
    return Vec3(0.2 + y * y, 0.3 - y, 0.1 + 2.0 * y - y * y);
  };
  const auto turn = [](double y) { return 0.4 - 0.7 * y; };  // about y
  for (std::size_t i = 0; i < solid.nodes.size(); ++i) {
    const Vec3& x = solid.nodes[i];
    u.segment<3>(3L * static_cast<Eigen::Index>(i)) =
        place(x.y()) + Vec3(0.0, turn(x.y()), 0.0).cross(Vec3(0, 0, x.z()));
  }
  const VectorX tied = tied_of(tie, solid.nodes, plate.mesh.nodes, u,
                               VectorX::Zero(6 * std::ssize(plate.mesh.nodes)));
  for (const TiedNode& node : tie.nodes) {
    const double y = plate.mesh.nodes[node.node].y();
    EXPECT_LT((tied.segment<3>(6L * node.node) - place(y)).norm(), 1e-12);
    EXPECT_NEAR(tied[6L * node.node + 4], turn(y), 1e-12);
  }
}

TEST(EdgeTie, ChangesWithPlacesAsItsGradientSays) {
  const Bar bar{.across = 2};
  const TetMesh solid = block_of(bar);
  const MappedShell plate = plate_of(bar, 0.2);
  const EdgeTie tie = tie_edges(solid, plate.mesh, section_of(bar));
  const Points x = moved(solid.nodes, 0.3, 0.05);
  const Points X = moved(plate.mesh.nodes, 0.5, 0.05);
  const VectorX u = derivatives::wave(solid, 0.8);
  const VectorX six = six_waves(X, 1.7);
  const VectorX p = six_waves(X, 2.9);
  const auto work = [&](double t) {
    const VectorX tied =
        tied_of(tie, moved(x, 1.1, t), moved(X, 1.4, t), u, six);
    double sum = 0.0;
    for (const TiedNode& node : tie.nodes) {
      sum += p.segment<6>(6L * node.node).dot(tied.segment<6>(6L * node.node));
    }
    return sum;
  };
  Points by_solid(x.size(), Vec3::Zero());
  Points by_shell(X.size(), Vec3::Zero());
  add_tie_gradient(tie, x, X, u, tied_of(tie, x, X, u, six), p, by_solid,
                   by_shell);
  double exact = 0.0;
  double scale = 0.0;
  const auto add = [&](const Points& places, double phase, const Points& by) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vec3 parts =
          derivatives::wave(places[i], phase).cwiseProduct(by[i]);
      exact += parts.sum();
      scale += parts.cwiseAbs().sum();
    }
  };
  add(x, 1.1, by_solid);
  add(X, 1.4, by_shell);
  derivatives::expect_derivative({exact, scale, 1e-3, 1e-7}, work);
}

TEST(EdgeTie, RefusesAnEdgeThatWouldBeAHinge) {
  // The plate goes on from the edge of a block that is far thinner.
  Bar thin;
  thin.thickness = 0.005;
  Bar bar;
  const MappedShell plate = plate_of(bar);
  EXPECT_THROW(tie_edges(block_of(thin), plate.mesh, section_of(bar)),
               InvalidInput);
}

/// Held at the block's end, with one load.
struct Solved {
  VectorX u;
  VectorX left;  // residual
  VectorX forces;
  Vec3 tip = Vec3::Zero();
  Eigen::Index solid_size = 0;
};

loads::LoadCase held_end() {
  loads::LoadCase load_case;
  load_case.name = "held";
  load_case.supports = {parts::hold("x0")};
  return load_case;
}

Solved solve_bar(const Bar& bar, const Vec3& force) {
  const TetMesh solid = block_of(bar);
  const MappedShell plate = plate_of(bar);
  const std::vector<shell::Section> sections = section_of(bar);
  const EdgeTie tie = tie_edges(solid, plate.mesh, sections);
  const JointSystem system(solid, material_of(bar), held_end(), plate.mesh,
                           sections, {}, tie);
  shell::ShellLoads loads;
  for (const auto& edge :
       plate.edges([](double s, double) { return s > 1.0 - 1e-9; })) {
    loads.edges.push_back({edge, force / bar.width, Vec3::Zero()});
  }
  Solved result;
  result.solid_size = 3 * std::ssize(solid.nodes);
  result.forces.resize(result.solid_size + 6 * std::ssize(plate.mesh.nodes));
  result.forces << VectorX::Zero(result.solid_size),
      shell::nodal_forces(plate.mesh, sections, loads);
  result.u = system.solve(result.forces);
  result.left = system.residual(result.u, result.forces);
  EXPECT_LT(system.imbalance(result.left, result.forces), 1e-9);
  const VectorX reactions = system.reactions(result.left);
  Vec3 sum = force;
  for (Eigen::Index i = 0; i < reactions.size(); i += 3) {
    sum += reactions.segment<3>(i);
  }
  EXPECT_LT(sum.norm(), 1e-9 * force.norm());
  result.tip =
      result.u.segment<3>(result.solid_size + 6L * plate.node(1.0, 0.5));
  return result;
}

TEST(JointSystem, IsPulledAsABarIs) {
  for (const int across : {1, 3}) {
    const Bar bar{.across = across, .through = across + 1};
    const double exact =
        2.0 * bar.length / (kModulus * bar.width * bar.thickness);
    EXPECT_NEAR(solve_bar(bar, Vec3::UnitX()).tip.x(), exact, 2e-4 * exact)
        << across;
  }
}

/// Of a cantilever with shear, both halves.
double beam_deflection(const Bar& bar) {
  const double L = 2.0 * bar.length;
  const double A = bar.width * bar.thickness;
  const double I = A * bar.thickness * bar.thickness / 12.0;
  const double G = 0.5 * kModulus / (1.0 + bar.poisson);
  return L * L * L / (3.0 * kModulus * I) + L / (5.0 / 6.0 * G * A);
}

TEST(JointSystem, BendsAsABeamDoes) {
  // Across the wall, and in its plane.
  std::vector<double> errors;
  for (const int n : {4, 8}) {
    const Bar bar{.along = n, .across = 1, .through = 2};
    const double exact = beam_deflection(bar);
    errors.push_back(
        std::abs(solve_bar(bar, Vec3::UnitZ()).tip.z() / exact - 1.0));
  }
  EXPECT_LT(errors[0], 2e-3);
  EXPECT_LT(errors[1], 5e-4);
  const Bar flat{.along = 8, .across = 2};
  Bar turned = flat;
  std::swap(turned.width, turned.thickness);
  const double exact = beam_deflection(turned);
  EXPECT_NEAR(solve_bar(flat, Vec3::UnitY()).tip.y(), exact, 2e-3 * exact);
}

TEST(JointSystem, IsSymmetric) {
  const Bar bar{.poisson = 0.3, .across = 2};
  const TetMesh solid = block_of(bar);
  const MappedShell plate = plate_of(bar, 0.1);
  const std::vector<shell::Section> sections = section_of(bar);
  const EdgeTie tie = tie_edges(solid, plate.mesh, sections);
  const JointSystem system(solid, material_of(bar), held_end(), plate.mesh,
                           sections, {}, tie);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto some = [&] {
    VectorX f(3 * std::ssize(solid.nodes) + 6 * std::ssize(plate.mesh.nodes));
    for (double& value : f) {
      value = normal(random);
    }
    return f;
  };
  const VectorX f = some();
  const VectorX g = some();
  const VectorX u = system.solve(f);
  const VectorX v = system.solve(g);
  EXPECT_NEAR(g.dot(u), f.dot(v), 1e-9 * g.norm() * u.norm());
  EXPECT_GT(f.dot(u), 0.0);
}

TEST(JointSystem, TellsOfWhatCanMove) {
  const Bar bar;
  const TetMesh solid = block_of(bar);
  const MappedShell plate = plate_of(bar);
  const std::vector<shell::Section> sections = section_of(bar);
  const EdgeTie tie = tie_edges(solid, plate.mesh, sections);
  loads::LoadCase half = held_end();
  half.supports = {{.surface = "x0", .fix_x = true}};
  EXPECT_THROW(
      JointSystem(solid, material_of(bar), half, plate.mesh, sections, {}, tie),
      SolverError);
  // The plate alone would hold the block.
  std::vector<shell::NodeSupport> supports;
  shell_shapes::hold(supports,
                     plate.nodes([](double s, double) { return s > 0.999; }),
                     "xyzabc");
  half.supports.clear();
  EXPECT_NO_THROW(JointSystem(solid, material_of(bar), half, plate.mesh,
                              sections, supports, tie));
  EXPECT_THROW(JointSystem(solid, material_of(bar), half, plate.mesh, sections,
                           supports, EdgeTie{}),
               SolverError);
}

}  // namespace
}  // namespace meniscus::joint_test
