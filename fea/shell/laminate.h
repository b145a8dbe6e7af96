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

/// What a laminate changes by as one number of one ply does.
struct LawRate {
  PlyLaw ply;
  Eigen::Matrix2d across = Eigen::Matrix2d::Zero();  // of LaminateLaw
};
struct PlyRates {
  LawRate by_modulus;  // Young's; orthotropic: all moduli in proportion [per 1]
  LawRate by_angle;    // [1/rad]
};

/// A number's derivatives by what a ply is made of and how it lies; as
/// PlyRates.
struct PlyGradient {
  double modulus = 0.0;
  double density = 0.0;
  double angle = 0.0;
};

/// Per section, per ply. What is not there is 0.
using PlyGradients = std::vector<std::vector<PlyGradient>>;

/// Adds `factor` times `more`.
void add_plies(double factor, const PlyGradients& more, PlyGradients& sum);

/// One point of the rule through the thickness.
struct LayerPoint {
  double at = 0.0;      // from the middle, in thicknesses: -1/2 to 1/2
  double weight = 0.0;  // they sum to 1
  int ply = 0;
};

struct LaminateLaw {
  std::vector<PlyLaw> plies;
  std::vector<PlyRates> rates;     // of these
  std::vector<LayerPoint> points;  // two a ply, from the negative face on
  std::vector<double> from, to;    // each ply's faces, as LayerPoint::at
  /// Transverse shear 13, 23: even strains store by it what the plies do under
  /// the shear stresses of bending, which grow from either face as E (z - z_0)
  /// adds up, E a ply's stiffness in the plane, the mean of all directions, and
  /// z_0 where bending does not stretch (Reissner, J. Appl. Mech. 12, 1945:
  /// 5/6 of a homogeneous wall). It turns with the axes [pressure].
  Eigen::Matrix2d across = Eigen::Matrix2d::Zero();
  double mean_shear = 0.0;  // of all plies' in-plane shear moduli [pressure]
};

/// Throws InvalidInput for no ply, a share that is not positive, and as
/// element::check_material().
LaminateLaw laminate_law(const Laminate& laminate);

/// A number's derivatives by a laminate's law: by the numbers of its plies, and
/// by its mean shear.
struct LawGradient {
  explicit LawGradient(const LaminateLaw& law);
  std::vector<PlyGradient> by_ply() const;

  const LaminateLaw& law;  // not owned
  std::vector<PlyLaw> by;  // but for `across`, which walls do not look at
  Eigen::Matrix2d by_across = Eigen::Matrix2d::Zero();
  double by_mean_shear = 0.0;
};

/// Of a flat wall per length, about its middle: N = A e + B k, M = B e + D k
/// (Jones, Mechanics of composite materials, 1999); transverse forces
/// S gamma.
struct LaminateStiffness {
  Mat3 A, B, D;       // [force/length], [force], [force length]
  Eigen::Matrix2d S;  // [force/length]
};
LaminateStiffness laminate_stiffness(const LaminateLaw& law, double thickness);

}  // namespace meniscus::shell
