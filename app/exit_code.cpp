#include "app/exit_code.h"

namespace meniscus {

int exit_code_of(RunStatus status) {
  switch (status) {
    case RunStatus::Converged:
      return kExitDone;
    case RunStatus::Infeasible:
    case RunStatus::Stopped:
    case RunStatus::Failed:
      return kExitNoSolution;
    case RunStatus::Error:
      return kExitError;
    case RunStatus::Interrupted:
      return kExitInterrupted;
  }
  return kExitError;
}

}  // namespace meniscus
