/// The shells of a case on its film, frozen.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/surface_nodes.h"
#include "core/monitor.h"
#include "evolve/frozen/film_model.h"
#include "fea/elastic/elasticity.h"
#include "pipeline/case_data/case.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

/// Facets of the meshed films, with the middles of their edges on the finer
/// film. Films that share a line share its nodes. Facets are turned as those of
/// walls are; the film takes its thickness along.
class ShellModel {
 public:
  /// On the settled film that `film` is frozen at, of the design `inputs`.
  /// Throws InvalidInput for shapes of thickness that its films do not have.
  ShellModel(const case_data::Case& input,
             const case_data::EvaluatedCase& inputs,
             const frozen::FilmModel& film);

  QuadraticSurface surface(const Points& film) const { return nodes_.at(film); }

  /// The part of a design on its film, without solutions. Throws InvalidInput
  /// for a thickness that is not above 0, and MeshError as check_shell().
  std::shared_ptr<ShellPart> part(const case_data::EvaluatedCase& inputs,
                                  const Points& film) const;

  /// part() transposed: by all points of the film, and by the numbers of each
  /// shell's thickness.
  Points to_film(const Points& by_nodes, std::size_t points) const;
  std::vector<VectorX> to_numbers(const case_data::EvaluatedCase& inputs,
                                  const std::vector<Vec3>& by_thickness) const;

 private:
  double thickness_at(std::size_t shell, Numbers numbers, const Vec3& at) const;

  SurfaceNodes nodes_;
  std::vector<int> section_;                 // per facet: its shell
  Points reference_;                         // per corner, of the frozen film
  std::vector<walls::WallSpec> specs_;       // thicknesses have their shapes
  std::vector<std::string> keys_;            // of thicknesses, for messages
  std::vector<std::vector<double>> shares_;  // per shell, of its layers
  std::vector<std::optional<Vec3>> directions_;  // as the case gives them
  std::map<std::string, shell::Line> rims_;      // as ShellPart has them
  std::map<std::string, Vec3> planes_;           // the same
};

/// `solve(k)` of each load case, adding to the solution; what cannot be solved
/// is its failure.
equations::ElasticSolution solve_load_cases(
    const case_data::EvaluatedCase& inputs, ShellPart& part,
    const std::function<void(std::size_t load_case,
                             equations::ElasticSolution& solution)>& solve);

/// Solves all load cases, those held alike with one factor. A shell that can
/// move is a failure. `monitor`: of large ones, also of what their systems
/// solve later; not owned, may be null.
equations::ElasticSolution solve_shell(const case_data::EvaluatedCase& inputs,
                                       ShellPart& part, Monitor* monitor);

}  // namespace meniscus::shells
