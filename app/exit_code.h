/// The program's exit codes, a contract with scripts that call it.
#pragma once

#include "pipeline/study/study.h"

namespace meniscus {

inline constexpr int kExitDone = 0;
inline constexpr int kExitWrongInput = 2;  // found before work starts
inline constexpr int kExitNoSolution = 3;  // infeasible, stopped, failed
inline constexpr int kExitError = 4;       // internal error, full disk
inline constexpr int kExitInterrupted = 130;

/// Of result.json's status.
int exit_code_of(RunStatus status);

}  // namespace meniscus
