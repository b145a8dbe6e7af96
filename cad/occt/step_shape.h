/// Internal to step_text: a Brep as OpenCASCADE's shape.
#pragma once

#include <string>
#include <vector>

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include "cad/solid/brep.h"

namespace meniscus::occt {

struct StepShape {
  TopoDS_Shape solid;
  std::vector<TopoDS_Face> faces;  // as the Brep's, then the exact ones
  std::vector<std::string> names;  // of these
  int shells = 0;
};

/// Lengths are multiplied by `scale`. Throws MeshError for faces that are not
/// closed or enclose nothing.
StepShape step_shape(const solid::Brep& brep, double scale);

}  // namespace meniscus::occt
