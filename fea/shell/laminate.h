/// What a shell is made of through its thickness.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "fea/element/material.h"

namespace meniscus::shell {

/// A layer. Its material's first axis lies in the surface, turned by `angle`
/// about the normal from the section's direction; an orthotropic material's
/// own axes (Orthotropic::axes) are not read.
struct Ply {
  element::Material material;
  double share = 1.0;  // of the thickness, > 0
  double angle = 0.0;  // [rad]
};

/// Plies from the negative face to the positive one, to which the facet's
/// normal points.
struct Laminate {
  std::vector<Ply> plies;
  /// Of transverse shear: what parabolas of shear stress store beside even
  /// ones (Reissner 1945: 5/6 of a homogeneous plate).
  double shear_correction = 5.0 / 6.0;
};

/// In the section's axes, plane stress: components 11, 22, 12 (shears double).
struct PlyLaw {
  Mat3 plane = Mat3::Zero();                         // [pressure]
  Eigen::Matrix2d across = Eigen::Matrix2d::Zero();  // 13, 23 [pressure]
  Vec3 expansion = Vec3::Zero();                     // [1/temperature]
  Vec3 squeeze = Vec3::Zero();  // strains of a unit of stress across the wall
                                // [1/pressure]
  double density = 0.0;         // [mass/length^3]
};

/// One point of the rule through the thickness.
struct LayerPoint {
  double at = 0.0;      // from the middle, in thicknesses: -1/2 to 1/2
  double weight = 0.0;  // they sum to 1
  int ply = 0;
};

struct LaminateLaw {
  std::vector<PlyLaw> plies;
  std::vector<LayerPoint> points;  // two a ply, from the negative face on
  std::vector<double> from, to;    // each ply's faces, as LayerPoint::at
  double shear_correction = 5.0 / 6.0;
  double mean_shear = 0.0;  // of all plies' in-plane shear moduli [pressure]
};

/// Throws InvalidInput for no ply, a share or a correction that is not
/// positive, and as element::check_material().
LaminateLaw laminate_law(const Laminate& laminate);

/// Of a flat wall per length, about its middle: N = A e + B k, M = B e + D k
/// (Jones, Mechanics of composite materials, 1999); transverse forces
/// S gamma, with the correction.
struct LaminateStiffness {
  Mat3 A, B, D;       // [force/length], [force], [force length]
  Eigen::Matrix2d S;  // [force/length]
};
LaminateStiffness laminate_stiffness(const LaminateLaw& law, double thickness);

}  // namespace meniscus::shell
