#include "fea/element/material.h"

#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"

namespace meniscus::element {

namespace {

/// Least eigenvalue of the compliance, made dimensionless, that is told from
/// 0: that of an isotropic solid with Poisson's ratio 0.4999995.
constexpr double kLeastCompliance = 1e-6;

void check_orthotropic(const Material& material) {
  const Orthotropic& m = *material.orthotropic;
  const auto refuse = [&](const std::string& what) {
    throw InvalidInput(fmt::format("material '{}': {}", material.name, what));
  };
  if (!(m.youngs_moduli.minCoeff() > 0.0) || !m.youngs_moduli.allFinite() ||
      !(m.shear_moduli.minCoeff() > 0.0) || !m.shear_moduli.allFinite()) {
    refuse(
        fmt::format("Young's moduli are {}, {}, {} and shear moduli {}, {}, "
                    "{}; all must be above 0",
                    m.youngs_moduli[0], m.youngs_moduli[1], m.youngs_moduli[2],
                    m.shear_moduli[0], m.shear_moduli[1], m.shear_moduli[2]));
  }
  if (!span_a_plane(m.axes)) {
    refuse(
        fmt::format("its axes ({}, {}, {}) and ({}, {}, {}) have no length "
                    "or are parallel; give two that span a plane",
                    m.axes.first.x(), m.axes.first.y(), m.axes.first.z(),
                    m.axes.second.x(), m.axes.second.y(), m.axes.second.z()));
  }
  // Compliance scaled to a diagonal of 1.
  const Vec3& E = m.youngs_moduli;
  const Vec3& nu = m.poisson_ratios;
  Mat3 S = Mat3::Identity();
  S(0, 1) = S(1, 0) = -nu[0] * std::sqrt(E[1] / E[0]);
  S(0, 2) = S(2, 0) = -nu[1] * std::sqrt(E[2] / E[0]);
  S(1, 2) = S(2, 1) = -nu[2] * std::sqrt(E[2] / E[1]);
  const double least =
      S.allFinite() ? symmetric_eigen(S).values.minCoeff() : -1.0;
  if (!(least > kLeastCompliance)) {
    refuse(fmt::format(
        "its stiffness is not positive definite (least relative eigenvalue of "
        "the compliance {:.3g}): Poisson's ratios 12, 13, 23 = {}, {}, {} are "
        "too large; each must stay below sqrt(E_i / E_j), and all three "
        "together be smaller still",
        least, nu[0], nu[1], nu[2]));
  }
}

void check_isotropic(const Material& m) {
  if (!(m.youngs_modulus > 0.0) || !std::isfinite(m.youngs_modulus)) {
    throw InvalidInput(
        fmt::format("material '{}': Young's modulus is {}; it must be above 0",
                    m.name, m.youngs_modulus));
  }
  if (!(m.poisson_ratio > -1.0 && m.poisson_ratio < 0.5)) {
    throw InvalidInput(fmt::format(
        "material '{}': Poisson's ratio is {}; it must lie between -1 and 0.5, "
        "both excluded (for a nearly incompressible solid try 0.49)",
        m.name, m.poisson_ratio));
  }
  const Vec3& a = m.thermal_expansion;
  if (a[0] != a[1] || a[1] != a[2]) {
    throw InvalidInput(fmt::format(
        "material '{}' is isotropic, but its thermal expansions are {}, {}, "
        "{}; give one number, or an orthotropic material",
        m.name, a[0], a[1], a[2]));
  }
}

}  // namespace

void check_material(const Material& m) {
  if (!m.thermal_expansion.allFinite()) {
    throw InvalidInput(
        fmt::format("material '{}': its thermal expansion is not a finite "
                    "number",
                    m.name));
  }
  if (m.orthotropic) {
    check_orthotropic(m);
  } else {
    check_isotropic(m);
  }
  if (!(m.density >= 0.0) || !std::isfinite(m.density)) {
    throw InvalidInput(
        fmt::format("material '{}': density is {}; it must not be negative",
                    m.name, m.density));
  }
}

Lame lame(const Material& material) {
  const double E = material.youngs_modulus;
  const double nu = material.poisson_ratio;
  return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * E / (1.0 + nu)};
}

void check_materials(const TetMesh& mesh,
                     const std::vector<Material>& materials) {
  for (const Material& material : materials) {
    check_material(material);
  }
  const int count = static_cast<int>(materials.size());
  if (static_cast<int>(mesh.element_region.size()) != mesh.element_count()) {
    throw InvalidInput(
        fmt::format("the mesh has {} elements, but regions for {}",
                    mesh.element_count(), mesh.element_region.size()));
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int region = mesh.element_region[e];
    if (region < 0 || region >= count) {
      throw InvalidInput(fmt::format(
          "element {} lies in region {}, but materials are given for {} "
          "region(s) only",
          e, region, count));
    }
  }
}

}  // namespace meniscus::element
