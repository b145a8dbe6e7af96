#include "fea/functionals/inertia.h"

#include "core/error.h"
#include "fea/element/element_sweep.h"

namespace meniscus::functionals {

namespace {

/// Of one element, from a point: int r dV, int r r^T dV.
struct Moments {
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

Vec3 place_of(const TetMesh& mesh, std::span<const double> shape,
              std::span<const int> nodes) {
  Vec3 x = Vec3::Zero();
  for (std::size_t a = 0; a < shape.size(); ++a) {
    x += shape[a] * mesh.nodes[nodes[a]];
  }
  return x;
}

/// Sums over each region, in the elements' order.
template <int Nodes>
std::vector<Moments> region_moments(const TetMesh& mesh, std::size_t regions,
                                    const element::TetRule<Nodes>& rule,
                                    const Vec3& from) {
  std::vector<Moments> of_element(
      static_cast<std::size_t>(mesh.element_count()));
  const element::SweepTargets<0, 0> targets{};
  element::sweep_elements(
      mesh, rule, targets,
      [&](const element::SweepPoint<0>& point, element::SweepFlux<0>&) {
        const Vec3 r = place_of(mesh, point.shape, point.nodes) - from;
        of_element[point.element].first += point.volume * r;
        of_element[point.element].second += point.volume * r * r.transpose();
      });
  std::vector<Moments> sums(regions);
  for (std::size_t e = 0; e < of_element.size(); ++e) {
    sums[mesh.element_region[e]].first += of_element[e].first;
    sums[mesh.element_region[e]].second += of_element[e].second;
  }
  return sums;
}

/// Gradient of sum over regions of density int r . across r dV.
template <int Nodes>
Points inertia_gradient(const TetMesh& mesh,
                        const element::TetRule<Nodes>& rule,
                        const std::vector<element::Material>& materials,
                        const Mat3& across, const Vec3& from) {
  VectorX sum = element::nodal_zeros(mesh);
  const element::SweepTargets<0, 1> targets{.fields = {}, .outputs = {&sum}};
  element::sweep_elements(
      mesh, rule, targets,
      [&](const element::SweepPoint<0>& point, element::SweepFlux<1>& flux) {
        const double mass =
            point.volume *
            materials[mesh.element_region[point.element]].density;
        const Vec3 r = place_of(mesh, point.shape, point.nodes) - from;
        flux.by_shape[0] = 2.0 * mass * across * r;
        flux.by_gradient[0] = mass * r.dot(across * r) * Mat3::Identity();
      });
  return element::as_points(sum);
}

}  // namespace

InertiaFunctional inertia_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const Vec3& axis, const std::optional<Vec3>& point,
    element::Derivatives derivatives) {
  element::check_materials(mesh, materials);
  const double length = axis.norm();
  if (!(length > 0.0)) {
    throw InvalidInput(
        "moment of inertia: the axis has length 0; expected any other");
  }
  Vec3 from = Vec3::Zero();
  if (point) {
    from = *point;
  } else {
    for (int k = 0; k < 3; ++k) {
      from[k] = centre_of_mass_functional(mesh, materials, Vec3::Unit(k),
                                          element::Derivatives::None)
                    .value;
    }
  }
  const auto with_rule = [&](const auto& visit) {
    return mesh.order == 1 ? visit(element::fine_rule<4>())
                           : visit(element::fine_rule<10>());
  };
  const Vec3 unit = axis / length;
  const Mat3 across = Mat3::Identity() - unit * unit.transpose();
  const std::vector<Moments> sums = with_rule([&](const auto& rule) {
    return region_moments(mesh, materials.size(), rule, from);
  });
  InertiaFunctional result;
  Moments whole;
  for (std::size_t r = 0; r < sums.size(); ++r) {
    result.by_density.push_back(sums[r].second.cwiseProduct(across).sum());
    result.value += materials[r].density * result.by_density.back();
    whole.first += materials[r].density * sums[r].first;
    whole.second += materials[r].density * sums[r].second;
  }
  if (derivatives == element::Derivatives::All) {
    // About the centre of mass the first moment is 0: its own motion does not
    // count.
    result.by_nodes = with_rule([&](const auto& rule) {
      return inertia_gradient(mesh, rule, materials, across, from);
    });
    result.by_axis = -2.0 / length * across * whole.second * unit;
    if (point) {
      result.by_point = -2.0 * across * whole.first;
    }
  }
  return result;
}

}  // namespace meniscus::functionals
