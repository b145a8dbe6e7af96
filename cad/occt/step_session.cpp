#include "cad/occt/step_session.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::occt {

StepUnit step_unit(const std::string& unit) {
  if (unit == "mm") {
    return {1.0, "MM"};
  }
  if (unit == "m") {
    return {1000.0, "M"};
  }
  if (unit == "in") {
    return {25.4, "INCH"};
  }
  throw InvalidInput(
      fmt::format("unit '{}' of a STEP file is none of mm, m, in", unit));
}

StepSilence::StepSilence()
    : printers_(Message::DefaultMessenger()->Printers()) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
}

StepSilence::~StepSilence() {
  Message::DefaultMessenger()->ChangePrinters() = printers_;
}

}  // namespace meniscus::occt
