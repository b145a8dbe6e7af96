#include "io/calculix_springs.h"

#include <iterator>

#include <fmt/format.h>

#include "io/calculix_names.h"

namespace meniscus::io {

namespace {

/// -d + g + sum c . u = 0: component 1 of the spring's node is what the spring
/// feels, component 2 its ground.
void equation(Out out, const DeckSprings::Spring& spring, int node) {
  std::vector<std::string> terms = {fmt::format("{}, 1, -1.", node),
                                    fmt::format("{}, 2, 1.", node)};
  for (std::size_t a = 0; a < spring.nodes.size(); ++a) {
    for (int k = 0; k < 3; ++k) {
      if (const double c = spring.coefficients[a][k]; c != 0.0) {
        terms.push_back(
            fmt::format("{}, {}, {:.12e}", spring.nodes[a] + 1, k + 1, c));
      }
    }
  }
  fmt::format_to(out, "{}", equation_text(terms));
}

}  // namespace

std::string equation_text(const std::vector<std::string>& terms) {
  constexpr std::size_t kPerLine = 4;  // terms that CalculiX reads of a line
  std::string text = fmt::format("*EQUATION\n{}\n", terms.size());
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const bool last = k + 1 == terms.size() || k % kPerLine == kPerLine - 1;
    text += terms[k] + (last ? "\n" : ", ");
  }
  return text;
}

int spring_nodes(const std::vector<DeckSprings>& springs) {
  std::size_t count = 0;
  for (const DeckSprings& set : springs) {
    count += set.springs.size();
  }
  return static_cast<int>(count);
}

std::string springs_text(const TetMesh& mesh,
                         const std::vector<DeckSprings>& springs) {
  fmt::memory_buffer buffer;
  const Out out = std::back_inserter(buffer);
  int node = static_cast<int>(mesh.nodes.size()) + 1;
  int element = mesh.element_count() + 1;
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const DeckSprings& set = springs[s];
    const int first = node;
    fmt::format_to(out, "*NODE, NSET=SPRING_NODES_{}\n", s + 1);
    for (const DeckSprings::Spring& spring : set.springs) {
      const Vec3& x = mesh.nodes[static_cast<std::size_t>(spring.nodes[0])];
      fmt::format_to(out, "{}, {:.12e}, {:.12e}, {:.12e}\n", node++, x.x(),
                     x.y(), x.z());
    }
    fmt::format_to(out, "*ELEMENT, TYPE=SPRING1, ELSET=SPRINGS_{}\n", s + 1);
    for (int k = first; k < node; ++k) {
      fmt::format_to(out, "{}, {}\n", element++, k);
    }
    fmt::format_to(out, "*SPRING, ELSET=SPRINGS_{}\n1\n{:.12e}\n", s + 1,
                   set.stiffness);
    for (std::size_t k = 0; k < set.springs.size(); ++k) {
      equation(out, set.springs[k], first + static_cast<int>(k));
    }
  }
  return fmt::to_string(buffer);
}

std::string springs_boundary_text(const std::vector<DeckSprings>& springs,
                                  std::size_t step) {
  std::string text;
  for (std::size_t s = 0; s < springs.size(); ++s) {
    // A ground that is not held follows, and the spring pulls with nothing.
    text += fmt::format("SPRING_NODES_{}, {}, 3\n", s + 1,
                        acts_in(springs[s], step) ? 2 : 3);
  }
  return text;
}

}  // namespace meniscus::io
