#include "fea/loads/face_pressures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/face_points.h"

namespace meniscus::loads {

namespace {

/// Corners of the face that has not a corner, outward.
constexpr std::array<std::array<int, 3>, 4> kOutwardCorners = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

void add_face(const TetMesh& mesh, const FacePressure& load,
              std::vector<int>& faces) {
  const auto ids = mesh.element(load.element);
  const auto& corners =
      kOutwardCorners[static_cast<std::size_t>(load.opposite_corner)];
  for (const int corner : corners) {
    faces.push_back(ids[corner]);
  }
  for (std::size_t k = 0; mesh.order == 2 && k < 3; ++k) {
    const auto [a, b] = std::minmax(corners[k], corners[(k + 1) % 3]);
    const auto edge = std::find(kTetEdges.begin(), kTetEdges.end(), Edge{a, b});
    faces.push_back(ids[4 + (edge - kTetEdges.begin())]);
  }
}

}  // namespace

VectorX face_pressure_forces(const TetMesh& mesh,
                             const std::vector<FacePressure>& pressures) {
  TetMesh pressed;  // the faces alone
  pressed.order = mesh.order;
  pressed.nodes = mesh.nodes;
  for (const FacePressure& load : pressures) {
    if (load.element < 0 || load.element >= mesh.element_count() ||
        load.opposite_corner < 0 || load.opposite_corner > 3 ||
        !std::isfinite(load.pressure)) {
      throw InvalidInput(fmt::format(
          "a pressure of {} on the face off corner {} of element {}; give a "
          "finite one, a corner from 0 to 3 and one of {} elements",
          load.pressure, load.opposite_corner, load.element,
          mesh.element_count()));
    }
    add_face(mesh, load, pressed.faces);
  }
  const element::FaceQuadrature quadrature(mesh.order,
                                           element::FaceRule::Three);
  VectorX f = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  for (int face = 0; face < pressed.face_count(); ++face) {
    const auto ids = pressed.face(face);
    for (int q = 0; q < quadrature.size(); ++q) {
      const element::FacePoint point = quadrature.at(pressed, face, q);
      for (std::size_t a = 0; a < ids.size(); ++a) {
        f.segment<3>(3L * ids[a]) -=
            pressures[face].pressure * point.shape[a] * point.normal;
      }
    }
  }
  return f;
}

}  // namespace meniscus::loads
