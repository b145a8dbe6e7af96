/// The mesher side by side with the program `tetgen` on the same surfaces.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus {

struct MeshWork {
  std::string name;
  SurfaceMesh surface;
  double edge = 0.0;  // of the elements [length]
};

/// At full size about 115,000 to 170,000 elements; each level of `coarser`
/// leaves about an eighth of them.
std::vector<MeshWork> mesh_works(int coarser = 0);

/// CPU seconds, user and system, helper processes included.
struct MeshRun {
  bool succeeded = false;
  int elements = 0;
  double seconds = 0.0;
  double tetgen_seconds = 0.0;  // ours: of the helper; theirs: as it prints
  double wall_seconds = 0.0;
  double peak_bytes = 0.0;
  double min_dihedral_deg = 0.0;
  std::string message;
};

/// From the surface in memory to the checked, improved mesh in memory.
MeshRun run_mesher(const MeshWork& work);

bool have_tetgen();

/// The same switches, coordinates in the same frame. It reads a .smesh file
/// (a few per cent of its time) and writes none.
MeshRun run_tetgen_program(const MeshWork& work);

struct MeshRace {
  MeshRun own;         // the fastest, or the first that failed
  MeshRun peer;        // likewise
  double ratio = 0.0;  // median of own over peer, runs side by side
};

/// The two in turn, since a machine's speed drifts by more than they differ.
MeshRace race_mesher(const MeshWork& work, int runs);

}  // namespace meniscus
