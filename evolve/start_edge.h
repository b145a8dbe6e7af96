/// How much coarser than its settled film a model's start is.
#pragma once

namespace meniscus {

/// Halvings of the start's edges on the way to the film's own.
inline constexpr int kStartHalvings = 1;

/// The edge length that a start is built at, for a film of `edge` [length].
constexpr double start_edge(double edge) {
  return edge * (1 << kStartHalvings);
}

}  // namespace meniscus
