#include "fea/loads/material_rates.h"

#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"
#include "fea/element/element_sweep.h"
#include "fea/loads/body_loads.h"

namespace meniscus::loads {

namespace {

/// What a region's law becomes by each constant.
struct LawRates {
  element::ElasticLaw law;
  Mat3 expansion = Mat3::Zero();   // strain per degree
  Mat3 per_degree = Mat3::Zero();  // stress of a unit expansion in all three
  double modulus = 1.0;
  element::Lame by_poisson{0.0, 0.0};
};

std::vector<LawRates> law_rates(
    const std::vector<element::Material>& materials) {
  std::vector<LawRates> rates;
  rates.reserve(materials.size());
  for (const element::Material& material : materials) {
    LawRates r{.law = element::elastic_law(material)};
    element::Vec6 strain = r.law.expansion;
    strain.tail<3>() *= 0.5;
    r.expansion = element::stress_tensor(strain);
    r.per_degree = r.law.stress(Mat3::Identity());
    if (!material.orthotropic) {
      const double E = material.youngs_modulus;
      const double nu = material.poisson_ratio;
      const double bulk = (1.0 + nu) * (1.0 - 2.0 * nu);
      r.modulus = E;
      r.by_poisson = {E * (1.0 + 2.0 * nu * nu) / (bulk * bulk),
                      -0.5 * E / ((1.0 + nu) * (1.0 + nu))};
    }
    rates.push_back(r);
  }
  return rates;
}

/// Force per mass at a place.
Vec3 weight_at(const LoadCase& load_case, const Vec3& x) {
  Vec3 force = load_case.gravity;
  if (load_case.spin && load_case.spin->rate != 0.0) {
    const Spin& spin = *load_case.spin;
    const Vec3 a = spin.axis.normalized();
    const Vec3 r = x - spin.point;
    force += spin.rate * spin.rate * (r - a.dot(r) * a);
  }
  return force;
}

/// By modulus, Poisson's ratio, density, expansion.
using LawParts = std::array<double, 4>;

void check_size(const TetMesh& mesh, const VectorX& v) {
  if (v.size() != static_cast<Eigen::Index>(3 * mesh.nodes.size())) {
    throw InvalidInput(
        fmt::format("gradient by materials: a vector of {} numbers for {} "
                    "nodes",
                    v.size(), mesh.nodes.size()));
  }
}

LawParts point_parts(const TetMesh& mesh, const LoadCase& load_case,
                     const LawRates& r, const element::SweepPoint<2>& point,
                     const VectorX& lambda, const VectorX& change) {
  Vec3 x = Vec3::Zero();
  Vec3 here = Vec3::Zero();
  double degrees = 0.0;
  for (std::size_t a = 0; a < point.shape.size(); ++a) {
    x += point.shape[a] * mesh.nodes[point.nodes[a]];
    here += point.shape[a] * lambda.segment<3>(3L * point.nodes[a]);
    degrees +=
        change.size() != 0 ? point.shape[a] * change[point.nodes[a]] : 0.0;
  }
  const Mat3 strain =
      0.5 * (point.gradient[0] + point.gradient[0].transpose()) -
      degrees * r.expansion;
  const Mat3& H = point.gradient[1];
  const double V = point.volume;
  const double by_poisson =
      r.by_poisson.lambda * strain.trace() * H.trace() +
      2.0 * r.by_poisson.mu * strain.cwiseProduct(H).sum();
  return {-V / r.modulus * r.law.stress(strain).cwiseProduct(H).sum(),
          -V * by_poisson, V * weight_at(load_case, x).dot(here),
          V * degrees * r.per_degree.cwiseProduct(H).sum()};
}

}  // namespace

MaterialGradient material_gradient(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const LoadCase& load_case, const VectorX& u, const VectorX& lambda) {
  element::check_materials(mesh, materials);
  check_size(mesh, u);
  check_size(mesh, lambda);
  const VectorX change = temperature_change(mesh, load_case);
  const std::vector<LawRates> rates = law_rates(materials);
  std::vector<LawParts> parts(static_cast<std::size_t>(mesh.element_count()),
                              LawParts{});
  element::sweep_stiffness_points(
      mesh, element::SweepTargets<2, 0>{.fields = {&u, &lambda}, .outputs = {}},
      [&](const element::SweepPoint<2>& point, element::SweepFlux<0>&) {
        const LawParts here = point_parts(
            mesh, load_case, rates[mesh.element_region[point.element]], point,
            lambda, change);
        for (std::size_t k = 0; k < here.size(); ++k) {
          parts[point.element][k] += here[k];
        }
      });
  const std::vector<double> zeros(materials.size(), 0.0);
  MaterialGradient result{zeros, zeros, zeros, zeros};
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int region = mesh.element_region[e];
    result.youngs_modulus[region] += parts[e][0];
    result.poisson_ratio[region] += parts[e][1];
    result.density[region] += parts[e][2];
    result.thermal_expansion[region] += parts[e][3];
  }
  return result;
}

}  // namespace meniscus::loads
