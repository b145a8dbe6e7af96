/// Parts of which the case draws a half, a quarter or an eighth: the rest is
/// its image in [symmetry]'s planes.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "evolve/curves/curve.h"
#include "pipeline/case_data/case_problems.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

/// Of how many parts like the drawn one the whole is: 1, 2, 4 or 8.
int symmetric_parts(const Case& input);

/// Notes planes that are too many, or not at right angles to each other.
void check_planes(const Case& input, CaseProblems& problems);

/// After the bodies, before they are checked: finds the solids that lie in a
/// plane (CapEntry::symmetry), and closes each body whose films end there, or
/// of whose curves the plane cuts some, by a wetted face BODY/symmetry_1 (of
/// the first plane) at 90 degrees. Films of no body slide on the plane itself,
/// symmetry_1.
void add_cut_faces(Case& input, CaseProblems& problems);

/// After the responses: holds the cut faces in every load case, notes loads,
/// supports and responses that a half cannot have, and sets
/// ResponseEntry::images.
void apply_symmetry(Case& input, CaseProblems& problems);

/// Tells of curves and facets beyond a plane or wrongly across it, and of loads
/// and axes that are not their own images, at one design.
void check_symmetry(const Case& input, const EvaluatedCase& inputs,
                    const CaseValues& values);

/// What the end of a film's wall or shell in a plane is called:
/// "web/symmetry_1".
std::string wall_end(const std::string& film, int plane);

/// Those of the walls and shells whose films slide on a plane.
std::vector<std::string> wall_ends(const Case& input, int plane);

/// The names of the cut faces, in the order of the solids, then those of the
/// walls' ends.
std::vector<std::string> cut_faces(const Case& input);

/// What the images of a surface are called: "pad/image"; those of images
/// likewise.
std::string image_name(const std::string& surface);

/// The names of the faces in a plane (its place in `symmetry`) and of their
/// images in other planes: what is inside the whole.
std::vector<std::string> cuts_of_whole(const Case& input, std::size_t plane);

/// The solids of the case and, with planes of symmetry, their images.
std::vector<std::string> solids_of_whole(const Case& input);

/// Distance from the plane, above 0 where its normal points to [length].
inline double beyond(const SymmetryPlane& plane, const Vec3& point) {
  return plane.normal.dot(point - plane.at);
}

/// How far points lie beyond a plane [length].
struct Reach {
  double least = 0.0;
  double most = 0.0;
  Vec3 farthest = Vec3::Zero();  // where it is `most`
  double rounding = 0.0;         // what counts as 0

  bool is_in_plane() const { return most <= rounding && least >= -rounding; }
};

Reach reach_of(const SymmetryPlane& plane, const curves::Curve& curve);

/// The case's curves at the initial design; empty where they have no numbers,
/// which is told later.
std::vector<curves::Curve> curves_at_start(const Case& input);

/// The names of those that lie on both sides of the plane.
std::set<std::string> cut_by(const SymmetryPlane& plane,
                             const std::vector<curves::Curve>& curves);

/// Films and solids that end at some of the curves.
std::vector<std::string> surfaces_at(const Case& input,
                                     const std::set<std::string>& curves);

/// Tells of curves across a plane that are not their own images there, or that
/// pass it elsewhere than at the initial design; of fillets along them, of
/// facets and STEP solids that end at them, and of loads on what they hold
/// whose halves are not those of the whole.
void check_cut_curves(const Case& input, const films::FilmSystem& system,
                      const CaseValues& values);

}  // namespace meniscus::case_data
