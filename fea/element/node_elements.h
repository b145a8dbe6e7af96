/// Which elements stand around a node.
#pragma once

#include <span>
#include <vector>

namespace meniscus::element {

/// Elements around each node, ascending; owns its lists.
struct NodeElements {
  std::vector<int> start;    // node_count + 1
  std::vector<int> element;  // element ids, node after node
  std::span<const int> of(int node) const {
    return {element.data() + start[node], element.data() + start[node + 1]};
  }
};

/// `elements`: `nodes_per_element` ids each, of which the first `used` count
/// (4: corners only; nodes_per_element: all). Ids must be below `node_count`.
NodeElements node_elements(std::span<const int> elements, int nodes_per_element,
                           int used, int node_count);

}  // namespace meniscus::element
