/// A solid and its image in a plane, as one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cad/solid/brep.h"

namespace meniscus::step {

struct MirrorPlane {
  Vec3 at = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();    // unit
  std::vector<std::string> cuts;  // names of the faces that lie in it
};

/// The faces of both without those in the plane, whose edges they share. Faces
/// of the image are called `image_name(face)`. The solid has no exact faces of
/// its own (Brep::exact).
solid::Brep with_mirror_image(
    const solid::Brep& brep, const MirrorPlane& plane,
    const std::function<std::string(const std::string&)>& image_name);

}  // namespace meniscus::step
