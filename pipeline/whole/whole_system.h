/// The films of the whole, where planes of symmetry cut the curves of what the
/// case draws: for solids whose faces run on across these planes.
#pragma once

#include <vector>

#include "pipeline/case_data/case_values.h"

namespace meniscus::whole {

struct WholeSystem {
  films::FilmSystem system;
  /// The planes that cut nothing, by their place in Case::symmetry: the whole
  /// is `system` with its images in them.
  std::vector<std::size_t> mirrors;
};

/// The system without the faces of planes that cut, with the images of curves
/// and surfaces beside these planes (pad/image in the first, pad/image_2 in the
/// second) and the volumes of all images together. Throws InvalidInput where
/// that is not known: cells, fields, films and solids that end in such a plane
/// too, films whose kind is of fewer curves.
WholeSystem whole_system(const case_data::Case& input,
                         const films::FilmSystem& drawn);

}  // namespace meniscus::whole
