/// Internal to step_text: exact faces as OpenCASCADE's, and faces sewn to
/// one solid.
#pragma once

#include <vector>

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include "cad/solid/brep.h"

namespace meniscus::occt {

/// The faces of `from.faces`, which share their edges; surfaces and curves of
/// the same kinds and numbers. Lengths are multiplied by `scale`.
std::vector<TopoDS_Face> exact_faces(const solid::ExactFaces& from,
                                     double scale);

/// The faces joined where edges lie on each other, cut where one's vertex lies
/// on another's edge; `faces` become those of the solid. Throws MeshError where
/// edges stay free; `scale` is for the place that it names.
TopoDS_Shape sewn_solid(std::vector<TopoDS_Face>& faces, double scale);

}  // namespace meniscus::occt
