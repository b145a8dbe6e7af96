/// What the program and its helper `meniscus-petsc` say to each other, in files
/// of one folder, from one build: process r reads "piece_r" and writes
/// "result_r", each a header, arrays without gaps, and the end mark. Readers
/// check every number.
///
/// The solver's nodes are cut into equal contiguous ranges, one a process. A
/// process's piece holds its own nodes, all elements that touch them, and the
/// other nodes of these elements ("ghosts"), so that it assembles its rows of
/// the matrix without asking any other. Local ids: own nodes first, ascending,
/// then ghosts, ascending.
#pragma once

#include <cstdint>
#include <string>

namespace meniscus::distributed::petsc {

inline constexpr std::uint64_t kMagic = 0x4d45'4e50'4554'0001;  // last: version
inline constexpr std::uint64_t kEndMark = 0x454e'444d'4152'4b21;

/// Followed by: ids of the ghosts (int32 each), coordinates of all local nodes
/// (3 doubles each), elements (nodes_per_element local ids each, int32, in
/// TetMesh's order), their regions (int32), a Law per region, groups, and the
/// end mark.
struct PieceHeader {
  std::uint64_t magic = kMagic;
  std::int64_t process = 0;
  std::int64_t processes = 0;
  std::int64_t nodes = 0;  // of the whole part
  std::int64_t first = 0;  // own nodes: first .. first + own - 1
  std::int64_t own = 0;
  std::int64_t ghosts = 0;
  std::int64_t elements = 0;
  std::int64_t nodes_per_element = 0;
  std::int64_t regions = 0;
  std::int64_t groups = 0;
  std::int64_t max_iterations = 0;
  double tolerance = 0.0;  // see ElasticOptions
};

struct Law {
  double isotropic = 0.0;  // 1 or 0
  double lambda = 0.0;     // [pressure]
  double mu = 0.0;
  double tensor[81] = {};  // ElasticLaw::tensor, row by row
};

/// Load cases that are held alike share a matrix. Followed by: held local nodes
/// (int32 each), their projectors (9 doubles each), pairs of local nodes that
/// springs couple, at least one of them own (2 int32 each), their symmetric
/// blocks (9 doubles each), and for each load case the forces on own nodes (3
/// doubles each), then, with start, the displacements to begin from.
struct GroupHeader {
  std::int64_t held = 0;
  std::int64_t springs = 0;
  std::int64_t cases = 0;
  std::int64_t start = 0;  // 1 or 0
};

/// Followed by, for each group: the diagonal of its matrix (3 doubles an own
/// node); for each of its load cases a CaseResult and the displacements of own
/// nodes (3 doubles each). Then the end mark.
struct ResultHeader {
  std::uint64_t magic = kMagic;
  std::int64_t own = 0;
  double peak_bytes = 0.0;  // of the process
  double setup_seconds = 0.0;
  double solve_seconds = 0.0;
};

enum class CaseEnd : std::int64_t {
  Converged,
  TooManyIterations,
  NotPositive,
  NotFinite
};

struct CaseResult {
  CaseEnd end = CaseEnd::Converged;
  std::int64_t iterations = 0;
  double error = 0.0;  // relative, in the energy norm, estimated
};

inline std::string piece_name(int process) {
  return "piece_" + std::to_string(process);
}
inline std::string result_name(int process) {
  return "result_" + std::to_string(process);
}

}  // namespace meniscus::distributed::petsc
