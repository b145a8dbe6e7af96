#include "io/calculix_material.h"

#include <fmt/format.h>

namespace meniscus::io {

namespace {

std::string elastic_text(const DeckMaterial& material) {
  if (!material.orthotropic) {
    return fmt::format("*ELASTIC\n{:.12e}, {:.12e}\n", material.youngs_modulus,
                       material.poisson_ratio);
  }
  const DeckOrthotropic& m = *material.orthotropic;
  const Vec3& E = m.youngs_moduli;
  const Vec3& nu = m.poisson_ratios;
  const Vec3& G = m.shear_moduli;
  // CalculiX wants eight constants on the first line, one on the second.
  return fmt::format(
      "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n"
      "{:.9e}, {:.9e}, {:.9e}, {:.9e}, {:.9e}, {:.9e}, {:.9e}, {:.9e}\n"
      "{:.9e}\n",
      E[0], E[1], E[2], nu[0], nu[1], nu[2], G[0], G[1], G[2]);
}

std::string orientation_text(const DeckOrthotropic& m, std::size_t region) {
  const Vec3& a = m.axis_1;
  const Vec3& b = m.axis_2;
  return fmt::format(
      "*ORIENTATION, NAME=AXES_{}, SYSTEM=RECTANGULAR\n"
      "{:.12e}, {:.12e}, {:.12e}, {:.12e}, {:.12e}, {:.12e}\n",
      region, a[0], a[1], a[2], b[0], b[1], b[2]);
}

}  // namespace

std::string constants_text(const DeckMaterial& material,
                           const std::string& name) {
  std::string text =
      fmt::format("*MATERIAL, NAME={}\n", name) + elastic_text(material);
  if (material.density > 0.0) {
    text += fmt::format("*DENSITY\n{:.12e}\n", material.density);
  }
  const Vec3& alpha = material.thermal_expansion;
  if (!alpha.isZero(0.0)) {
    text += fmt::format("*EXPANSION, TYPE=ORTHO\n{:.12e}, {:.12e}, {:.12e}\n",
                        alpha[0], alpha[1], alpha[2]);
  }
  return text;
}

std::string material_text(const DeckMaterial& material, const std::string& name,
                          std::size_t region) {
  std::string text = constants_text(material, name);
  std::string oriented;
  if (material.orthotropic) {
    text += orientation_text(*material.orthotropic, region);
    oriented = fmt::format(", ORIENTATION=AXES_{}", region);
  }
  return text + fmt::format("*SOLID SECTION, ELSET=REGION_{}, MATERIAL={}{}\n",
                            region, name, oriented);
}

}  // namespace meniscus::io
