#include "fea/functionals/volume_functionals.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/element_sweep.h"

namespace meniscus::functionals {

namespace {

/// Sums over each region, in the elements' order.
struct RegionSums {
  std::vector<double> volume;
  std::vector<double> moment;  // int x . direction dV
};

/// The moments only with a direction.
template <int Nodes>
RegionSums region_sums(const TetMesh& mesh, std::size_t regions,
                       const element::TetRule<Nodes>& rule,
                       const Vec3& direction) {
  RegionSums sums{std::vector<double>(regions, 0.0),
                  std::vector<double>(regions, 0.0)};
  const auto count = static_cast<std::size_t>(mesh.element_count());
  std::vector<double> volume(count, 0.0);
  std::vector<double> moment(count, 0.0);
  const element::SweepTargets<0, 0> targets{};
  element::sweep_elements(
      mesh, rule, targets,
      [&](const element::SweepPoint<0>& point, element::SweepFlux<0>&) {
        volume[point.element] += point.volume;
        for (std::size_t a = 0; a < point.shape.size(); ++a) {
          moment[point.element] += point.volume * point.shape[a] *
                                   direction.dot(mesh.nodes[point.nodes[a]]);
        }
      });
  for (std::size_t e = 0; e < count; ++e) {
    sums.volume[mesh.element_region[e]] += volume[e];
    sums.moment[mesh.element_region[e]] += moment[e];
  }
  return sums;
}

/// Gradient of sum over regions of factor V + (direction times moment_factor)
/// . int x dV.
template <int Nodes>
Points gradient_of(const TetMesh& mesh, const element::TetRule<Nodes>& rule,
                   const std::vector<double>& factor, const Vec3& direction,
                   const std::vector<double>& moment_factor) {
  VectorX sum = element::nodal_zeros(mesh);
  const element::SweepTargets<0, 1> targets{.fields = {}, .outputs = {&sum}};
  element::sweep_elements(
      mesh, rule, targets,
      [&](const element::SweepPoint<0>& point, element::SweepFlux<1>& flux) {
        const int region = mesh.element_region[point.element];
        double density = factor[region];
        if (moment_factor[region] != 0.0) {
          for (std::size_t a = 0; a < point.shape.size(); ++a) {
            density += moment_factor[region] * point.shape[a] *
                       direction.dot(mesh.nodes[point.nodes[a]]);
          }
          flux.by_shape[0] = point.volume * moment_factor[region] * direction;
        }
        flux.by_gradient[0] = point.volume * density * Mat3::Identity();
      });
  return element::as_points(sum);
}

template <class Visit>
auto with_volume_rule(const TetMesh& mesh, const Visit& visit) {
  return mesh.order == 1 ? visit(element::volume_rule<4>())
                         : visit(element::volume_rule<10>());
}

template <class Visit>
auto with_moment_rule(const TetMesh& mesh, const Visit& visit) {
  return mesh.order == 1 ? visit(element::moment_rule<4>())
                         : visit(element::moment_rule<10>());
}

/// sum over regions of density times volume.
MassFunctional weighted_volume(const TetMesh& mesh,
                               const std::vector<double>& density,
                               element::Derivatives derivatives) {
  MassFunctional result;
  result.by_density = with_volume_rule(mesh, [&](const auto& rule) {
    return region_sums(mesh, density.size(), rule, Vec3::Zero()).volume;
  });
  for (std::size_t r = 0; r < density.size(); ++r) {
    result.value += density[r] * result.by_density[r];
  }
  if (derivatives == element::Derivatives::All) {
    result.by_nodes = with_volume_rule(mesh, [&](const auto& rule) {
      return gradient_of(mesh, rule, density, Vec3::Zero(),
                         std::vector<double>(density.size(), 0.0));
    });
  }
  return result;
}

std::vector<double> densities(const TetMesh& mesh,
                              const std::vector<element::Material>& materials) {
  element::check_materials(mesh, materials);
  std::vector<double> density;
  density.reserve(materials.size());
  for (const element::Material& material : materials) {
    density.push_back(material.density);
  }
  return density;
}

}  // namespace

element::Functional volume_functional(const TetMesh& mesh,
                                      element::Derivatives derivatives) {
  int regions = 0;
  for (const int region : mesh.element_region) {
    regions = std::max(regions, region + 1);
  }
  return weighted_volume(mesh, std::vector<double>(regions, 1.0), derivatives);
}

MassFunctional mass_functional(const TetMesh& mesh,
                               const std::vector<element::Material>& materials,
                               element::Derivatives derivatives) {
  return weighted_volume(mesh, densities(mesh, materials), derivatives);
}

MassFunctional centre_of_mass_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const Vec3& direction, element::Derivatives derivatives) {
  const std::vector<double> density = densities(mesh, materials);
  const RegionSums sums = with_moment_rule(mesh, [&](const auto& rule) {
    return region_sums(mesh, density.size(), rule, direction);
  });
  double mass = 0.0;
  double moment = 0.0;
  for (std::size_t r = 0; r < density.size(); ++r) {
    mass += density[r] * sums.volume[r];
    moment += density[r] * sums.moment[r];
  }
  if (!(mass > 0.0)) {
    throw InvalidInput(
        fmt::format("centre of mass: the mass is {}; give the materials a "
                    "density",
                    mass));
  }
  MassFunctional result;
  result.value = moment / mass;
  std::vector<double> factor;
  std::vector<double> moment_factor;
  factor.reserve(density.size());
  moment_factor.reserve(density.size());
  result.by_density.reserve(density.size());
  for (std::size_t r = 0; r < density.size(); ++r) {
    result.by_density.push_back(
        (sums.moment[r] - result.value * sums.volume[r]) / mass);
    factor.push_back(-result.value * density[r] / mass);
    moment_factor.push_back(density[r] / mass);
  }
  if (derivatives == element::Derivatives::All) {
    result.by_nodes = with_moment_rule(mesh, [&](const auto& rule) {
      return gradient_of(mesh, rule, factor, direction, moment_factor);
    });
  }
  return result;
}

}  // namespace meniscus::functionals
