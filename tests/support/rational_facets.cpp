#include "tests/support/rational_facets.h"

#include <algorithm>

namespace meniscus::rational {

namespace {

using Corners = std::array<Point, 3>;

Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Number dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0]};
}

Point between(const Point& a, const Point& b, const Number& at) {
  const Point way = b - a;
  return {a[0] + at * way[0], a[1] + at * way[1], a[2] + at * way[2]};
}

/// How far within edge k of t, in its plane of normal n.
Number within(const Corners& t, const Point& n, int k, const Point& p) {
  const Point& a = t[static_cast<std::size_t>(k)];
  const Point& b = t[static_cast<std::size_t>((k + 1) % 3)];
  return dot(cross(n, b - a), p - a);
}

bool holds(const Corners& t, const Point& n, const Point& p) {
  return within(t, n, 0, p) >= 0 && within(t, n, 1, p) >= 0 &&
         within(t, n, 2, p) >= 0;
}

/// Of a segment in the plane of t: is anything left within all three edges?
bool clipped(const Corners& t, const Point& n, const Point& p, const Point& q) {
  Number low = 0;
  Number high = 1;
  for (int k = 0; k < 3; ++k) {
    const Number at_p = within(t, n, k, p);
    const Number at_q = within(t, n, k, q);
    if (at_p < 0 && at_q < 0) {
      return false;
    }
    if (at_p < 0) {
      low = std::max<Number>(low, at_p / (at_p - at_q));
    } else if (at_q < 0) {
      high = std::min<Number>(high, at_p / (at_p - at_q));
    }
  }
  return low <= high;
}

bool edge_meets(const Point& p, const Point& q, const Corners& t) {
  const Point n = cross(t[1] - t[0], t[2] - t[0]);
  const Number at_p = dot(n, p - t[0]);
  const Number at_q = dot(n, q - t[0]);
  if (at_p == 0 && at_q == 0) {
    return clipped(t, n, p, q);
  }
  if ((at_p > 0 && at_q > 0) || (at_p < 0 && at_q < 0)) {
    return false;
  }
  return holds(t, n, between(p, q, at_p / (at_p - at_q)));
}

}  // namespace

Point point(const Vec3& x) {
  return {Number(x.x()), Number(x.y()), Number(x.z())};
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Point o = point(a);
  return dot(cross(point(b) - o, point(c) - o), point(d) - o).sign();
}

bool meet(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
  const Corners a = {point(s[0]), point(s[1]), point(s[2])};
  const Corners b = {point(t[0]), point(t[1]), point(t[2])};
  for (std::size_t k = 0; k < 3; ++k) {
    if (edge_meets(a[k], a[(k + 1) % 3], b) ||
        edge_meets(b[k], b[(k + 1) % 3], a)) {
      return true;
    }
  }
  return false;
}

}  // namespace meniscus::rational
