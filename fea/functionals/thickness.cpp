#include "fea/functionals/thickness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "fea/element/face_points.h"

namespace meniscus::functionals {

namespace {

/// Cosine between normals of faces across from each other, at most.
constexpr double kAcross = -0.5;
/// A wall beside (cosine above kAcross, below -kAcross) with a smaller ball
/// than this part of the one across makes an edge; around a rod all are alike.
constexpr double kBeside = 0.9;

/// Of an edge whose wedge does not count: between its faces, and cosine of the
/// faces' normals where they make such an edge.
constexpr double kSharpestEdge = 10.0 * EIGEN_PI / 180.0;
constexpr double kEdgeCosine = -0.17;
/// Faces of a wedge: normals so near (cosine) to those at its edge, and the
/// edge so near, times its distance were they plane.
constexpr double kSameWall = 0.9;
constexpr double kNearEdge = 1.5;

constexpr double kBelowLeast = 0.05;  // of the least thickness
constexpr double kFeather = 0.02;     // of the median one: a feather edge

/// The point of the seven at the centre is the first.
constexpr int kCentre = 0;

struct FaceCentre {
  int face;
  Vec3 place;
  Vec3 normal;  // unit
};

/// Of the outer surface, ascending along x and then by face.
std::vector<FaceCentre> outer_centres(const TetMesh& mesh) {
  const element::FaceQuadrature plane(1, element::FaceRule::Seven);
  std::vector<FaceCentre> centres;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_front.empty() || mesh.face_front[f] < 0) {
      const element::FacePoint point = plane.at(mesh, f, kCentre);
      centres.push_back({f, point.position, point.normal.normalized()});
    }
  }
  std::sort(centres.begin(), centres.end(),
            [](const FaceCentre& a, const FaceCentre& b) {
              return a.place.x() != b.place.x() ? a.place.x() < b.place.x()
                                                : a.face < b.face;
            });
  return centres;
}

/// The middle of a sharp edge of the surface, and the normals of its faces.
struct SharpEdge {
  Vec3 place;
  std::array<Vec3, 2> normal;
};

std::vector<SharpEdge> sharp_edges(const TetMesh& mesh) {
  const element::FaceQuadrature plane(1, element::FaceRule::Seven);
  std::map<Edge, int> first_face;
  std::vector<SharpEdge> edges;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (!mesh.face_front.empty() && mesh.face_front[f] >= 0) {
      continue;
    }
    const auto ids = mesh.face(f);
    for (int k = 0; k < 3; ++k) {
      const int a = ids[k];
      const int b = ids[(k + 1) % 3];
      const auto [known, is_new] = first_face.try_emplace(edge_key(a, b), f);
      if (is_new) {
        continue;
      }
      const Vec3 n = plane.at(mesh, known->second, kCentre).normal.normalized();
      const Vec3 m = plane.at(mesh, f, kCentre).normal.normalized();
      if (n.dot(m) < kEdgeCosine) {
        edges.push_back({0.5 * (mesh.nodes[a] + mesh.nodes[b]), {n, m}});
      }
    }
  }
  return edges;
}

/// Are the faces, `diameter` apart, the two sides of a sharp edge's wedge?
bool are_wedge(const FaceCentre& a, const FaceCentre& b, double diameter,
               const std::vector<SharpEdge>& edges) {
  const double cosine = -a.normal.dot(b.normal);  // of the wedge's angle
  if (!(cosine < std::cos(kSharpestEdge))) {
    return false;
  }
  const double to_edge =
      0.5 * diameter * std::sqrt((1.0 + cosine) / (1.0 - cosine));
  return std::any_of(edges.begin(), edges.end(), [&](const SharpEdge& edge) {
    const auto along = [&](int side) {
      return edge.normal[side].dot(a.normal) > kSameWall &&
             edge.normal[1 - side].dot(b.normal) > kSameWall;
    };
    return (edge.place - a.place).norm() < kNearEdge * to_edge + diameter &&
           (along(0) || along(1));
  });
}

/// The face across from centre k, or -1 where none faces the other way.
int across(const std::vector<FaceCentre>& centres, std::size_t k,
           const std::vector<SharpEdge>& edges) {
  const FaceCentre& a = centres[k];
  double best = std::numeric_limits<double>::infinity();  // diameter
  double beside = best;
  const FaceCentre* other = nullptr;
  const auto look_at = [&](const FaceCentre& b) {
    const Vec3 e = b.place - a.place;
    const double depth = -a.normal.dot(e);
    const double cosine = a.normal.dot(b.normal);
    if (!(depth > 0.0) || cosine > -kAcross) {
      return;
    }
    const double diameter = e.squaredNorm() / depth;
    if (cosine > kAcross) {
      beside = std::min(beside, diameter);
      return;
    }
    if (diameter < best ||
        (diameter == best && other != nullptr && b.face < other->face)) {
      best = diameter;
      other = &b;
    }
  };
  // A ball's diameter is no less than the distance of two of its points.
  for (std::size_t i = k; i-- > 0;) {
    if (a.place.x() - centres[i].place.x() > best) {
      break;
    }
    look_at(centres[i]);
  }
  for (std::size_t i = k + 1; i < centres.size(); ++i) {
    if (centres[i].place.x() - a.place.x() > best) {
      break;
    }
    look_at(centres[i]);
  }
  return other == nullptr || beside < kBeside * best ||
                 are_wedge(a, *other, best, edges)
             ? -1
             : other->face;
}

struct Distance {
  double value = 0.0;
  Vec3 by_e, by_normal_a, by_normal_b;  // by the normals as they are
};

Distance distance_of(const element::FacePoint& a, const element::FacePoint& b) {
  const Vec3 e = b.position - a.position;
  const Vec3 n_a = a.normal.normalized();
  const Vec3 n_b = b.normal.normalized();
  const double apart = 1.0 - n_a.dot(n_b);
  const double depth = e.dot(n_b);
  const auto of_length = [](const Vec3& by_unit, const Vec3& n, double length) {
    return Vec3((by_unit - n.dot(by_unit) * n) / length);
  };
  const double turn = 2.0 * depth / (apart * apart);
  return {2.0 * depth / apart, 2.0 / apart * n_b,
          of_length(turn * n_b, n_a, a.normal.norm()),
          of_length(2.0 / apart * e + turn * n_a, n_b, b.normal.norm())};
}

/// Of each pair, in order [length].
std::vector<double> distances_of(const TetMesh& mesh,
                                 const ThicknessPairs& pairs) {
  const element::FaceQuadrature plane(1, element::FaceRule::Seven);
  std::vector<double> distances;
  distances.reserve(pairs.faces.size());
  for (const auto& [a, b] : pairs.faces) {
    distances.push_back(
        distance_of(plane.at(mesh, a, kCentre), plane.at(mesh, b, kCentre))
            .value);
  }
  return distances;
}

}  // namespace

ThicknessPairs thickness_pairs(const TetMesh& base) {
  const std::vector<FaceCentre> centres = outer_centres(base);
  const int count = static_cast<int>(centres.size());
  const std::vector<SharpEdge> edges = sharp_edges(base);
  std::vector<int> found(centres.size(), -1);
#pragma omp parallel for schedule(dynamic, 64)
  for (int k = 0; k < count; ++k) {
    found[k] = across(centres, static_cast<std::size_t>(k), edges);
  }
  ThicknessPairs pairs;
  for (std::size_t k = 0; k < centres.size(); ++k) {
    if (found[k] >= 0) {
      pairs.faces.push_back({centres[k].face, found[k]});
    }
  }
  if (pairs.faces.empty()) {
    throw InvalidInput(
        fmt::format("thickness: none of {} faces of the surface has one "
                    "across the solid from it",
                    count));
  }
  std::sort(pairs.faces.begin(), pairs.faces.end());
  std::vector<double> distances = distances_of(base, pairs);
  pairs.least = *std::min_element(distances.begin(), distances.end());
  const auto middle = distances.begin() + std::ssize(distances) / 2;
  std::nth_element(distances.begin(), middle, distances.end());
  pairs.median = *middle;
  return pairs;
}

double usual_sharpness(const ThicknessPairs& pairs) {
  const auto count = static_cast<double>(pairs.faces.size());
  const double least = std::max(pairs.least, kFeather * pairs.median);
  return std::max(1.0, std::log(count)) / (kBelowLeast * least);
}

ThinPlace thinnest_place(const TetMesh& mesh, const ThicknessPairs& pairs,
                         double limit) {
  const element::FaceQuadrature plane(1, element::FaceRule::Seven);
  ThinPlace result{.value = std::numeric_limits<double>::infinity()};
  double area = 0.0;
  double below = 0.0;
  for (const auto& [f, g] : pairs.faces) {
    const element::FacePoint a = plane.at(mesh, f, kCentre);
    const element::FacePoint b = plane.at(mesh, g, kCentre);
    const double value = distance_of(a, b).value;
    area += a.normal.norm();
    below += value < limit ? a.normal.norm() : 0.0;
    if (value < result.value) {
      result.value = value;
      result.place = 0.5 * (a.position + b.position);
    }
  }
  result.share = below / area;
  return result;
}

element::Functional thickness_functional(const TetMesh& mesh,
                                         const ThicknessPairs& pairs,
                                         double sharpness,
                                         element::Derivatives derivatives) {
  if (!(sharpness > 0.0) || !std::isfinite(sharpness) || pairs.faces.empty()) {
    throw InvalidInput(fmt::format(
        "thickness: sharpness {} over {} pairs of faces; both must be above 0",
        sharpness, pairs.faces.size()));
  }
  const element::FaceQuadrature plane(1, element::FaceRule::Seven);
  std::vector<Distance> distances;
  distances.reserve(pairs.faces.size());
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : pairs.faces) {
    distances.push_back(
        distance_of(plane.at(mesh, a, kCentre), plane.at(mesh, b, kCentre)));
    least = std::min(least, distances.back().value);
  }
  double sum = 0.0;
  for (const Distance& d : distances) {
    sum += std::exp(-sharpness * (d.value - least));
  }
  element::Functional result{.value = least - std::log(sum) / sharpness};
  if (derivatives == element::Derivatives::All) {
    result.by_nodes.assign(mesh.nodes.size(), Vec3::Zero());
    for (std::size_t k = 0; k < distances.size(); ++k) {
      const Distance& d = distances[k];
      const double share = std::exp(-sharpness * (d.value - least)) / sum;
      const auto& [a, b] = pairs.faces[k];
      plane.pull_back(mesh, a, kCentre, -share * d.by_e, share * d.by_normal_a,
                      result.by_nodes);
      plane.pull_back(mesh, b, kCentre, share * d.by_e, share * d.by_normal_b,
                      result.by_nodes);
    }
  }
  return result;
}

}  // namespace meniscus::functionals
