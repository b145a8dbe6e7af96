#include "app/run_files.h"

#include "app/draw.h"
#include "app/exit_code.h"
#include "pipeline/results.h"

namespace meniscus {

void write_run_files(const Case& input, const EvaluationFields& fields,
                     const std::filesystem::path& folder,
                     const RunArguments& arguments, Monitor& monitor,
                     RunResult& result) {
  if (!fields.mesh.nodes.empty()) {
    monitor.progress({.stage = "output", .detail = "writing meshes"});
    write_meshes(input, fields, folder);
    if (arguments.pictures) {
      monitor.progress({.stage = "output", .detail = "drawing pictures"});
      for (std::string& warning : draw(input, fields, folder, monitor)) {
        result.warnings.push_back(std::move(warning));
      }
    }
  }
  for (const std::string& name : write_unfilled(fields, folder)) {
    result.warnings.push_back("look at the surface in " + name);
  }
}

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
