/// A region's material as deck text (internal to the deck writer).
#pragma once

#include <string>

#include "io/calculix_inp.h"

namespace meniscus::io {

/// *MATERIAL with its constants. `name`: as CalculiX takes it.
std::string constants_text(const DeckMaterial& material,
                           const std::string& name);

/// The same, its orientation if it has one, and the section of element set
/// REGION_<region>.
std::string material_text(const DeckMaterial& material, const std::string& name,
                          std::size_t region);

}  // namespace meniscus::io
