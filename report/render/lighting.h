/// The light in pictures. It is worked out at points, not at pixels: compiling
/// shaders with lights for Mesa's software renderer took half the time of a
/// picture, and shapes are refined to a few pixels
/// (report/render/painted_shape.h).
#pragma once

#include <vector>

#include "core/types.h"
#include "report/render/colour_map.h"

namespace meniscus::render {

/// How a surface answers to light (Phong).
struct Finish {
  double specular = 0.25;
  double ambient = 0.15;  // light from everywhere, 0..1
};

/// Key, fill, back and head light that stand with the camera (vtkLightKit).
class Lights {
 public:
  Lights();

  /// The light that the eye sees, above 1 where it dazzles. `normal`, `to_eye`:
  /// unit, in the eye's axes (EyeView::seen), the normal on the side that is
  /// looked at.
  Colour shade(const Colour& colour, const Vec3& normal, const Vec3& to_eye,
               const Finish& finish) const;

 private:
  struct Light {
    Vec3 towards;  // unit, from the model
    Colour colour;
  };
  std::vector<Light> lights_;
};

}  // namespace meniscus::render
