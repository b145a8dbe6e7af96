/// What is known of a case's responses before one is computed.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// Made of responses above it: an expression or an envelope.
bool is_composed(const ResponseEntry& entry);

/// Indices of the responses that a composed one is made of; of others none.
std::vector<int> responses_in(const Case& input, const ResponseEntry& entry);

/// False for peaks of nodal stress, and for what is made of them.
bool has_derivatives(const Case& input, int response);

/// Of a field near its largest or smallest value (response_kinds.h), or made of
/// such a response.
bool is_extreme(const Case& input, int response);

/// The worst direction of a load is known for it without trial: a response
/// that is linear in the load, or quadratic at each place.
bool knows_worst_direction(const ResponseEntry& entry);

/// The load from any direction that has the load case as one of its three unit
/// loads; the end where there is none.
std::vector<DirectionsEntry>::const_iterator directions_with(
    const Case& input, std::size_t load_case);

/// Which of the load cases with shown ones behind them (forward::find_stresses)
/// has the peak of stress that a response is of.
std::size_t shown_load_case(const Case& input, const ResponseEntry& entry);

/// Position of a response of the case; it must exist.
int response_index(const Case& input, const std::string& name);

}  // namespace meniscus::case_data
