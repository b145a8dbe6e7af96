#include "fea/shell/shell_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <omp.h>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/shell/facet_matrices.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_factor_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::hold;
using shell_shapes::MappedShell;

/// A vault with a wall that stands on it, held at random.
struct Vault {
  MappedShell shell;
  std::vector<Section> sections = {shell_shapes::isotropic(2e5, 0.3)};
  std::vector<LaminateLaw> laws = laminate_laws(sections);
  std::vector<NodeSupport> supports;
  ShellFreedom freedom;

  explicit Vault(unsigned seed)
      : shell(vault(seed)),
        supports(held(shell, seed)),
        freedom(nodes(), supports) {}

  int nodes() const { return static_cast<int>(shell.mesh.nodes.size()); }

  static MappedShell vault(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double turn = 0.5 + unit(random);
    const double thickness = std::pow(10.0, -1.0 - 2.0 * unit(random));
    const shell_shapes::GridOptions grid = {
        .m = 10 + static_cast<int>(random() % 9),
        .n = 12,
        .cut = Cut::Mixed,
        .seed = seed};
    const auto roof = [=](double s, double t) -> Vec3 {
      return {5.0 * std::sin(turn * (2.0 * s - 1.0)), 8.0 * t,
              5.0 * std::cos(turn * (2.0 * s - 1.0))};
    };
    const auto wall = [=](double s, double t) -> Vec3 {
      return roof(s, 0.5) + Vec3(0.0, 0.0, 2.0 * t);
    };
    return shell_shapes::joined(
        shell_shapes::mapped_shell(roof, thickness, grid),
        shell_shapes::mapped_shell(wall, thickness, grid));
  }

  static std::vector<NodeSupport> held(const MappedShell& shell,
                                       unsigned seed) {
    std::mt19937 random(seed + 1);
    std::vector<NodeSupport> supports;
    hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
         "xyz");
    const auto nodes = static_cast<int>(shell.mesh.nodes.size());
    for (int k = 0; k < 20; ++k) {
      NodeSupport one{.node = static_cast<int>(random() % nodes)};
      one.held[random() % 6] = true;
      const bool again =
          std::any_of(supports.begin(), supports.end(),
                      [&](const NodeSupport& s) { return s.node == one.node; });
      if (!again) {
        one.axes = element::LocalAxes{Vec3(1.0, 2.0, 0.3), Vec3(0.0, 1.0, 1.0)};
        supports.push_back(one);
      }
    }
    return supports;
  }

  FacetMatrix stiffness(int facet) const {
    return condensed(
        whole_stiffness(facet_of(shell.mesh, sections, laws, facet)));
  }

  ShellFactor factor(const ShellFactorOptions& options,
                     Eigen::MatrixXd* right = nullptr) const {
    return {shell.mesh, freedom, [this](int f) { return stiffness(f); },
            options, right};
  }
};

constexpr double kAll = std::numeric_limits<double>::infinity();

TEST(ShellFactor, OfSubstructuresSolvesAsTheWhole) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const Vault vault(seed);
    std::srand(seed);
    const Eigen::MatrixXd right =
        Eigen::MatrixXd::Random(vault.freedom.unknowns(), 3);
    const Eigen::MatrixXd whole = vault.factor({.most_levels = 0}).solve(right);
    Eigen::MatrixXd at_once = right;
    vault.factor({.most_levels = 0}, &at_once);
    EXPECT_TRUE(at_once == whole);
    for (const int levels : {1, 2, 3, 4}) {
      const ShellFactorOptions options = {
          .unknowns = 100, .most_levels = levels, .kept_bytes = kAll};
      const Eigen::MatrixXd parts = vault.factor(options).solve(right);
      EXPECT_LT((parts - whole).norm(), 1e-7 * whole.norm())
          << "seed " << seed << ", " << levels << " levels";
      ShellFactorOptions remade = options;
      remade.kept_bytes = 0.0;
      EXPECT_TRUE(vault.factor(remade).solve(right) == parts);
      Eigen::MatrixXd on_the_way = right;
      vault.factor(remade, &on_the_way);
      EXPECT_TRUE(on_the_way == parts);
    }
  }
}

/// A long plate and a short one, a quarter of both, that hang together nowhere:
/// one leaf of four has no boundary, and the one beside it has.
TEST(ShellFactor, OfPiecesApartSolvesAsTheWhole) {
  const auto plate = [](int cells, double height) {
    return shell_shapes::mapped_shell(
        [=](double s, double t) -> Vec3 {
          return {cells * s, 8.0 * t, height};
        },
        0.05, {.m = cells, .n = 8});
  };
  const MappedShell plates =
      shell_shapes::joined(plate(12, 0.0), plate(4, 1.0));
  const Substructures cut = cut_shell(plates.mesh, 2);
  int apart = 0;
  for (int leaf = 0; leaf < cut.leaf_count(); ++leaf) {
    apart += cut.parts[cut.part_of(leaf)].boundary.empty() ? 1 : 0;
  }
  ASSERT_EQ(apart, 1);
  std::vector<NodeSupport> supports;
  hold(supports, plates.nodes([](double s, double) { return s < 1e-9; }),
       "xyzabc");
  const ShellFreedom freedom(static_cast<int>(plates.mesh.nodes.size()),
                             supports);
  const std::vector<Section> sections = {shell_shapes::isotropic(2e5, 0.3)};
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const auto solved = [&](int levels) -> Eigen::MatrixXd {
    const ShellFactor factor(
        plates.mesh, freedom,
        [&](int f) {
          return condensed(
              whole_stiffness(facet_of(plates.mesh, sections, laws, f)));
        },
        {.unknowns = 50, .most_levels = levels, .kept_bytes = kAll});
    return factor.solve(Eigen::MatrixXd::Ones(freedom.unknowns(), 1));
  };
  const Eigen::MatrixXd whole = solved(0);
  for (const int levels : {1, 2, 3, 4}) {
    EXPECT_LT((solved(levels) - whole).norm(), 1e-7 * whole.norm()) << levels;
  }
}

TEST(ShellFactor, HasTheSameBitsInAnyNumberOfThreads) {
  const Vault vault(5);
  const Eigen::MatrixXd right =
      Eigen::MatrixXd::Ones(vault.freedom.unknowns(), 1);
  const ShellFactorOptions options = {.unknowns = 500};
  const int before = omp_get_max_threads();
  const Eigen::MatrixXd one = [&] {
    omp_set_num_threads(1);
    return vault.factor(options).solve(right);
  }();
  for (const int threads : {2, 3}) {
    omp_set_num_threads(threads);
    EXPECT_TRUE(vault.factor(options).solve(right) == one) << threads;
  }
  omp_set_num_threads(before);
}

TEST(ShellFactor, SaysHowFarItIsAndStops) {
  struct Listener : Monitor {
    std::vector<Progress> heard;
    std::size_t most = 1000;
    void progress(const Progress& progress) override {
      heard.push_back(progress);
    }
    bool stop_requested() const override { return heard.size() >= most; }
  } listener;
  const Vault vault(8);
  const ShellFactorOptions options = {.unknowns = 100, .monitor = &listener};
  const Eigen::MatrixXd right =
      Eigen::MatrixXd::Ones(vault.freedom.unknowns(), 1);
  vault.factor(options).solve(right);
  ASSERT_GE(listener.heard.size(), 6U);
  for (const Progress& progress : listener.heard) {
    EXPECT_GE(progress.fraction, 0.0) << progress.detail;
    EXPECT_LT(progress.fraction, 1.0) << progress.detail;
  }
  // While substructures are condensed, and while they are solved.
  const std::size_t all = listener.heard.size();
  for (const std::size_t most : {std::size_t(1), all - 1}) {
    listener.heard.clear();
    listener.most = most;
    EXPECT_THROW(vault.factor(options).solve(right), Interrupted);
    EXPECT_EQ(listener.heard.size(), most);
  }
}

TEST(ShellFactor, RefusesWhatIsNotPositiveDefinite) {
  const Vault vault(6);
  for (const int levels : {0, 3}) {
    const auto make = [&] {
      return ShellFactor(
          vault.shell.mesh, vault.freedom,
          [&](int f) -> FacetMatrix { return -vault.stiffness(f); },
          {.unknowns = 500, .most_levels = levels});
    };
    EXPECT_THROW(make(), SolverError) << levels;
  }
  Eigen::MatrixXd short_one = Eigen::MatrixXd::Zero(3, 1);
  EXPECT_THROW(vault.factor({}).solve(short_one), SolverError);
  EXPECT_THROW(vault.factor({}, &short_one), SolverError);
}

TEST(CutShell, GivesEveryNodeOneHome) {
  const Vault vault(7);
  const ShellMesh& mesh = vault.shell.mesh;
  for (const int levels : {0, 1, 3}) {
    const Substructures cut = cut_shell(mesh, levels);
    std::vector<int> homes(mesh.nodes.size(), 0);
    for (const Part& part : cut.parts) {
      for (const int node : part.own) {
        ++homes[node];
      }
    }
    EXPECT_EQ(std::count(homes.begin(), homes.end(), 1), vault.nodes());
    EXPECT_TRUE(cut.parts[1].boundary.empty());
    std::size_t facets = 0;
    for (int leaf = 0; leaf < cut.leaf_count(); ++leaf) {
      facets += cut.facets[leaf].size();
      EXPECT_LT(cut.facets[leaf].size(),
                1.1 * mesh.facets.size() / cut.leaf_count() + 2.0);
      const Part& part = cut.parts[cut.part_of(leaf)];
      for (const int facet : cut.facets[leaf]) {
        for (const int node : mesh.facets[facet]) {
          EXPECT_TRUE(
              std::binary_search(part.own.begin(), part.own.end(), node) ||
              std::binary_search(part.boundary.begin(), part.boundary.end(),
                                 node));
        }
      }
    }
    EXPECT_EQ(facets, mesh.facets.size());
  }
}

}  // namespace
}  // namespace meniscus::shell_factor_test
