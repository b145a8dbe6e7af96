/// Internal to reading and writing STEP: units, and quiet.
#pragma once

#include <string>

#include <Message_SequenceOfPrinters.hxx>

namespace meniscus::occt {

struct StepUnit {
  double millimetres = 1.0;
  const char* name = "MM";  // OpenCASCADE's
};
/// Throws InvalidInput for a unit that is none of mm, m, in.
StepUnit step_unit(const std::string& unit);

/// While it lives nothing of OpenCASCADE's talk reaches the terminal.
class StepSilence {
 public:
  StepSilence();
  ~StepSilence();
  StepSilence(const StepSilence&) = delete;
  StepSilence& operator=(const StepSilence&) = delete;

 private:
  Message_SequenceOfPrinters printers_;
};

}  // namespace meniscus::occt
