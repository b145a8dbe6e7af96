/// What filling and solving a part will take, before it begins.
#pragma once

#include <cstddef>
#include <string>

#include "pipeline/case_data/case.h"

namespace meniscus::forward {

struct WorkEstimate {
  double elements = 0.0;  // ten-node tetrahedra
  double bytes = 0.0;     // at the peak of the first model
};

/// Of a volume [length^3] within `facets` (0: not known) at edges of `edge`
/// [length]: 8.2 elements for each cube of the edge, at least 1.5 for each
/// facet, 4.2 kB for each element, as docs/performance.md has them.
WorkEstimate estimate_work(double volume, std::size_t facets, double edge);

/// Of the volumes that the case asks for.
WorkEstimate estimate_work(const case_data::Case& input,
                           const case_data::EvaluatedCase& inputs, double edge);

/// "about 110,000 elements, 0.5 GB".
std::string text_of(const WorkEstimate& work);

/// Throws InvalidInput where memory does not hold it, or numbers of nodes do
/// not: names what `edge` is and what would fit.
void require_work(const WorkEstimate& work, double edge);
/// The same of a shell: 46 kB for each facet, or 15 kB where it is cut into
/// substructures, which those beside solids are not.
void require_shell_work(std::size_t facets, double edge,
                        bool beside_solids = false);
/// Of the case's initial design.
void require_work(const case_data::Case& input);

}  // namespace meniscus::forward
