#include "fea/loads/body_loads.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/elastic_law.h"
#include "fea/element/point_stress.h"
#include "fea/element/tet_shape.h"
#include "fea/loads/load_checks.h"

namespace meniscus::loads {

namespace {

/// visit(element, point, volume, shape functions, gradients) for every point
/// of the stiffness rule.
template <int Nodes, class Visit>
void visit_points(const TetMesh& mesh, const Visit& visit) {
  std::array<std::array<double, Nodes>, element::kTetPoints<Nodes>> shapes;
  for (int q = 0; q < element::kTetPoints<Nodes>; ++q) {
    shapes[q] = element::tet_shapes<Nodes>(element::rule_point<Nodes>(q));
  }
  std::array<Vec3, Nodes> x;
  element::TetGradients<Nodes> g;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (int a = 0; a < Nodes; ++a) {
      x[a] = mesh.nodes[ids[a]];
    }
    element::tet_gradients<Nodes>(x, g);
    for (int q = 0; q < element::kTetPoints<Nodes>; ++q) {
      visit(e, g.volume[q], shapes[q], g.gradient[q]);
    }
  }
}

template <class Visit>
void over_points(const TetMesh& mesh, const Visit& visit) {
  if (mesh.order == 1) {
    visit_points<4>(mesh, visit);
  } else {
    visit_points<10>(mesh, visit);
  }
}

/// The materials that fill some element.
std::vector<char> used_regions(
    const TetMesh& mesh, const std::vector<element::Material>& materials) {
  std::vector<char> used(materials.size(), 0);
  for (const int region : mesh.element_region) {
    used[region] = 1;
  }
  return used;
}

Vec3 checked_axis(const LoadCase& load_case) {
  const Spin& spin = *load_case.spin;
  require_finite(spin.point, load_case, "the point of spin");
  require_finite(spin.rate, load_case, "the rate of spin");
  const double length = spin.axis.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw InvalidInput(fmt::format(
        "load case '{}': the axis of spin ({}, {}, {}) has no length",
        load_case.name, spin.axis.x(), spin.axis.y(), spin.axis.z()));
  }
  return spin.axis / length;
}

void check_densities(const TetMesh& mesh, const LoadCase& load_case,
                     const std::vector<element::Material>& materials) {
  element::check_materials(mesh, materials);
  const std::vector<char> used = used_regions(mesh, materials);
  for (std::size_t r = 0; r < materials.size(); ++r) {
    if (used[r] != 0 && materials[r].density == 0.0) {
      throw InvalidInput(fmt::format(
          "load case '{}': gravity or spin acts, but material '{}' of region "
          "{} has density 0; give its mass per volume",
          load_case.name, materials[r].name, r));
    }
  }
}

}  // namespace

void add_body_forces(const TetMesh& mesh, const LoadCase& load_case,
                     const std::vector<element::Material>& materials,
                     VectorX& f) {
  require_finite(load_case.gravity, load_case, "gravity");
  const bool spins = load_case.spin && load_case.spin->rate != 0.0;
  const Vec3 axis = load_case.spin ? checked_axis(load_case) : Vec3::Zero();
  if (load_case.gravity.isZero(0.0) && !spins) {
    return;
  }
  check_densities(mesh, load_case, materials);
  const Vec3 centre = spins ? load_case.spin->point : Vec3::Zero();
  const double square =
      spins ? load_case.spin->rate * load_case.spin->rate : 0.0;
  over_points(mesh, [&](int e, double volume, const auto& shape, const auto&) {
    const auto ids = mesh.element(e);
    Vec3 force = load_case.gravity;
    if (spins) {
      Vec3 r = -centre;
      for (std::size_t a = 0; a < shape.size(); ++a) {
        r += shape[a] * mesh.nodes[ids[a]];
      }
      force += square * (r - axis.dot(r) * axis);
    }
    force *= volume * materials[mesh.element_region[e]].density;
    for (std::size_t a = 0; a < shape.size(); ++a) {
      f.segment<3>(3L * ids[a]) += shape[a] * force;
    }
  });
}

VectorX temperature_change(const TetMesh& mesh, const LoadCase& load_case) {
  if (!load_case.temperature) {
    return {};
  }
  const Temperature& t = *load_case.temperature;
  require_finite(t.reference, load_case, "the reference temperature");
  if (t.nodal.size() != 0) {
    if (t.nodal.size() != static_cast<Eigen::Index>(mesh.nodes.size()) ||
        !t.nodal.allFinite()) {
      throw InvalidInput(fmt::format(
          "load case '{}': its {} nodal temperatures must be finite and one "
          "for each of {} nodes",
          load_case.name, t.nodal.size(), mesh.nodes.size()));
    }
    return t.nodal.array() - t.reference;
  }
  if (!t.field) {
    require_finite(t.value, load_case, "the temperature");
    return VectorX::Constant(static_cast<Eigen::Index>(mesh.nodes.size()),
                             t.value - t.reference);
  }
  VectorX change(static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    change[static_cast<Eigen::Index>(i)] =
        field_value(t.field, mesh.nodes[i], load_case, "the temperature") -
        t.reference;
  }
  return change;
}

void add_thermal_forces(const TetMesh& mesh, const LoadCase& load_case,
                        const std::vector<element::Material>& materials,
                        VectorX& f) {
  const VectorX change = temperature_change(mesh, load_case);
  if (change.size() == 0 || change.isZero(0.0)) {
    return;
  }
  element::check_materials(mesh, materials);
  const std::vector<char> used = used_regions(mesh, materials);
  bool expands = false;
  std::vector<Mat3> stress;
  for (std::size_t r = 0; r < materials.size(); ++r) {
    stress.push_back(
        element::stress_tensor(element::elastic_law(materials[r]).heat_stress));
    expands = expands || (used[r] != 0 && !stress.back().isZero(0.0));
  }
  if (!expands) {
    throw InvalidInput(fmt::format(
        "load case '{}': the temperature changes, but no material has a "
        "thermal expansion; give one",
        load_case.name));
  }
  over_points(
      mesh, [&](int e, double volume, const auto& shape, const auto& gradient) {
        const auto ids = mesh.element(e);
        double degrees = 0.0;
        for (std::size_t a = 0; a < shape.size(); ++a) {
          degrees += shape[a] * change[ids[a]];
        }
        const Mat3 s = volume * degrees * stress[mesh.element_region[e]];
        for (std::size_t a = 0; a < shape.size(); ++a) {
          f.segment<3>(3L * ids[a]) += s * gradient[a];
        }
      });
}

double strain_energy(const TetMesh& mesh,
                     const std::vector<element::Material>& materials,
                     const VectorX& displacement,
                     const VectorX& temperature_change) {
  const element::PointStress points =
      element::point_stress(mesh, materials, displacement, temperature_change);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws(materials);
  double energy = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const element::ElasticLaw& law = laws[mesh.element_region[e]];
    for (int q = 0; q < points.points_per_element; ++q) {
      const std::size_t at = points.index(e, q);
      const element::Stress& s = points.stress[at];
      energy +=
          0.5 * points.volume[at] * element::complementary_product(s, s, law);
    }
  }
  return energy;
}

}  // namespace meniscus::loads
