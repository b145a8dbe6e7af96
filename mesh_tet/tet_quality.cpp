#include "mesh_tet/tet_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace meniscus::mesh_tet {

namespace {

constexpr double kDegree = 180.0 / std::numbers::pi;

/// The two faces (as kTetFaces) that meet at each edge of kTetEdges: those
/// opposite to the other two corners.
constexpr std::array<Edge, 6> kFacesAtEdge = {
    {{2, 3}, {0, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}}};

std::array<Vec3, 4> face_normals2(const TetCorners& x) {
  std::array<Vec3, 4> normals;
  for (int f = 0; f < 4; ++f) {
    const auto& c = kTetFaces[f];
    normals[f] = (x[c[1]] - x[c[0]]).cross(x[c[2]] - x[c[0]]);
  }
  return normals;
}

/// Cosines times their absolute values: the same order without square roots.
std::array<double, 6> squares_between(const std::array<Vec3, 4>& normals) {
  std::array<double, 4> norm2;
  for (int f = 0; f < 4; ++f) {
    norm2[f] = normals[f].squaredNorm();
  }
  std::array<double, 6> squares;
  for (int e = 0; e < 6; ++e) {
    const auto [f, g] = kFacesAtEdge[e];
    const double norms = norm2[f] * norm2[g];
    const double dot = -normals[f].dot(normals[g]);
    squares[e] = norms > 0.0 ? dot * std::abs(dot) / norms : 1.0;
  }
  return squares;
}

double degrees_of(double square) {
  const double cosine = std::copysign(std::sqrt(std::abs(square)), square);
  return kDegree * std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// Bin of ten degrees in the histogram.
int bin_of(double square) {
  static const std::array<double, 17> kBounds = [] {
    std::array<double, 17> bounds{};
    for (int i = 0; i < 17; ++i) {
      const double cosine = std::cos(10.0 * (i + 1) / kDegree);
      bounds[i] = cosine * std::abs(cosine);
    }
    return bounds;
  }();
  int bin = 0;
  for (const double bound : kBounds) {
    bin += square <= bound ? 1 : 0;
  }
  return bin;
}

/// Squares of the measures of shape.
struct Shape {
  double aspect2 = 0.0;
  double radius_edge2 = 0.0;
};

Shape shape_of(const TetCorners& x, const std::array<Vec3, 4>& normals,
               double volume) {
  double shortest2 = std::numeric_limits<double>::infinity();
  double longest2 = 0.0;
  for (const Edge& edge : kTetEdges) {
    const double length2 = (x[edge[1]] - x[edge[0]]).squaredNorm();
    longest2 = std::max(longest2, length2);
    shortest2 = std::min(shortest2, length2);
  }
  double normal2 = 0.0;
  for (const Vec3& n : normals) {
    normal2 = std::max(normal2, n.squaredNorm());
  }
  const Vec3 a = x[1] - x[0];
  const Vec3 b = x[2] - x[0];
  const Vec3 c = x[3] - x[0];
  const Vec3 around = a.squaredNorm() * b.cross(c) +
                      b.squaredNorm() * c.cross(a) +
                      c.squaredNorm() * a.cross(b);
  // Radius |around| / 12 V; height 3 V over the area |normal| / 2.
  const double volume2 = volume * volume;
  return {longest2 * normal2 / (36.0 * volume2),
          around.squaredNorm() / (144.0 * volume2 * shortest2)};
}

}  // namespace

double tet_volume(const TetCorners& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0;
}

std::array<double, 6> dihedral_cosines(const TetCorners& x) {
  const auto normals = face_normals2(x);
  std::array<double, 4> norm;
  for (int f = 0; f < 4; ++f) {
    norm[f] = normals[f].norm();
  }
  std::array<double, 6> cosines;
  for (int e = 0; e < 6; ++e) {
    const auto [f, g] = kFacesAtEdge[e];
    const double norms = norm[f] * norm[g];
    cosines[e] =
        norms > 0.0 ? std::clamp(-normals[f].dot(normals[g]) / norms, -1.0, 1.0)
                    : 1.0;
  }
  return cosines;
}

TetQuality tet_quality(const TetMesh& mesh) {
  TetQuality quality;
  if (mesh.element_count() == 0) {
    return quality;
  }
  // Extremes of c |c| for cosines c, which fall as the angles rise: roots and
  // arc cosines are taken of the last two only.
  double largest = -1.0;  // of signed squared cosines
  double smallest = 1.0;
  quality.min_volume = std::numeric_limits<double>::infinity();
  const auto raise = [](double& most, int& which, double value, int e) {
    if (value > most || std::isnan(value)) {
      most = value;
      which = e;
    }
  };
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    const TetCorners x = {mesh.nodes[ids[0]], mesh.nodes[ids[1]],
                          mesh.nodes[ids[2]], mesh.nodes[ids[3]]};
    // Dihedral angles from the normals of the two faces at each edge.
    const auto normals = face_normals2(x);
    for (const double c : squares_between(normals)) {
      ++quality.dihedral_histogram[bin_of(c)];
      raise(largest, quality.worst_element, c, e);
      if (c < smallest) {
        smallest = c;
        quality.largest_dihedral_element = e;
      }
    }
    // Longest edge over least height, circumradius over shortest edge, squared.
    const double volume = tet_volume(x);
    const Shape shape = shape_of(x, normals, volume);
    raise(quality.max_aspect, quality.aspect_element, shape.aspect2, e);
    raise(quality.max_radius_edge, quality.radius_edge_element,
          shape.radius_edge2, e);
    quality.min_volume = std::min(quality.min_volume, volume);
  }
  quality.max_aspect = std::sqrt(quality.max_aspect);
  quality.max_radius_edge = std::sqrt(quality.max_radius_edge);
  quality.min_dihedral_deg = degrees_of(largest);
  quality.max_dihedral_deg = degrees_of(smallest);
  return quality;
}

std::optional<QualityBreach> find_breach(const TetQuality& quality,
                                         const QualityBounds& bounds) {
  const auto say = [](const char* what, double value, double bound,
                      int element) {
    return QualityBreach{fmt::format(fmt::runtime(what), value, bound),
                         element};
  };
  if (!(quality.min_dihedral_deg >= bounds.min_dihedral_deg)) {
    return say("a dihedral angle of {:.3g} degrees, the least is {:.3g}",
               quality.min_dihedral_deg, bounds.min_dihedral_deg,
               quality.worst_element);
  }
  if (!(quality.max_dihedral_deg <= bounds.max_dihedral_deg)) {
    return say("a dihedral angle of {:.4g} degrees, the most is {:.4g}",
               quality.max_dihedral_deg, bounds.max_dihedral_deg,
               quality.largest_dihedral_element);
  }
  if (!(quality.max_aspect <= bounds.max_aspect)) {
    return say("an aspect of {:.3g}, the most is {:.3g}", quality.max_aspect,
               bounds.max_aspect, quality.aspect_element);
  }
  if (!(quality.max_radius_edge <= bounds.max_radius_edge)) {
    return say("a radius-edge ratio of {:.3g}, the most is {:.3g}",
               quality.max_radius_edge, bounds.max_radius_edge,
               quality.radius_edge_element);
  }
  return std::nullopt;
}

std::string place_of(const TetMesh& mesh, int element) {
  if (element < 0 || element >= mesh.element_count()) {
    return "nowhere";
  }
  const auto ids = mesh.element(element).first(4);
  Vec3 at = Vec3::Zero();
  for (const int id : ids) {
    at += 0.25 * mesh.nodes[id];
  }
  std::string text =
      fmt::format("near ({:.6g}, {:.6g}, {:.6g})", at.x(), at.y(), at.z());
  std::set<int> labels;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f).first(3);
    if (std::any_of(face.begin(), face.end(), [&](int node) {
          return std::find(ids.begin(), ids.end(), node) != ids.end();
        })) {
      labels.insert(mesh.face_label[f]);
    }
  }
  for (const int label : labels) {
    text += fmt::format("{}'{}'", label == *labels.begin() ? " at " : ", ",
                        mesh.labels[label]);
  }
  return text;
}

}  // namespace meniscus::mesh_tet
