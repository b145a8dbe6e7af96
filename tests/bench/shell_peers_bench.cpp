/// The same part as our shell, our ten-node tetrahedra (one through the wall,
/// as [walls] have them) and CalculiX's S6 and S8R, on finer and finer meshes:
/// a displacement beside the finest shell's, unknowns, seconds. CalculiX's are
/// of its whole process, written to print one node. docs/performance.md,
/// Shells.
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "fea/elastic/elasticity.h"
#include "fea/shell/shell_system.h"
#include "io/shell_deck/calculix_shells.h"
#include "tests/support/calculix.h"
#include "tests/support/mapped_shapes.h"
#include "tests/support/shapes.h"
#include "tests/support/shell_shapes.h"

namespace meniscus {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A side of the unit square, 0: s = 0, 1: s = 1, 2: t = 0, 3: t = 1, with the
/// components that are held along it, x y z and a b c about them.
struct HeldSide {
  int side;
  const char* shell;
};

/// A cylinder about y, of a radius, through an angle and a length.
struct Part {
  const char* name;
  double radius, angle, length, thickness;
  element::Material material;
  std::vector<HeldSide> held;
  Vec3 gravity = Vec3::Zero();
  Vec3 on_first_side = Vec3::Zero();  // a force spread along s = 0
  double read_s = 0.0;                // at t = 0
  int component = 2;

  Vec3 normal(double s) const {
    return {std::sin(s * angle), 0.0, std::cos(s * angle)};
  }
  Vec3 at(double s, double t) const {
    return radius * normal(s) + Vec3(0, t * length, 0);
  }
};

std::vector<Part> parts() {
  const Vec3 down(0, 0, -1);
  return {{.name = "Scordelis-Lo roof",
           .radius = 25.0,
           .angle = 40.0 / 180.0 * kPi,
           .length = 25.0,
           .thickness = 0.25,
           .material = {.youngs_modulus = 4.32e8,
                        .poisson_ratio = 0.0,
                        .density = 1.0},
           .held = {{3, "xz"}, {2, "yac"}, {0, "xbc"}},
           .gravity = 360.0 * down,
           .read_s = 1.0},
          {.name = "cylinder pressed along a line",
           .radius = 100.0,
           .angle = 0.5 * kPi,
           .length = 100.0,
           .thickness = 1.0,
           .material = {.youngs_modulus = 210e3, .poisson_ratio = 0.3},
           .held = {{0, "xbc"}, {1, "zab"}, {2, "yac"}},
           .on_first_side = 100.0 * down}};
}

bool on_side(int side, double s, double t) {
  constexpr double kNear = 1e-9;
  const double value = side < 2 ? s : t;
  return std::abs(value - side % 2) < kNear;
}

struct Measured {
  double value = 0.0;
  long unknowns = 0;
  double seconds = 0.0;
};

class Watch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                         start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ =
      std::chrono::steady_clock::now();
};

shell_shapes::MappedShell mesh_of(const Part& part, int cells) {
  return shell_shapes::mapped_shell(
      [&](double s, double t) { return part.at(s, t); }, part.thickness,
      {.m = cells, .n = cells});
}

std::vector<shell::NodeSupport> supports_of(
    const Part& part, const shell_shapes::MappedShell& shell) {
  std::vector<shell::NodeSupport> supports;
  for (const HeldSide& held : part.held) {
    shell_shapes::hold(supports, shell.nodes([&](double s, double t) {
      return on_side(held.side, s, t);
    }),
                       held.shell);
  }
  return supports;
}

shell::ShellLoads loads_of(const Part& part,
                           const shell_shapes::MappedShell& shell) {
  shell::ShellLoads loads;
  loads.gravity = part.gravity;
  for (const std::array<int, 3>&edge :
       shell.edges([](double s, double t) { return on_side(0, s, t); })) {
    loads.edges.push_back(
        {.nodes = edge, .force = part.on_first_side / part.length});
  }
  return loads;
}

Measured our_shell(const Part& part, int cells) {
  const shell_shapes::MappedShell shell = mesh_of(part, cells);
  const std::vector<shell::Section> sections = {
      {.laminate = {.plies = {{.material = part.material}}}}};
  const Watch watch;
  const shell::ShellSystem system(shell.mesh, sections,
                                  supports_of(part, shell));
  const VectorX u = system.solve(loads_of(part, shell)).displacement;
  return {u[6L * shell.node(part.read_s, 0) + part.component],
          system.freedom().unknowns(), watch.seconds()};
}

/// Bricks of the unit cube, bent: x along s, y along t, z across the wall.
Measured our_solid(const Part& part, int cells) {
  const TetMesh mesh = shapes::mapped(
      shapes::straight_quadratic(shapes::brick(Vec3::Ones(), cells, cells, 1)),
      [&](const Vec3& p) -> Vec3 {
        return part.at(p.x(), p.y()) +
               (p.z() - 0.5) * part.thickness * part.normal(p.x());
      });
  loads::LoadCase load_case{.name = "load"};
  for (const HeldSide& held : part.held) {
    const std::string is = held.shell;
    const auto has = [&](char c) { return is.find(c) != std::string::npos; };
    constexpr const char* kSides[] = {"x0", "x1", "y0", "y1"};
    load_case.supports.push_back({.surface = kSides[held.side],
                                  .fix_x = has('x'),
                                  .fix_y = has('y'),
                                  .fix_z = has('z')});
  }
  load_case.gravity = part.gravity;
  if (!part.on_first_side.isZero(0.0)) {
    load_case.forces.push_back({{"x0"}, part.on_first_side});
  }
  const Watch watch;
  const elastic::ElasticModel model(mesh, {part.material}, {load_case});
  const double seconds = watch.seconds();
  const VectorX& u = model.base_solution().displacements.at(0);
  // The middle of the wall is half way up an edge across it.
  const Vec3 at = part.at(part.read_s, 0);
  std::size_t nearest = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if ((mesh.nodes[n] - at).norm() < (mesh.nodes[nearest] - at).norm()) {
      nearest = n;
    }
  }
  return {u[3L * static_cast<long>(nearest) + part.component],
          model.base_solution().report.dofs, seconds};
}

/// Of the wedges or bricks that CalculiX makes of shells: three nodes across
/// the wall at corners, two at middles.
long wedge_unknowns(long cells, long middles) {
  return 3 * (3 * (cells + 1) * (cells + 1) + 2 * middles);
}

/// Prints one node and writes nothing else.
std::string only_print(std::string deck, int node) {
  deck.resize(deck.find("*NODE FILE"));
  deck.insert(deck.find("*STEP"),
              fmt::format("*NSET, NSET=READ\n{}\n", node + 1));
  return deck + "*NODE PRINT, NSET=READ, GLOBAL=YES\nU\n*END STEP\n";
}

Measured by_calculix(const std::string& deck, int nodes, int node,
                     int component, long unknowns) {
  const Watch watch;
  const std::vector<CalculixStep> steps = run_calculix(deck, nodes);
  return {steps.at(0).displacement[3L * node + component], unknowns,
          watch.seconds()};
}

shell_deck::ShellDeck deck_of(const Part& part,
                              const shell_shapes::MappedShell& shell) {
  shell_deck::ShellDeck deck{.nodes = shell.mesh.nodes,
                             .facets = shell.mesh.facets,
                             .section = shell.mesh.section};
  deck.thickness.resize(deck.facets.size());
  for (auto& row : deck.thickness) {
    row.fill(part.thickness);
  }
  const io::DeckMaterial material{
      .name = "m",
      .youngs_modulus = part.material.youngs_modulus,
      .poisson_ratio = part.material.poisson_ratio,
      .density = part.material.density,
      .orthotropic = {}};
  deck.sections = {{.name = "part", .plies = {{material}}}};
  shell_deck::DeckShellStep step{.name = "load", .gravity = part.gravity};
  for (const shell::NodeSupport& support : supports_of(part, shell)) {
    step.supports.push_back({{support.node}, support.held});
  }
  shell::ShellLoads edges = loads_of(part, shell);
  edges.gravity.setZero();
  step.nodal_forces = shell::nodal_forces(
      shell.mesh, {{.laminate = {.plies = {{.material = part.material}}}}},
      edges);
  deck.steps = {step};
  return deck;
}

Measured calculix_s6(const Part& part, int cells) {
  const shell_shapes::MappedShell shell = mesh_of(part, cells);
  const int node = shell.node(part.read_s, 0);
  const auto nodes = static_cast<int>(shell.mesh.nodes.size());
  return by_calculix(
      only_print(shell_deck::calculix_shell_deck(deck_of(part, shell)), node),
      nodes, node, part.component,
      wedge_unknowns(cells, 3L * cells * cells + 2L * cells));
}

/// Pairs of facets (a, b, c), (a, c, d) as one quadrilateral a b c d.
Measured calculix_s8r(const Part& part, int cells) {
  const shell_shapes::MappedShell shell = mesh_of(part, cells);
  const int node = shell.node(part.read_s, 0);
  std::string text = shell_deck::calculix_shell_deck(deck_of(part, shell));
  const std::size_t from = text.find("*ELEMENT");
  const std::size_t to = text.find("*ELSET, ELSET=EALL");
  std::string elements = "*ELEMENT, TYPE=S8R, ELSET=SHELL_0\n";
  const int row = 2 * cells + 1;
  const auto at = [&](int i, int j) {
    return shell.node(static_cast<double>(i) / (row - 1),
                      static_cast<double>(j) / (row - 1)) +
           1;
  };
  int number = 0;
  for (int i = 0; i + 2 < row; i += 2) {
    for (int j = 0; j + 2 < row; j += 2) {
      elements += fmt::format("{}, {}, {}, {}, {}, {}, {}, {}, {}\n", ++number,
                              at(i, j), at(i + 2, j), at(i + 2, j + 2),
                              at(i, j + 2), at(i + 1, j), at(i + 2, j + 1),
                              at(i + 1, j + 2), at(i, j + 1));
    }
  }
  text.replace(from, to - from, elements);
  return by_calculix(
      only_print(text, node), static_cast<int>(shell.mesh.nodes.size()), node,
      part.component, wedge_unknowns(cells, 2L * cells * (cells + 1)));
}

void race(const Part& part) {
  constexpr int kFinest = 96;
  const double limit = our_shell(part, kFinest).value;
  std::cout << fmt::format("{}: {:.6g}\n", part.name, limit);
  const struct {
    const char* name;
    std::function<Measured(const Part&, int)> run;
    int most;
  } runs[] = {{"our shell", our_shell, 64},
              {"our solid", our_solid, 96},
              {"ccx S6", calculix_s6, 96},
              {"ccx S8R", calculix_s8r, 64}};
  for (const auto& run : runs) {
    for (int cells = 4; cells <= run.most; cells += cells / 2) {
      const Measured found = run.run(part, cells);
      std::cout << fmt::format("| {} | {} | {} | {:.3f} % | {:.3f} s |\n",
                               run.name, cells, found.unknowns,
                               100.0 * (found.value / limit - 1.0),
                               found.seconds)
                << std::flush;
    }
  }
}

}  // namespace
}  // namespace meniscus

int main() {
  for (const meniscus::Part& part : meniscus::parts()) {
    meniscus::race(part);
  }
}
