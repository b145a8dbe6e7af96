#include "io/shell_deck/shell_deck.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::shell_deck {

namespace {

void check_facets(const ShellDeck& deck) {
  const std::size_t facets = deck.facets.size();
  if (facets == 0 || deck.section.size() != facets ||
      deck.thickness.size() != facets) {
    throw InvalidInput(fmt::format(
        "the deck has {} facets, {} sections and {} thicknesses of facets",
        facets, deck.section.size(), deck.thickness.size()));
  }
  const auto nodes = static_cast<int>(deck.nodes.size());
  const auto sections = static_cast<int>(deck.sections.size());
  for (std::size_t f = 0; f < facets; ++f) {
    for (const int node : deck.facets[f]) {
      if (node < 0 || node >= nodes) {
        throw InvalidInput(fmt::format("facet {} of the deck has node {} of {}",
                                       f, node, nodes));
      }
    }
    if (deck.section[f] < 0 || deck.section[f] >= sections) {
      throw InvalidInput(
          fmt::format("facet {} of the deck has section {} of {}", f,
                      deck.section[f], sections));
    }
  }
}

void check_sections(const ShellDeck& deck) {
  for (const DeckShellSection& section : deck.sections) {
    if (section.plies.empty()) {
      throw InvalidInput(fmt::format(
          "section '{}' of the deck has no ply; give it one", section.name));
    }
    for (const DeckPly& ply : section.plies) {
      if (ply.material.orthotropic && !section.direction) {
        throw InvalidInput(
            fmt::format("section '{}' of the deck has a ply of '{}', which is "
                        "orthotropic, and no direction; give it one",
                        section.name, ply.material.name));
      }
    }
  }
}

void check_rigid(const ShellDeck& deck) {
  const auto nodes = static_cast<int>(deck.nodes.size());
  for (const DeckRigidBody& body : deck.rigid) {
    std::vector<int> all = body.nodes;
    all.push_back(body.point);
    for (const int node : all) {
      if (node < 0 || node >= nodes) {
        throw InvalidInput(
            fmt::format("the rigid '{}' of the deck has node {} of {}",
                        body.name, node, nodes));
      }
    }
  }
}

void check_step(const ShellDeck& deck, const DeckShellStep& step) {
  const auto nodes = static_cast<int>(deck.nodes.size());
  const auto facets = static_cast<int>(deck.facets.size());
  if (step.nodal_forces.size() != 0 &&
      step.nodal_forces.size() != Eigen::Index{6} * nodes) {
    throw InvalidInput(
        fmt::format("step '{}' of the deck has {} nodal forces and moments; {} "
                    "nodes have 6 each",
                    step.name, step.nodal_forces.size(), nodes));
  }
  if (step.held_at.size() != 0 &&
      step.held_at.size() != Eigen::Index{6} * nodes) {
    throw InvalidInput(fmt::format(
        "step '{}' of the deck holds nodes at {} numbers; {} nodes have 6 each",
        step.name, step.held_at.size(), nodes));
  }
  if (step.supports.empty()) {
    throw InvalidInput(fmt::format(
        "step '{}' of the deck has no support; hold a rim", step.name));
  }
  for (const DeckShellSupport& support : step.supports) {
    for (const int node : support.nodes) {
      if (node < 0 || node >= nodes) {
        throw InvalidInput(
            fmt::format("step '{}' of the deck holds node {} of {}", step.name,
                        node, nodes));
      }
    }
  }
  for (const DeckFacetPressure& load : step.pressures) {
    if (load.facet < 0 || load.facet >= facets) {
      throw InvalidInput(
          fmt::format("step '{}' of the deck presses facet {} of {}", step.name,
                      load.facet, facets));
    }
  }
}

}  // namespace

void check_shell_deck(const ShellDeck& deck) {
  check_facets(deck);
  check_sections(deck);
  check_rigid(deck);
  for (const DeckShellStep& step : deck.steps) {
    check_step(deck, step);
  }
}

bool is_plain(const DeckShellSection& section) {
  return section.plies.size() == 1 &&
         !section.plies.front().material.orthotropic;
}

std::optional<double> even_thickness(const ShellDeck& deck, int section) {
  std::optional<double> even;
  for (std::size_t f = 0; f < deck.facets.size(); ++f) {
    if (deck.section[f] == section) {
      even = even.value_or(deck.thickness[f][0]);
      for (const double t : deck.thickness[f]) {
        if (t != *even) {
          return {};
        }
      }
    }
  }
  return even;
}

double DeckShellStep::temperature_at(int node) const {
  return temperature_change +
         (nodal_temperatures.size() > 0 ? nodal_temperatures[node] : 0.0);
}

bool is_heated(const ShellDeck& deck) {
  return std::any_of(
      deck.steps.begin(), deck.steps.end(), [](const DeckShellStep& s) {
        return s.temperature_change != 0.0 || s.nodal_temperatures.size() > 0;
      });
}

std::array<double, 6> held_values(const DeckShellStep& step, int node,
                                  const std::optional<Mat3>& frame) {
  std::array<double, 6> values = {};
  if (step.held_at.size() != 0) {
    const Mat3 axes = frame.value_or(Mat3::Identity());
    const Eigen::Index first = Eigen::Index{6} * node;
    for (int k = 0; k < 6; ++k) {
      values[static_cast<std::size_t>(k)] =
          axes.col(k % 3).dot(step.held_at.segment<3>(first + k / 3 * 3));
    }
  }
  return values;
}

bool needs_axes(const std::array<bool, 6>& fixed) {
  return !(fixed[0] == fixed[1] && fixed[1] == fixed[2] &&
           fixed[3] == fixed[4] && fixed[4] == fixed[5]);
}

std::map<int, Mat3> turned_nodes(const ShellDeck& deck) {
  std::map<int, Mat3> turned;
  std::map<int, Mat3> held;  // plain ones, too
  for (const DeckShellStep& step : deck.steps) {
    for (const DeckShellSupport& support : step.supports) {
      if (!needs_axes(support.fixed)) {
        continue;
      }
      const Mat3 axes = support.axes.value_or(Mat3::Identity());
      for (const int node : support.nodes) {
        if (held.emplace(node, axes).first->second != axes) {
          throw InvalidInput(fmt::format(
              "load case '{}' holds node {} along other axes than another "
              "support or load case does; a deck has one frame a node: export "
              "a case with one of them",
              step.name, node + 1));
        }
        if (support.axes) {
          turned.emplace(node, axes);
        }
      }
    }
  }
  return turned;
}

}  // namespace meniscus::shell_deck
