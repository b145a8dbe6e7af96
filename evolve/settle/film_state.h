/// How a film is settled, and what that gives: its points and what was found
/// out about them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "core/types.h"

namespace meniscus::settle {

struct SettleOptions {
  double residual_factor = 1e-9;    // stop: residual <= factor x tension x edge
  double volume_tolerance = 1e-10;  // relative
  int max_iterations = 60;
  Monitor* monitor = nullptr;
};

struct BodyState {
  std::string name;
  double volume = 0.0;         // [length^3]
  double target_volume = 0.0;  // [length^3]; the volume where none is asked
  double pressure = 0.0;       // inside minus outside [force/length^2]
};

/// A film that a pop pulled off another one.
struct PulledFilm {
  std::string name;
  std::string pulled_from;    // the film whose tension and wall it has
  Vec3 place = Vec3::Zero();  // its middle
  double area = 0.0;          // [length^2]
};

struct FilmReport {
  int vertices = 0;
  int facets = 0;
  double energy = 0.0;    // tension x area, and fields [force length]
  double area = 0.0;      // of films, caps not counted [length^2]
  double tension = 0.0;   // the largest of a film [force/length]
  double residual = 0.0;  // max |dE/dh_i - sum p dV/dh_i| over free vertices
  double residual_bound = 0.0;  // 1e-9 x tension x mean edge [force]
  double min_eigenvalue = 0.0;  // of the constrained Hessian in the metric of
                                // lumped vertex area [force/length^3]
  int index = 0;                // its number of negative eigenvalues
  bool index_at_least = false;  // only the lowest was looked for: may be more
  int iterations = 0;
  // Shortest line along an inward normal from film to film [length]; 0: none.
  double smallest_neck = 0.0;
  Vec3 neck_position = Vec3::Zero();
  std::string verdict;  // "stable", "unstable: ...", "pinching: ..."
  std::vector<PulledFilm> popped;
  std::vector<BodyState> bodies;
  double seconds = 0.0;
};

/// "2", or "at least 1".
std::string index_text(const FilmReport& film);

/// The film at one design: points of every vertex of the model's fine mesh, or
/// why there is none. `heights` are h, one per free vertex.
struct FilmState {
  Points points;
  VectorX heights;
  FilmReport report;
  std::optional<Failure> failure;
};

}  // namespace meniscus::settle
