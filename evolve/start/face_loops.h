/// Internal to start: the loops around plane faces that planes cut, those of
/// symmetry or of a cell. Open ends of a face's boundary lie on these planes;
/// straight seams between them close it, which faces on both sides of a seam
/// have in common.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/geometry/edge_key.h"
#include "evolve/films/film_complex.h"

namespace meniscus::start {

/// Of each edge of the surface's facets the way that one of them runs, where
/// only one has it.
std::set<Edge> open_runs(const SurfaceMesh& mesh, int label);

/// The set of all level sets of two constraint sets, of which either may be -1;
/// made where there is none yet.
int joined_set(films::FilmComplex& complex, int a, int b);

struct FacePlane {
  Vec3 at = Vec3::Zero();       // [length]
  Vec3 normal = Vec3::UnitZ();  // unit; of faces as their facets, of planes
                                // that cut away from what is left
  int set = -1;                 // its constraint set; -1: a solid's own face
};

/// Adds facets to a surface: `ids` are the vertices of the filling's first
/// points, the others are new, come last and lie inside.
void add_filling(const SurfaceMesh& filling, std::vector<int> ids, int label,
                 films::FilmComplex& complex);

/// Fills faces with triangles of about `edge` [length], their loops in the
/// direction of the facets; new vertices come last. `graded`: as fill_face().
/// Throws InvalidInput, naming the surface, for a loop that crosses itself.
void fill_loops(const std::vector<std::vector<int>>& loops, double edge,
                bool graded, int label, films::FilmComplex& complex);

/// Leaves out vertices that no facet has, with their marked edges; the others
/// keep their order.
void drop_unused(films::FilmComplex& complex);

/// How far a vertex may be off a plane that it lies on: 1e-9 of the size.
double reach_of_planes(const Points& points);

class FaceSeams {
 public:
  /// `edge`: seams are cut into pieces of about so much [length].
  FaceSeams(films::FilmComplex& complex, std::vector<FacePlane> planes,
            double edge);

  /// The closed loops of a face whose boundary runs from vertices to the
  /// `next`; chains of it that are open end on `planes`. From the end of a
  /// chain a seam runs along its plane, the face to its left, to where a chain
  /// begins or the next plane cuts it off, and so on. New seams have marked
  /// edges, and vertices that stay on both planes. Throws InvalidInput, naming
  /// `face`, for an end from which no seam leads to a beginning.
  std::vector<std::vector<int>> loops(const FacePlane& face,
                                      std::map<int, int> next,
                                      const std::string& name);

 private:
  void close(const FacePlane& face, std::map<int, int>& next);
  /// From `vertex`, where a chain ends, to the beginning of one.
  void walk(const FacePlane& face, int vertex, std::set<int>& beginnings,
            std::map<int, int>& next);
  int plane_at(const FacePlane& face, int vertex) const;
  int next_plane(const FacePlane& face, int plane, const Vec3& from,
                 const Vec3& way, double& far) const;
  void join(const FacePlane& face, int plane, int from, int to,
            std::map<int, int>& next);
  const std::vector<int>& seam(int from, int to, int set);
  int corner(const FacePlane& face, int p, int q);
  int add_vertex(const Vec3& place, int set);

  films::FilmComplex& complex_;
  std::vector<FacePlane> planes_;
  double edge_;
  double reach_;
  std::map<Edge, std::vector<int>> seams_;   // by their ends, smaller first
  std::map<std::vector<int>, int> corners_;  // by level sets, of three planes
};

}  // namespace meniscus::start
