/// Derivatives by the numbers of a load case.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

/// d(v . f) by each number of a load case at fixed mesh and v, once for any
/// number of design variables: a load case whose numbers are the derivatives
/// and, for fields, the places where they are asked and what each value counts.
struct LoadGradient {
  LoadCase by_number;
  struct NumberField {
    Points places;
    std::vector<double> weights;
  };
  struct VectorField {
    Points places;
    Points weights;
  };
  std::vector<NumberField> pressures;  // of each; empty without a field
  std::vector<VectorField> tractions;  // the same
  NumberField temperature;             // the same
};

/// Some number of the loads does, or a field may; supports and springs aside.
bool changes(const LoadCase& rates);

/// `v`: 3 per node; an adjoint, say. Throws as nodal_forces().
LoadGradient load_gradient(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const LoadCase& load_case, const VectorX& v);

/// Adds a functional's derivative by the nodes' temperatures (functional.h's
/// by_temperature; empty: nothing), so that load_rate() tells it, too.
void add_temperature_gradient(const TetMesh& mesh, const LoadCase& load_case,
                              const VectorX& by_temperature,
                              LoadGradient& gradient);

/// v . df for `rates`: a load case with the same loads in the same order, every
/// number (and value of a field) its derivative by one design variable. A
/// rate of a field may be a number: it is the same everywhere. Of supports and
/// pins the enforced numbers count, where the gradient has them
/// (supports/enforced.h); a model's springs are its base's. Throws InvalidInput
/// where loads differ in count, or a field stands for a number's rate.
double load_rate(const LoadGradient& gradient, const LoadCase& rates);

}  // namespace meniscus::loads
