#include "fea/material.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus {

namespace {

void check(const Material& m) {
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
  if (!(m.density >= 0.0) || !std::isfinite(m.density)) {
    throw InvalidInput(
        fmt::format("material '{}': density is {}; it must not be negative",
                    m.name, m.density));
  }
}

}  // namespace

Lame lame(const Material& material) {
  const double E = material.youngs_modulus;
  const double nu = material.poisson_ratio;
  return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * E / (1.0 + nu)};
}

void check_materials(const TetMesh& mesh,
                     const std::vector<Material>& materials) {
  for (const Material& material : materials) {
    check(material);
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

}  // namespace meniscus
