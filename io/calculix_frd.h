/// CalculiX's result file (.frd) in text, as cgx, FreeCAD and PrePoMax read it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "io/file_notes.h"

namespace meniscus::io {

enum class FrdKind { Displacement, Force, Stress };

/// Values at all nodes, all components of one before the next: 3, or of stress
/// the 6 components xx yy zz xy yz zx.
struct FrdField {
  FrdKind kind = FrdKind::Displacement;
  std::vector<double> values;
};

enum class FrdAnalysis { Static, Frequency, Buckling };

/// What belongs together: a static step, a mode.
struct FrdResult {
  FrdAnalysis analysis = FrdAnalysis::Static;
  int step = 1;        // of the deck
  int mode = 0;        // from 1; 0: no mode
  double value = 1.0;  // time, frequency or buckling factor
  std::vector<FrdField> fields;
};

struct FrdOptions {
  FileNotes notes;
  std::vector<int> node_numbers;       // one per node; empty: from 1
  std::vector<int> element_numbers;    // the same
  std::vector<std::string> materials;  // one per region
};

/// Six digits, as CalculiX writes. Throws InvalidInput for fields and numbers
/// that do not fit the mesh, IoError.
void write_frd(const std::filesystem::path& path, const TetMesh& mesh,
               const std::vector<FrdResult>& results,
               const FrdOptions& options = {});

}  // namespace meniscus::io
