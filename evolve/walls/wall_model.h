/// Walls frozen on a film: thickness, corrections and the order of films about
/// junctions are found once, and the walls of every other design follow their
/// film smoothly.
///
///   y_k(p) = x_v(p) + sum_w t_wv(p) / t_wv(0) *
///            ( sum_f c_kf n_f(p) + sum_j b_kj (x_j(p) - x_v(p)) + e_k )
///
/// y_k: a point of a wall over film vertex v; w: the walls that meet there,
/// t_wv their thickness where v was on that film; n_f: unit normals of the
/// facets about v that look into its sector (wall_topology.h), x_j the vertices
/// next to v. c, b and the tiny rest e, one set per w, are constants that give
/// the offset found at the reference film exactly, so that the wall turns with
/// its film. Where v slides on planes the sum is brought into them
/// (wall_planes.h) by n, the unit sum of these normals by angle.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/surface_nodes.h"
#include "evolve/frozen/film_model.h"
#include "evolve/walls/wall_reference.h"
#include "evolve/walls/wall_spec.h"
#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// A response's derivatives by what walls are made of.
struct WallGradient {
  Points film;                     // by the film's points
  std::vector<VectorX> thickness;  // by the numbers of each wall's
};

class WallModel {
 public:
  /// On the film `points` of a state of `film`; `system`: its own. A film's
  /// normals point away from the middle of its rim (of a flat film along its
  /// curve's normal). Throws InvalidInput and MeshError as wall_reference().
  static WallModel freeze(const frozen::FilmModel& film,
                          const films::FilmSystem& system, const Points& points,
                          const std::vector<WallSpec>& walls,
                          SafePlaces places = SafePlaces::Worst);

  WallModel(const WallFilms& films, std::vector<WallSpec> walls,
            SafePlaces places = SafePlaces::Worst);

  /// The walls at the reference film, one per region: the closed surface at the
  /// film's own resolution and what was measured of it.
  const std::vector<ThickWall>& walls() const { return walls_; }

  /// The largest safe thickness at every film vertex that has a wall [length];
  /// infinite where nothing limits it and elsewhere. Empty unless asked for
  /// Everywhere.
  const std::vector<double>& safe() const { return reference_.safe_at; }

  /// The numbers of the thickness of `walls`, this model's at another design;
  /// of rates theirs.
  std::vector<VectorX> numbers(const std::vector<WallSpec>& walls) const;

  /// The closed walls for meshing: corners at the meshed resolution, mid-sides
  /// from the finer film. `numbers`: see above. Throws InvalidInput where a
  /// thickness is not above 0.
  QuadraticSurface surface(const Points& film,
                           const std::vector<VectorX>& numbers) const;

  /// The same at the film's own resolution.
  SurfaceMesh fine(const Points& film,
                   const std::vector<VectorX>& numbers) const;

  /// Where the meshed walls should have nodes inside, at the reference film
  /// [length]: half way across them at the film's vertices, and on its
  /// junctions, so that two elements lie across a wall. None where that is
  /// thinner than half the edges there, whose elements would be too flat, or
  /// twice as thick as they are, which has nodes inside anyway.
  Points middles() const;

  /// As FilmModel::split_facets().
  void split_facets(const std::vector<char>& marked);

  /// surface() transposed at `film` and `numbers`.
  WallGradient transpose(const Points& film,
                         const std::vector<VectorX>& numbers,
                         const Points& by_corners,
                         const Points& by_mid_sides) const;

 private:
  struct Share {  // of a unit normal (of topology_.facets), or of an edge
    int at = 0;
    int wall = 0;
    double weight = 0.0;
  };
  struct Follow {  // how one wall point follows its film
    std::vector<Share> normals;
    std::vector<Share> edges;  // `at`: the other end
    std::vector<WallMove> rest;
    std::optional<Mat3> along;     // of a vertex that slides
    std::vector<Share> of_normal;  // of n there
  };

  struct Around {  // a wall point: facets of its sector, by corner angle
    std::vector<std::pair<int, double>> facets;
    std::vector<char> in_front;  // of these: is it on the normal's side?
    std::set<int> neighbours;    // film vertices
  };

  void freeze_moves();
  void find_straight();
  Follow follow(const Around& around, int vertex, const Points& normals,
                const std::vector<WallMove>& moves) const;
  void through_normals(const Points& film, const Points& normals,
                       const Points& by_normals, Points& by_film) const;
  void report();
  /// Per wall, per film vertex: t / t0.
  std::vector<VectorX> ratios(const std::vector<VectorX>& numbers) const;
  Points points_of(const Points& film,
                   const std::vector<VectorX>& numbers) const;
  Points unit_normals(const Points& film) const;
  /// The sum in y_k, before it is brought into planes.
  Vec3 offset(int point, const Points& film, const Points& normals,
              const std::vector<VectorX>& ratio) const;
  /// Of a point that slides: sum of its normals by angle.
  Vec3 normal_sum(int point, const Points& normals) const;

  std::vector<WallSpec> given_;
  Points reference_film_;
  WallPlanes planes_;
  std::vector<std::vector<int>> vertices_of_;  // of the film, per wall
  WallTopology topology_;
  std::vector<WallSpec> specs_;  // given_, on the film
  WallReference reference_;
  std::vector<Follow> follow_;  // per wall point
  std::vector<char> straight_;  // per wall point, see find_straight()
  SurfaceNodes nodes_;
  std::vector<ThickWall> walls_;
};

}  // namespace meniscus::walls
