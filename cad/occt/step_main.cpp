// meniscus-step: reads and writes STEP for the program, which links no
// OpenCASCADE itself and starts this to read under limits of time and memory:
// OpenCASCADE may end its process on a damaged file. Questions on stdin,
// answers on stdout (cad/step/step_messages.h).
#include <new>
#include <optional>
#include <unistd.h>

#include <Standard_Failure.hxx>
#include <fmt/format.h>

#include "cad/occt/open_step_edges.h"
#include "cad/occt/solid_of_step.h"
#include "cad/occt/step_text.h"
#include "cad/occt/tessellate_step.h"
#include "cad/step/brep_message.h"
#include "cad/step/step_messages.h"
#include "core/error.h"
#include "core/frame.h"

namespace {

using namespace meniscus;
using namespace meniscus::occt;
using step::StepAnswer;
using step::StepQuestion;

class Answerer {
 public:
  std::string answer(const std::string& question) {
    try {
      FrameWriter out;
      out.put(StepAnswer::Done);
      FrameReader in(question);
      answer(in, out);
      return out.bytes();
    } catch (const InvalidInput& error) {
      return refusal(StepAnswer::InvalidInput, error.what());
    } catch (const MeshError& error) {
      return refusal(StepAnswer::MeshError, error.what());
    } catch (const std::bad_alloc&) {
      return refusal(StepAnswer::NoMemory, "");
    } catch (const std::exception& error) {
      return refusal(StepAnswer::IoError, error.what());
    } catch (const Standard_Failure& failure) {
      const char* said = failure.GetMessageString();
      return refusal(
          StepAnswer::InvalidInput,
          fmt::format("{}: OpenCASCADE cannot read it ({}{}{}); the file is "
                      "damaged; write it anew from its CAD program",
                      path_, failure.DynamicType()->Name(),
                      said != nullptr && *said != 0 ? ": " : "",
                      said != nullptr ? said : ""));
    }
  }

 private:
  static std::string refusal(StepAnswer kind, const std::string& message) {
    FrameWriter out;
    out.put(kind);
    out.put_text(message);
    return out.bytes();
  }

  void answer(FrameReader& in, FrameWriter& out) {
    switch (in.get<StepQuestion>()) {
      case StepQuestion::Part: {
        path_ = in.get_text();
        step::ReadStepOptions options{.unit = in.get_text()};
        options.edge = in.get<double>();
        step::put_mesh(out, tessellate_step(path_, options));
        break;
      }
      case StepQuestion::Open: {
        path_ = in.get_text();
        edges_.emplace(path_, in.get_text());
        break;
      }
      case StepQuestion::Loop: {
        std::vector<std::string> names(in.get<std::uint64_t>());
        for (std::string& name : names) {
          name = in.get_text();
        }
        step::put_loop(out, edges_.value().loop(names));
        break;
      }
      case StepQuestion::Rim:
        step::put_loop(out, edges_.value().rim(in.get_text()));
        break;
      case StepQuestion::Solid: {
        path_ = in.get_text();
        out.put_text(exact_shape_text(solid_of_step(path_, in.get_text())));
        break;
      }
      case StepQuestion::Write: {
        path_ = in.get_text();
        const step::StepOptions options{.name = in.get_text(),
                                        .unit = in.get_text()};
        std::vector<step::StepPart> parts(in.get<std::uint64_t>());
        for (step::StepPart& part : parts) {
          part.name = in.get_text();
          part.brep = step::get_brep(in);
        }
        const StepText written = step_text(path_, parts, options);
        step::put_report(out, written.report);
        out.put_text(written.text);
        break;
      }
    }
  }

  std::string path_;
  std::optional<OpenStepEdges> edges_;
};

}  // namespace

int main() {
  const int out = take_stdout();
  Answerer answerer;
  while (const auto question = read_frame(STDIN_FILENO)) {
    if (!write_frame(out, answerer.answer(*question))) {
      ::_exit(1);
    }
  }
  ::_exit(0);  // shapes of a damaged file are not taken apart
}
