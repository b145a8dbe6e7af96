/// What the picture helper reads from a run's VTK files.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "report/picture/picture_job.h"
#include "report/render/cut_plane.h"

namespace meniscus::render {

/// Throws InvalidInput, naming the file, when it cannot be read or lacks the
/// cell data `surface`. `ending`: of the names of its point fields.
picture::PictureSurface load_surface(const std::string& path,
                                     const std::string& ending = "");

/// The tetrahedra of a .vtu. Throws InvalidInput.
picture::PictureTets load_tets(const std::string& path);

/// What a job shows: what it holds, else what the file says.
template <class Data, class Load>
std::shared_ptr<const Data> shape_of(const picture::PictureSource<Data>& source,
                                     const Load& load) {
  return source.data ? source.data
                     : std::make_shared<const Data>(load(source.file));
}

/// The facets left of a mesh of which all beyond a plane was taken away (whole
/// elements): label 0 are outer faces, label 1 the faces laid open.
SurfaceMesh cut_open(const picture::PictureTets& tets, const CutPlane& plane);

/// What is left of a mesh without the surfaces that are hidden
/// (report/picture/picture_job.h), and without the points that only they had.
SurfaceMesh without(const SurfaceMesh& mesh,
                    const std::vector<std::string>& hidden);

/// Edges where two surfaces meet or a surface ends.
std::vector<Edge> rim_edges(const SurfaceMesh& mesh);

}  // namespace meniscus::render
