#include "core/math/taped.h"

namespace meniscus {

void Tape::transpose(const Taped& result, double by_value, double by_rate,
                     std::span<double> by_values, std::span<double> by_rates) {
  if (result.is_constant()) {
    return;
  }
  value_.assign(nodes_.size(), 0.0);
  rate_.assign(nodes_.size(), 0.0);
  value_[static_cast<std::size_t>(result.node)] = by_value;
  rate_[static_cast<std::size_t>(result.node)] = by_rate;
  const auto inputs = by_values.size();
  for (std::size_t k = static_cast<std::size_t>(result.node) + 1;
       k-- > inputs;) {
    const Node& node = nodes_[k];
    const auto add = [&](int at, double by, double rate_by) {
      if (at >= 0) {
        value_[static_cast<std::size_t>(at)] +=
            by * value_[k] + rate_by * rate_[k];
        rate_[static_cast<std::size_t>(at)] += by * rate_[k];
      }
    };
    add(node.a, node.by_a, node.rate_by_a);
    add(node.b, node.by_b, node.rate_by_b);
  }
  for (std::size_t k = 0; k < inputs; ++k) {
    by_values[k] += value_[k];
    by_rates[k] += rate_[k];
  }
}

}  // namespace meniscus
