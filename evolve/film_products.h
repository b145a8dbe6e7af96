/// Products of the derivatives of L = E - sum pressure F with motions of all
/// vertices of a film, rims and caps included; without the bending of walls.
#pragma once

#include "evolve/energy.h"

namespace meniscus {

class FilmProducts {
 public:
  /// `pressure`: one per functional. References must outlive this.
  FilmProducts(const FilmEnergy& energy, const FilmTargets& targets,
               const VectorX& pressure);

  /// Second derivative x motion, one vector per vertex.
  Points hessian_times(const Points& points, const Points& motion) const;

  /// How fast each surface's area grows in the motion; 0 of caps.
  VectorX area_rates(const Points& points, const Points& motion) const;

 private:
  void add_facets(const Points& points, const Points& motion,
                  Points& sum) const;
  void add_terms(const Points& points, const Points& motion, Points& sum) const;

  const FilmEnergy& energy_;
  const FilmTargets& targets_;
  const VectorX& pressure_;
};

}  // namespace meniscus
