#include "tests/support/delaunay_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

namespace meniscus::test_films {

namespace {

using std::numbers::pi;

// r, z, psi, area, volume of the half film.
using State = std::array<double, 5>;

State slope(const State& at, double pressure) {
  const double r = at[0];
  const double c = std::cos(at[2]);
  return {std::sin(at[2]), c, c / r - pressure, 2.0 * pi * r, pi * r * r * c};
}

State moved(const State& at, double h, const State& by) {
  State to = at;
  for (std::size_t i = 0; i < at.size(); ++i) {
    to[i] += h * by[i];
  }
  return to;
}

State runge_kutta(const State& at, double h, double pressure) {
  const State a = slope(at, pressure);
  const State b = slope(moved(at, 0.5 * h, a), pressure);
  const State c = slope(moved(at, 0.5 * h, b), pressure);
  const State d = slope(moved(at, h, c), pressure);
  State to = at;
  for (std::size_t i = 0; i < at.size(); ++i) {
    to[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return to;
}

// The zero of a function that rises from low to high, to rounding.
double bisect(double low, double high,
              const std::function<double(double)>& value) {
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (low + high);
    (value(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Where spacing / (2 c) = u has cosh(u) = u sinh(u), the two catenoids of a
// pair of rings become one.
constexpr double kTurningPoint = 1.19967864025773;

Catenoid catenoid_of_waist(double c, double spacing) {
  const double u = 0.5 * spacing / c;
  return {c, pi * c * c * (2.0 * u + std::sinh(2.0 * u))};
}

void require_catenoid(double radius, double spacing) {
  if (spacing > kCatenoidLimit * radius) {
    throw std::domain_error("no catenoid at this spacing");
  }
}

}  // namespace

double Meridian::distance(double r, double z) const {
  const double above = std::abs(z);
  const auto gap2 = [&](const Place& p) {
    return (p.r - r) * (p.r - r) + (p.z - above) * (p.z - above);
  };
  const Place& p = *std::min_element(
      places.begin(), places.end(),
      [&](const Place& a, const Place& b) { return gap2(a) < gap2(b); });
  const double dr = r - p.r;
  const double dz = above - p.z;
  const double along = dr * std::sin(p.psi) + dz * std::cos(p.psi);
  const double across = dr * std::cos(p.psi) - dz * std::sin(p.psi);
  // Beyond the rim there is no curve to come nearer to.
  if (std::abs(along) > step) {
    return std::hypot(along, across);
  }
  const double bend = std::cos(p.psi) / p.r - pressure;
  return std::abs(across + 0.5 * bend * along * along);
}

Meridian delaunay_meridian(double equator, double pressure, double half_length,
                           int steps) {
  Meridian meridian;
  meridian.pressure = pressure;
  meridian.step = half_length / steps;
  State at = {equator, 0.0, 0.0, 0.0, 0.0};
  meridian.places.push_back({equator, 0.0, 0.0});
  for (int step = 0; step < steps; ++step) {
    at = runge_kutta(at, meridian.step, pressure);
    meridian.places.push_back({at[0], at[1], at[2]});
  }
  meridian.area = 2.0 * at[3];
  meridian.volume = 2.0 * at[4];
  return meridian;
}

Meridian unduloid() { return delaunay_meridian(1.0, 1.3, 1.5); }

Meridian nodoid() { return delaunay_meridian(1.0, 2.6, 0.65); }

Catenoid catenoid(double radius, double spacing) {
  require_catenoid(radius, spacing);
  const double least = 0.5 * spacing / kTurningPoint;
  const double c = bisect(least, radius, [&](double waist) {
    return waist * std::cosh(0.5 * spacing / waist) - radius;
  });
  return catenoid_of_waist(c, spacing);
}

Catenoid thin_catenoid(double radius, double spacing) {
  require_catenoid(radius, spacing);
  const double most = 0.5 * spacing / kTurningPoint;
  const double c = bisect(0.01 * most, most, [&](double waist) {
    return radius - waist * std::cosh(0.5 * spacing / waist);
  });
  return catenoid_of_waist(c, spacing);
}

Sphere sphere_of_volume(double volume) {
  const double radius = std::cbrt(0.75 * volume / pi);
  return {radius, 4.0 * pi * radius * radius, 2.0 / radius};
}

SessileCap sessile_cap(double volume, double angle) {
  const double c = std::cos(angle);
  SessileCap cap;
  cap.radius = std::cbrt(3.0 * volume / (pi * (2.0 + c) * std::pow(1 - c, 2)));
  cap.rim_radius = cap.radius * std::sin(angle);
  cap.height = cap.radius * (1.0 - c);
  cap.film_area = 2.0 * pi * cap.radius * cap.height;
  cap.wetted_area = pi * cap.rim_radius * cap.rim_radius;
  cap.energy = cap.film_area - c * cap.wetted_area;
  cap.pressure = 2.0 / cap.radius;
  return cap;
}

TripleDisk triple_disk(double half_spacing) {
  // At the disk dr/dz = sinh(u) = cot(60 degrees).
  const double u = std::asinh(1.0 / std::sqrt(3.0));
  // Left of the turning point the radius at the ring falls as c grows.
  const double c = bisect(half_spacing, 1.0, [&](double waist) {
    return waist * std::cosh(u + half_spacing / waist) - 1.0;
  });
  const double end = u + half_spacing / c;
  const double r = c * std::cosh(u);
  const double bands =
      2.0 * pi * c * c *
      (end - u + 0.5 * (std::sinh(2.0 * end) - std::sinh(2.0 * u)));
  return {c, r, pi * r * r + bands};
}

DoubleBubble double_bubble(double volume) {
  const double r = std::cbrt(8.0 * volume / (9.0 * pi));
  return {r, 0.5 * std::sqrt(3.0) * r, 6.75 * pi * r * r, 2.0 / r};
}

}  // namespace meniscus::test_films
