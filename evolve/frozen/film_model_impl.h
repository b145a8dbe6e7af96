/// What a FilmModel holds: shared by the sources that implement it, included
/// nowhere else.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/surface_nodes.h"
#include "evolve/energy/energy.h"
#include "evolve/frozen/carry.h"
#include "evolve/frozen/film_adjoint.h"
#include "evolve/frozen/film_model.h"
#include "evolve/frozen/line_lead.h"

namespace meniscus::frozen {

struct FilmModel::Impl {
  films::FilmComplex complex;    // finest level, at the reference film
  std::vector<Edge> parents;     // of the refinements' new vertices
  std::size_t near_parents = 0;  // of the first two refinements
  int refinements = 0;
  SurfaceMesh meshed;                 // the meshed level at the reference film
  films::FilmComplex meshed_complex;  // the same with all it is made of
  std::optional<energy::FilmEnergy> energy;
  std::optional<Carry> carry;
  std::unique_ptr<const LineLead> lead;  // null: no lines that move
  films::FilmTargets targets;
  settle::FilmState reference;
  /// What settle() was asked for when it found the reference.
  std::optional<films::FilmTargets> reference_goal;
  double usual_neck = 0.0;    // of the reference [length]
  double margin_scale = 0.0;  // lowest eigenvalue that margins are smooth by
  double start_edge = 0.0;    // of the start that it was found from [length]
  std::vector<int> regions;   // per body, -1: void
  SurfaceNodes nodes;         // the meshed level's, facets split

  /// What a film rests on, beside its points and heights.
  struct AtRest {
    films::FilmTargets targets;
    Points base;        // X
    Points directions;  // n(X)
    energy::FilmPaths paths;
    VectorX pressure;  // one per functional
  };

  films::FilmTargets targets_of_system(const films::FilmSystem& system) const;
  const films::FilmWall& wall_of(const films::FilmSystem& system,
                                 int surface) const;
  void check_fields(const films::FilmSystem& system) const;
  static VectorX scalar_numbers(const films::FilmSystem& system,
                                std::size_t quantity);
  /// The poles of one of its quantities, of the spines of a design.
  std::vector<films::Pole> poles_of(const films::FilmSystem& system,
                                    std::size_t quantity) const;
  /// The spines of a complex that another design left, sampled anew for this
  /// one: their arms may be slimmer now.
  static void sample_spines(const films::FilmSystem& system,
                            films::FilmComplex& complex);
  /// How fast the numbers of each field change (films::FilmTargets::numbers).
  std::vector<VectorX> number_rates(const films::FilmSystem& system,
                                    const films::FilmSystem& rates) const;
  std::vector<curves::Curve> curves_of_system(
      const films::FilmSystem& system) const;
  void find_reference(const films::FilmSystem& initial,
                      const FilmModelOptions& options,
                      const settle::SettleOptions& settle);
  /// The same, from first facets of that edge, coarse ones where halvings are
  /// to come.
  void find_reference_from(double edge, int halvings,
                           const films::FilmSystem& initial,
                           const FilmModelOptions& options,
                           const settle::SettleOptions& settle);
  /// The same from `first`, of that many halvings to come.
  void settle_reference(const films::FilmComplex& first, double edge,
                        int halvings, const films::FilmSystem& initial,
                        const FilmModelOptions& options,
                        const settle::SettleOptions& settle);
  /// The complex as it is, along its normals.
  void settle_level(const settle::SettleOptions& settle);
  /// Nested refinements of the settled complex, settled one by one.
  /// `may_groom`: their vertices may be spread anew where facets are slivers.
  void refine_and_settle(int levels, bool may_groom,
                         const settle::SettleOptions& settle);
  /// A complex of the model's at a design.
  films::FilmComplex at_design(films::FilmComplex complex,
                               const settle::FilmState& state,
                               const films::FilmSystem& system) const;
  void build_rigid(const films::FilmSystem& initial,
                   const FilmModelOptions& options);
  /// One level finer; keeps the new vertices' parents.
  void refine_once(int level);
  settle::FilmState rigid_state(const Points& points,
                                const films::FilmTargets& goal) const;
  EdgeMiddles middles(std::size_t count) const;
  std::vector<char> straight() const;
  /// A state that settle() gave for `system`. Throws InvalidInput for others.
  AtRest at_rest(const settle::FilmState& state,
                 const films::FilmSystem& system) const;
  void check_response(const FilmCovector& response) const;
  void lead_lines(const films::FilmSystem& initial);
  /// X for `fraction` of the way from the reference to a design.
  Points base_at(const Points& rim_moves, const films::FilmTargets& goal,
                 double fraction) const;
  /// From derivatives by X, and by the rest at fixed X.
  FilmGradient gradient_of(FilmAdjoint::Result found) const;
  std::vector<RimGradient> rim_gradients(const Points& by_rim) const;
  std::vector<FilmGradient> rigid_gradients(
      const std::vector<FilmCovector>& responses) const;
  FilmAdjoint::Rates rates_of(const films::FilmSystem& system,
                              const films::FilmSystem& rates) const;
  /// At `t` of the way from the reference to a design, from the film of those
  /// heights.
  settle::FilmState settle_on_the_way(
      const Points& moves, const films::FilmTargets& goal, double t,
      const VectorX& heights, const settle::SettleOptions& options) const;
  /// Where lines run together on the way to a design that has no film; nothing
  /// where they do not.
  std::optional<Failure> lines_that_meet(
      const Points& moves, const films::FilmTargets& goal,
      const settle::SettleOptions& options) const;
  settle::FilmState settle_in_parts(const Points& moves,
                                    const films::FilmTargets& goal, int parts,
                                    const settle::SettleOptions& options) const;
};

}  // namespace meniscus::frozen
