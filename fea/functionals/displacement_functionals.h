/// Displacements of a surface as functionals (functional.h). All throw
/// InvalidInput: a surface that is unknown or has no area, a direction without
/// length, displacements that do not fit the mesh.
#pragma once

#include <string>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"
#include "fea/loads/load_case.h"

namespace meniscus::functionals {

/// mean_displacement() (loads.h): (1/A) int u . d dA [length].
element::DirectedFunctional mean_displacement_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& direction,
    const VectorX& displacement,
    element::Derivatives derivatives = element::Derivatives::All);

/// (1/A) int w(x) u . d dA by seven points a face [length x weight]. Divided by
/// the area, not by the weight's integral, so that a weight may change its
/// sign and measure a tilt.
element::DirectedFunctional weighted_displacement_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& direction,
    const loads::SlopedField& weight, const VectorX& displacement,
    element::Derivatives derivatives = element::Derivatives::All);

/// ((1/A) int |u . d|^p dA)^(1/p) by seven points a face [length]; p >= 2.
element::DirectedFunctional displacement_norm_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& direction,
    double power, const VectorX& displacement,
    element::Derivatives derivatives = element::Derivatives::All);

/// Angle by which a surface turns about `axis` (made unit), right-handed: the
/// component along it of the rigid rotation that fits the nodes' displacement
/// best, weighted by area [rad]. What a remote moment (RemoteLoad) works on.
element::DirectedFunctional rotation_functional(
    const TetMesh& mesh, const std::string& surface, const Vec3& axis,
    const VectorX& displacement,
    element::Derivatives derivatives = element::Derivatives::All);

}  // namespace meniscus::functionals
