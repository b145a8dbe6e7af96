/// Kinds of responses, one row each: what a case says of one and what the rest
/// of the program asks about it; pipeline/forward/response_partials computes
/// them.
#pragma once

#include <string_view>
#include <vector>

#include "core/units.h"
#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_kinds.h"

namespace meniscus::case_data {

/// How the error that the mesh makes in a response is estimated.
enum class ErrorSource {
  Exact,        // none that counts
  ByDual,       // by_displacement makes a dual load
  ByReadings,   // what the largest reading of a peak says above the one told
  BySmoothing,  // what a smooth extreme is beside the sharp one
  Unknown  // of smooth maxima: recovery and the dual solution miss the most
};

/// How the worst direction of a load is known without trial.
enum class WorstKnown {
  No,
  BySum,     // the response is linear in the load
  ByEnergy,  // quadratic
  AtNodes    // quadratic at each node, of von Mises stress
};

struct ResponseRow {
  const char* name;
  ResponseKind kind;
  Dimension dimension;  // None also where it is not known
  std::string_view doc;
  KindKeys keys;
  ErrorSource error = ErrorSource::Exact;
  bool of_films = false;  // a case without films has none
  bool has_derivatives = true;
  /// Of a field near its largest or smallest value: from mesh to mesh it shows
  /// no order, and at a clamped edge or a sharp corner it may have no limit.
  bool is_extreme = false;
  WorstKnown worst = WorstKnown::No;
};

/// All of them, in the order of the reference.
const std::vector<ResponseRow>& response_kinds();

const ResponseRow& row_of(ResponseKind kind);

/// Their names, in this order.
std::vector<std::string> names_of(const std::vector<ResponseKind>& kinds);

/// A key that each of its kind has.
bool needs_key(const ResponseRow& row, const char* key);

}  // namespace meniscus::case_data
