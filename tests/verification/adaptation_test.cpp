/// One round of adaptive refinement against uniform meshes, on an angle with a
/// re-entrant edge and clamped edges, where stresses are singular.
#include "pipeline/forward/adaptation.h"

#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fea/loads/loads.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/nested_surface.h"
#include "tests/support/parts.h"
#include "tests/support/shapes.h"

namespace meniscus::adaptation_test {
namespace {

/// Three cubes of edge 1 with n x n squares a face, "top" at y = 2 and "end" at
/// x = 2.
SurfaceMesh angle(int n) {
  SurfaceMesh mesh = shapes::cubes({2, 2, 1}, n, [](int i, int j, int) {
    return i == 1 && j == 1 ? -1 : 0;
  });
  mesh.labels = {"outside", "top", "end"};
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Vec3 centre = Vec3::Zero();
    for (const int p : mesh.facets[f]) {
      centre += mesh.points[p] / 3.0;
    }
    constexpr double kOnPlane = 1e-9;
    mesh.facet_label[f] = centre.y() > 2.0 - kOnPlane   ? 1
                          : centre.x() > 2.0 - kOnPlane ? 2
                                                        : 0;
  }
  return mesh;
}

// A uniform mesh of as many elements errs by 6 to 18 % more (its error falls
// with the fourth root of their number only), by what TetGen makes of either.
constexpr double kBetter = 0.97;

struct Solved {
  TetMesh mesh;
  double energy = 0.0;  // strain energy
  stress::EnergyError error;
  int elements = 0;
};

Solved solve(const QuadraticSurface& surface,
             const mesh_tet::TetrahedralizeOptions& options) {
  const mesh_tet::Tetrahedralization filled =
      mesh_tet::tetrahedralize(surface.base, options);
  EXPECT_FALSE(filled.failure) << filled.failure->message;
  Solved result{.mesh = mesh_tet::make_quadratic(filled.mesh, surface)};
  loads::LoadCase bend{.name = "bend"};
  bend.supports = {{"top", true, true, true}};
  bend.forces = {{"end", {0.0, -1.0, 0.0}}};
  const element::Material steel = parts::steel();
  const elastic::ElasticModel model(result.mesh, {steel}, {bend});
  EXPECT_FALSE(model.base_solution().failure);
  const VectorX& u = model.base_solution().displacements[0];
  result.energy = 0.5 * loads::nodal_forces(result.mesh, bend).dot(u);
  result.error = stress::estimate_error(
      result.mesh, {steel},
      {u,
       stress::recover_by_patches(
           result.mesh, element::point_stress(result.mesh, {steel}, u)),
       {}});
  result.elements = result.mesh.element_count();
  return result;
}

Solved adapted(const NestedSurface& nested, const Solved& coarse) {
  std::vector<double> share;
  for (const double e : coarse.error.element) {
    share.push_back(e * e / (coarse.error.error * coarse.error.error));
  }
  const forward::RefinementPlan plan =
      forward::plan_refinement(coarse.mesh, share);
  const double edge = mean_edge_length(nested.surface().base);
  return solve(nested.split(plan.split),
               {.edge = edge,
                .size = plan.size,
                .radius_edge_ratio = forward::kGradedRadiusEdge,
                .min_dihedral_deg = forward::kGradedDihedral});
}

TEST(Adaptation, ErrsLessThanUniformMeshesOfAsManyElements) {
  std::vector<Solved> uniform;
  std::vector<Solved> fine;
  for (const int n : {2, 3, 4, 6, 8}) {
    const NestedSurface nested = nested_surface(angle(n), 2);
    uniform.push_back(solve(nested.surface(), {}));
    if (n <= 4 || n == 8) {
      fine.push_back(adapted(nested, uniform.back()));
    }
  }
  // The finest mesh and its own estimated error stand for the exact solution.
  const Solved& best = fine.back();
  const double exact = best.energy + 0.5 * best.error.error * best.error.error;
  const double norm = std::sqrt(2.0 * exact);
  const auto error = [&](const Solved& s) {
    return std::sqrt(2.0 * (exact - s.energy)) / norm;
  };
  for (const Solved& s : uniform) {
    std::cout << fmt::format(
        "uniform: {} elements, energy error {:.2f} %, "
        "estimated {:.2f} %\n",
        s.elements, 100.0 * error(s), 100.0 * s.error.relative());
  }
  const auto uniform_error = [&](double elements) {
    std::size_t k = 1;
    while (k + 1 < uniform.size() && uniform[k].elements < elements) {
      ++k;
    }
    const double low = std::log(uniform[k - 1].elements);
    const double t =
        (std::log(elements) - low) / (std::log(uniform[k].elements) - low);
    return std::exp((1.0 - t) * std::log(error(uniform[k - 1])) +
                    t * std::log(error(uniform[k])));
  };
  for (std::size_t k = 0; k + 1 < fine.size(); ++k) {
    const double as_many = uniform_error(fine[k].elements);
    std::cout << fmt::format(
        "adapted: {} elements from {}, energy error {:.2f} % (before {:.2f} "
        "%), estimated {:.2f} %; a uniform mesh of as many {:.2f} %\n",
        fine[k].elements, uniform[k].elements, 100.0 * error(fine[k]),
        100.0 * error(uniform[k]), 100.0 * fine[k].error.relative(),
        100.0 * as_many);
    EXPECT_LT(error(fine[k]), kBetter * as_many);
  }
}

}  // namespace
}  // namespace meniscus::adaptation_test
