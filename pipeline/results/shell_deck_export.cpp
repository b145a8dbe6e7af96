#include "pipeline/results/shell_deck_export.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/local_axes.h"
#include "fea/shell/shell_loads.h"
#include "pipeline/results/calculix_export.h"
#include "pipeline/shells/shell_holds.h"

namespace meniscus::results {

namespace {

shell_deck::DeckNodeSet node_set(std::string name, std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return {std::move(name), std::move(nodes)};
}

std::vector<shell_deck::DeckNodeSet> sets_of(const shells::ShellPart& part) {
  std::vector<shell_deck::DeckNodeSet> sets;
  const TetMesh& skin = part.skin;
  for (std::size_t label = 0; label < skin.labels.size(); ++label) {
    std::vector<int> nodes;
    for (int f = 0; f < skin.face_count(); ++f) {
      if (skin.face_label[f] == static_cast<int>(label)) {
        nodes.insert(nodes.end(), skin.face(f).begin(), skin.face(f).end());
      }
    }
    if (!nodes.empty()) {
      sets.push_back(node_set(skin.labels[label], std::move(nodes)));
    }
  }
  for (const auto& [name, rim] : part.rims) {
    std::vector<int> nodes;
    for (const std::array<int, 3>& edge : rim) {
      nodes.insert(nodes.end(), edge.begin(), edge.end());
    }
    sets.push_back(node_set(name, std::move(nodes)));
  }
  return sets;
}

/// Nodes that are held alike, together.
std::vector<shell_deck::DeckShellSupport> supports_of(
    const std::vector<shell::NodeSupport>& supports) {
  std::vector<shell_deck::DeckShellSupport> result;
  for (const shell::NodeSupport& support : supports) {
    std::optional<Mat3> axes;
    if (support.axes) {
      axes = element::unit_axes(*support.axes);
    }
    if (result.empty() || result.back().fixed != support.held ||
        result.back().axes != axes) {
      result.push_back({.fixed = support.held, .axes = axes});
    }
    result.back().nodes.push_back(support.node);
  }
  return result;
}

shell_deck::DeckShellStep shell_step_of(const shells::ShellPart& part,
                                        const loads::LoadCase& load_case) {
  if (!load_case.springs.empty()) {
    throw InvalidInput(fmt::format(
        "load case '{}' has springs, which decks of shells do not say; hold "
        "components, or export another format",
        load_case.name));
  }
  shell_deck::DeckShellStep step{.name = load_case.name};
  const auto nodes = static_cast<int>(part.mesh.nodes.size());
  const std::vector<shell::RigidRim> rims = shells::rigid_rims(part, load_case);
  std::vector<shell::NodeSupport> supports =
      shells::node_supports(part, load_case);
  // Their points, which stand behind all nodes, hold rims' nodes.
  supports =
      shells::off_rims(supports, shell::ShellFreedom(nodes, supports, rims));
  for (std::size_t r = 0; r < rims.size(); ++r) {
    if (rims[r].held != std::array<bool, 6>{}) {
      supports.push_back({.node = nodes + static_cast<int>(r),
                          .held = rims[r].held,
                          .axes = rims[r].axes,
                          .value = rims[r].value});
    }
  }
  step.supports = supports_of(supports);
  const auto all_nodes = nodes + static_cast<int>(rims.size());
  if (loads::enforces(load_case)) {
    step.held_at = shell::ShellFreedom(all_nodes, supports).held_values();
  }
  const shell::ShellLoads all = shells::shell_actions(part, load_case).loads;
  shell::ShellLoads others = all;  // than a deck has as such
  others.pressures.clear();
  others.gravity.setZero();
  others.spin.reset();
  others.temperature.reset();
  others.nodal_temperature.reset();
  step.nodal_forces = VectorX::Zero(6L * all_nodes);
  step.nodal_forces.head(6L * nodes) =
      shell::nodal_forces(part.mesh, part.sections, others);
  for (const shell::FacetPressure& p : all.pressures) {
    step.pressures.push_back({p.facet, p.pressure});
  }
  step.gravity = all.gravity;
  if (all.temperature) {
    step.temperature_change = all.temperature->mean;
  }
  if (all.nodal_temperature) {
    step.nodal_temperatures = VectorX::Zero(all_nodes);
    step.nodal_temperatures.head(nodes) = all.nodal_temperature->value;
  }
  if (all.spin) {
    step.spin = io::DeckSpin{all.spin->point, all.spin->axis, all.spin->rate};
  }
  return step;
}

/// A deck has the same ones in all steps.
void add_rigid_bodies(const case_data::EvaluatedCase& inputs,
                      const shells::ShellPart& part,
                      shell_deck::ShellDeck& deck) {
  if (inputs.load_cases.empty()) {
    return;
  }
  const auto of = [&](const loads::LoadCase& load_case) {
    return shells::rigid_rims(part, load_case);
  };
  const loads::LoadCase& first = inputs.load_cases.front();
  const std::vector<shell::RigidRim> rims = of(first);
  for (const loads::LoadCase& other : inputs.load_cases) {
    const std::vector<shell::RigidRim> own = of(other);
    if (!std::equal(rims.begin(), rims.end(), own.begin(), own.end(),
                    [](const shell::RigidRim& a, const shell::RigidRim& b) {
                      return a.nodes == b.nodes && a.point == b.point;
                    })) {
      throw InvalidInput(fmt::format(
          "load cases '{}' and '{}' have other rigid supports or loads; a deck "
          "has the same, about the same points, in all: export a case with one "
          "of them",
          first.name, other.name));
    }
  }
  for (const shell::RigidRim& rim : rims) {
    deck.rigid.push_back(
        {rim.name, static_cast<int>(deck.nodes.size()), rim.nodes});
    deck.nodes.push_back(rim.point);
  }
}

shell_deck::DeckShellSection section_of(const std::string& name,
                                        const shell::Section& section) {
  shell_deck::DeckShellSection result{.name = name,
                                      .plies = {},
                                      .offset = section.offset,
                                      .direction = section.direction};
  double whole = 0.0;
  for (const shell::Ply& ply : section.laminate.plies) {
    whole += ply.share;
  }
  for (const shell::Ply& ply : section.laminate.plies) {
    result.plies.push_back(
        {deck_material_of(ply.material), ply.share / whole, ply.angle});
  }
  return result;
}

}  // namespace

shell_deck::ShellDeck shell_deck_of(const case_data::Case& input,
                                    const case_data::EvaluatedCase& inputs,
                                    const shells::ShellPart& part) {
  shell_deck::ShellDeck deck{
      .comments = {"case: " + input.title, "units: " + input.units.name},
      .nodes = part.mesh.nodes,
      .facets = part.mesh.facets,
      .section = part.mesh.section,
      .sets = sets_of(part)};
  for (std::size_t f = 0; f < part.mesh.facets.size(); ++f) {
    deck.thickness.push_back(shell::facet_thicknesses(part.mesh, f));
  }
  for (std::size_t s = 0; s < input.shells.size(); ++s) {
    deck.sections.push_back(section_of(input.shells[s].name, part.sections[s]));
  }
  add_rigid_bodies(inputs, part, deck);
  // Of a load from any direction, which shells refuse, there are more.
  for (std::size_t k = 0; k < input.load_cases.size(); ++k) {
    deck.steps.push_back(shell_step_of(part, inputs.load_cases[k]));
  }
  return deck;
}

}  // namespace meniscus::results
