#include "fea/elastic/elastic_gradient.h"

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/loads/body_load_gradient.h"
#include "fea/supports/enforced.h"
#include "fea/supports/support_gradient.h"
#include "fea/supports/surface_load_gradient.h"

namespace meniscus::elastic {

namespace {

void check_size(const TetMesh& mesh, const loads::LoadCase& load_case,
                const char* what, const VectorX& v) {
  if (v.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("gradient of load case '{}': {} of {} numbers for {} nodes",
                    load_case.name, what, v.size(), mesh.nodes.size()));
  }
}

/// -lambda . K u: with H_u, H_l the two gradients, s_u, s_l their stresses and
/// dx_i/dx_j = D of a change, dH = -H D and dV = V tr D.
void add_stiffness_gradient(const TetMesh& mesh,
                            const std::vector<element::Material>& materials,
                            const VectorX& u, const VectorX& lambda,
                            VectorX& sum) {
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  const element::SweepTargets<2, 1> targets{.fields = {&u, &lambda},
                                            .outputs = {&sum}};
  element::sweep_stiffness_points(
      mesh, targets,
      [&](const element::SweepPoint<2>& point, element::SweepFlux<1>& flux) {
        const element::ElasticLaw& law =
            laws[mesh.element_region[point.element]];
        const auto& [H_u, H_l] = point.gradient;
        const Mat3 s_u = law.stress(H_u);
        const Mat3 s_l = law.stress(H_l);
        Mat3& M = flux.by_gradient[0];
        M.noalias() = H_l.transpose() * s_u;
        M.noalias() += H_u.transpose() * s_l;
        M.diagonal().array() -= s_u.cwiseProduct(H_l).sum();
        M *= point.volume;
      });
}

void add_force_gradient(const TetMesh& mesh,
                        const std::vector<element::Material>& materials,
                        const loads::LoadCase& load_case, const VectorX& v,
                        Points& gradient) {
  supports::add_surface_load_gradient(mesh, load_case, v, gradient);
  if (load_case.spin || load_case.temperature ||
      !load_case.gravity.isZero(0.0)) {
    loads::add_body_load_gradient(mesh, materials, load_case, v, gradient);
  }
}

}  // namespace

Points force_gradient(const TetMesh& mesh,
                      const std::vector<element::Material>& materials,
                      const loads::LoadCase& load_case, const VectorX& v) {
  check_size(mesh, load_case, "a vector", v);
  Points gradient(mesh.nodes.size(), Vec3::Zero());
  add_force_gradient(mesh, materials, load_case, v, gradient);
  return gradient;
}

Points residual_gradient(const TetMesh& mesh,
                         const std::vector<element::Material>& materials,
                         const loads::LoadCase& load_case,
                         const loads::AdjointPair& pair) {
  element::check_materials(mesh, materials);
  check_size(mesh, load_case, "a displacement", pair.displacement);
  check_size(mesh, load_case, "an adjoint", pair.lambda);
  check_size(mesh, load_case, "reactions", pair.reactions);
  check_size(mesh, load_case, "an adjoint's reactions", pair.adjoint_reactions);
  VectorX sum = element::nodal_zeros(mesh);
  add_stiffness_gradient(mesh, materials, pair.displacement, pair.lambda, sum);
  Points gradient = element::as_points(sum);
  add_force_gradient(mesh, materials, load_case, pair.lambda, gradient);
  supports::add_spring_gradient(mesh, load_case, pair.displacement, pair.lambda,
                                gradient);
  supports::add_support_gradient(mesh, load_case, pair, gradient);
  supports::add_pin_gradient(mesh, load_case, pair, gradient);
  return gradient;
}

}  // namespace meniscus::elastic
