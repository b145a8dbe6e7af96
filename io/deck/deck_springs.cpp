#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/deck/deck_steps.h"

namespace meniscus::deck {

namespace {

/// Reads springs and equations against what a step holds.
///
/// A spring stands on a node of the part, or on a node in no element that one
/// equation ties to the part: -d + g + sum c . u = 0, as our own decks have it
/// (calculix_springs.h), d the spring's component and g its ground. A ground
/// that is free follows the part, and the spring then pulls with nothing.
class SpringReader {
 public:
  SpringReader(const DeckCards& cards, const FrozenModel& frozen,
               const std::map<NodeComponent, double>& held, ReadStep& step)
      : cards_(cards),
        model_(frozen.model),
        frozen_(frozen),
        held_(held),
        step_(step),
        tied_(model_.equations.size(), 0) {}

  void read() {
    for (std::size_t e = 0; e < model_.equations.size(); ++e) {
      for (const RawEquation::Term& term : model_.equations[e].terms) {
        if (require_node(model_.equations[e], term) < 0) {
          loose_[{term.node, term.component}].push_back(static_cast<int>(e));
        }
      }
    }
    std::vector<char> used(model_.springs.size(), 0);
    for (const RawSpringSection& section : model_.spring_sections) {
      const auto set = model_.spring_sets.find(section.elset);
      if (set == model_.spring_sets.end()) {
        cards_.refuse(section.at, fmt::format("the deck has no springs in '{}'",
                                              shown_field(section.elset)));
      }
      for (const int spring : set->second) {
        const auto at = static_cast<std::size_t>(spring);
        used[at] = 1;
        add_spring(model_.springs[at], section);
      }
    }
    if (const auto bare = std::find(used.begin(), used.end(), 0);
        bare != used.end()) {
      const auto at = static_cast<std::size_t>(bare - used.begin());
      cards_.refuse(model_.springs[at].at, "the spring has no *SPRING");
    }
    for (std::size_t e = 0; e < tied_.size(); ++e) {
      if (tied_[e] == 0) {
        add_hold(model_.equations[e]);
      }
    }
  }

 private:
  /// The mesh's node, or -1 for one in no element.
  int require_node(const RawEquation& equation,
                   const RawEquation::Term& term) const {
    const int place = model_.node_numbers.place_of(term.node);
    if (place < 0) {
      cards_.refuse(equation.at,
                    fmt::format("the deck has no node {}", term.node));
    }
    return frozen_.node_of[static_cast<std::size_t>(place)];
  }

  void add_spring(const RawSpring& spring, const RawSpringSection& section) {
    const int place = model_.node_numbers.place_of(spring.node);
    if (place < 0) {
      cards_.refuse(spring.at,
                    fmt::format("the deck has no node {}", spring.node));
    }
    const int node = frozen_.node_of[static_cast<std::size_t>(place)];
    if (node >= 0) {
      step_.springs.push_back(
          {section.stiffness, {node}, {Vec3::Unit(section.component)}});
      return;
    }
    const NodeComponent own = {spring.node, section.component};
    const auto tie = loose_.find(own);
    if (tie == loose_.end() || tie->second.size() != 1 ||
        held_.count(own) > 0) {
      cards_.refuse(spring.at,
                    fmt::format("the spring's node {} is in no element; it "
                                "pulls on the part where one *EQUATION, and no "
                                "*BOUNDARY, has its component {}",
                                spring.node, section.component + 1));
    }
    const int equation = tie->second.front();
    tied_[static_cast<std::size_t>(equation)] = 1;
    add_tied(model_.equations[static_cast<std::size_t>(equation)], own,
             section.stiffness);
  }

  void add_tied(const RawEquation& equation, const NodeComponent& own,
                double stiffness) {
    double own_coefficient = 0.0;
    std::map<int, Vec3> of_node;
    for (const RawEquation::Term& term : equation.terms) {
      const int node = require_node(equation, term);
      const NodeComponent where = {term.node, term.component};
      if (where == own) {
        own_coefficient += term.coefficient;
      } else if (node >= 0) {
        of_node.try_emplace(node, Vec3::Zero()).first->second[term.component] +=
            term.coefficient;
      } else if (const auto ground = held_.find(where); ground == held_.end()) {
        return;  // its ground follows
      } else if (ground->second != 0.0) {
        cards_.refuse(equation.at,
                      "its spring's ground is held at a "
                      "displacement that is not 0, which is not "
                      "known");
      }
    }
    if (own_coefficient == 0.0 || of_node.empty()) {
      cards_.refuse(equation.at,
                    "the equation does not tie its spring to a "
                    "node of the part");
    }
    ReadSpring& spring = step_.springs.emplace_back();
    spring.stiffness = stiffness;
    for (const auto& [node, c] : of_node) {
      spring.nodes.push_back(node);
      spring.coefficients.push_back(-c / own_coefficient);
    }
  }

  /// An equation of one node's components alone holds it across them.
  void add_hold(const RawEquation& equation) {
    Vec3 direction = Vec3::Zero();
    const int node = require_node(equation, equation.terms.front());
    for (const RawEquation::Term& term : equation.terms) {
      if (require_node(equation, term) != node) {
        cards_.refuse(equation.at,
                      "*EQUATION between several nodes is not known, but for a "
                      "spring's own node; of one node it holds a direction");
      }
      direction[term.component] += term.coefficient;
    }
    const double length = direction.norm();
    if (node < 0 || !(length > 0.0) || !std::isfinite(length)) {
      cards_.refuse(equation.at,
                    "*EQUATION holds no node of the part: its "
                    "node is in no element, or its coefficients "
                    "are 0");
    }
    step_.holds.push_back({node, direction / length});
  }

  const DeckCards& cards_;
  const DeckModel& model_;
  const FrozenModel& frozen_;
  const std::map<NodeComponent, double>& held_;
  ReadStep& step_;
  std::vector<char> tied_;  // equations that belong to springs
  std::map<NodeComponent, std::vector<int>> loose_;  // equations, by components
                                                     // of nodes in no element
};

}  // namespace

void put_deck_springs(const DeckCards& cards, const FrozenModel& frozen,
                      const std::map<NodeComponent, double>& held,
                      ReadStep& step) {
  SpringReader(cards, frozen, held, step).read();
}

}  // namespace meniscus::deck
