#include "io/calculix_pins.h"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "io/calculix_springs.h"

namespace meniscus::io {

namespace {

constexpr double kNoTerm = 1e-14;  // a factor that rounding left

/// The first of a pin's two nodes.
int pin_node(const TetMesh& mesh, const CalculixDeck& deck, std::size_t pin) {
  return static_cast<int>(mesh.nodes.size()) + spring_nodes(deck.springs) + 1 +
         2 * static_cast<int>(pin);
}

/// Of a node at d from the point: -u_c + (motions of the pin)_c = 0.
std::string node_equations(const DeckPin& pin, int node, const Vec3& d,
                           int pin_node) {
  std::string text;
  for (int c = 0; c < 3; ++c) {
    std::vector<std::string> terms = {
        fmt::format("{}, {}, -1.", node + 1, c + 1)};
    const auto add = [&](int of, int k, double factor, double size) {
      if (std::abs(factor) > kNoTerm * size) {
        terms.push_back(fmt::format("{}, {}, {:.12e}", of, k + 1, factor));
      }
    };
    for (int k = 0; k < 3; ++k) {
      add(pin_node, k, pin.axes(c, k), 1.0);
    }
    for (int k = 0; k < 3; ++k) {
      add(pin_node + 1, k, pin.axes.col(k).cross(d)[c], d.norm());
    }
    text += equation_text(terms);
  }
  return text;
}

}  // namespace

std::string pins_text(const TetMesh& mesh, const CalculixDeck& deck) {
  std::string text;
  for (std::size_t p = 0; p < deck.pins.size(); ++p) {
    const DeckPin& pin = deck.pins[p];
    const int first = pin_node(mesh, deck, p);
    text += fmt::format("*NODE, NSET=PIN_{}\n", p + 1);
    for (const int node : {first, first + 1}) {
      text += fmt::format("{}, {:.12e}, {:.12e}, {:.12e}\n", node,
                          pin.point.x(), pin.point.y(), pin.point.z());
    }
    for (const int node : pin.nodes) {
      text += node_equations(
          pin, node, mesh.nodes[static_cast<std::size_t>(node)] - pin.point,
          first);
    }
  }
  return text;
}

std::string pins_boundary_text(const TetMesh& mesh, const CalculixDeck& deck,
                               const DeckStep& step) {
  std::string text;
  for (std::size_t p = 0; p < step.pins.size(); ++p) {
    for (int k = 0; k < 6; ++k) {
      const auto motion = static_cast<std::size_t>(k);
      if (step.pins[p].fixed[motion]) {
        text += fmt::format("{}, {}, {}, {:.12e}\n",
                            pin_node(mesh, deck, p) + k / 3, k % 3 + 1,
                            k % 3 + 1, step.pins[p].value[motion]);
      }
    }
  }
  return text;
}

}  // namespace meniscus::io
