/// Exact films to compare with. Tension 1 throughout, so a pressure is
/// inside minus outside over tension [1/length].
#pragma once

#include <vector>

namespace meniscus::test_films {

/// Half of a film of revolution about the z axis with constant mean curvature,
/// from its equator (neck or bulge) at z = 0 upwards, by arclength:
///   r' = sin psi, z' = cos psi, psi' = cos psi / r - pressure,
/// along which r cos psi - pressure r^2 / 2 stays constant (Delaunay 1841).
/// Area and volume are those of the whole film, mirrored at z = 0.
struct Meridian {
  struct Place {
    double r = 0.0;
    double z = 0.0;
    double psi = 0.0;  // angle of the tangent to the axis [radian]
  };
  double pressure = 0.0;
  double step = 0.0;          // of arclength [length]
  std::vector<Place> places;  // at 0, step, 2 step, ...
  double area = 0.0;          // [length^2]
  double volume = 0.0;        // between the planes of its rims [length^3]

  const Place& rim() const { return places.back(); }
  /// Distance of a point (r, |z|) from the curve [length]; good to step^3.
  double distance(double r, double z) const;
};

/// Fixed-step Runge-Kutta of order 4 from radius `equator` over half the
/// film's arclength. Pressure below 1 / equator: a neck at the equator; above:
/// a bulge. Unduloid while equator > pressure equator^2 / 2, nodoid beyond.
Meridian delaunay_meridian(double equator, double pressure, double half_length,
                           int steps = 4000);

/// Unduloid with a bulge at z = 0: equator 1, pressure 1.3, which ends before
/// its neck.
Meridian unduloid();

/// Nodoid with a bulge at z = 0: equator 1, pressure 2.6, rims short of the
/// place where it turns back in z; beyond that a film at fixed volume slips
/// sideways and is no longer of revolution.
Meridian nodoid();

/// Catenoid between rings of `radius`, `spacing` apart.
struct Catenoid {
  double waist = 0.0;  // [length]
  double area = 0.0;   // [length^2]
};
/// The stable film. Throws std::domain_error where there is none:
/// spacing / radius above 1.32548.
Catenoid catenoid(double radius, double spacing);
/// The unstable film of the same rings.
Catenoid thin_catenoid(double radius, double spacing);
/// Largest spacing / radius of a catenoid between equal rings.
constexpr double kCatenoidLimit = 1.32548684;

/// Sphere of a volume.
struct Sphere {
  double radius = 0.0;    // [length]
  double area = 0.0;      // [length^2]
  double pressure = 0.0;  // [1/length]
};
Sphere sphere_of_volume(double volume);

/// Drop on a plane without gravity.
struct SessileCap {
  double radius = 0.0;       // of the sphere [length]
  double rim_radius = 0.0;   // [length]
  double height = 0.0;       // [length]
  double film_area = 0.0;    // [length^2]
  double wetted_area = 0.0;  // [length^2]
  double energy = 0.0;       // film - cos(angle) wetted [length^2]
  double pressure = 0.0;     // [1/length]
};
SessileCap sessile_cap(double volume, double angle);

/// Two rings of radius 1 at z = +-half_spacing and a disk between: catenoids
/// that meet it at 120 degrees.
struct TripleDisk {
  double waist = 0.0;        // c of r = c cosh(...) [length]
  double disk_radius = 0.0;  // [length]
  double area = 0.0;         // [length^2]
};
TripleDisk triple_disk(double half_spacing = 0.3);

/// Two equal bubbles of `volume` each with a flat film between.
struct DoubleBubble {
  double radius = 0.0;         // of both spheres [length]
  double middle_radius = 0.0;  // of the flat film [length]
  double area = 0.0;           // [length^2]
  double pressure = 0.0;       // in both [1/length]
};
DoubleBubble double_bubble(double volume);

/// 6 sqrt(2): tetrahedron in the cube of side 2, six films to the centre.
constexpr double kTetrahedralFrameArea = 8.48528137423857;
/// Cube of side 1 with twelve films and a square, by Richardson extrapolation
/// of Surface Evolver's areas; the last digit is good to 2.
constexpr double kCubeFrameArea = 4.2395630;

}  // namespace meniscus::test_films
