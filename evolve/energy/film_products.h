/// Products of the derivatives of L = E - sum pressure F with motions of all
/// vertices of a film, rims and caps included; without the bending of walls.
#pragma once

#include "evolve/energy/energy.h"

namespace meniscus::energy {

class FilmProducts {
 public:
  /// `pressure`: one per functional. `energy` must outlive this.
  FilmProducts(const FilmEnergy& energy, const films::FilmTargets& targets,
               VectorX pressure);
  /// Of - sum pressure F alone.
  FilmProducts(const FilmEnergy& energy, VectorX pressure);

  /// Second derivative x motion, one vector per vertex.
  Points hessian_times(const Points& points, const Points& motion) const;

  /// Gradient by all vertices of motion . (second derivative x motion), at
  /// the same motion. Exact for tension x area and volumes; of other terms
  /// differences along the motion, good to ten figures.
  Points third_times(const Points& points, const Points& motion) const;

  /// How fast each surface's area grows in the motion; 0 of caps.
  VectorX area_rates(const Points& points, const Points& motion) const;
  /// And how fast that rate grows: motion . (d2 area x motion).
  VectorX area_curvatures(const Points& points, const Points& motion) const;

  /// Per field (FilmTerm::field) the derivatives by its numbers: of motion .
  /// slope of E, of `energies` x E itself added; empty: it has none.
  std::vector<VectorX> number_slopes(const Points& points, const Points& motion,
                                     double energies) const;
  /// And of motion . (second derivative x motion), as third_times().
  std::vector<VectorX> number_curvatures(const Points& points,
                                         const Points& motion) const;
  /// How fast the slope of E changes as the numbers do, one list per field.
  Points number_motion(const Points& points,
                       const std::vector<VectorX>& rates) const;

  /// Gradient by all vertices of sum weight x lumped area, one weight per
  /// unknown.
  Points metric_gradient(const Points& points, const VectorX& weight) const;

 private:
  /// Per surface: the sum of `of_facet`(frame, its motion, corners' motion).
  template <class OfFacet>
  VectorX over_films(const Points& points, const Points& motion,
                     const OfFacet& of_facet) const;
  template <class OfJet>
  void over_bent(const Points& points, const Points& motion, JetOrder order,
                 const OfJet& of_jet) const;
  void add_facets(const Points& points, const Points& motion,
                  Points& sum) const;
  void add_bent(const Points& points, const Points& motion, double factor,
                Points& sum) const;
  void add_terms(const Points& points, const Points& motion, double factor,
                 Points& sum) const;
  double weight_of(int functional) const;
  bool has_terms() const;
  template <class Each>
  void over_numbers(const Each& each) const;
  template <class Add>
  static void over_chunks(const FilmTerm& term, const Add& add, VectorX& sum);
  void add_number_slopes(const Points& points, const Points& motion,
                         double factor, std::vector<VectorX>& sum) const;
  std::vector<VectorX> no_numbers() const;
  double term_step(const Points& points, const Points& motion) const;

  const FilmEnergy& energy_;
  VectorX tension_;               // one per surface
  std::vector<VectorX> numbers_;  // films::FilmTargets::numbers
  double energies_;               // factor of E's other terms
  VectorX pressure_;
};

}  // namespace meniscus::energy
