#include "fea/distributed/petsc_child.h"

#include <cstdlib>
#include <filesystem>
#include <stdlib.h>

#include <fmt/format.h>

#include "core/child_process.h"
#include "core/error.h"
#include "core/find_program.h"

namespace meniscus::distributed {

namespace {

namespace fs = std::filesystem;

constexpr const char* kHelper = "meniscus-petsc";
constexpr const char* kVariable = "MENISCUS_PETSC";
constexpr const char* kStarter = "mpirun";
constexpr int kKilled = 137;  // mpirun's code for a process that was

std::string find_petsc() {
  return require_helper(
      kHelper, kVariable,
      "this program was built without PETSc; install libpetsc-real-dev and "
      "openmpi-bin and build again, or choose another solver");
}

void require_starter() {
  if (!find_program(kStarter)) {
    throw IoError(
        fmt::format("{} not found in PATH; the solver petsc needs "
                    "it: install openmpi-bin",
                    kStarter));
  }
}

/// A folder that goes with its owner.
class Folder {
 public:
  Folder() {
    std::error_code failed;
    std::string name =
        (fs::temp_directory_path(failed) / "meniscus-petsc-XXXXXX").string();
    if (failed || ::mkdtemp(name.data()) == nullptr) {
      throw IoError(fmt::format(
          "no temporary folder can be made as {}; TMPDIR chooses its place",
          name));
    }
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Without the empty lines and rules that mpirun puts around its messages.
std::string condensed(const std::string& text) {
  std::string result;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    if (line.find_first_not_of("- \t") != std::string::npos) {
      result += (result.empty() ? "" : "\n") + line;
    }
    at = end + 1;
  }
  return result;
}

/// The helper is one thread a process. Binding would put two runs at a time on
/// the same cores; --oversubscribe: more processes than cores are allowed; on a
/// busy machine one that waits must not keep the core from those it waits for.
ChildOptions command(const std::string& helper, const PetscRun& run,
                     const fs::path& folder) {
  ChildOptions options;
  options.argv = {kStarter,
                  "-n",
                  std::to_string(run.processes),
                  "--allow-run-as-root",
                  "--oversubscribe",
                  "--bind-to",
                  "none",
                  "--mca",
                  "mpi_yield_when_idle",
                  "1",
                  "-x",
                  "OMP_NUM_THREADS",
                  "-x",
                  "OPENBLAS_NUM_THREADS",
                  helper,
                  folder.string()};
  options.environment = {
      {"OMP_NUM_THREADS", "1"}, {"OPENBLAS_NUM_THREADS", "1"}, {"LC_ALL", "C"}};
  if (std::getenv("OMPI_MCA_orte_default_hostfile") == nullptr) {
    // On one machine: what Open MPI leaves behind when it is stopped goes with
    // the folder.
    options.environment.emplace_back("OMPI_MCA_orte_tmpdir_base",
                                     folder.string());
    options.environment.emplace_back("OMPI_MCA_btl_vader_backing_directory",
                                     folder.string());
  }
  options.time_limit = run.time_limit;
  options.monitor = run.monitor;
  return options;
}

}  // namespace

void require_petsc() {
  find_petsc();
  require_starter();
}

PetscSolution run_petsc(const PetscSystem& system, const PetscRun& run) {
  const std::string helper = find_petsc();
  require_starter();
  const Folder folder;
  write_pieces(system, run.processes, folder.path());
  const ChildResult child = run_child(command(helper, run, folder.path()));
  if (child.stopped) {
    throw Interrupted("stopped on request while PETSc was solving");
  }
  if (child.timed_out) {
    throw SolverError(fmt::format(
        "PETSc's {} processes were ended at their time limit of {:.0f} s; more "
        "processes or a coarser mesh (resolution.fea) need less",
        run.processes, run.time_limit));
  }
  if (!child.succeeded()) {
    const std::string said = condensed(child.error_tail);
    throw SolverError(fmt::format(
        "PETSc's {} processes (mpirun) {}{}{}{}", run.processes,
        describe_end(child),
        child.exit_code == kKilled
            ? " (one was killed by signal 9; was there enough memory?)"
            : "",
        said.empty() ? "" : ", saying:\n", said));
  }
  return read_results(system, run.processes, folder.path());
}

}  // namespace meniscus::distributed
