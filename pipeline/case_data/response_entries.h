/// What is known of a case's responses before one is computed.
#pragma once

#include <string>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// False for peaks of nodal stress, and for what is made of them.
bool has_derivatives(const Case& input, int response);

/// Position of a response of the case; it must exist.
int response_index(const Case& input, const std::string& name);

}  // namespace meniscus::case_data
