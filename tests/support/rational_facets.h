/// Triangles of doubles in rational arithmetic: what is so, however slowly.
#pragma once

#include <array>

#include <boost/multiprecision/cpp_int.hpp>

#include "core/types.h"

namespace meniscus::rational {

using Number = boost::multiprecision::cpp_rational;
using Point = std::array<Number, 3>;

Point point(const Vec3& x);

/// Sign of (b - a) x (c - a) . (d - a).
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Do the closed triangles have a point in common? Neither may be a line. Each
/// edge is cut by the other's plane, or clipped by its edges where it lies in
/// that plane.
bool meet(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t);

}  // namespace meniscus::rational
