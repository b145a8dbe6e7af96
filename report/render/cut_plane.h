/// Where a part is cut open so that one sees into it.
#pragma once

#include "report/picture/picture_data.h"

namespace meniscus::render {

struct CutPlane {
  Vec3 normal = Vec3::UnitY();  // unit; what lies beyond `level` is taken away
  double level = 0.0;           // along the normal [length]
};

/// Of planes across the part's principal directions and the axes, at several
/// depths, the one that shows the most of the inside to an eye in direction
/// `view`: an L is cut along both of its arms.
CutPlane cut_plane(const picture::PictureTets& tets, const Vec3& view);

}  // namespace meniscus::render
