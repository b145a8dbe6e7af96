#include "io/analysis_deck.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::io {

namespace {

void check_sizes(const TetMesh& mesh, const DeckStep& step) {
  const auto forces = static_cast<std::size_t>(step.nodal_forces.size());
  if (forces != 0 && forces != 3 * mesh.nodes.size()) {
    throw InvalidInput(fmt::format(
        "step '{}' of the deck has {} nodal forces; {} nodes need {}",
        step.name, forces, mesh.nodes.size(), 3 * mesh.nodes.size()));
  }
  const auto heated = static_cast<std::size_t>(step.temperature_change.size());
  if (heated != 0 && heated != mesh.nodes.size()) {
    throw InvalidInput(
        fmt::format("step '{}' of the deck has {} temperatures for {} nodes",
                    step.name, heated, mesh.nodes.size()));
  }
}

void check_support(const TetMesh& mesh, const DeckSupport& support,
                   const DeckStep& step) {
  const std::vector<int> nodes = supported_nodes(mesh, support, step);
  const int count = static_cast<int>(mesh.nodes.size());
  if (nodes.empty()) {
    throw InvalidInput(
        fmt::format("step '{}' of the deck fixes no node of '{}'", step.name,
                    support.surface));
  }
  for (const int node : nodes) {
    if (node < 0 || node >= count) {
      throw InvalidInput(fmt::format(
          "step '{}' of the deck fixes node {}; the mesh has {} nodes",
          step.name, node, count));
    }
  }
}

void check_springs(const TetMesh& mesh, const DeckSprings& set,
                   std::size_t number) {
  if (!(set.stiffness > 0.0)) {
    throw InvalidInput(fmt::format(
        "springs {} of the deck have stiffness {}; it must be above 0", number,
        set.stiffness));
  }
  const int count = static_cast<int>(mesh.nodes.size());
  for (const DeckSprings::Spring& spring : set.springs) {
    const bool fits =
        spring.nodes.size() == spring.coefficients.size() &&
        std::all_of(spring.nodes.begin(), spring.nodes.end(),
                    [&](int node) { return node >= 0 && node < count; });
    if (!fits) {
      throw InvalidInput(fmt::format(
          "a spring of set {} of the deck has {} nodes, {} coefficients; the "
          "mesh has {} nodes",
          number, spring.nodes.size(), spring.coefficients.size(), count));
    }
  }
}

void check_pins(const TetMesh& mesh, const std::vector<DeckPin>& pins) {
  const int count = static_cast<int>(mesh.nodes.size());
  for (std::size_t k = 0; k < pins.size(); ++k) {
    for (const int node : pins[k].nodes) {
      if (node < 0 || node >= count) {
        throw InvalidInput(
            fmt::format("pin {} of the deck has node {}; the mesh has {} nodes",
                        k + 1, node, count));
      }
    }
  }
}

void check_pin_supports(const AnalysisDeck& deck, const DeckStep& step) {
  if (step.pins.size() != deck.pins.size()) {
    throw InvalidInput(fmt::format(
        "step '{}' of the deck says how {} pins are held; the deck has {}",
        step.name, step.pins.size(), deck.pins.size()));
  }
}

}  // namespace

void check_deck(const TetMesh& mesh, const AnalysisDeck& deck) {
  const int regions = mesh.element_region.empty()
                          ? 0
                          : 1 + *std::max_element(mesh.element_region.begin(),
                                                  mesh.element_region.end());
  if (static_cast<int>(deck.materials.size()) != regions) {
    throw InvalidInput(fmt::format(
        "the deck has {} materials for {} regions; give one per region",
        deck.materials.size(), regions));
  }
  for (std::size_t s = 0; s < deck.steps.size(); ++s) {
    const DeckStep& step = deck.steps[s];
    check_sizes(mesh, step);
    const bool on_springs =
        std::any_of(deck.springs.begin(), deck.springs.end(),
                    [s](const DeckSprings& set) { return acts_in(set, s); });
    check_pin_supports(deck, step);
    const bool on_pins = std::any_of(
        step.pins.begin(), step.pins.end(), [](const DeckPinSupport& pin) {
          return pin.fixed != std::array<bool, 6>{};
        });
    if (step.supports.empty() && deck.equations.empty() && !on_springs &&
        !on_pins) {
      throw InvalidInput(fmt::format(
          "step '{}' of the deck has no support; fix a surface", step.name));
    }
    for (const DeckSupport& support : step.supports) {
      check_support(mesh, support, step);
    }
  }
  check_pins(mesh, deck.pins);
  for (std::size_t k = 0; k < deck.springs.size(); ++k) {
    check_springs(mesh, deck.springs[k], k + 1);
  }
}

bool acts_in(const DeckSprings& springs, std::size_t step) {
  return std::find(springs.steps.begin(), springs.steps.end(),
                   static_cast<int>(step)) != springs.steps.end();
}

std::vector<int> deck_surface_nodes(const TetMesh& mesh, int label) {
  std::vector<int> ids;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_label[static_cast<std::size_t>(f)] == label) {
      const auto face = mesh.face(f);
      ids.insert(ids.end(), face.begin(), face.end());
    }
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

int surface_of_step(const TetMesh& mesh, const std::string& surface,
                    const DeckStep& step) {
  const int id = mesh.label_of(surface);
  if (id < 0) {
    throw InvalidInput(fmt::format(
        "step '{}' of the deck names the surface '{}'; the mesh has: {}",
        step.name, surface, fmt::join(mesh.labels, ", ")));
  }
  return id;
}

std::vector<int> supported_nodes(const TetMesh& mesh,
                                 const DeckSupport& support,
                                 const DeckStep& step) {
  if (support.surface.empty()) {
    return support.nodes;
  }
  return deck_surface_nodes(mesh, surface_of_step(mesh, support.surface, step));
}

int corner_off_face(const TetMesh& mesh, int face) {
  const auto nodes = mesh.face(face);
  const int behind = mesh.face_element[static_cast<std::size_t>(face)];
  const auto element = mesh.element(behind);
  const auto on_face = [&](int node) {
    return std::find(nodes.begin(), nodes.begin() + 3, node) !=
           nodes.begin() + 3;
  };
  int off = -1;
  for (int corner = 0; corner < 4; ++corner) {
    if (!on_face(element[static_cast<std::size_t>(corner)])) {
      if (off >= 0) {
        throw MeshError(fmt::format(
            "boundary face {} does not belong to the element {} behind it",
            face, behind));
      }
      off = corner;
    }
  }
  return off;
}

}  // namespace meniscus::io
