/// The numbers behind a case's names at one design.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case.h"

namespace meniscus {

/// All names' values at one design: design variables, then parameters. What
/// has no good value is told in `problems` and counts as 0.
class CaseValues {
 public:
  /// Throws InvalidInput for a design of the wrong size. Keeps references.
  CaseValues(const Case& input, const VectorX& design,
             std::vector<std::string>& problems);

  double at(const Quantity& quantity) const;
  Vec3 at(const QuantityVector& vector) const {
    return {at(vector[0]), at(vector[1]), at(vector[2])};
  }

  /// The value; when it has one that is not `good`, what it must be is told.
  template <class Condition>
  double at(const Quantity& quantity, const Condition& good,
            const char* must_be) const {
    const std::size_t before = problems_.size();
    const double value = at(quantity);
    if (problems_.size() == before && !good(value)) {
      tell_bad(quantity, value, must_be);
    }
    return value;
  }
  double positive(const Quantity& quantity) const {
    return at(
        quantity, [](double x) { return x > 0.0; }, "above 0");
  }

  /// Over x, y, z alone: the values stand in its text, to the last bit.
  Expression of_place(const PlaceQuantity& quantity) const;

  /// " where support_x = 3, gap = 2"; nothing for plain numbers.
  template <class... Quantities>
  std::string where(const Quantities&... quantities) const {
    std::vector<char> used(values_.size(), 0);
    (mark(quantities, used), ...);
    return where_text(used);
  }

  std::vector<std::string>& problems() const { return problems_; }

 private:
  void tell_bad(const Quantity& quantity, double value,
                const char* must_be) const;
  std::string where_text(const std::vector<char>& used) const;
  static void mark(const Quantity& quantity, std::vector<char>& used);
  template <class Items>
  static void mark(const Items& items, std::vector<char>& used) {
    for (const auto& item : items) {
      mark(item, used);
    }
  }

  const Case& input_;
  std::vector<std::string>& problems_;
  std::vector<std::string> names_;
  std::vector<double> values_;
};

}  // namespace meniscus
