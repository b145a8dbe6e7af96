#include "cad/step/step_writer.h"

#include "cad/step/brep_message.h"
#include "cad/step/step_child.h"
#include "cad/step/step_messages.h"
#include "core/atomic_file.h"

namespace meniscus::step {

StepReport write_step(const std::filesystem::path& path,
                      const solid::Brep& brep, const StepOptions& options) {
  return write_step(path, {{options.name, brep}}, options);
}

StepReport write_step(const std::filesystem::path& path,
                      const std::vector<StepPart>& parts,
                      const StepOptions& options) {
  StepChild child(path, StepTask::Write, options.monitor);
  FrameWriter asked = question(StepQuestion::Write);
  asked.put_text(path.string());
  asked.put_text(options.name);
  asked.put_text(options.unit);
  asked.put(static_cast<std::uint64_t>(parts.size()));
  for (const StepPart& part : parts) {
    asked.put_text(part.name);
    put_brep(asked, part.brep);
  }
  const std::string answer = child.ask(asked);
  FrameReader in(answer);
  const StepReport report = get_report(in);
  // Not by the helper: one that is ended leaves nothing beside the file.
  write_file(path, in.get_text());
  return report;
}

}  // namespace meniscus::step
