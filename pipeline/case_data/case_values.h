/// The numbers behind a case's names at one design.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "core/math/dual.h"
#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// All names' values at one design: design variables, then parameters. What
/// has no good value is told in `problems` and counts as 0.
///
/// Made for a rate, at() gives a number's derivative by one design variable
/// instead: whatever copies numbers into structs then fills them with rates,
/// unchecked.
class CaseValues {
 public:
  /// Throws InvalidInput for a design of the wrong size. Keeps references.
  CaseValues(const Case& input, const VectorX& design,
             std::vector<std::string>& problems);
  /// Rates by design variable `rate_by`.
  CaseValues(const Case& input, const VectorX& design,
             std::vector<std::string>& problems, int rate_by);

  bool are_rates() const { return !duals_.empty(); }
  /// Of rates: some name in it changes.
  bool moves(const Quantity& quantity) const;

  double at(const Quantity& quantity) const;
  Vec3 at(const QuantityVector& vector) const {
    return {at(vector[0]), at(vector[1]), at(vector[2])};
  }

  /// Value and, of rates, derivative: for what is not copied but computed.
  Dual1 dual(const Quantity& quantity) const;

  /// The value; when it has one that is not `good`, what it must be is told.
  template <class Condition>
  double at(const Quantity& quantity, const Condition& good,
            const char* must_be) const {
    const std::size_t before = problems_.size();
    const double value = at(quantity);
    if (!are_rates() && problems_.size() == before && !good(value)) {
      add_problem(quantity, value, must_be);
    }
    return value;
  }
  double positive(const Quantity& quantity) const {
    return at(
        quantity, [](double x) { return x > 0.0; }, "above 0");
  }

  /// Over x, y, z alone: the values stand in its text, to the last bit. No
  /// rates.
  Expression of_place(const PlaceQuantity& quantity) const;
  /// Over x, y, z and the names that some design variable moves; its numbers
  /// are their values, or their rates.
  PlaceField place_field(const PlaceQuantity& quantity) const;
  /// Does any design variable move it?
  bool follows_design(const Quantity& quantity) const;
  template <class Items>
  bool follows_design(const Items& items) const {
    return std::any_of(items.begin(), items.end(), [this](const auto& item) {
      return follows_design(item);
    });
  }

  /// An expression over the case's names and `more` values after them; its
  /// derivative, when these change at `more_rates`. Quiet NaN, and a problem
  /// told, where it has none.
  double at(const Quantity& quantity, std::span<const double> more) const;
  double rate(const Quantity& quantity, std::span<const double> more,
              std::span<const double> more_rates) const;

  /// The number at a place, or its rate there. Throws ExpressionError where it
  /// has none.
  loads::NumberOfPlace field(const PlaceQuantity& quantity) const;
  /// Its gradient there (of values only).
  loads::VectorOfPlace slope(const PlaceQuantity& quantity) const;

  /// " where support_x = 3, gap = 2"; nothing for plain numbers, and for more
  /// than eight names.
  template <class... Quantities>
  std::string where(const Quantities&... quantities) const {
    std::vector<char> used(values_.size(), 0);
    (mark(quantities, used), ...);
    return where_text(used);
  }

  std::vector<std::string>& problems() const { return problems_; }

 private:
  const std::string& name_of(std::size_t k) const;
  std::vector<std::string> names() const;
  double evaluate(const Quantity& quantity) const;
  bool follows(int name) const;
  double nothing(const Quantity& quantity, const ExpressionError& error) const;
  void add_problem(const Quantity& quantity, double value,
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
  std::vector<double> values_;
  std::vector<char> parameter_follows_;  // some design variable
  std::vector<Dual> duals_;              // of one variable; for rates only
};

}  // namespace meniscus::case_data
