/// Responses: numbers that a case asks of an evaluated design.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evolve/frozen/film_model.h"
#include "fea/element/functional.h"
#include "fea/functionals/thickness.h"
#include "fea/stress/exclusion_zones.h"
#include "pipeline/case_data/case.h"
#include "pipeline/responses/response_modes.h"
#include "pipeline/responses/scans.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::responses {

/// What a design came to, on loan to the responses.
struct ResponseContext {
  const case_data::EvaluatedCase& inputs;
  const TetMesh& mesh;
  const equations::ElasticSolution& solution;
  const stress::Excluded& excluded;  // that figures of stress leave out
  // May be null for responses of displacements and of the mesh:
  const frozen::FilmModel* film = nullptr;
  const settle::FilmState* film_state = nullptr;
  const functionals::ThicknessPairs* pairs =
      nullptr;                               // thickness_pairs_of() the model
  const Scans* scans = nullptr;              // read_scans() of the case
  const ResponseModes* modes = nullptr;      // of the design
  const shells::ShellPart* shell = nullptr;  // of a case with shells
};

/// What a response changes by one load case, all else held. What is empty is
/// zero.
struct CasePartials {
  int load_case = 0;        // index
  VectorX by_displacement;  // 3 per node [value/length]; of shells 3 or 6
  /// Where by_displacement is K u times a number, that number: the adjoint is
  /// then so many displacements.
  double self_adjoint = 0.0;
  /// Of any but a response's first: by_displacement is so many times that of
  /// the first, whose supports are the same, and so is the adjoint.
  std::optional<double> of_first = {};
  VectorX by_forces;       // 3 per node, of shells 6 [value/force]
  VectorX by_temperature;  // per node [value/temperature]
  shell::ActionGradient by_actions = {};  // of shells, beside by_forces
};

/// One response's value and its partial derivatives, all else held. What is
/// empty is zero.
struct ResponsePartials {
  double value = 0.0;
  Points by_nodes;                  // of the mesh [value/length]
  std::vector<Vec3> by_thickness;   // of shells, at each facet's corners
  std::vector<CasePartials> cases;  // that it depends on the displacement of
  /// Of a load from any direction: the worst, where it acts most.
  std::optional<Vec3> worst_direction;
  Vec3 by_direction = Vec3::Zero();
  Vec3 by_point = Vec3::Zero();
  Points by_pin_point;  // of the response's load case: of its modes
  // Per region, of shells per layer; displacement held:
  std::vector<double> by_density;
  std::vector<double> by_modulus;  // Young's
  std::vector<double> by_angle;    // of shells [value/rad]
  frozen::FilmCovector film;
};

/// What a response of kind thickness compares in every design; empty without
/// one. `base`: the mesh at the design that the model is frozen at. Throws as
/// thickness_pairs().
functionals::ThicknessPairs thickness_pairs_of(const case_data::Case& input,
                                               const TetMesh& base);

/// One value per response of the case, in its order and units. Not finite
/// where the fields are not. Throws InvalidInput, naming file, line and key,
/// where an expression, a weight or a region has no value.
VectorX respond(const case_data::Case& input, const ResponseContext& fields);

/// `values` with the figures of films computed anew, and the expressions of
/// them: of another film of the design that they are of. The context may be
/// without mesh and solution. Throws as respond().
VectorX respond_films(const case_data::Case& input,
                      const ResponseContext& fields, VectorX values);

/// Of a response that is no expression of others. Throws InvalidInput for one
/// without derivatives (has_derivatives()) when they are asked for.
ResponsePartials partials_of(const case_data::ResponseEntry& response,
                             const case_data::ResponseInputs& inputs,
                             const ResponseContext& fields,
                             element::Derivatives derivatives);

/// What a weight or a region that moves with the design changes the response
/// by, all else held; `rates`: of `inputs`, by one design variable;
/// `worst_direction`: of its partials. Throws as respond().
double place_rate(const case_data::ResponseEntry& response,
                  const case_data::ResponseInputs& inputs,
                  const case_data::ResponseInputs& rates,
                  const std::optional<Vec3>& worst_direction,
                  const ResponseContext& fields);

}  // namespace meniscus::responses
