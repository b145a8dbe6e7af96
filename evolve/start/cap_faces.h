/// The plane faces that solid caps are made of.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::start {

/// Throws InvalidInput, naming cap, curve and place, for a rim that is not
/// plane within 1e-9 of its size.
void require_flat(const Points& rim, const std::string& cap,
                  const std::string& curve);

/// The loops of one cap by faces: of each the loop around it, then its holes,
/// the loops that lie within it in its plane (every second one within the next,
/// as usual: a loop within a hole is a face again).
std::vector<std::vector<int>> faces_with_holes(
    const std::vector<Points>& loops);

/// Before faces of so much area are filled: throws InvalidInput where their
/// facets outgrow memory.
void require_room(double area, double edge);

/// Triangles of about `edge` in the first loop less the others, whose points
/// come first in their order; with `graded`, finer beside loops that are cut
/// finer. Throws InvalidInput naming `curve`.
SurfaceMesh fill_face(const std::vector<Points>& loops, double edge,
                      bool graded, const std::string& curve);

}  // namespace meniscus::start
