/// Tension x area and body volumes of a film complex along given directions:
/// values, gradients, and Hessians on a pattern that is built once.
///
/// An unknown is a pair (vertex, direction): its vertex moves by h d. Now one
/// unknown per free vertex; nothing here assumes that, so triple lines can
/// have two and quadruple points three. Sums run in facet order: same input,
/// same bits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/linear_solve.h"
#include "evolve/film_complex.h"

namespace meniscus {

/// What is asked of the liquid: the numbers that change with the design.
struct FilmTargets {
  std::vector<double> tension;      // one per surface [force/length]; caps 0
  std::vector<ComplexBody> bodies;  // volume or pressure asked
};

FilmTargets targets_of(const FilmComplex& complex);

class FilmEnergy {
 public:
  /// Takes the topology of `complex` (facets, kinds, sides of bodies), no
  /// positions. Throws MeshError for a facet corner out of range.
  explicit FilmEnergy(const FilmComplex& complex);

  int unknowns() const { return static_cast<int>(vertex_.size()); }
  int bodies() const { return body_count_; }
  const std::vector<int>& vertices() const { return vertex_; }  // per unknown
  const std::vector<Triangle>& facets() const { return facets_; }
  bool is_liquid(int facet) const { return liquid_[facet] != 0; }
  /// Sign of a facet in a body: +1 normal out of it, -1 into it, 0 elsewhere.
  int side(int facet, int body) const { return side_[facet][body]; }
  /// Per unknown: number of the film component that no curve holds, else -1.
  const std::vector<int>& floating() const { return floating_; }
  int floating_count() const { return floating_count_; }

  /// Sum of tension x area [force length].
  double value(const Points& points, const std::vector<double>& tension) const;
  /// Area of the films [length^2].
  double area(const Points& points) const;
  /// Signed volumes, one per body [length^3].
  VectorX volumes(const Points& points) const;

  /// dE/dx at the unknowns' vertices, one row each [force].
  Eigen::MatrixX3d gradient(const Points& points,
                            const std::vector<double>& tension) const;
  /// dV/dx of one body at the unknowns' vertices, one row each [length^2].
  Eigen::MatrixX3d volume_gradient(const Points& points, int body) const;

  /// Lower triangle of the Hessian of E - sum pressure x V along
  /// `directions` (one unit vector per unknown) [force/length]. `out` must
  /// come from pattern(); its values are overwritten.
  void hessian(const Points& points, const Points& directions,
               const std::vector<double>& tension, const VectorX& pressure,
               SparseMatrix& out) const;
  const SparseMatrix& pattern() const { return pattern_; }
  /// Fill-reducing order of pattern(), found once.
  const std::vector<int>& order() const { return order_; }

  /// Unit area-weighted normals of the films at the unknowns' vertices; zero
  /// where the films cancel.
  Points normals(const Points& points) const;
  /// A third of the area of the films' facets around each unknown's vertex.
  VectorX lumped_area(const Points& points) const;
  /// Smallest cosine between a film facet's normal and the mean of its
  /// unknowns' directions; `facet` receives where. Negative: folded.
  double smallest_cosine(const Points& points, const Points& directions,
                         int* facet = nullptr) const;
  /// Mean length of the films' edges [length].
  double mean_edge(const Points& points) const;

  /// points + h d at every unknown's vertex.
  Points moved(const Points& points, const Points& directions,
               const VectorX& heights) const;

 private:
  struct Corner {
    int corner;
    int unknown;
  };
  void find_floating(const FilmComplex& complex);
  void build_pattern();

  std::vector<Triangle> facets_;
  std::vector<int> label_;
  std::vector<char> liquid_;
  std::vector<std::vector<int>> side_;  // per facet, per body
  std::vector<int> vertex_;
  std::vector<int> floating_;
  int floating_count_ = 0;
  int body_count_ = 0;
  std::vector<int> corner_start_;  // per facet: into corners_
  std::vector<Corner> corners_;
  std::vector<int> slot_start_;  // per facet: into slots_
  std::vector<int> slots_;       // position in the pattern, pairs j <= i
  SparseMatrix pattern_;
  std::vector<int> order_;
};

}  // namespace meniscus
