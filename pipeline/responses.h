/// Responses: numbers that a case asks of an evaluated design.
#pragma once

#include "evolve/film_model.h"
#include "pipeline/case.h"

namespace meniscus {

/// What a design came to, on loan to the responses.
struct ResponseInput {
  const EvaluatedCase& numbers;
  const FilmReport& film;
  const TetMesh& mesh;
  const ElasticSolution& solution;
  const std::vector<char>& excluded;  // that peaks leave out; may be empty
};

/// One value per response of the case, in its order and units. Not finite
/// where the fields are not.
VectorX respond(const Case& input, const ResponseInput& fields);

/// Nodal stresses of one load case, its expansion taken out. `u`: 3 per node;
/// `excluded`: one char per element that the peak leaves out, or empty.
StressField load_case_stress(const TetMesh& mesh, const EvaluatedCase& numbers,
                             std::size_t load_case, const VectorX& u,
                             const std::vector<char>& excluded = {});

/// Position of a response of the case; it must exist.
int response_index(const Case& input, const std::string& name);

}  // namespace meniscus
