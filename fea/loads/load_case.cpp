#include "fea/loads/load_case.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace meniscus::loads {

std::string Surfaces::text() const {
  return fmt::format("{}", fmt::join(*this, " and "));
}

bool enforces(const LoadCase& load_case) {
  return std::any_of(
             load_case.supports.begin(), load_case.supports.end(),
             [](const Support& s) { return s.displacement || s.rotation; }) ||
         std::any_of(load_case.held_nodes.begin(), load_case.held_nodes.end(),
                     [](const HeldNode& h) { return h.displacement != 0.0; }) ||
         std::any_of(load_case.pins.begin(), load_case.pins.end(),
                     [](const RigidPin& pin) {
                       return pin.displacement || pin.rotation;
                     });
}

}  // namespace meniscus::loads
