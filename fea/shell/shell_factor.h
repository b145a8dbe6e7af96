/// K^-1 of a shell, of as many unknowns as memory has room for.
///
/// Substructures are condensed onto the cuts between them, these onto the next
/// ones, up to the whole (static condensation: Guyan 1965; multifrontal:
/// Duff and Reid 1983): dense fronts for the cuts, sparse factors within. The
/// latter take most of the memory; those for which there is none are made
/// again for each solution.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/math/linear_solve.h"
#include "core/math/spilled_matrix.h"
#include "core/monitor.h"
#include "fea/shell/shell_assembly.h"
#include "fea/shell/substructures.h"

namespace meniscus::shell {

struct ShellFactorOptions {
  /// Unknowns of a substructure, about; below twice of it there is one.
  int unknowns = 60000;
  /// Halvings at most: more of them take less memory and work within, and more
  /// for the cuts.
  int most_levels = 7;
  /// That substructures' factors may keep, and a quarter of it the cuts', the
  /// others of which go to the disk [byte]; below 0: half of what the machine
  /// has left. The results do not depend on it.
  double kept_bytes = -1.0;
  /// Told how far it is, and asked whether to stop, where there are
  /// substructures; not owned, null for none.
  Monitor* monitor = nullptr;
};

class ShellFactor {
 public:
  /// Keeps references, `matrix`, of one facet, symmetric, and the monitor.
  /// `right`: columns of free unknowns that become their solution on the way,
  /// for which substructures are made once less; may be null. Throws
  /// SolverError where the sum is not positive definite, or memory runs out,
  /// IoError where the disk does, Interrupted.
  ShellFactor(const ShellMesh& mesh, const ShellFreedom& freedom,
              MatrixOfFacet matrix, const ShellFactorOptions& options = {},
              Eigen::MatrixXd* right = nullptr);
  ~ShellFactor();

  /// One or several columns of free unknowns. Throws IoError, Interrupted.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  struct Leaf;
  struct Front;
  struct Columns;
  Leaf factored(int leaf) const;
  const Leaf& leaf_of(int leaf, std::unique_ptr<Leaf>& made) const;
  void condense_leaf(int leaf, Columns* columns);
  void check_rows(const Eigen::MatrixXd& right) const;
  void eliminate(int leaf, const Leaf& own, Columns& columns) const;
  Eigen::MatrixXd solve_cuts(Columns& columns) const;
  /// Some in threads at a time, after() after each time.
  template <class Each, class After>
  void for_leaves(const char* work, const Each& each, const After& after) const;
  void condense_halves(int part);
  StoredMatrix stored(Eigen::MatrixXd matrix);
  std::vector<int> unknowns_of(const std::vector<int>& nodes) const;

  const ShellMesh& mesh_;
  const ShellFreedom& freedom_;
  MatrixOfFacet matrix_;
  Substructures cut_;
  Monitor& monitor_;
  double kept_bytes_ = 0.0;
  std::vector<std::unique_ptr<Leaf>> kept_;
  std::vector<std::unique_ptr<Front>> fronts_;  // by part
  // By part, until its whole has it; of no rows where it hangs on nothing. The
  // lower triangle alone has a meaning.
  std::vector<std::optional<StoredMatrix>> schur_;
  std::mutex dense_mutex_;
  double dense_bytes_ = 0.0;  // of both, without what is on the disk
};

}  // namespace meniscus::shell
