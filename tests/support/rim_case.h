/// A part whose boundary is many points, moved by one design variable to as
/// many as points: what the cost of a gradient is measured on.
#pragma once

#include <string>

namespace meniscus {

/// The text of a case: a film between two polygons of `points` / 2 corners each
/// [mm], `length` apart, whose corners stand at the radii r0, r1, ... of
/// `variables` arcs; two responses, the pull's mean displacement and the mass.
/// Elements are as large as the polygons' sides allow, at most of `edge` [mm].
std::string rim_case(int points, int variables, double length,
                     double edge = 20.0);

}  // namespace meniscus
