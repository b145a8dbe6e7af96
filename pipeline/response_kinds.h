/// Kinds of responses, one row each: what a case says of one, what the rest of
/// the program asks about it, and how it is computed.
#pragma once

#include <string_view>
#include <vector>

#include "core/units.h"
#include "pipeline/case_kinds.h"
#include "pipeline/responses.h"

namespace meniscus {

/// How the error that the mesh makes in a response is estimated.
enum class ErrorSource {
  Exact,   // none that counts
  ByDual,  // by_displacement makes a dual load
  Unknown  // of peaks: recovery and the dual solution miss the most
};

/// One response of one design, on loan.
struct ResponseTask {
  const ResponseEntry& response;
  const ResponseNumbers& numbers;
  const ResponseInput& fields;
  Derivatives derivatives;
};

struct ResponseRow {
  const char* name;
  ResponseKind kind;
  Dimension dimension;  // None also where it is not known
  std::string_view doc;
  KindKeys keys;
  ResponsePartials (*partials)(const ResponseTask& task);  // null: expression
  ErrorSource error = ErrorSource::Exact;
  bool of_films = false;  // a case without films has none
  bool has_derivatives = true;
};

/// All of them, in the order of the reference.
const std::vector<ResponseRow>& response_kinds();

const ResponseRow& row_of(ResponseKind kind);

/// A key that each of its kind has.
bool needs_key(const ResponseRow& row, const char* key);

/// Of extremes over the part's surface, where the case says nothing else: to a
/// tenth of an edge [1/length].
double sharpness_of(const ResponseEntry& response, const ResponseInput& fields);

}  // namespace meniscus
