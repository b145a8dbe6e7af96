#include "fea/supports/restraints.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/supports/held_check.h"
#include "fea/supports/supports.h"

namespace meniscus::supports {

bool Restraints::operator==(const Restraints& other) const {
  return freedom.held == other.freedom.held &&
         freedom.projector == other.freedom.projector &&
         springs == other.springs && pins == other.pins;
}

void check_restraints(const TetMesh& mesh, const loads::LoadCase& load_case) {
  std::vector<HeldDirection> held = held_directions(mesh, load_case);
  const std::vector<HeldDirection> sprung = sprung_directions(mesh, load_case);
  held.insert(held.end(), sprung.begin(), sprung.end());
  const std::vector<PinFrame> pins = pin_frames(mesh, load_case);
  if (held.empty() &&
      std::all_of(pins.begin(), pins.end(),
                  [](const PinFrame& pin) { return pin.is_free(); })) {
    throw InvalidInput(fmt::format(
        "load case '{}' has no support: fix x, y, z or the normal of a surface",
        load_case.name));
  }
  check_held(mesh, held, pins, load_case.name);
}

Restraints make_restraints(const TetMesh& mesh,
                           const loads::LoadCase& load_case,
                           const solver::NodeOrder& order) {
  const solver::NodeFreedom given =
      node_freedom(mesh, held_directions(mesh, load_case));
  std::vector<char> loose(mesh.nodes.size(), 1);
  for (const int node : mesh.elements) {
    loose[node] = 0;
  }
  std::vector<std::pair<int, Mat3>> held;
  for (std::size_t h = 0; h < given.held.size(); ++h) {
    if (loose[given.held[h]] == 0) {
      held.emplace_back(order.to_solver[given.held[h]], given.projector[h]);
    }
  }
  Restraints restraints;
  restraints.pins = pin_frames(mesh, load_case);
  for (PinFrame& pin : restraints.pins) {
    for (int& node : pin.nodes) {
      node = order.to_solver[node];
      held.emplace_back(node, Mat3::Zero());
    }
  }
  for (std::size_t i = 0; i < loose.size(); ++i) {
    if (loose[i] != 0) {
      held.emplace_back(order.to_solver[i], Mat3::Zero());
    }
  }
  std::sort(held.begin(), held.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  restraints.freedom.nodes = given.nodes;
  for (const auto& [node, P] : held) {
    restraints.freedom.held.push_back(node);
    restraints.freedom.projector.push_back(P);
  }
  restraints.springs =
      renumbered(spring_blocks(mesh, load_case, mesh.order), order.to_solver);
  return restraints;
}

bool alike(const Restraints& a, const Restraints& b) {
  const auto same_rank = [](const Mat3& P, const Mat3& Q) {
    return std::lround(P.trace()) == std::lround(Q.trace());
  };
  const auto same_pin = [](const PinFrame& p, const PinFrame& q) {
    return p.nodes == q.nodes && p.fixed == q.fixed;
  };
  return a.freedom.held == b.freedom.held &&
         std::equal(a.pins.begin(), a.pins.end(), b.pins.begin(), b.pins.end(),
                    same_pin) &&
         std::equal(a.freedom.projector.begin(), a.freedom.projector.end(),
                    b.freedom.projector.begin(), same_rank);
}

int free_unknowns(const Restraints& restraints) {
  double free = 3.0 * restraints.freedom.nodes;
  for (const Mat3& P : restraints.freedom.projector) {
    free -= 3.0 - P.trace();
  }
  for (const PinFrame& pin : restraints.pins) {
    free += static_cast<double>(
        std::count(pin.fixed.begin(), pin.fixed.end(), false));
  }
  return static_cast<int>(std::lround(free));
}

SpringBlocks corner_springs(const TetMesh& mesh,
                            const loads::LoadCase& load_case,
                            const solver::NodeOrder& order,
                            const solver::CornerMap& map) {
  std::vector<int> corner_of(mesh.nodes.size(), -1);  // the mesh's node
  for (std::size_t c = 0; c < map.corner.size(); ++c) {
    corner_of[order.to_mesh[map.corner[c]]] = static_cast<int>(c);
  }
  return renumbered(spring_blocks(mesh, load_case, 1), corner_of);
}

solver::BlockMatrix<double> sprung_matrix(
    const solver::BlockPattern& pattern,
    const solver::BlockMatrix<double>& matrix, const SpringBlocks& springs) {
  solver::BlockMatrix<double> sprung = matrix;
  add_springs(pattern, springs, sprung);
  return sprung;
}

}  // namespace meniscus::supports
