#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/math/dense.h"
#include "fea/shell/facet_matrices.h"
#include "fea/shell/shell_assembly.h"
#include "fea/shell/shell_system.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_facet_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::MappedShell;

constexpr double kYoung = 70.0;
constexpr double kPoisson = 0.3;
constexpr double kShear = kYoung / (2.0 * (1.0 + kPoisson));

std::mt19937& random_numbers() {
  static std::mt19937 random(7);
  return random;
}

double number(double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random_numbers());
}

unsigned seed() { return static_cast<unsigned>(random_numbers()()); }

Vec3 direction() {
  return Vec3(number(-1, 1), number(-1, 1), number(-1, 1)).normalized();
}

Mat3 rotation() {
  return Eigen::AngleAxisd(number(0.3, 3.0), direction()).toRotationMatrix();
}

/// A flat quadrilateral with random corners, in general position.
struct FlatPatch {
  Mat3 axes = rotation();
  Vec3 origin = {number(-3, 3), number(-3, 3), number(-3, 3)};
  double skew = number(-0.3, 0.3);
  double taper = number(-0.3, 0.3);
  double thickness = number(0.02, 0.3);
  MappedShell shell = shell_shapes::mapped_shell(
      [this](double s, double t) -> Vec3 { return place(s, t); }, thickness,
      {.m = 3,
       .n = 4,
       .cut = Cut::Mixed,
       .shake = 0.3,
       .seed = seed(),
       .straight = true});

  Vec3 place(double s, double t) const {
    return origin + axes * Vec3(2.0 * s + skew * t, t * (1.0 + taper * s), 0);
  }
  /// Coordinates in the plane.
  Vec3 local(const Vec3& x) const { return axes.transpose() * (x - origin); }
};

/// A state of constant strain: displacement and rotation by coordinates in the
/// plane, and its energy per area and thickness t.
struct ConstantState {
  const char* name;
  std::function<Six(const Vec3&)> field;
  double energy;
};

std::vector<ConstantState> constant_states(double t) {
  const double e = number(0.5, 1.0);
  const double k = number(0.5, 1.0);
  const double whole = kYoung / (1.0 - kPoisson * kPoisson);
  const double D = whole * t * t * t / 12.0;
  const auto six = [](double u, double v, double w, double a, double b,
                      double c) {
    Six f;
    f << u, v, w, a, b, c;
    return f;
  };
  return {
      {"stretch", [=](const Vec3& x) { return six(e * x[0], 0, 0, 0, 0, 0); },
       0.5 * whole * t * e * e},
      {"shear in the plane",
       [=](const Vec3& x) {
         return six(e * x[1], 0, 0, 0, 0, -0.5 * e);  // half the curl
       },
       0.5 * kShear * t * e * e},
      {"bending",
       [=](const Vec3& x) {
         return six(0, 0, 0.5 * k * x[0] * x[0], 0, -k * x[0], 0);
       },
       0.5 * D * k * k},
      {"twist",
       [=](const Vec3& x) {
         return six(0, 0, k * x[0] * x[1], k * x[0], -k * x[1], 0);
       },
       D * (1.0 - kPoisson) * k * k},
      {"transverse shear",
       [=](const Vec3& x) { return six(0, 0, e * x[0], 0, 0, 0); },
       0.5 * (5.0 / 6.0) * kShear * t * e * e}};
}

VectorX nodal_field(const FlatPatch& patch, const ConstantState& state) {
  const Points& nodes = patch.shell.mesh.nodes;
  VectorX u(static_cast<Eigen::Index>(6 * nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Six own = state.field(patch.local(nodes[i]));
    const auto at = static_cast<Eigen::Index>(6 * i);
    u.segment<3>(at) = patch.axes * own.head<3>();
    u.segment<3>(at + 3) = patch.axes * own.tail<3>();
  }
  return u;
}

double area_of(const ShellMesh& mesh) {
  double area = 0.0;
  for (const auto& f : mesh.facets) {
    const Vec3& o = mesh.nodes[f[0]];
    area += 0.5 * (mesh.nodes[f[1]] - o).cross(mesh.nodes[f[2]] - o).norm();
  }
  return area;
}

Eigen::MatrixXd dense_stiffness(const ShellMesh& mesh,
                                const std::vector<Section>& sections) {
  const ShellFreedom freedom(static_cast<int>(mesh.nodes.size()), {});
  const ShellAssembly assembly(mesh, freedom);
  const auto laws = laminate_laws(sections);
  const SparseMatrix K = assembly.sum([&](int f) {
    return condensed(whole_stiffness(facet_of(mesh, sections, laws, f)));
  });
  return Eigen::MatrixXd(Eigen::MatrixXd(K).selfadjointView<Eigen::Lower>());
}

/// Rounding of sums whose terms stretch walls of 1/50 of their length.
constexpr double kExact = 1e-9;

TEST(ShellPatch, ConstantStrainsStoreTheirEnergy) {
  for (int draw = 0; draw < 5; ++draw) {
    const FlatPatch patch;
    const std::vector<Section> sections = {
        shell_shapes::isotropic(kYoung, kPoisson)};
    const ShellMesh& mesh = patch.shell.mesh;
    const auto laws = laminate_laws(sections);
    const double area = area_of(mesh);
    for (const ConstantState& state : constant_states(patch.thickness)) {
      SCOPED_TRACE(state.name);
      const VectorX u = nodal_field(patch, state);
      double energy = 0.0;  // with bubbles at rest
      for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
        WholeVector own = WholeVector::Zero();
        own.head<kUnknowns>() = numbers_of(mesh, f, u);
        energy +=
            0.5 *
            own.dot(whole_stiffness(facet_of(mesh, sections, laws, f)) * own);
      }
      EXPECT_NEAR(energy / (state.energy * area), 1.0, kExact);
    }
  }
}

/// All but transverse shear, which needs moments spread over the plate.
TEST(ShellPatch, ConstantStrainsFollowFromTheBoundary) {
  for (int draw = 0; draw < 5; ++draw) {
    const FlatPatch patch;
    const ShellMesh& mesh = patch.shell.mesh;
    const std::vector<Section> sections = {
        shell_shapes::isotropic(kYoung, kPoisson)};
    auto states = constant_states(patch.thickness);
    states.pop_back();
    for (const ConstantState& state : states) {
      SCOPED_TRACE(state.name);
      const VectorX u = nodal_field(patch, state);
      std::vector<NodeSupport> supports;
      shell_shapes::hold(supports, patch.shell.nodes([](double s, double t) {
        return s < 1e-9 || t < 1e-9 || s > 1 - 1e-9 || t > 1 - 1e-9;
      }),
                         "xyzabc");
      for (NodeSupport& support : supports) {
        support.value = u.segment<6>(6L * support.node);
      }
      const ShellSystem system(mesh, sections, supports);
      const ShellSolution solution = system.solve({});
      EXPECT_LT((solution.displacement - u).norm() / u.norm(), kExact);
      EXPECT_NEAR(solution.strain_energy / (state.energy * area_of(mesh)), 1.0,
                  kExact);
    }
  }
}

/// Curved, unevenly thick, layered and away from its surface.
MappedShell curved_patch(int cells) {
  const double a = number(-0.4, 0.4);
  const double b = number(-0.4, 0.4);
  const double c = number(-0.4, 0.4);
  const Mat3 R = rotation();
  MappedShell shell = shell_shapes::mapped_shell(
      [=](double s, double t) -> Vec3 {
        return R * Vec3(s + 0.1 * t * t, t - 0.2 * s * s,
                        a * s * s + b * s * t + c * t * t);
      },
      0.05,
      {.m = cells,
       .n = cells,
       .cut = Cut::Mixed,
       .shake = 0.25,
       .seed = seed()});
  for (Vec3& t : shell.mesh.thickness) {
    t = Vec3(number(0.02, 0.1), number(0.02, 0.1), number(0.02, 0.1));
  }
  return shell;
}

Section layered() {
  element::Material fiber{"fiber", 1.0, 0.3, 1.0, {}};
  fiber.orthotropic = element::Orthotropic{
      {130.0, 9.0, 9.0}, {0.3, 0.3, 0.4}, {5.0, 5.0, 3.0}, {}};
  Section section;
  section.laminate.plies = {{fiber, 1.0, 0.4}, {fiber, 2.0, -0.7}};
  section.offset = number(-0.5, 0.5);
  section.direction = direction();
  return section;
}

VectorX rigid_motion(const ShellMesh& mesh, const Vec3& move,
                     const Vec3& turn) {
  VectorX u(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    u.segment<3>(at) = move + turn.cross(mesh.nodes[i]);
    u.segment<3>(at + 3) = turn;
  }
  return u;
}

TEST(ShellFacet, RigidMotionsGiveNoForce) {
  for (int draw = 0; draw < 10; ++draw) {
    const MappedShell shell = curved_patch(2);
    const Eigen::MatrixXd K = dense_stiffness(shell.mesh, {layered()});
    const VectorX u = rigid_motion(shell.mesh, direction(), direction());
    EXPECT_LT((K * u).norm() / (K.norm() * u.norm()), kExact);
  }
}

TEST(ShellFacet, AFreePatchHasSixMotionsWithoutEnergy) {
  for (const int cells : {1, 2, 3}) {
    const MappedShell shell = curved_patch(cells);
    const Eigen::MatrixXd K =
        dense_stiffness(shell.mesh, {shell_shapes::isotropic(1.0, kPoisson)});
    const VectorX values = symmetric_eigen(K).values;
    EXPECT_LT(std::abs(values[5]), 1e-12 * values.tail<1>()[0]);
    EXPECT_GT(values[6], 1e-8 * values.tail<1>()[0]);
  }
  // A flat facet alone: a bubble about its normal would make a seventh.
  const FlatPatch flat;
  ShellMesh one = flat.shell.mesh;
  const auto& c = one.facets[0];
  Points nodes;
  for (const int node : c) {
    nodes.push_back(one.nodes[node]);
  }
  one.nodes = nodes;
  one.facets = {{0, 1, 2, 3, 4, 5}};
  one.thickness.resize(1);
  one.section.resize(1);
  const VectorX values =
      symmetric_eigen(
          dense_stiffness(one, {shell_shapes::isotropic(1.0, kPoisson)}))
          .values;
  EXPECT_LT(std::abs(values[5]), 1e-12 * values.tail<1>()[0]);
  EXPECT_GT(values[6], 1e-8 * values.tail<1>()[0]);
}

/// The rows of the stiffness and the strains of one field are two codes.
TEST(ShellFacet, EnergyIsThatOfTheStrains) {
  const MappedShell shell = curved_patch(1);
  const std::vector<Section> sections = {layered()};
  const auto laws = laminate_laws(sections);
  const Facet facet = facet_of(shell.mesh, sections, laws, 0);
  const WholeVector whole = WholeVector::Random();
  const FacetVector u = whole.head<kUnknowns>();
  const auto X = triples(facet);
  const auto axes = bubble_axes(X);
  const Triple<double> bubble =
      plus(times(whole[kUnknowns], axes[0]), whole[kUnknowns + 1], axes[1]);
  const LaminateLaw& law = laws[0];
  double energy = 0.0;
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const FacetStrain<double> s = facet_strain(
        X, p, frame, Eigen::Map<const FacetField>(u.data()), bubble);
    const double t = thickness_at(facet, p);
    double wall = kDrilling * law.mean_shear * t *
                  std::pow(s.stretch[0][1] - s.stretch[1][0], 2);
    for (const LayerPoint& point : law.points) {
      const double zeta = (point.at + facet.offset) * t;
      const auto shift = shifter(frame.curvature, zeta);
      const auto e = layer_strain(s, inverse(shift), zeta);
      const Vec3 plane = as_vector(e.plane);
      const Eigen::Vector2d across(e.across[0], e.across[1]);
      const PlyLaw& ply = law.plies[point.ply];
      wall += point.weight * t * determinant(shift) *
              (plane.dot(ply.plane * plane) + across.dot(law.across * across));
    }
    energy += p.weight * frame.area * wall;
  }
  EXPECT_NEAR(whole.dot(whole_stiffness(facet) * whole) / energy, 1.0, 1e-12);
}

TEST(ShellFacet, MassIsThatOfMovingAndTurningWalls) {
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {2.0 * s, 3.0 * t, 0.0};
      },
      0.5, {.m = 2, .n = 2});
  constexpr double kDensity = 7.0;
  Section section = shell_shapes::isotropic(1.0, kPoisson, kDensity);
  section.offset = 0.25;
  const std::vector<Section> sections = {section};
  const auto laws = laminate_laws(sections);
  const VectorX u = rigid_motion(shell.mesh, {0, 0, 0}, {1, 0, 0});
  double twice = 0.0;
  for (std::size_t f = 0; f < shell.mesh.facets.size(); ++f) {
    const FacetVector own = numbers_of(shell.mesh, static_cast<int>(f), u);
    twice += own.dot(
        facet_mass(facet_of(shell.mesh, sections, laws, static_cast<int>(f))) *
        own);
  }
  // About x: y^2 over the plate, and z from -1/8 to 3/8.
  const double inertia =
      kDensity * 2.0 * (0.5 * 9.0 + 3.0 * (27.0 + 1.0) / 512.0 / 3.0);
  EXPECT_NEAR(twice / inertia, 1.0, 1e-12);
}

}  // namespace
}  // namespace meniscus::shell_facet_test
