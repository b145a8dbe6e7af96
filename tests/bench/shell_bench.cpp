/// Three-sided shell elements side by side on agreed benchmarks: the table of
/// decision 0034. Meshes of n cells a side for six nodes, of 2 n for three: as
/// many unknowns. With a number of cells as argument: seconds and memory of a
/// curved panel, stage by stage; with a second one at most so many halvings,
/// with a third GB that substructures' factors may keep.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>

#include <fmt/format.h>
#include <sys/resource.h>

#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "tests/support/shell_benchmarks.h"

namespace meniscus {
namespace {

using namespace shell_benchmarks;  // NOLINT: what is measured
using shell_shapes::Cut;

struct Row {
  const char* name;
  std::function<double(const GridOptions&, const Element&)> value;
};

void print_rows(const Element& element) {
  const Row rows[] = {
      {"Scordelis-Lo", scordelis_lo},
      {"pinched cylinder", pinched_cylinder},
      {"hemisphere", holed_hemisphere},
      {"hemisphere, t / 10", thin_hemisphere},
      {"LE3", nafems_le3},
      {"plate, clamped, t = 1e-2",
       [](const GridOptions& o, const Element& e) {
         return square_plate(1e-2, true, o, e) / 0.0012653;
       }},
      {"plate, clamped, t = 1e-4",
       [](const GridOptions& o, const Element& e) {
         return square_plate(1e-4, true, o, e) / 0.0012653;
       }},
      {"plate, supported, t = 1e-4",
       [](const GridOptions& o, const Element& e) {
         return square_plate(1e-4, false, o, e) / 0.0040624;
       }},
      {"twisted beam, along",
       [](GridOptions o, const Element& e) {
         o = {.m = 3 * o.n, .n = o.n / 2};  // a node in the tip's middle
         return twisted_beam(0.32, 1.0, true, o, e) / 0.005424;
       }},
      {"twisted beam, thin", [](GridOptions o, const Element& e) {
         o = {.m = 3 * o.n, .n = o.n / 2};
         return twisted_beam(0.0032, 1e-6, false, o, e) / 1.294e-3;
       }}};
  for (const Row& row : rows) {
    std::cout << fmt::format("| {} | {} |", element.name, row.name);
    for (const int n : {2, 4, 8, 16, 32}) {
      const int cells = element.corners_only ? 2 * n : n;
      std::string value = "-";
      try {
        value = fmt::format(
            "{:.4f}",
            row.value({.m = cells, .n = cells, .cut = Cut::Mixed, .shake = 0.2},
                      element));
      } catch (const std::exception&) {  // singular
      }
      std::cout << fmt::format(" {} |", value);
    }
    std::cout << std::endl;
  }
}

/// Seconds since the last call.
double lap() {
  static auto last = std::chrono::steady_clock::now();
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - last).count();
  last = now;
  return seconds;
}

void tell(const char* stage) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  std::cout << fmt::format("{:<12} {:7.2f} s  {:6.2f} GB\n", stage, lap(),
                           static_cast<double>(used.ru_maxrss) / 1048576.0);
}

void time_panel(int cells, const shell::ShellFactorOptions& options) {
  const shell_shapes::MappedShell panel = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {10.0 * std::sin(1.2 * s), 12.0 * t,
                10.0 * std::cos(1.2 * s) + 0.5 * std::sin(3.0 * t)};
      },
      0.05, {.m = cells, .n = cells, .cut = Cut::Mixed, .shake = 0.2});
  const shell::ShellMesh& mesh = panel.mesh;
  const std::vector<shell::Section> sections = {
      shell_shapes::isotropic(2e5, 0.3, 1.0)};
  std::vector<shell::NodeSupport> supports;
  shell_shapes::hold(supports, panel.nodes([](double s, double) {
    return s < 1e-9 || s > 1 - 1e-9;
  }),
                     "xyz");
  shell::ShellLoads loads;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    loads.pressures.push_back({static_cast<int>(f), 1.0});
  }
  const shell::ShellFreedom freedom(static_cast<int>(mesh.nodes.size()),
                                    supports);
  std::cout << fmt::format("{} unknowns\n", freedom.unknowns());
  tell("mesh");
  const auto laws = shell::laminate_laws(sections);
  const shell::ShellFactor factor(
      mesh, freedom,
      [&](int f) {
        return shell::condensed(
            shell::whole_stiffness(shell::facet_of(mesh, sections, laws, f)));
      },
      options);
  tell("factor");
  const VectorX f = shell::nodal_forces(mesh, sections, loads);
  tell("loads");
  const VectorX u = freedom.expand(factor.solve(freedom.restrict(f)));
  tell("solution");
  const auto stress = shell::averaged_stress(
      mesh, shell::shell_stress(mesh, sections, loads, u));
  tell("stress");
  const auto gradient = shell::residual_gradient(mesh, sections, loads, u, u);
  tell("gradient");
  std::cout << fmt::format("compliance {:.12g}\n", u.dot(f));
}

}  // namespace
}  // namespace meniscus

int main(int count, char** arguments) {
  if (count > 1) {
    meniscus::shell::ShellFactorOptions options;
    if (count > 2) {
      options.most_levels = std::atoi(arguments[2]);
    }
    if (count > 3) {
      options.kept_bytes = 1e9 * std::atof(arguments[3]);
    }
    meniscus::time_panel(std::atoi(arguments[1]), options);
    return 0;
  }
  for (const auto& element :
       {meniscus::shell_benchmarks::program(),
        meniscus::shell_benchmarks::three_nodes(),
        meniscus::shell_benchmarks::plain_quadratic(),
        meniscus::shell_benchmarks::reduced_quadratic()}) {
    meniscus::print_rows(element);
  }
}
