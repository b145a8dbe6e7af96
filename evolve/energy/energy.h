/// The energy of a film complex and the functionals it holds (volumes of
/// bodies, held quantities): values, gradients, and Hessians along given
/// directions on a pattern that is built once. Sums run in facet order: same
/// input, same bits.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/math/linear_solve.h"
#include "evolve/energy/film_space.h"
#include "evolve/energy/film_terms.h"
#include "evolve/films/film_complex.h"
#include "evolve/films/film_targets.h"

namespace meniscus::energy {

/// What a Hessian asks of walls where films slide.
struct WallBends {
  Points gradient;  // of E - sum pressure F, one per vertex; empty: no walls
  /// d2x/dh2 of each unknown (FilmPaths::second); null: of a film that is where
  /// its directions begin.
  const Points* second = nullptr;
};

class FilmEnergy {
 public:
  /// Takes the topology of `complex` (facets, kinds, sides of bodies), its
  /// walls and its terms, no positions. Throws MeshError for a facet corner
  /// out of range.
  explicit FilmEnergy(const films::FilmComplex& complex,
                      FilmMotion motion = FilmMotion::NormalSpace);
  ~FilmEnergy();
  FilmEnergy(FilmEnergy&&) noexcept;
  FilmEnergy& operator=(FilmEnergy&&) noexcept;

  const FilmSpace& space() const { return space_; }
  int unknowns() const { return space_.unknowns(); }
  const std::vector<int>& vertices() const { return space_.vertices(); }
  /// Bodies, then held quantities.
  int functionals() const { return functional_count_; }
  int bodies() const { return body_count_; }
  const std::vector<Triangle>& facets() const { return facets_; }
  bool is_liquid(int facet) const { return liquid_[label_[facet]] != 0; }
  /// Sign of a facet in a body: +1 normal out of it, -1 into it, 0 elsewhere.
  int side(int facet, int body) const {
    return body < body_count_ ? side_[label_[facet]][body] : 0;
  }

  /// Energy: tension x area, of wetted walls too, and every other term
  /// [force length].
  double value(const Points& points, const films::FilmTargets& targets) const;
  /// Area of the films [length^2].
  double area(const Points& points) const;
  /// Signed volumes of the bodies [length^3], then the held quantities.
  VectorX volumes(const Points& points) const;
  /// Value of every quantity of the complex.
  VectorX quantities(const Points& points,
                     const films::FilmTargets& targets) const;

  /// dE/dx, one per vertex [force]; boundary vertices included.
  Points gradient(const Points& points,
                  const films::FilmTargets& targets) const;
  /// dF/dx of one functional, one per vertex.
  Points functional_gradient(const Points& points, int functional) const;

  /// Per surface its area, 0 of caps that wet no wall [length^2]; gradient of
  /// sum weight x area.
  VectorX areas(const Points& points) const;
  Points area_gradient(const Points& points, const VectorX& weight) const;
  /// False: caps, and films whose tension is a field or turns with them.
  bool has_tension(int surface) const { return tense_[surface] != 0; }

  /// What of a gradient (one per vertex) runs along each unknown's direction.
  VectorX along(const Points& slope, const Points& directions) const;

  /// Elements of the Hessian of E - sum pressure F along `directions`, packed:
  /// per facet the lower triangle over its corners' unknowns.
  void elements(const Points& points, const Points& directions,
                const films::FilmTargets& targets, const VectorX& pressure,
                const WallBends& bends, std::vector<double>& out) const;
  /// Scatters elements into `out`, which must come from pattern().
  void assemble(const std::vector<double>& elements, SparseMatrix& out) const;
  /// Lower triangle of the Hessian [force/length]. `bends`: as
  /// FilmPaths::second; null: of a film that is where its directions begin.
  void hessian(const Points& points, const Points& directions,
               const films::FilmTargets& targets, const VectorX& pressure,
               SparseMatrix& out, const Points* bends = nullptr) const;
  const SparseMatrix& pattern() const { return pattern_; }
  /// Fill-reducing order of pattern(), found at the first call.
  const std::vector<int>& order() const;

  /// vertices() in that order, each where the first of its unknowns comes.
  std::vector<int> vertex_order() const;

  struct Corner {
    int corner;
    int unknown;
  };
  const std::vector<int>& corner_start() const { return corner_start_; }
  const std::vector<Corner>& corners() const { return corners_; }
  const std::vector<int>& element_start() const { return element_start_; }

  /// A third of the area of the films' facets around each unknown's vertex.
  VectorX lumped_area(const Points& points) const;
  /// Smallest cosine between a film facet's normals at `points` and at `base`;
  /// `facet` receives where. Negative: folded.
  double smallest_cosine(const Points& points, const Points& base,
                         int* facet = nullptr) const;
  /// Mean length of the films' edges [length].
  double mean_edge(const Points& points) const;

  /// Motions of floating parts that change nothing, along `directions`, each
  /// weighted by `metric`: columns that span them (none: no columns).
  Eigen::MatrixXd rigid_motions(const Points& points, const Points& directions,
                                const VectorX& metric) const;

 private:
  friend class FilmProducts;  // motions x derivatives
  Vec3 cone_origin(const Points& points) const;
  /// The normal that a facet's area counts along; null: its own.
  const Vec3* flat(int facet) const {
    const std::optional<Vec3>& normal = flat_[label_[facet]];
    return normal ? &*normal : nullptr;
  }
  /// The area of a surface on a bent wall.
  struct BentArea {
    int surface = 0;
    std::unique_ptr<FilmTerm> term;
    std::vector<FilmTerm::Element> elements;
  };
  void add_bent_area(const films::FilmComplex& complex, int surface);
  FacetJet jet_of(const BentArea& area, const FilmTerm::Element& element,
                  const Points& points, JetOrder order) const;
  std::vector<double> pressure_jumps(const VectorX& pressure) const;
  /// Calls each(element, jet) for the elements of a term, in order. `numbers`:
  /// of its field.
  template <class Each>
  void over_term(const FilmTerm& term, const Points& points, JetOrder order,
                 Numbers numbers, const Each& each) const;
  /// Of those alone that are `wanted`.
  template <class Wanted, class Each>
  void over_term(const FilmTerm& term, const Points& points, JetOrder order,
                 Numbers numbers, const Wanted& wanted, const Each& each) const;
  void add_term_gradients(const Points& points, int functional,
                          const std::vector<VectorX>& numbers,
                          Points& sum) const;
  void find_floating(const films::FilmComplex& complex);
  void build_pattern();
  void add_terms(const Points& points, const std::vector<VectorX>& numbers,
                 const VectorX& pressure, const Points& directions,
                 std::vector<double>& out) const;
  void add_wall_curvature(const Points& points, const Points& directions,
                          const Points& gradient,
                          std::vector<double>& out) const;
  void add_bends(const WallBends& bends, std::vector<double>& out) const;
  void add_jet(int facet, double factor, const FacetJet& jet,
               const Points& directions, std::vector<double>& out) const;
  void add_block(int facet, int corner_a, int corner_b,
                 const Eigen::Matrix3d& block, const Points& directions,
                 std::vector<double>& out) const;

  FilmSpace space_;
  std::vector<Triangle> facets_;
  std::vector<int> label_;
  std::vector<char> liquid_;   // per surface
  std::vector<char> counted_;  // per surface: liquid or wetted on a plane
  std::vector<std::optional<Vec3>> flat_;  // per surface: along what normal
  std::vector<BentArea> bent_;
  std::vector<char> plain_;             // per surface: tension is a number
  std::vector<char> tense_;             // per surface: so, or on a bent wall
  std::vector<std::vector<int>> side_;  // per surface, per body
  std::vector<char> cone_;              // per body: cones measure it
  bool open_cones_ = false;             // of a body that facets do not close
  VectorX volume_offset_;
  std::vector<std::unique_ptr<FilmTerm>> terms_;
  int body_count_ = 0;
  int functional_count_ = 0;
  int quantity_count_ = 0;
  std::vector<double> modulus_;  // per quantity: what its terms carry
  std::vector<int> floating_;    // per unknown: floating part, or -1
  int floating_count_ = 0;
  bool resisted_ = false;        // by fields in space: nothing floats
  Vec3 gravity_ = Vec3::Zero();  // zero where nothing has weight
  /// Per floating part: what of rotations its films' tensions resist.
  std::vector<Eigen::Matrix3d> turn_resistance_;
  std::vector<int> corner_start_;  // per facet: into corners_
  std::vector<Corner> corners_;
  std::vector<int> element_start_;  // per facet: into elements
  std::vector<int> slots_;          // element entry -> pattern
  SparseMatrix pattern_;
  mutable std::vector<int> order_;
};

}  // namespace meniscus::energy
