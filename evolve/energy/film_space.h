/// Which vertices of a complex move, in how many directions, and how: films
/// move in their normal space only (1, 2 or 3 directions on a smooth vertex, a
/// line where films meet or end, a junction), because tangential motion
/// changes a triangle mesh but not the film. Walls take directions away and
/// bend the way (level sets, parametric curves).
#pragma once

#include <vector>

#include "core/error.h"
#include "evolve/films/film_complex.h"

namespace meniscus::energy {

enum class FilmMotion {
  NormalSpace,
  Anywhere  // within the walls: for descent, which may then slide vertices to
            // where coarse facets have less area, as Surface Evolver's `g` does
};

/// A vertex that cannot be put back on its walls; names them and the place.
class OffWalls : public MeshError {
 public:
  using MeshError::MeshError;
};

/// How vertices move with heights h along directions n from base points X: on
/// walls x = P(X + h n), P the nearest point of a cylinder, sphere or cone.
struct FilmPaths {
  struct Bent {
    int unknown = 0;
    int vertex = 0;
    Vec3 direction = Vec3::Zero();  // n
    films::BentWall wall;
    Vec3 place = Vec3::Zero();  // X + h n
    films::OntoWall onto;       // P there
  };
  Points first;   // dx/dh, one per unknown
  Points second;  // d2x/dh2, one per unknown; empty: no walls but planes
  std::vector<Bent> bent;
};

class FilmSpace {
 public:
  /// Takes topology, kinds and constraints, no positions. Throws MeshError for
  /// a facet corner out of range, InvalidInput for a curve that films cannot
  /// slide along.
  explicit FilmSpace(const films::FilmComplex& complex,
                     FilmMotion motion = FilmMotion::NormalSpace);

  /// An unknown is a pair (vertex, direction); those of one vertex follow each
  /// other.
  int unknowns() const { return static_cast<int>(vertex_.size()); }
  const std::vector<int>& vertices() const { return vertex_; }
  int first(int vertex) const { return first_[vertex]; }
  int rank(int vertex) const { return first_[vertex + 1] - first_[vertex]; }
  int vertex_count() const { return static_cast<int>(first_.size()) - 1; }
  /// The two ends of the line through a vertex (triple line, rim on a wall),
  /// or {-1, -1}.
  const Edge& line_ends(int vertex) const;
  /// +1 or -1 per facet: turns facets so that neighbours across ordinary
  /// edges agree.
  double turn(int facet) const { return turn_.empty() ? 1.0 : turn_[facet]; }
  bool has_walls() const { return !walled_.empty(); }
  const std::vector<int>& walled() const { return walled_; }

  /// Unit directions, one per unknown, of the film at `points`: area-weighted
  /// normals, two normals of a line, or axes; within the walls (what runs along
  /// them of the film's normal: Surface Evolver's choice). Zero where films
  /// cancel.
  Points directions(const Points& points) const;

  /// directions() transposed: adds to `sum`, one per vertex, the gradient by
  /// the points of something whose gradient by each direction is given. Throws
  /// InvalidInput for films that slide on curves or on walls of a formula.
  void transpose_directions(const Points& points, const Points& by_directions,
                            Points& sum) const;

  /// How fast directions() change when the points move, at fixed h. Throws as
  /// transpose_directions().
  Points direction_rates(const Points& points, const Points& motion) const;

  /// points + h d at every unknown's vertex, back on the walls. Throws as
  /// project().
  Points moved(const Points& points, const Points& directions,
               const VectorX& heights) const;

  /// True where films slide on cylinders, spheres or cones; of walled()[k].
  bool has_bent_walls() const;
  bool is_on_bent(int k) const { return bent_wall(walls_[k]) != nullptr; }
  FilmPaths paths(const Points& points, const Points& directions,
                  const VectorX& heights) const;

  /// Puts every walled vertex back on its walls. Throws OffWalls when one
  /// cannot be reached, or only so far along a cylinder that digits are lost.
  void project(Points& points) const;

  /// What the walls' bending adds to the Hessian at walled()[k], for a given
  /// gradient of the energy there: symmetric, to be taken along directions.
  Eigen::Matrix3d wall_curvature(int k, const Vec3& at,
                                 const Vec3& gradient) const;

  /// Gradients of the level sets at a walled vertex, one row each; for a curve
  /// two normals of it.
  Eigen::MatrixX3d wall_normals(int k, const Vec3& at) const;

  /// Parameter on its curve of a sliding vertex at `at`.
  double parameter(int vertex, const Vec3& at) const;

 private:
  struct Wall {
    std::vector<int> level_sets;
    int curve = -1;
    double t = 0.0;
  };
  void orient(const std::vector<Triangle>& facet_edges,
              const std::vector<Triangle>& facets,
              const std::vector<char>& film, int edge_count);
  /// A cylinder, sphere or cone; null: others.
  const films::BentWall* bent_wall(const Wall& wall) const;
  Vec3 back_on(const Wall& wall, Vec3 at) const;
  /// `from`: where a vertex comes from, for messages.
  Vec3 on_walls(std::size_t k, const Vec3& at, const Vec3& from) const;
  std::string off_walls(std::size_t k, const Vec3& at) const;
  double nearest(const Wall& wall, const Vec3& at) const;
  void wall_directions(int k, const Points& points, const Vec3& normal,
                       Points& result) const;
  struct WallWay {
    Vec3 normal = Vec3::Zero();  // of the wall, unit
    Vec3 way = Vec3::Zero();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();  // d normal / d place
    bool across = false;  // of the film's edge, not along the film's normal
  };
  bool runs_along_planes(int k, const Points& points) const;
  WallWay wall_way(int k, const Points& points, const Vec3& normal2) const;
  static bool turns_across(const Vec3& along, const Vec3& across);

  std::vector<Triangle> facets_;
  std::vector<char> film_;  // per facet: liquid
  std::vector<int> vertex_;
  std::vector<int> first_;
  std::vector<int> line_;  // per vertex: into line_ends_, or -1
  std::vector<Edge> line_ends_;
  std::vector<signed char> turn_;
  std::vector<int> walled_;   // vertices
  std::vector<int> wall_of_;  // per vertex: into walls_, or -1; may be empty
  std::vector<Wall> walls_;
  std::vector<films::LevelSet> level_sets_;
  std::vector<curves::Curve> curves_;
};

/// The axis that is farthest from a line's unit tangent t: t x axis is the
/// first of the line's two directions.
Vec3 line_axis(const Vec3& t);

}  // namespace meniscus::energy
