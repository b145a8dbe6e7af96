/// Runs CalculiX on a deck and reads what it printed.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/types.h"

namespace meniscus {

/// One step's *NODE PRINT and *EL PRINT results.
struct CalculixStep {
  VectorX displacement;          // 3 per node, in node order
  Vec3 reaction = Vec3::Zero();  // sum over the supports
  /// At integration points, element by element: xx yy zz xy yz zx.
  std::vector<std::array<double, 6>> stress;
};

bool have_calculix();

struct CalculixOptions {
  double time_limit = 300.0;  // [s]
  int threads = 1;
};

/// Runs `ccx` in a fresh folder. Throws std::runtime_error with the end of its
/// output when it fails.
std::vector<CalculixStep> run_calculix(const std::string& deck, int node_count,
                                       const CalculixOptions& options = {});

/// The same for a deck of one static step, with its procedure exchanged for
/// "*FREQUENCY\n6" or "*BUCKLE\n2": omega^2 [1/time^2], or buckling factors.
std::vector<double> run_calculix_eigenvalues(std::string deck,
                                             const std::string& procedure);

/// Reads the text of a .dat file with the displacement of all nodes and total
/// forces per step.
std::vector<CalculixStep> read_calculix_dat(const std::string& text,
                                            int node_count);

/// Largest difference of a component over the largest component of `theirs`;
/// infinite when the sizes differ.
double relative_difference(const VectorX& ours, const VectorX& theirs);
double relative_difference(const std::vector<std::array<double, 6>>& ours,
                           const std::vector<std::array<double, 6>>& theirs);

}  // namespace meniscus
