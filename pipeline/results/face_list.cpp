#include "pipeline/results/face_list.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/math/dense.h"

namespace meniscus::results {

namespace {

constexpr double kFlat = 1e-3;   // of normals about their mean
constexpr double kRound = 0.03;  // of distances from an axis or a centre
constexpr double kAcross = 0.1;  // of normals along a cylinder's axis

struct Facets {
  std::vector<Vec3> normals;  // unit
  std::vector<double> areas;
  Points corners;
  double area = 0.0;
  Vec3 middle = Vec3::Zero();
};

Facets facets_of(const SurfaceMesh& mesh, int label) {
  Facets found;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Vec3 n = area_vector2(mesh, static_cast<int>(f));
    if (mesh.facet_label[f] != label || !(n.norm() > 0.0)) {
      continue;
    }
    found.normals.push_back(n.normalized());
    found.areas.push_back(0.5 * n.norm());
    found.area += found.areas.back();
    Vec3 middle = Vec3::Zero();
    for (const int id : mesh.facets[f]) {
      found.corners.push_back(mesh.points[static_cast<std::size_t>(id)]);
      middle += found.corners.back() / 3.0;
    }
    found.middle += found.areas.back() * middle;
  }
  if (found.area > 0.0) {
    found.middle /= found.area;
  }
  return found;
}

/// Centre and radius of the sphere through points, in the `dimensions` of
/// `basis` (a circle in two of them), by least squares.
std::pair<Vec3, double> fit_round(const Facets& facets,
                                  const Eigen::Matrix3Xd& basis) {
  const Eigen::Index dimensions = basis.cols();
  const auto rows = static_cast<Eigen::Index>(facets.corners.size());
  Eigen::MatrixXd a(rows, dimensions + 1);
  VectorX b(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const VectorX p =
        basis.transpose() *
        (facets.corners[static_cast<std::size_t>(k)] - facets.middle);
    a.row(k) << 2.0 * p.transpose(), 1.0;
    b[k] = p.squaredNorm();
  }
  const VectorX x = least_squares(a, b).x;
  const double square = x[dimensions] + x.head(dimensions).squaredNorm();
  return {facets.middle + basis * x.head(dimensions),
          square > 0.0 ? std::sqrt(square) : 0.0};
}

/// All points as far from the centre, and all normals along the radius.
bool is_round(const Facets& facets, const Eigen::Matrix3Xd& basis,
              const Vec3& centre, double radius) {
  return radius > 0.0 &&
         std::all_of(
             facets.corners.begin(), facets.corners.end(), [&](const Vec3& p) {
               const double r = (basis.transpose() * (p - centre)).norm();
               return std::abs(r - radius) <= kRound * radius;
             });
}

/// Outward normals point to the axis: there is material around it.
bool is_hollow(const Facets& facets, const Vec3& centre) {
  double sum = 0.0;
  for (std::size_t f = 0; f < facets.normals.size(); ++f) {
    sum +=
        facets.areas[f] * facets.normals[f].dot(facets.corners[3 * f] - centre);
  }
  return sum < 0.0;
}

std::string place_text(const Vec3& p) {
  const auto tidy = [](double x) { return std::abs(x) < 1e-9 ? 0.0 : x; };
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", tidy(p.x()), tidy(p.y()),
                     tidy(p.z()));
}

std::string shape_text(const FaceShape& shape, const std::string& unit) {
  const std::string at = " at " + place_text(shape.place);
  const std::string area = fmt::format(", area {:.4g} {}2", shape.area, unit);
  switch (shape.kind) {
    case FaceKind::Plane:
      return "plane" + at + ", outwards " + place_text(shape.direction) + area;
    case FaceKind::Cylinder:
      return fmt::format("{} of radius {:.4g}{} along {}{}",
                         shape.hollow ? "bore" : "cylinder", shape.radius, at,
                         place_text(shape.direction), area);
    case FaceKind::Sphere:
      return fmt::format("{} of radius {:.4g}{}{}",
                         shape.hollow ? "hollow sphere" : "sphere",
                         shape.radius, at, area);
    case FaceKind::Other:
      break;
  }
  return "curved" + at + area;
}

/// An axis has no sense: its largest part is above 0.
Vec3 sensed(const Vec3& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Vec3(-axis) : axis;
}

}  // namespace

FaceShape face_shape(const SurfaceMesh& mesh, int label) {
  const Facets facets = facets_of(mesh, label);
  FaceShape shape{.place = facets.middle, .area = facets.area};
  if (facets.normals.empty()) {
    return shape;
  }
  Vec3 mean = Vec3::Zero();
  Mat3 spread = Mat3::Zero();
  for (std::size_t f = 0; f < facets.normals.size(); ++f) {
    const Vec3& n = facets.normals[f];
    mean += facets.areas[f] / facets.area * n;
    spread += facets.areas[f] / facets.area * n * n.transpose();
  }
  if (mean.norm() > 1.0 - kFlat) {
    shape.kind = FaceKind::Plane;
    shape.direction = mean.normalized();
    return shape;
  }
  const SymmetricEigen<3> eigen = symmetric_eigen(spread);
  const Vec3 axis = sensed(eigen.vectors.col(0));
  const bool across = std::all_of(
      facets.normals.begin(), facets.normals.end(),
      [&](const Vec3& n) { return std::abs(n.dot(axis)) < kAcross; });
  const Eigen::Matrix3Xd basis =
      across ? Eigen::Matrix3Xd(eigen.vectors.rightCols(2))
             : Eigen::Matrix3Xd(Mat3::Identity());
  const auto [centre, radius] = fit_round(facets, basis);
  if (is_round(facets, basis, centre, radius)) {
    shape.kind = across ? FaceKind::Cylinder : FaceKind::Sphere;
    shape.place = centre;
    shape.direction = across ? axis : Vec3(Vec3::Zero());
    shape.radius = radius;
    shape.hollow = is_hollow(facets, centre);
  }
  return shape;
}

std::string face_list(const SurfaceMesh& mesh, const std::string& length_unit,
                      std::size_t most) {
  std::vector<FaceShape> shapes;
  shapes.reserve(mesh.labels.size());
  for (int label = 0; label < static_cast<int>(mesh.labels.size()); ++label) {
    shapes.push_back(face_shape(mesh, label));
  }
  std::vector<std::size_t> order(shapes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) {
                     return shapes[a].area > shapes[b].area;
                   });
  std::string text;
  for (std::size_t k = 0; k < order.size() && k < most; ++k) {
    text += fmt::format("{}  {}: {}", k > 0 ? "\n" : "", mesh.labels[order[k]],
                        shape_text(shapes[order[k]], length_unit));
  }
  if (order.size() > most) {
    text += fmt::format("\n  and {} more", order.size() - most);
  }
  return text;
}

}  // namespace meniscus::results
