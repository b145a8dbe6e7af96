#include "fea/joint/edge_tie.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/facet_tree.h"
#include "core/math/dense.h"
#include "core/math/gauss_rule.h"
#include "fea/joint/tie_motion.h"
#include "fea/shell/facet_rule.h"
#include "fea/shell/facet_strain.h"
#include "fea/shell/shell_loads.h"

namespace meniscus::joint {

namespace {

constexpr double kTouches = 0.1;  // of the thickness, and of the edge
constexpr int kAlong = 4;         // fibres of an edge
constexpr int kAcross = 8;        // points of a fibre

/// Least mean square of a fibre's arms, over the thickness squared, of which a
/// whole one has 1/12.
constexpr double kLeastArm = 1e-3;

/// The outer faces of a solid, each as four plane facets.
class SolidFaces {
 public:
  explicit SolidFaces(const TetMesh& solid)
      : solid_(solid), mesh_(cut_faces(solid)), tree_(mesh_, all(mesh_)) {}
  SolidFaces(const SolidFaces&) = delete;
  SolidFaces& operator=(const SolidFaces&) = delete;
  ~SolidFaces() = default;

  double distance(const Vec3& at) const {
    const auto found = tree_.nearest(at);
    return found ? found->distance : std::numeric_limits<double>::infinity();
  }

  /// The face's point that is nearest; there must be faces.
  TiePoint point(const Vec3& at, double weight) const {
    const NearestPoint found = *tree_.nearest(at);
    const auto& facet = kFacets[found.facet % 4];
    Vec3 L = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      L += found.weights[c] * kPlaces[facet[c]];
    }
    TiePoint result{.weight = weight};
    const auto face = solid_.face(faces_of(found.facet));
    std::copy(face.begin(), face.end(), result.nodes.begin());
    const shell::FacetPoint functions = shell::facet_functions(L[1], L[2]);
    std::copy_n(functions.shape.begin(), result.shape.size(),
                result.shape.begin());
    return result;
  }

 private:
  static constexpr std::array<std::array<int, 3>, 4> kFacets = {
      {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  /// The shares of the corners at a face's six nodes.
  inline static const std::array<Vec3, 6> kPlaces = {
      Vec3(1, 0, 0),     Vec3(0, 1, 0),     Vec3(0, 0, 1),
      Vec3(0.5, 0.5, 0), Vec3(0, 0.5, 0.5), Vec3(0.5, 0, 0.5)};

  SurfaceMesh cut_faces(const TetMesh& solid) {
    SurfaceMesh mesh;
    mesh.points = solid.nodes;
    for (int f = 0; f < solid.face_count(); ++f) {
      if (!solid.face_front.empty() && solid.face_front[f] >= 0) {
        continue;  // between two bodies
      }
      outer_.push_back(f);
      const auto face = solid.face(f);
      for (const auto& own : kFacets) {
        mesh.facets.push_back({face[own[0]], face[own[1]], face[own[2]]});
        mesh.facet_label.push_back(0);
      }
    }
    return mesh;
  }

  static std::vector<int> all(const SurfaceMesh& mesh) {
    std::vector<int> facets(mesh.facets.size());
    std::iota(facets.begin(), facets.end(), 0);
    return facets;
  }

  int faces_of(int facet) const { return outer_[facet / 4]; }

  const TetMesh& solid_;
  std::vector<int> outer_;
  SurfaceMesh mesh_;
  FacetTree tree_;
};

/// As shell::edge_shapes(), but the integral of one times an edge function is 0
/// for all but its own, and of that the function's integral.
Vec3 dual_shapes(double s) {
  Mat3 M;
  M << 4, -1, 2, -1, 4, 2, 2, 2, 16;
  const Vec3 integral(1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0);
  return integral.asDiagonal() * (M / 30.0).inverse() * shell::edge_shapes(s);
}

using shell::FacetEdge;

double thickness_on(const shell::ShellMesh& mesh, const FacetEdge& edge,
                    double s) {
  const Vec3& t = mesh.thickness[edge.facet];
  return (1.0 - s) * t[edge.edge] + s * t[(edge.edge + 1) % 3];
}

double length_of(const shell::ShellMesh& mesh, const FacetEdge& edge) {
  const auto [from, to, middle] = shell::edge_nodes(mesh, edge);
  return (mesh.nodes[to] - mesh.nodes[from]).norm();
}

std::vector<FacetEdge> edges_on(const SolidFaces& faces,
                                const shell::ShellMesh& mesh) {
  std::vector<double> away;
  away.reserve(mesh.nodes.size());
  for (const Vec3& node : mesh.nodes) {
    away.push_back(faces.distance(node));
  }
  std::vector<FacetEdge> edges;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int side = 0; side < 3; ++side) {
      const FacetEdge edge{static_cast<int>(f), side};
      const std::array<int, 3> nodes = shell::edge_nodes(mesh, edge);
      // Edges that only begin there leave it by their length.
      const double most = kTouches * std::min(thickness_on(mesh, edge, 0.5),
                                              length_of(mesh, edge));
      if (std::all_of(nodes.begin(), nodes.end(),
                      [&](int node) { return away[node] <= most; })) {
        edges.push_back(edge);
      }
    }
  }
  return edges;
}

/// Across the wall at a place of the edge.
Fibre fibre_at(const SolidFaces& faces, const shell::ShellMesh& mesh,
               const FacetEdge& edge, double offset, double s) {
  Vec3 corners = Vec3::Zero();
  corners[edge.edge] = 1.0 - s;
  corners[(edge.edge + 1) % 3] = s;
  std::array<shell::Triple<double>, shell::kNodes> X{};
  for (int k = 0; k < shell::kNodes; ++k) {
    const Vec3& node = mesh.nodes[mesh.facets[edge.facet][k]];
    X[k] = {node[0], node[1], node[2]};
  }
  const shell::FacetPoint at = shell::facet_point(corners[1], corners[2]);
  const Vec3 normal =
      shell::as_vector(shell::facet_frame(X, at, nullptr).axes[2]);
  Vec3 middle = Vec3::Zero();
  const std::array<int, 3> nodes = shell::edge_nodes(mesh, edge);
  const Vec3 shapes = shell::edge_shapes(s);
  for (int k = 0; k < 3; ++k) {
    middle += shapes[k] * mesh.nodes[nodes[k]];
  }
  const double thickness = thickness_on(mesh, edge, s);
  Fibre fibre;
  for (const GaussPoint& across : gauss_rule(kAcross)) {
    fibre.push_back(
        faces.point(middle + (offset + across.at - 0.5) * thickness * normal,
                    across.weight));
  }
  return fibre;
}

/// About which the fibres' arms turn least goes last.
Mat3 turning_axes(const Mat3& arms, double thickness, const Vec3& place) {
  const auto found = symmetric_eigen(arms);
  if (!(found.values[1] > kLeastArm * thickness * thickness)) {
    throw InvalidInput(fmt::format(
        "a shell's edge lies on a solid at ({:.4g}, {:.4g}, {:.4g}) where the "
        "wall's end, {:.4g} thick, has no width on it: draw the edge on a face "
        "of the solid, half a thickness from its ends",
        place.x(), place.y(), place.z(), thickness));
  }
  Mat3 axes;
  axes.col(0) = found.vectors.col(2);
  axes.col(1) = found.vectors.col(1);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

EdgeTie tie_edges(const TetMesh& solid, const shell::ShellMesh& mesh,
                  const std::vector<shell::Section>& sections) {
  const SolidFaces faces(solid);
  EdgeTie tie;
  std::map<int, TiedNode> nodes;
  std::map<int, double> thickness;
  for (const FacetEdge& edge : edges_on(faces, mesh)) {
    const std::array<int, 3> on_edge = shell::edge_nodes(mesh, edge);
    const double length = length_of(mesh, edge);
    const double offset = sections[mesh.section[edge.facet]].offset;
    for (const GaussPoint& along : gauss_rule(kAlong)) {
      const auto fibre = static_cast<int>(tie.fibres.size());
      tie.fibres.push_back(fibre_at(faces, mesh, edge, offset, along.at));
      const Vec3 dual = dual_shapes(along.at);
      for (int k = 0; k < 3; ++k) {
        TiedNode& node = nodes[on_edge[k]];
        node.node = on_edge[k];
        node.fibres.push_back({fibre, along.weight * length * dual[k]});
        thickness[node.node] = thickness_on(mesh, edge, 0.5);
      }
    }
  }
  for (auto& [id, node] : nodes) {
    const double sum = std::accumulate(
        node.fibres.begin(), node.fibres.end(), 0.0,
        [](double s, const FibreShare& own) { return s + own.share; });
    for (FibreShare& own : node.fibres) {
      own.share /= sum;
    }
    node.axes = turning_axes(mean_arms(tie, node, solid.nodes), thickness[id],
                             mesh.nodes[id]);
    tie.nodes.push_back(std::move(node));
  }
  return tie;
}

}  // namespace meniscus::joint
