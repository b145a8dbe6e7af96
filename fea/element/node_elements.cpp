#include "fea/element/node_elements.h"

#include <numeric>

namespace meniscus::element {

NodeElements node_elements(std::span<const int> elements, int nodes_per_element,
                           int used, int node_count) {
  const std::size_t width = nodes_per_element;
  const std::size_t count = elements.size() / width;
  NodeElements around;
  around.start.assign(static_cast<std::size_t>(node_count) + 1, 0);
  for (std::size_t e = 0; e < count; ++e) {
    for (int a = 0; a < used; ++a) {
      ++around.start[elements[e * width + a] + 1];
    }
  }
  std::partial_sum(around.start.begin(), around.start.end(),
                   around.start.begin());
  around.element.resize(around.start.back());
  std::vector<int> next(around.start.begin(), around.start.end() - 1);
  for (std::size_t e = 0; e < count; ++e) {
    for (int a = 0; a < used; ++a) {
      around.element[next[elements[e * width + a]]++] = static_cast<int>(e);
    }
  }
  return around;
}

}  // namespace meniscus::element
