/// Bulk data for Nastran (MSC, NX, OptiStruct and what else takes it): a mesh
/// with its materials, supports and loads as a linear static job, SOL 101.
///
/// Nodes and elements are numbered from 1 in the mesh's order; element n of
/// region r has property and material r + 1. Load case k is SUBCASE k. Node
/// sets of the surfaces are SETs of the case control, named in comments. Long
/// fields of 16 characters carry 11 digits or more. What belongs to nothing in
/// the file is left out: rotations are held by GRDSET.
#pragma once

#include <filesystem>
#include <string>

#include "io/analysis_deck.h"

namespace meniscus::io {

/// The file's text. Pressures become PLOAD4, nodal forces FORCE, weight GRAV,
/// spin RFORCE about a held grid point on the axis, temperatures TEMP against
/// a reference of 0; equations MPC; springs CELAS2 on scalar points that MPCs
/// tie to the mesh; orthotropic materials MAT9 in axes of CORD2R. Text that is
/// not ASCII becomes '_'. Throws InvalidInput as check_deck() does, and for a
/// mesh with more than 99,999,999 nodes or elements.
std::string nastran_bdf(const TetMesh& mesh, const AnalysisDeck& deck);

/// The same into a file; IoError.
void write_nastran_bdf(const std::filesystem::path& path, const TetMesh& mesh,
                       const AnalysisDeck& deck);

/// A real number as Nastran reads it, at most 16 characters, with as many
/// digits as these hold: 11 or more, 10 beyond 1e99 and below 1e-99.
std::string nastran_real(double value);

}  // namespace meniscus::io
