#include "fea/shell/shell_loads.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/gauss_rule.h"
#include "core/parallel_for.h"
#include "fea/shell/facet_loads.h"

namespace meniscus::shell {

namespace {

void add_edge(const ShellMesh& mesh, const EdgeLoad& load, VectorX& f) {
  for (const LinePoint& p : line_points(mesh, load.nodes)) {
    const double length = p.weight * p.tangent.norm();
    for (int k = 0; k < 3; ++k) {
      f.segment<3>(6L * load.nodes[k]) += length * p.shape[k] * load.force;
      f.segment<3>(6L * load.nodes[k] + 3) += length * p.shape[k] * load.moment;
    }
  }
}

}  // namespace

void check_loads(const ShellMesh& mesh, const ShellLoads& loads) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  for (const EdgeLoad& load : loads.edges) {
    for (const int node : load.nodes) {
      if (node < 0 || node >= nodes) {
        throw InvalidInput(fmt::format(
            "an edge load acts on node {} of a shell of {}", node, nodes));
      }
    }
  }
  if (loads.spin && !(loads.spin->axis.norm() > 0.0)) {
    throw InvalidInput("the spin of a shell has an axis without length");
  }
  if (const auto& heat = loads.nodal_temperature;
      heat && (heat->value.size() != nodes ||
               (!heat->slope.empty() && std::ssize(heat->slope) != nodes))) {
    throw InvalidInput(fmt::format(
        "a shell of {} nodes has {} nodal temperatures and {} gradients of "
        "them; give one a node",
        nodes, heat->value.size(), heat->slope.size()));
  }
  if (loads.nodal.size() != 0 && loads.nodal.size() != 6L * nodes) {
    throw InvalidInput(
        fmt::format("a shell of {} nodes has {} nodal forces and moments; give "
                    "six a node",
                    nodes, loads.nodal.size()));
  }
}

Vec3 edge_shapes(double s) {
  return {(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0),
          4.0 * s * (1.0 - s)};
}

std::array<LinePoint, 3> line_points(const ShellMesh& mesh,
                                     const std::array<int, 3>& nodes) {
  std::array<LinePoint, 3> points;
  const std::vector<GaussPoint> rule = gauss_rule(3);
  for (int q = 0; q < 3; ++q) {
    const double s = rule[q].at;
    LinePoint& p = points[q];
    p.weight = rule[q].weight;
    Eigen::Map<Vec3>(p.shape.data()) = edge_shapes(s);
    p.slope = {4.0 * s - 3.0, 4.0 * s - 1.0, 4.0 - 8.0 * s};
    p.tangent = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      p.tangent += p.slope[k] * mesh.nodes[nodes[k]];
    }
  }
  return points;
}

VectorX nodal_forces(const ShellMesh& mesh,
                     const std::vector<Section>& sections,
                     const ShellLoads& loads) {
  check_loads(mesh, loads);
  VectorX f = loads.nodal;
  if (f.size() == 0) {
    f = VectorX::Zero(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  }
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const std::vector<FacetLoad> own = facet_loads(mesh, loads);
  const bool everywhere =
      has_mass_loads(loads) || loads.temperature || loads.nodal_temperature;
  std::vector<FacetVector> forces(mesh.facets.size(), FacetVector::Zero());
  parallel_for(static_cast<std::ptrdiff_t>(forces.size()),
               [&](std::ptrdiff_t k) {
                 if (everywhere || own[k].presses() || own[k].pulls()) {
                   const Facet facet =
                       facet_of(mesh, sections, laws, static_cast<int>(k));
                   WholeVector whole = facet_forces(facet, loads, own[k]);
                   condensed(whole_stiffness(facet), &whole);
                   forces[k] = whole.head<kUnknowns>();
                 }
               });
  for (std::size_t k = 0; k < forces.size(); ++k) {
    for (int i = 0; i < kNodes; ++i) {
      f.segment<6>(6L * mesh.facets[k][i]) += forces[k].segment<6>(6 * i);
    }
  }
  for (const EdgeLoad& load : loads.edges) {
    add_edge(mesh, load, f);
  }
  return f;
}

MassForce mass_force(const loads::Spin& spin) {
  if (spin.axis.isZero(0.0)) {
    throw InvalidInput("a spin has no axis; give it one of any length but 0");
  }
  const Vec3 n = spin.axis.normalized();
  const Mat3 slope =
      spin.rate * spin.rate * (Mat3::Identity() - n * n.transpose());
  return {-slope * spin.point, slope};
}

MassForce mass_force_rate(const loads::Spin& spin, const loads::Spin& rates) {
  const MassForce here = mass_force(spin);
  const Vec3 n = spin.axis.normalized();
  const Vec3 dn = (rates.axis - n.dot(rates.axis) * n) / spin.axis.norm();
  const Mat3 slope =
      2.0 * spin.rate * rates.rate * (Mat3::Identity() - n * n.transpose()) -
      spin.rate * spin.rate * (dn * n.transpose() + n * dn.transpose());
  return {-slope * spin.point - here.slope * rates.point, slope};
}

}  // namespace meniscus::shell
