/// Exact displacement fields: their stress, the loads they need, and how far a
/// finite-element solution is from them.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "core/math/dual.h"
#include "fea/element/elastic_law.h"
#include "fea/loads/loads.h"

namespace meniscus::exact {

using Dual = BasicDual<3>;
using DualVec = std::array<Dual, 3>;
/// Displacement as a function of the place.
using Displacement = std::function<DualVec(const DualVec&)>;

struct State {
  Vec3 u;
  element::Stress stress;
  Vec3 body_force;  // -div stress
};

/// A field in an isotropic material.
class Field {
 public:
  Field(const element::Material& material, Displacement displacement);
  State at(const Vec3& x) const;
  const element::Material& material() const { return material_; }

 private:
  element::Material material_;
  element::Lame lame_;
  Displacement displacement_;
};

/// Nodal forces of the field's tractions on the surfaces, and of its body
/// force in the volume if `with_body_force`; by rules of degree five.
enum class BodyForce { None, Included };
VectorX loads(const TetMesh& mesh, const Field& field,
              const std::vector<std::string>& surfaces, BodyForce body);

/// Mean of u . direction over a surface, by a rule of degree five.
double mean_displacement(const TetMesh& mesh, const Field& field,
                         const std::string& surface, const Vec3& direction);

/// Root of integrals over the mesh; energies are a(e, e).
struct Norms {
  double l2 = 0.0, energy = 0.0;              // of the error
  double l2_exact = 0.0, energy_exact = 0.0;  // of the field
};
Norms error_norms(const TetMesh& mesh, const Field& field, const VectorX& u);

/// Lame: pressure in the bore of a thick cylinder about z, plane strain.
Field thick_cylinder(const element::Material& material, double a, double b,
                     double pressure);

/// Lame: pressure inside a thick sphere.
Field thick_sphere(const element::Material& material, double a, double b,
                   double pressure);

/// Kirsch: circular hole of radius `a` about z in a plate pulled along x,
/// plane strain.
Field hole_in_plate(const element::Material& material, double a, double pull);

/// Golovin: a quarter of a ring a < r < b about z bent by opposite moments on
/// its ends (x = 0 and y = 0, which keeps its plane), per length along z;
/// tension inside, plane strain.
Field bent_ring(const element::Material& material, double a, double b,
                double moment);

/// Goodier: spherical cavity of radius 1 in a solid pulled along z. Built from
/// Kelvin's doublet and a harmonic quadrupole; the three constants follow from
/// a cavity free of traction.
Field spherical_cavity(const element::Material& material, double pull);

}  // namespace meniscus::exact
