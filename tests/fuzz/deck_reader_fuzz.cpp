// libFuzzer harness of the reader of decks: a mesh whose elements and faces
// name its nodes, steps that name both, or InvalidInput.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/deck/deck_reader.h"

namespace {

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void require_sound(const meniscus::deck::ReadDeck& deck) {
  const auto nodes = static_cast<int>(deck.mesh.nodes.size());
  const auto within = [](int count) {
    return [count](int id) { return id >= 0 && id < count; };
  };
  const auto all = [](const std::vector<int>& ids, const auto& good) {
    require(std::all_of(ids.begin(), ids.end(), good));
  };
  const meniscus::TetMesh& mesh = deck.mesh;
  all(mesh.elements, within(nodes));
  all(mesh.faces, within(nodes));
  all(mesh.face_label, within(static_cast<int>(mesh.labels.size())));
  all(mesh.element_region, within(static_cast<int>(deck.materials.size())));
  require(mesh.element_count() == static_cast<int>(mesh.element_region.size()));
  require(deck.node_numbers.size() == mesh.nodes.size());
  for (const meniscus::deck::ReadStep& step : deck.steps) {
    for (const auto& hold : step.holds) {
      require(within(nodes)(hold.node) && hold.direction.allFinite());
    }
    for (const auto& spring : step.springs) {
      all(spring.nodes, within(nodes));
      require(spring.nodes.size() == spring.coefficients.size());
    }
    for (const auto& pressure : step.pressures) {
      require(within(mesh.element_count())(pressure.element));
    }
    for (const auto& body : step.body_loads) {
      all(body.elements, within(mesh.element_count()));
    }
    require(step.nodal_forces.allFinite());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    require_sound(meniscus::deck::read_deck_text(text, "fuzz.inp"));
  } catch (const meniscus::InvalidInput&) {
  }
  return 0;
}
