/// Runs the helper `meniscus-petsc` in several processes.
#pragma once

#include <optional>

#include "core/monitor.h"
#include "fea/distributed/petsc_cut.h"

namespace meniscus::distributed {

struct PetscRun {
  int processes = 2;
  double time_limit = 600.0;   // wall clock [s]
  Monitor* monitor = nullptr;  // asked every 50 ms whether to stop
};

/// Throws IoError, with what to install, unless mpirun (Debian's openmpi-bin)
/// is in PATH and the helper is found: at the path in the environment variable
/// MENISCUS_PETSC; else beside the running program, in ../libexec/meniscus from
/// there, and where the program was installed. It is built where PETSc
/// (libpetsc-real-dev) is found.
void require_petsc();

/// The pieces go through a folder in TMPDIR that ends with the call; over
/// several machines (Open MPI's own variables name them) all must see it.
/// Throws what require_petsc and write_pieces throw, SolverError when a process
/// dies or the time is over, with the end of what it said, and Interrupted.
PetscSolution run_petsc(const PetscSystem& system, const PetscRun& run);

}  // namespace meniscus::distributed
