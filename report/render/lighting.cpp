#include "report/render/lighting.h"

#include <algorithm>
#include <cmath>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

namespace meniscus::render {

namespace {

constexpr double kShininess = 40.0;  // the exponent of Phong's highlights

}  // namespace

Lights::Lights() {
  vtkNew<vtkLightKit> kit;
  kit->SetKeyLightIntensity(0.95);
  kit->SetKeyLightWarmth(0.52);
  kit->SetFillLightWarmth(0.48);
  kit->SetKeyToFillRatio(2.2);
  kit->SetKeyToHeadRatio(4.0);
  vtkNew<vtkRenderer> renderer;
  kit->AddLightsToRenderer(renderer);
  kit->Update();
  vtkLightCollection* lights = renderer->GetLights();
  lights->InitTraversal();
  while (vtkLight* light = lights->GetNextItem()) {
    // A headlight's own place is where it was made: it shines as one looks.
    const Vec3 towards =
        light->LightTypeIsHeadlight() != 0
            ? Vec3(Vec3::UnitZ())
            : Vec3(Vec3(light->GetPosition()) - Vec3(light->GetFocalPoint()));
    const double* colour = light->GetDiffuseColor();
    const double power = light->GetIntensity();
    lights_.push_back(
        {towards.normalized(),
         {power * colour[0], power * colour[1], power * colour[2]}});
  }
}

Colour Lights::shade(const Colour& colour, const Vec3& normal,
                     const Vec3& to_eye, const Finish& finish) const {
  Colour diffuse{};
  Colour specular{};
  const Vec3 mirrored = 2.0 * normal.dot(to_eye) * normal - to_eye;
  for (const Light& light : lights_) {
    const double falls = normal.dot(light.towards);
    if (falls <= 0.0) {
      continue;
    }
    const double shine =
        std::pow(std::max(0.0, mirrored.dot(light.towards)), kShininess);
    for (std::size_t c = 0; c < 3; ++c) {
      diffuse[c] += falls * light.colour[c];
      specular[c] += shine * light.colour[c];
    }
  }
  Colour seen;
  for (std::size_t c = 0; c < 3; ++c) {
    seen[c] = colour[c] *
                  (finish.ambient + (1.0 - 0.5 * finish.ambient) * diffuse[c]) +
              finish.specular * specular[c];
  }
  return seen;
}

}  // namespace meniscus::render
