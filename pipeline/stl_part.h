/// A part from another program, analysed as a run's own part is.
#pragma once

#include <filesystem>
#include <string>

#include "core/monitor.h"
#include "core/surface_mesh.h"
#include "pipeline/part_comparison.h"

namespace meniscus {

/// Edges longer than `longest` [length] halved, and again, until none is;
/// shape, labels and bodies stay.
SurfaceMesh with_short_edges(SurfaceMesh surface, double longest);

/// The part that `path`, an ASCII STL file with a `solid NAME` for each face,
/// encloses: meshed at the run's resolution.fea (shorter where the file's own
/// facets are), of the run's material, held and loaded as the run's answer is
/// by the names of its surfaces, and solved by the same solver. Sides are
/// straight: the file knows no others.
/// Throws InvalidInput (file, a surface that loads or supports name and the
/// file does not have, a run of several materials), IoError, MeshError (no
/// mesh), SolverError.
/// `kept`, when given, receives the meshes and the solution.
PartFigures stl_part_figures(const std::filesystem::path& path,
                             const RunPart& run, Monitor* monitor,
                             EvaluationFields* kept = nullptr);

}  // namespace meniscus
