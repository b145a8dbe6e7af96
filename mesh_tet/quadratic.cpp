#include "mesh_tet/quadratic.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "mesh_tet/jacobian.h"

namespace meniscus::mesh_tet {

namespace {

/// Numbers edges in order of first appearance.
class EdgeNumbers {
 public:
  explicit EdgeNumbers(std::size_t expected) { ids_.reserve(expected); }

  int add(int a, int b) {
    return ids_.emplace(edge_key(a, b), static_cast<int>(ids_.size()))
        .first->second;
  }
  /// -1 when it is not there.
  int find(int a, int b) const {
    const auto at = ids_.find(edge_key(a, b));
    return at == ids_.end() ? -1 : at->second;
  }
  std::size_t size() const { return ids_.size(); }

 private:
  std::unordered_map<Edge, int, EdgeHash> ids_;
};

std::array<Vec3, 10> positions(const TetMesh& mesh, int e) {
  const auto ids = mesh.element(e);
  std::array<Vec3, 10> x;
  for (int n = 0; n < 10; ++n) {
    x[n] = mesh.nodes[ids[n]];
  }
  return x;
}

bool jacobian_above(const TetMesh& mesh, int e, double least) {
  const CornerJacobians jacobians = corner_jacobians(positions(mesh, e));
  const double mean = mean_determinant(jacobians);
  return mean > 0.0 && determinant_above(jacobians, least * mean);
}

/// Elements, faces and node count of the ten-node mesh; mid-sides at zero.
TetMesh quadratic_topology(const TetMesh& linear,
                           const QuadraticSurface& surface) {
  TetMesh mesh;
  mesh.order = 2;
  mesh.corner_count = linear.corner_count;
  mesh.element_region = linear.element_region;
  mesh.face_label = linear.face_label;
  mesh.face_element = linear.face_element;
  mesh.face_front = linear.face_front;
  mesh.labels = linear.labels;
  // Surface edges come first: their mid-sides have the surface's numbers.
  EdgeNumbers numbers(linear.elements.size());
  for (const Edge& e : surface.edges) {
    numbers.add(e[0], e[1]);
  }
  if (numbers.size() != surface.edges.size()) {
    throw MeshError("quadratic surface: an edge is listed twice");
  }
  // Every edge of a face must be one of them, else the surface is another.
  const int corners = linear.corner_count;
  mesh.faces.reserve(2 * linear.faces.size());
  for (int f = 0; f < linear.face_count(); ++f) {
    const auto ids = linear.face(f);
    mesh.faces.insert(mesh.faces.end(), ids.begin(), ids.end());
    for (int k = 0; k < 3; ++k) {
      const int edge = numbers.find(ids[k], ids[(k + 1) % 3]);
      if (edge < 0) {
        throw MeshError(fmt::format(
            "quadratic surface: edge {}-{} of face {} has no mid-side; the "
            "surface is not the one that was filled",
            ids[k], ids[(k + 1) % 3], f));
      }
      mesh.faces.push_back(corners + edge);
    }
  }
  // One mid-side node per edge, shared by all elements about it: the ten-node
  // mesh conforms.
  mesh.elements.reserve(linear.elements.size() / 4 * 10);
  for (int e = 0; e < linear.element_count(); ++e) {
    const auto ids = linear.element(e);
    mesh.elements.insert(mesh.elements.end(), ids.begin(), ids.end());
    for (const Edge& edge : kTetEdges) {
      mesh.elements.push_back(corners +
                              numbers.add(ids[edge[0]], ids[edge[1]]));
    }
  }
  mesh.nodes.assign(corners + numbers.size(), Vec3::Zero());
  return mesh;
}

/// Surface edges that a model has and how many elements see them curved.
void check_fit(const TetMesh& mesh, const Points& corners,
               const QuadraticSurface& surface,
               const std::vector<char>& curve_edge) {
  if (mesh.order != 2 ||
      corners.size() != static_cast<std::size_t>(mesh.corner_count) ||
      surface.mid.size() != surface.edges.size() ||
      curve_edge.size() != surface.edges.size() ||
      mesh.nodes.size() < corners.size() + surface.edges.size()) {
    throw MeshError(fmt::format(
        "ten-node mesh (order {}, {} corners, {} nodes), {} corner positions, "
        "surface with {} edges and {} mid-sides, and {} edge flags do not fit "
        "together",
        mesh.order, mesh.corner_count, mesh.nodes.size(), corners.size(),
        surface.edges.size(), surface.mid.size(), curve_edge.size()));
  }
}

/// Straightens the surface edges of poor elements until there is none.
void choose_curved(TetMesh& mesh, const QuadraticSurface& surface,
                   std::vector<char>& curve_edge) {
  const int first = mesh.corner_count;
  const int last = first + static_cast<int>(surface.edges.size());
  std::vector<int> curved;  // elements with a curved side
  const auto is_curved = [&](int node) {
    return node >= first && node < last && curve_edge[node - first] != 0;
  };
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    if (std::any_of(ids.begin() + 4, ids.end(), is_curved)) {
      curved.push_back(e);
    }
  }
  bool changed = true;
  while (changed) {
    changed = false;
    for (const int e : curved) {
      const auto ids = mesh.element(e);
      if (std::none_of(ids.begin() + 4, ids.end(), is_curved) ||
          jacobian_above(mesh, e, kLeastCurvedJacobian)) {
        continue;
      }
      for (int m = 0; m < 6; ++m) {
        const int node = ids[4 + m];
        if (is_curved(node)) {
          curve_edge[node - first] = 0;
          mesh.nodes[node] = 0.5 * (mesh.nodes[ids[kTetEdges[m][0]]] +
                                    mesh.nodes[ids[kTetEdges[m][1]]]);
          changed = true;
        }
      }
    }
  }
}

}  // namespace

void move_quadratic(TetMesh& mesh, const Points& corner_nodes,
                    const QuadraticSurface& surface,
                    const std::vector<char>& curve_edge) {
  check_fit(mesh, corner_nodes, surface, curve_edge);
  std::copy(corner_nodes.begin(), corner_nodes.end(), mesh.nodes.begin());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (int m = 0; m < 6; ++m) {
      mesh.nodes[ids[4 + m]] = 0.5 * (corner_nodes[ids[kTetEdges[m][0]]] +
                                      corner_nodes[ids[kTetEdges[m][1]]]);
    }
  }
  for (std::size_t i = 0; i < surface.mid.size(); ++i) {
    if (curve_edge[i] != 0) {
      mesh.nodes[mesh.corner_count + i] = surface.mid[i];
    }
  }
}

TetMesh make_quadratic(const TetMesh& linear, const QuadraticSurface& surface,
                       std::vector<char>* curve_edge, int* straightened) {
  if (linear.order != 1) {
    throw MeshError(fmt::format(
        "make_quadratic needs a four-node mesh, found order {}", linear.order));
  }
  TetMesh mesh = quadratic_topology(linear, surface);
  std::vector<char> flags;
  const bool given = curve_edge != nullptr && !curve_edge->empty();
  if (given) {
    flags = *curve_edge;
  } else {
    flags.assign(surface.edges.size(), 1);
  }
  move_quadratic(mesh, linear.nodes, surface, flags);
  if (!given) {
    choose_curved(mesh, surface, flags);
  }
  if (straightened != nullptr) {
    *straightened = static_cast<int>(std::count(flags.begin(), flags.end(), 0));
  }
  if (curve_edge != nullptr) {
    *curve_edge = std::move(flags);
  }
  return mesh;
}

QuadraticGradient transpose_quadratic(const TetMesh& mesh,
                                      const Points& node_gradient,
                                      const std::vector<char>& curve_edge) {
  if (mesh.order != 2 || node_gradient.size() != mesh.nodes.size()) {
    throw MeshError(fmt::format(
        "transpose_quadratic: {} gradient entries for {} nodes of order {}",
        node_gradient.size(), mesh.nodes.size(), mesh.order));
  }
  const auto corners = static_cast<std::size_t>(mesh.corner_count);
  QuadraticGradient gradient;
  gradient.corners.assign(node_gradient.begin(),
                          node_gradient.begin() + mesh.corner_count);
  gradient.mid.assign(curve_edge.size(), Vec3::Zero());
  std::vector<char> done(mesh.nodes.size(), 0);
  for (std::size_t i = 0; i < curve_edge.size(); ++i) {
    if (curve_edge[i] != 0) {
      gradient.mid[i] = node_gradient[corners + i];
      done[corners + i] = 1;
    }
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (int m = 0; m < 6; ++m) {
      const int node = ids[4 + m];
      if (done[node] == 0) {
        done[node] = 1;
        gradient.corners[ids[kTetEdges[m][0]]] += 0.5 * node_gradient[node];
        gradient.corners[ids[kTetEdges[m][1]]] += 0.5 * node_gradient[node];
      }
    }
  }
  return gradient;
}

int find_inverted(const TetMesh& mesh, double least) {
  for (int e = 0; e < mesh.element_count(); ++e) {
    const bool good = mesh.order == 1 ? corner_volume(mesh, e) > 0.0
                                      : jacobian_above(mesh, e, least);
    if (!good) {
      return e;
    }
  }
  return -1;
}

double jacobian_ratio(const TetMesh& mesh, int element) {
  if (mesh.order == 1) {
    return corner_volume(mesh, element) > 0.0 ? 1.0 : -1.0;
  }
  const CornerJacobians jacobians = corner_jacobians(positions(mesh, element));
  const double mean = mean_determinant(jacobians);
  if (!(mean > 0.0)) {
    return -1.0;
  }
  double low = -1.0;  // smaller values are all as bad
  double high = 1.0;
  if (determinant_above(jacobians, (1.0 - 1e-9) * mean)) {
    return 1.0;
  }
  while (high - low > 0.01) {
    const double middle = 0.5 * (low + high);
    (determinant_above(jacobians, middle * mean) ? low : high) = middle;
  }
  return low;
}

}  // namespace meniscus::mesh_tet
