// Settles films of several kinds, twice and then two at a time, and prints
// every bit of the answers: FilmBits.* compares them between thread counts.
#include <cstdint>
#include <cstring>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "core/process_settings.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_complexes.h"

namespace meniscus {
namespace {

struct Work {
  std::string name;
  films::FilmComplex start;
  settle::FindOptions options;
};

/// A drop under gravity, wetting its floor at 75 degrees, below a ceiling that
/// it touches.
films::FilmComplex drop_between_walls() {
  films::FilmComplex complex =
      test_films::sessile_cap_start(75.0 * std::numbers::pi / 180);
  complex.bodies[0].density = 1.0;
  complex.gravity = Vec3(0.0, 0.0, -1.0);
  complex.level_sets.push_back(
      {.name = "ceiling",
       .formula = Expression::parse("0.55 - z", {"x", "y", "z"}),
       .side = films::LevelSet::Side::AtLeast});
  complex.constraint_sets.push_back({1});
  complex.surfaces[0].constraints = 1;
  for (films::ComplexVertex& vertex : complex.vertices) {
    if (vertex.constraints < 0) {
      vertex.constraints = 1;
      vertex.held = false;
    }
  }
  return complex;
}

std::vector<Work> works() {
  // Past the facets that are factored directly: multigrid takes part.
  return {
      {"catenoid", test_films::catenoid_start(), {.refinements = 4}},
      {"cube", test_films::cube_start(), {.refinements = 3}},
      {"strut", test_films::strut_start(), {.refinements = 3}},
      {"triple_disk", test_films::triple_disk_start(), {.refinements = 4}},
      {"cube_frame", test_films::cube_frame_start(), {.refinements = 4}},
      {"double_bubble", test_films::double_bubble_start(), {.refinements = 3}},
      {"drop_between_walls", drop_between_walls(), {.refinements = 1}},
      {"remeshed_strut", test_films::strut_start(), {.edge = 0.12}}};
}

class Digest {
 public:
  void add(std::span<const double> values) {
    for (const double value : values) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      sum_ = (sum_ ^ bits) * 0x100000001b3U;  // FNV-1a, word by word
      sum_ ^= sum_ >> 29U;
    }
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325U;
};

/// Points, facets and every number of the report but its seconds.
std::string settled_text(const Work& work) {
  films::FilmComplex complex = work.start;
  const settle::FilmState state =
      settle::find_equilibrium(complex, work.options);
  const settle::FilmReport& report = state.report;
  Digest digest;
  for (const Points* points : std::initializer_list<const Points*>{
           &state.points, &complex.mesh.points}) {
    for (const Vec3& p : *points) {
      digest.add({p.data(), 3});
    }
  }
  digest.add(
      {state.heights.data(), static_cast<std::size_t>(state.heights.size())});
  for (const Triangle& facet : complex.mesh.facets) {
    for (const int v : facet) {
      digest.add(std::vector<double>{static_cast<double>(v)});
    }
  }
  digest.add(std::vector<double>{report.area, report.residual_bound,
                                 report.smallest_neck, report.neck_position.x(),
                                 report.neck_position.y(),
                                 report.neck_position.z()});
  for (const settle::BodyState& body : report.bodies) {
    digest.add(
        std::vector<double>{body.volume, body.target_volume, body.pressure});
  }
  return fmt::format("{} {} facets {} steps {:a} {:a} {:a} {} {:016x}",
                     work.name, report.facets, report.iterations, report.energy,
                     report.residual, report.min_eigenvalue, report.verdict,
                     digest.sum());
}

}  // namespace
}  // namespace meniscus

int main(int, char** words) {
  meniscus::start_with_settings(words);  // as the program does
  const std::vector<meniscus::Work> works = meniscus::works();
  std::vector<std::string> first;
  for (const meniscus::Work& work : works) {
    first.push_back(meniscus::settled_text(work));
    fmt::print("{}\n", first.back());
  }
  for (std::size_t k = 0; k + 1 < works.size(); k += 2) {
    std::string beside;
    std::thread other([&] { beside = meniscus::settled_text(works[k + 1]); });
    const std::string again = meniscus::settled_text(works[k]);
    other.join();
    if (again != first[k] || beside != first[k + 1]) {
      fmt::print("second run differs:\n{}\n{}\n", again, beside);
      return 1;
    }
  }
  return 0;
}
