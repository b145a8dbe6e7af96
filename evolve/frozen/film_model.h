/// The frozen film. Start complex, grooming and equilibrium act once, at the
/// initial design, and fix triangulation and a reference film that the
/// boundary curves carry. For any later design each free film vertex moves
/// along its own fixed direction on the carried reference film, so that the
/// film is a unique smooth function of the design (docs/theory).
///
///   x_i(p) = X_i(p) + h_i n_i(p),   X(p) = X(p0) + C (r(p) - r(p0))
///
/// r: rim points on the curves at fixed curve parameters; C: constant harmonic
/// weights, rows summing to one (evolve/frozen/carry.h); n_i: unit vertex
/// normal of X(p); h: minimises tension x area and the field energies over the
/// film at the bodies' volumes and pressures. Lines where films meet have two
/// directions, points where lines do three, and X follows them to first order
/// (evolve/frozen/line_lead.h). Tensions and the numbers of fields may change
/// with the design, the fields' formulas stay those of the initial one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/surface_nodes.h"
#include "core/monitor.h"
#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"
#include "evolve/frozen/film_gradient.h"
#include "evolve/settle/film_state.h"

namespace meniscus::frozen {

struct FilmModelOptions {
  double edge = 0.0;    // target edge of the meshed film [length], > 0
  int refinements = 1;  // nested 1:4 refinements up to the film's own mesh
  /// A settled film of the system to begin from in the place of first facets,
  /// at about `edge`: meshed_at() of another model. On loan; null: none.
  const films::FilmComplex* start = nullptr;
  /// The first facets are a film at rest: Newton along normals alone, so that
  /// vertices stay where they are in the film.
  bool at_rest = false;
  Monitor* monitor = nullptr;
};

/// Planes on which films slide.
struct SlidingPlanes {
  struct Plane {
    std::string face;  // the cap that it was made for, the first of several
    Vec3 normal = Vec3::UnitZ();  // unit, either way
  };
  std::vector<Plane> planes;
  std::vector<std::vector<int>> at;  // per vertex: of `planes`, those that it
                                     // stays in
};

class FilmModel {
 public:
  /// Freezes a model at `initial`. Throws InvalidInput for a system that
  /// cannot be built (open body, unknown curve, curve off the hull). A film
  /// that cannot be found or is unstable is reported by reference().failure,
  /// and the model must then not be used further.
  static FilmModel freeze(const films::FilmSystem& initial,
                          const FilmModelOptions& options);

  /// The same film on its own facets with edges half as long, for the error of
  /// its figures: a model frozen at the design that `state` was settled for,
  /// with the margins' scale of this one. A film that is not there on these
  /// facets is in reference().failure. `monitor` may be null. Throws as
  /// complex_at(), and InvalidInput for a model without liquid.
  FilmModel refined(const settle::FilmState& state,
                    const films::FilmSystem& system, Monitor* monitor) const;

  /// The settled film at the initial design.
  const settle::FilmState& reference() const;

  /// Edge length of the start that the reference was found from [length].
  double start_edge() const;

  /// Equilibrium for another design of the same system; a pure function of
  /// the model and `system`, and may run in several threads. A film that is
  /// not found is in the state's failure, not thrown. Throws InvalidInput for
  /// names, kinds and fields that are not the model's, for numbers that no film
  /// can follow (radius, tension or volume not above 0, anything not finite),
  /// and for a model that has no film at its initial design.
  settle::FilmState settle(const films::FilmSystem& system,
                           const settle::SettleOptions& options = {}) const;

  /// The closed surface for meshing, from any state's points: corners at the
  /// meshed resolution, mid-sides from the finer film (on straight edges when
  /// refinements = 0). Labels are the names of films and caps; of several
  /// bodies, facet_bodies has the regions of material (voids left out and not
  /// counted). Linear in `points` with constant weights.
  QuadraticSurface surface(const Points& points) const;

  /// Halves the edges of the marked facets (one char per facet of surface()) in
  /// all that surface() gives from now on: for adaptive meshes, before anything
  /// is built on it. New corners are vertices of the film's first refinement;
  /// their mid-sides lie on the film where it has two. Throws MeshError where
  /// it has none.
  void split_facets(const std::vector<char>& marked);

  /// surface() transposed: dJ/dx by every vertex of the film, from dJ by the
  /// surface's corners (base.points) and mid-sides, one each.
  Points transpose_surface(const Points& by_corners,
                           const Points& by_mid_sides) const;

  /// Total derivatives by the design, of responses that are given by their
  /// derivatives by the settled film: settle() transposed (docs/theory.md, The
  /// film's adjoint). `state`: of settle(system), not failed. Costs one
  /// factorisation, and per response two solves. Pure, may run in several
  /// threads. Throws InvalidInput for a state that failed or is not this
  /// model's, and for lists that do not fit.
  std::vector<FilmGradient> transpose(
      const settle::FilmState& state, const films::FilmSystem& system,
      const std::vector<FilmCovector>& responses) const;

  /// How fast the film's points move with design variables, `rates` of each as
  /// rate() wants them: settle() differentiated forwards. Worth it where many
  /// responses meet few variables; one factorisation, and a solve for each.
  /// Throws as transpose() and rate().
  std::vector<Points> tangents(
      const settle::FilmState& state, const films::FilmSystem& system,
      const std::vector<films::FilmSystem>& rates) const;

  /// dJ along one design variable: `rates` is `system` with each number's
  /// derivative in its place (curves of the same kinds, tensions, volumes,
  /// pressures; fields and tension fields are the model's and not read). A
  /// parametric curve's rates are expressions of t.
  double rate(const FilmGradient& gradient, const films::FilmSystem& system,
              const films::FilmSystem& rates) const;

  /// Area per label of fine_mesh(); 0 for caps [length^2].
  VectorX areas(const Points& points) const;
  const std::vector<std::string>& labels() const;

  /// Margin to collapse of a state of settle(system) [force/length^3], with
  /// its derivatives for transpose(). Throws as that does, and InvalidInput for
  /// options out of range.
  FilmResponse margin(const settle::FilmState& state,
                      const films::FilmSystem& system,
                      const MarginOptions& options = {}) const;

  /// Smallest radius of curvature of the films (evolve/frozen/film_radius.h)
  /// [length], with its derivatives.
  FilmResponse smallest_radius(const Points& points, int power = 16) const;

  /// Least distance of two films (evolve/frozen/gap_between.h) [length], with
  /// its derivatives.
  FilmResponse gap(const Points& points, const std::string& film,
                   const std::string& other, double smoothing) const;

  /// All facets at the film's own resolution (caps included), for files and
  /// pictures.
  SurfaceMesh fine_mesh(const Points& points) const;

  /// Those of them that bound material, with the regions on their sides, as
  /// surface() has them. Points as fine_mesh().
  SurfaceMesh solids(const Points& points) const;

  /// The same without interfaces between regions: closed surfaces.
  SurfaceMesh boundary(const Points& points) const;

  /// The finest complex at a state of settle(system): its points, on the
  /// design's curves, with its tensions, volumes and pressures. Throws
  /// InvalidInput for a state that failed or is not this model's.
  films::FilmComplex complex_at(const settle::FilmState& state,
                                const films::FilmSystem& system) const;

  /// The meshed level of complex_at(): what a model of that design begins from
  /// (FilmModelOptions::start). Throws likewise.
  films::FilmComplex meshed_at(const settle::FilmState& state,
                               const films::FilmSystem& system) const;

  /// Facets of the meshed level, caps and voids included: for what else is
  /// made of the films. It has no points; corners are vertices of the film.
  SurfaceMesh meshed_facets() const;

  /// The film's vertices between others, of every refinement from the meshed
  /// level to the fine one.
  EdgeMiddles middles() const;
  int refinements() const;

  /// Vertices of the fine mesh on a curve; none for a curve that the model has
  /// not.
  std::vector<int> rim(const std::string& curve) const;
  /// Their parameters t on it, in the same order.
  std::vector<double> rim_parameters(const std::string& curve) const;

  /// Of the fine mesh, the ends of curves that a plane cuts included.
  SlidingPlanes sliding_planes() const;

  FilmModel(FilmModel&&) noexcept;
  FilmModel& operator=(FilmModel&&) noexcept;
  ~FilmModel();

 private:
  struct Impl;
  explicit FilmModel(std::unique_ptr<Impl> impl);
  static FilmModel finish(std::unique_ptr<Impl> impl,
                          const films::FilmSystem& initial,
                          const settle::SettleOptions& settle);
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::frozen
