// Harmonic functions on meshes.
#include "core/geometry/harmonic.h"

#include <gtest/gtest.h>

#include "tests/support/sheet_shapes.h"

namespace meniscus::harmonic_test {
namespace {

// Two conductors in a row: 0 and 1 at the ends, the stiff half takes its share
// 1 / (1 + k) of the way.
TEST(Harmonic, IsFlatterWhereItIsStiff) {
  const SurfaceMesh mesh =
      shapes::patch([](double u, double v) { return Vec3(2.0 * u, v, 0.3); },
                    {.rows = 5, .columns = 8, .jitter = 0.0});
  for (const double k : {1.0, 3.0, 250.0}) {
    HarmonicProblem problem{mesh.points, mesh.facets, {}, {}, {}};
    problem.fixed.assign(mesh.points.size(), 0);
    problem.values =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.points.size()), 1);
    problem.weights = HarmonicWeights::Exact;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      problem.facets.push_back(static_cast<int>(f));
      const Triangle& t = mesh.facets[f];
      const double middle =
          (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]).x() / 3.0;
      problem.stiffness.push_back(middle < 1.0 ? 1.0 : k);
    }
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const double x = mesh.points[v].x();
      problem.fixed[v] = x < 1e-12 || x > 2.0 - 1e-12 ? 1 : 0;
      problem.values(static_cast<Eigen::Index>(v), 0) = x > 1.0 ? 1.0 : 0.0;
    }
    const Eigen::MatrixXd values = harmonic(problem);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const double x = mesh.points[v].x();
      const double soft = k / (1.0 + k);
      const double exact = x < 1.0 ? soft * x : soft + (1.0 - soft) * (x - 1.0);
      EXPECT_NEAR(values(static_cast<Eigen::Index>(v), 0), exact, 1e-12) << k;
    }
  }
}

}  // namespace
}  // namespace meniscus::harmonic_test
