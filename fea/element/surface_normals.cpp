#include "fea/element/surface_normals.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/face_points.h"
#include "fea/element/surface_faces.h"

namespace meniscus::element {

namespace {

constexpr double kOffPlane = 1e-6;  // of the surface's size
constexpr double kFolded = 1e-6;    // |mean normal| of unit normals

/// Rounding must not turn a support along an axis into an oblique one.
Vec3 snapped(Vec3 n) {
  constexpr double kAligned = 1e-12;
  for (int k = 0; k < 3; ++k) {
    if (1.0 - std::abs(n[k]) < kAligned) {
      return n[k] > 0.0 ? Vec3::Unit(k) : Vec3(-Vec3::Unit(k));
    }
  }
  return n;
}

/// visit(place among `nodes`, area vector there) for every node of every face.
template <class Visit>
void over_face_nodes(const TetMesh& mesh, int label,
                     const std::vector<int>& nodes, const Visit& visit) {
  const FaceQuadrature quadrature(mesh.order, FaceRule::Nodes);
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] == label) {
      const auto ids = mesh.face(f);
      for (std::size_t a = 0; a < ids.size(); ++a) {
        const auto at = std::lower_bound(nodes.begin(), nodes.end(), ids[a]);
        visit(static_cast<std::size_t>(at - nodes.begin()),
              quadrature.at(mesh, f, static_cast<int>(a)).normal);
      }
    }
  }
}

/// A node takes the largest spread in the faces around it: on a surface's rim a
/// node may have one face only and tell nothing by itself.
std::vector<double> widened(const TetMesh& mesh, int label,
                            const SurfaceNormals& normals) {
  std::vector<double> result(normals.spread.size(), 0.0);
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[f] != label) {
      continue;
    }
    std::vector<std::size_t> places;
    double largest = 0.0;
    for (const int node : mesh.face(f)) {
      const auto at =
          std::lower_bound(normals.nodes.begin(), normals.nodes.end(), node);
      places.push_back(static_cast<std::size_t>(at - normals.nodes.begin()));
      largest = std::max(largest, normals.spread[places.back()]);
    }
    for (const std::size_t k : places) {
      result[k] = std::max(result[k], largest);
    }
  }
  return result;
}

}  // namespace

SurfaceNormals surface_normals(const TetMesh& mesh,
                               const std::string& surface) {
  const int label = surface_label(mesh, surface);
  SurfaceNormals result;
  result.nodes = surface_nodes(mesh, label);
  const std::size_t count = result.nodes.size();
  result.normal.assign(count, Vec3::Zero());
  result.spread.assign(count, 0.0);
  std::vector<double> area(count, 0.0);
  over_face_nodes(mesh, label, result.nodes,
                  [&](std::size_t k, const Vec3& vector) {
                    result.normal[k] += vector;
                    area[k] += vector.norm();
                  });
  for (std::size_t k = 0; k < count; ++k) {
    const double length = result.normal[k].norm();
    if (!(length > kFolded * area[k])) {
      const Vec3& x = mesh.nodes[result.nodes[k]];
      throw InvalidInput(fmt::format(
          "surface '{}' has no normal at ({:.4g}, {:.4g}, {:.4g}): its faces "
          "there are flat or folded over each other",
          surface, x.x(), x.y(), x.z()));
    }
    result.normal[k] = snapped(result.normal[k] / length);
  }
  over_face_nodes(
      mesh, label, result.nodes, [&](std::size_t k, const Vec3& vector) {
        if (vector.norm() > 0.0) {
          result.spread[k] =
              std::max(result.spread[k],
                       (vector.normalized() - result.normal[k]).norm());
        }
      });
  result.spread = widened(mesh, label, result);
  return result;
}

Vec3 plane_normal(const TetMesh& mesh, const std::string& surface) {
  const int label = surface_label(mesh, surface);
  Vec3 normal = Vec3::Zero();
  Vec3 centre = Vec3::Zero();
  double area = 0.0;
  over_face_points(mesh, label, FaceRule::Three,
                   [&](int, const FacePoint& point) {
                     normal += point.normal;
                     centre += point.normal.norm() * point.position;
                     area += point.normal.norm();
                   });
  if (!(normal.norm() > kFolded * area)) {
    throw InvalidInput(fmt::format(
        "surface '{}' is no plane: its faces have no mean normal", surface));
  }
  normal = snapped(normal.normalized());
  centre /= area;
  double size = 0.0;
  double off = 0.0;
  int worst = 0;
  for (const int node : surface_nodes(mesh, label)) {
    const Vec3 d = mesh.nodes[node] - centre;
    size = std::max(size, d.norm());
    if (std::abs(d.dot(normal)) > off) {
      off = std::abs(d.dot(normal));
      worst = node;
    }
  }
  if (!(off <= kOffPlane * size)) {
    const Vec3& x = mesh.nodes[worst];
    throw InvalidInput(fmt::format(
        "surface '{}' is no plane: ({:.4g}, {:.4g}, {:.4g}) lies {:.3g} off; "
        "symmetry needs a plane (to slide on a curved surface fix its normal)",
        surface, x.x(), x.y(), x.z(), off));
  }
  return normal;
}

}  // namespace meniscus::element
