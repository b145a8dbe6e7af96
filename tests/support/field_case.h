/// A strut whose film's tension is a field of any number of coefficients.
#pragma once

#include <string>

namespace meniscus {

/// Each coefficient a design variable; elements of `edge` [mm].
std::string field_case(int along, int around, double edge);

}  // namespace meniscus
