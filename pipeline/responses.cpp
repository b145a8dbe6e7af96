#include "pipeline/responses.h"

#include "fea/body_loads.h"

namespace meniscus {

namespace {

/// Half the work of the loads, where they all go into the solid.
double energy_of(const ResponseInput& fields, const LoadCase& load_case,
                 const VectorX& u) {
  const auto& materials = fields.numbers.materials;
  if (load_case.springs.empty() && !load_case.temperature) {
    return 0.5 * nodal_forces(fields.mesh, load_case, materials).dot(u);
  }
  return strain_energy(fields.mesh, materials, u,
                       temperature_change(fields.mesh, load_case));
}

double value_of(const ResponseEntry& response, const Vec3& direction,
                const ResponseInput& fields) {
  const auto load_case = static_cast<std::size_t>(response.load_case);
  const VectorX& u = fields.solution.displacements[load_case];
  const auto& materials = fields.numbers.materials;
  switch (response.kind) {
    case ResponseKind::MeanDisplacement:
      return mean_displacement(fields.mesh, response.surface, direction, u);
    case ResponseKind::Mass:
      return mesh_mass(fields.mesh, materials);
    case ResponseKind::Volume:
      return mesh_volume(fields.mesh);
    case ResponseKind::MaxVonMises:
      return load_case_stress(fields.mesh, fields.numbers, load_case, u,
                              fields.excluded)
          .max_von_mises;
    case ResponseKind::StrainEnergy:
      return energy_of(fields, fields.numbers.load_cases[load_case], u);
    case ResponseKind::FilmArea:
      return fields.film.area;
  }
  return 0.0;
}

}  // namespace

StressField load_case_stress(const TetMesh& mesh, const EvaluatedCase& numbers,
                             std::size_t load_case, const VectorX& u,
                             const std::vector<char>& excluded) {
  StressField field =
      recover_stress(mesh, numbers.materials, u,
                     temperature_change(mesh, numbers.load_cases[load_case]));
  if (!excluded.empty()) {
    find_peak(mesh, excluded, field);
  }
  return field;
}

VectorX respond(const Case& input, const ResponseInput& fields) {
  VectorX values(static_cast<Eigen::Index>(input.responses.size()));
  for (std::size_t k = 0; k < input.responses.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] = value_of(
        input.responses[k], fields.numbers.response_directions[k], fields);
  }
  return values;
}

int response_index(const Case& input, const std::string& name) {
  int index = 0;
  while (input.responses[static_cast<std::size_t>(index)].name != name) {
    ++index;
  }
  return index;
}

}  // namespace meniscus
