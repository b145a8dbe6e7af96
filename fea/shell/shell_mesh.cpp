#include "fea/shell/shell_mesh.h"

#include <cstddef>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/shell/facet_matrices.h"

namespace meniscus::shell {

namespace {

/// Sine of the least angle between a section's direction and the normal.
constexpr double kAlong = 1e-3;

void check_numbers(const ShellMesh& mesh,
                   const std::vector<Section>& sections) {
  const std::size_t facets = mesh.facets.size();
  if (mesh.section.size() != facets || mesh.thickness.size() != facets) {
    throw MeshError(fmt::format(
        "a shell of {} facets has {} sections and {} thicknesses of facets",
        facets, mesh.section.size(), mesh.thickness.size()));
  }
  const int nodes = static_cast<int>(mesh.nodes.size());
  std::vector<char> used(mesh.nodes.size(), 0);
  for (std::size_t f = 0; f < facets; ++f) {
    for (const int node : mesh.facets[f]) {
      if (node < 0 || node >= nodes) {
        throw MeshError(fmt::format("facet {} of a shell has node {} of {}", f,
                                    node, nodes));
      }
      used[node] = 1;
    }
    if (mesh.section[f] < 0 ||
        mesh.section[f] >= static_cast<int>(sections.size())) {
      throw MeshError(fmt::format("facet {} of a shell has section {} of {}", f,
                                  mesh.section[f], sections.size()));
    }
    if (!(mesh.thickness[f].array() > 0.0).all() ||
        !mesh.thickness[f].allFinite()) {
      throw MeshError(fmt::format(
          "facet {} of a shell has thicknesses {}, {}, {}; give it "
          "numbers above 0",
          f, mesh.thickness[f][0], mesh.thickness[f][1], mesh.thickness[f][2]));
    }
  }
  for (int i = 0; i < nodes; ++i) {
    if (used[i] == 0) {
      throw MeshError(fmt::format(
          "node {} of a shell belongs to no facet; leave it out", i));
    }
  }
}

}  // namespace

std::array<int, 3> edge_nodes(const ShellMesh& mesh, const FacetEdge& edge) {
  const std::array<int, 6>& facet = mesh.facets[edge.facet];
  return {facet[edge.edge], facet[(edge.edge + 1) % 3], facet[3 + edge.edge]};
}

ShellMesh shell_mesh(const QuadraticSurface& surface, const VectorX& thickness,
                     int section) {
  const int corners = static_cast<int>(surface.base.points.size());
  if (thickness.size() != corners) {
    throw MeshError(
        fmt::format("a shell of {} corners has {} thicknesses; give one each",
                    corners, thickness.size()));
  }
  ShellMesh mesh;
  mesh.nodes = surface.base.points;
  mesh.nodes.insert(mesh.nodes.end(), surface.mid.begin(), surface.mid.end());
  for (std::size_t f = 0; f < surface.base.facets.size(); ++f) {
    const Triangle& c = surface.base.facets[f];
    const Triangle& e = surface.facet_edges[f];
    mesh.facets.push_back(
        {c[0], c[1], c[2], corners + e[0], corners + e[1], corners + e[2]});
    mesh.thickness.emplace_back(thickness[c[0]], thickness[c[1]],
                                thickness[c[2]]);
  }
  mesh.section.assign(mesh.facets.size(), section);
  return mesh;
}

std::array<double, 6> facet_thicknesses(const ShellMesh& mesh,
                                        std::size_t facet) {
  const Vec3& t = mesh.thickness[facet];
  return {t[0],
          t[1],
          t[2],
          0.5 * (t[0] + t[1]),
          0.5 * (t[1] + t[2]),
          0.5 * (t[2] + t[0])};
}

NodeFacets node_facets(const ShellMesh& mesh) {
  NodeFacets list;
  list.start.assign(mesh.nodes.size() + 1, 0);
  for (const auto& nodes : mesh.facets) {
    for (const int node : nodes) {
      ++list.start[node + 1];
    }
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    list.start[i + 1] += list.start[i];
  }
  list.facet.resize(list.start.back());
  std::vector<int> next(list.start.begin(), list.start.end() - 1);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int node : mesh.facets[f]) {
      list.facet[next[node]++] = static_cast<int>(f);
    }
  }
  return list;
}

std::vector<LaminateLaw> laminate_laws(const std::vector<Section>& sections) {
  std::vector<LaminateLaw> laws;
  laws.reserve(sections.size());
  for (const Section& section : sections) {
    laws.push_back(laminate_law(section.laminate));
  }
  return laws;
}

void check_shell(const ShellMesh& mesh, const std::vector<Section>& sections) {
  check_numbers(mesh, sections);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    std::array<Triple<double>, kNodes> X;
    for (int i = 0; i < kNodes; ++i) {
      const Vec3& x = mesh.nodes[mesh.facets[f][i]];
      X[i] = {x[0], x[1], x[2]};
    }
    const Section& section = sections[mesh.section[f]];
    Vec3 first = Vec3::Zero();
    for (const FacetPoint& p : facet_rule()) {
      const FacetFrame<double> frame = facet_frame(X, p, nullptr);
      const Vec3 n(frame.axes[2][0], frame.axes[2][1], frame.axes[2][2]);
      if (!(frame.area > 0.0) || !(n.dot(first) >= 0.0)) {
        throw MeshError(
            fmt::format("facet {} of a shell near ({:.5g}, {:.5g}, {:.5g}) is "
                        "folded or has no area",
                        f, X[0][0], X[0][1], X[0][2]));
      }
      first = n;
      if (section.direction && !(n.cross(*section.direction).norm() >
                                 kAlong * section.direction->norm())) {
        throw MeshError(fmt::format(
            "the direction ({}, {}, {}) of a section is normal to facet {} of "
            "the shell; give the facets there a section of their own",
            section.direction->x(), section.direction->y(),
            section.direction->z(), f));
      }
    }
  }
}

}  // namespace meniscus::shell
