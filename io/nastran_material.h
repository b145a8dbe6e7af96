/// A region's material as bulk data (internal to the Nastran writer).
#pragma once

#include <string>

#include "io/analysis_deck.h"

namespace meniscus::io {

/// PSOLID and MAT1, or MAT9 with its axes in CORD2R, all of number `id`.
std::string nastran_material(const DeckMaterial& material, int id);

/// The card MAT1 of an isotropic material.
std::string isotropic_card(const DeckMaterial& material, int id);

/// MAT1, or MAT8 of an orthotropic material in the plane of axes 1 and 2.
std::string ply_card(const DeckMaterial& material, int id);

}  // namespace meniscus::io
