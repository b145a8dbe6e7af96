/// The whole of a part of which the case draws a half, a quarter or an eighth,
/// for files and pictures.
///
/// What is drawn keeps its names; its images have those of
/// case_data::image_name(). Faces in a plane of symmetry lie inside the whole
/// and are left out.
#pragma once

#include <optional>

#include "pipeline/forward/forward_model.h"

namespace meniscus::whole {

/// The surface and its images, joined where they meet: of closed ones closed
/// ones. The same without planes of symmetry.
SurfaceMesh whole_surface(const case_data::Case& input, SurfaceMesh drawn);

/// Film, boundary, mesh, displacements, stresses and modes likewise; all else
/// is of the drawn part. Nothing without planes of symmetry: the fields are the
/// whole then.
std::optional<forward::EvaluationFields> whole_part(
    const case_data::Case& input, const forward::EvaluationFields& drawn);

}  // namespace meniscus::whole
