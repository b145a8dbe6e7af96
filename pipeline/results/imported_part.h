/// A part from another program, analysed as a run's own part is.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/geometry/surface_mesh.h"
#include "core/monitor.h"
#include "pipeline/results/part_comparison.h"
#include "pipeline/results/part_shape.h"

namespace meniscus::results {

/// Edges longer than `longest` [length] halved, and again, until none is;
/// labels and bodies stay. The new points stand on `shape`, without one in the
/// middles of straight edges.
SurfaceMesh with_short_edges(SurfaceMesh surface, double longest,
                             const PartShape* shape = nullptr);

/// Throws InvalidInput where a part's points are of another order of size than
/// the run's `own`: its unit is another one, or a point of it is wrong.
void require_like_size(const Points& points, const Points& own,
                       const std::string& path, const std::string& length_unit);

/// A face's name in a file -> what the run calls it.
using FaceNames = std::map<std::string, std::string>;

/// The part that the file `path` encloses: ASCII STL with a `solid NAME` for
/// each face, OBJ with a group for each, binary STL all of one face, STEP by
/// the names of its faces, in the case's unit, a datafile's films and fixed
/// facets (film_1, solid_1, ...: one for each colour); `names` before these.
/// Meshed at the run's
/// resolution.fea (shorter where the file's own facets are), of the run's
/// material, held and loaded as the run's answer is by the names of its
/// surfaces, and solved by the same solver. Faces of STEP are curved as they
/// are in the file, to a few thousandths of an edge; the other formats know
/// flat facets only.
/// Throws InvalidInput (file, a name of a face that is not there, a surface
/// that loads or supports name and the file does not have, a run of several
/// materials), IoError, MeshError (no mesh), SolverError. `kept`, when given,
/// receives the meshes and the solution.
PartFigures imported_part_figures(const std::filesystem::path& path,
                                  const RunPart& run, const FaceNames& names,
                                  Monitor* monitor,
                                  forward::EvaluationFields* kept = nullptr);

}  // namespace meniscus::results
