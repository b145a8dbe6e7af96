/// Displacements that supports and pins enforce.
#pragma once

#include "core/geometry/tet_mesh.h"
#include "fea/loads/adjoint_pair.h"
#include "fea/loads/load_case.h"

namespace meniscus::supports {

/// What nodes are held at by supports, held nodes and pins, 3 per node and 0
/// along free directions; on the nodes of pins that of their fixed motions.
/// Empty where everything is held at 0 [length]. Throws InvalidInput, naming
/// load case, surface and place, where two supports enforce different
/// displacements of one node.
VectorX enforced_displacement(const TetMesh& mesh,
                              const loads::LoadCase& load_case);

/// Adds to `by_number` the derivatives by all numbers that supports and pins of
/// the load case have: of J by enforced displacements, rotations and points,
/// through displacement and adjoint.
void add_enforced_gradient(const TetMesh& mesh,
                           const loads::LoadCase& load_case,
                           const loads::AdjointPair& pair,
                           loads::LoadCase& by_number);

/// Adds what the moving nodes of pins do to an adjoint gradient: nodes of a
/// pin that turns by w are displaced by w x dx.
void add_pin_gradient(const TetMesh& mesh, const loads::LoadCase& load_case,
                      const loads::AdjointPair& pair, Points& gradient);

}  // namespace meniscus::supports
