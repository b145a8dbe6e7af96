/// Coarse raw starts of films with known answers, for tests and benchmarks.
/// Tension 1 everywhere; facets run outward of the bodies, and one way within
/// a surface. Where four facets replace one per refinement, the comments give
/// the counts of films alone; caps come on top.
#pragma once

#include <optional>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::test_films {

/// Cylinder between rings of radius 1 at z = +-0.5: `around` x `rows` quads of
/// two facets each. 15 x 2: 60 facets, x 4^6 = 245,760.
films::FilmComplex catenoid_start(int around = 15, int rows = 2);

/// Surface of the unit cube [0, 1]^3, n x n quads a side, each cut into four
/// about its centre; one body of volume 1. n = 3: 216 facets,
/// x 4^5 = 221,184.
films::FilmComplex cube_start(int n = 3);

/// Film from the square of side 2 at z = 0 to the circle of radius 0.6 at
/// z = 4 about x = 0.8, closed by solid caps; one body of volume 14. 20 around
/// x 6 rows: 240 facets, x 4^5 = 245,760. `around` is a multiple of 4.
films::FilmComplex strut_start(int around = 20, int rows = 6);

/// Rings of radius 1 at z = +-0.3 joined to a disk of radius 0.8 at z = 0:
/// three films along a liquid circle. 12 around: 60 facets,
/// x 4^6 = 245,760.
films::FilmComplex triple_disk_start();

/// Frame of the cube of side 1 about the origin: one film from each of its
/// edges and a square of side 0.2 at z = 0; 12 triple lines, four quadruple
/// points. 40 facets, x 4^6 = 163,840.
films::FilmComplex cube_frame_start();

/// Tetrahedron of four corners of the cube [-1, 1]^3: six films from its edges
/// to a point off the centre; four triple lines. 24 facets.
films::FilmComplex tetrahedral_frame_start();

/// Two unit cubes with a common face at x = 0, n x n quads a face, each cut
/// into four; two bodies of volume 1.
films::FilmComplex double_bubble_start(int n = 2);

/// The unit cube without its bottom on the plane z = 0: n x n quads a face,
/// each cut into four; rim free in the plane, one body of volume 1 above the
/// plane. `angle`: contact angle inside the liquid [radian]; the wall's energy
/// -cos(angle) x wetted area is a line integral along the rim.
films::FilmComplex sessile_cap_start(double angle, int n = 2);

/// Cylinder about the z axis from z = 0, closed by solid caps.
struct TubeSpec {
  double radius = 1.0;  // [length]
  double length = 2.0;  // [length]
  int around = 12;
  int rows = 4;
  // At most one; neither: pressure 0.
  std::optional<double> volume;    // [length^3]
  std::optional<double> pressure;  // [force/length^2]
};
films::FilmComplex tube_start(const TubeSpec& spec);

/// Volume of the prism that tube_start() begins with [length^3].
double prism_volume(const TubeSpec& spec);

/// Pressure at which that prism rests [force/length^2]: that of the inscribed
/// circle, 1 / (radius cos(pi / around)).
double prism_pressure(const TubeSpec& spec);

/// A tube longer than its perimeter (radius 1, length 6.5) at the volume of
/// its own prism: settled as it stands, and a saddle of index 1 under
/// volume (Plateau-Rayleigh).
films::FilmComplex long_tube_saddle(int around = 18, int rows = 18);

/// The unstable catenoid between rings of radius 1 at z = +-0.5, waist
/// 0.2350: settled but for its faceting, and a saddle of index 1.
films::FilmComplex thin_catenoid_saddle(int around = 18, int rows = 18);

/// Films from the z axis, 0 <= z <= 4, out to radius 2 at these angles [deg],
/// `along` quads each; rims and the axis' ends are fixed.
films::FilmComplex fins_start(const std::vector<double>& degrees, int along);

}  // namespace meniscus::test_films
