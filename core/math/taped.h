/// Numbers that are written down as they are computed, with how fast they
/// change along one way, so that the derivatives of both by all inputs follow
/// from one run back (reverse over forward differentiation; Griewank, Walther,
/// Evaluating Derivatives, 2008, chapter 5).
#pragma once

#include <span>
#include <vector>

#include "core/math/dual.h"

namespace meniscus {

class Tape;

/// Result of an operation, an input or, without a node, a constant.
struct Taped : DualArithmetic<Taped> {
  double value = 0.0;
  double rate = 0.0;
  Tape* tape = nullptr;
  int node = -1;

  Taped() = default;
  Taped(double constant) : value(constant) {}  // NOLINT: numbers are taped
  bool is_constant() const { return node < 0; }
};

class Tape {
 public:
  void clear() { nodes_.clear(); }
  /// Inputs are numbered as they come, before any operation.
  Taped input(double value, double rate) {
    return add(value, rate, {.a = -1, .b = -1});
  }
  /// Adds the derivatives of by_value x result + by_rate x its rate to those
  /// by each input and by each input's rate.
  void transpose(const Taped& result, double by_value, double by_rate,
                 std::span<double> by_values, std::span<double> by_rates);

  Taped one(const Taped& a, double g, double g1, double g2) {
    return add(g, g1 * a.rate,
               {.a = a.node, .b = -1, .by_a = g1, .rate_by_a = g2 * a.rate});
  }
  Taped two(const Taped& a, const Taped& b, double g, const Partials& d) {
    return add(g, d.a * a.rate + d.b * b.rate,
               {.a = a.node,
                .b = b.node,
                .by_a = d.a,
                .by_b = d.b,
                .rate_by_a = d.aa * a.rate + d.ab * b.rate,
                .rate_by_b = d.ab * a.rate + d.bb * b.rate});
  }

 private:
  /// Derivatives of an operation's value by its operands' values (as of its
  /// rate by their rates), and of its rate by their values.
  struct Node {
    int a;
    int b;
    double by_a = 0.0;
    double by_b = 0.0;
    double rate_by_a = 0.0;
    double rate_by_b = 0.0;
  };
  Taped add(double value, double rate, const Node& node) {
    Taped result(value);
    result.rate = rate;
    result.tape = this;
    result.node = static_cast<int>(nodes_.size());
    nodes_.push_back(node);
    return result;
  }

  std::vector<Node> nodes_;
  std::vector<double> value_;  // derivatives by each node
  std::vector<double> rate_;
};

inline Taped chain(const Taped& a, double g, double g1, double g2) {
  return a.is_constant() ? Taped(g) : a.tape->one(a, g, g1, g2);
}

inline Taped chain(const Taped& a, const Taped& b, double g,
                   const Partials& d) {
  if (b.is_constant()) {
    return chain(a, g, d.a, d.aa);
  }
  return a.is_constant() ? chain(b, g, d.b, d.bb) : a.tape->two(a, b, g, d);
}

}  // namespace meniscus
