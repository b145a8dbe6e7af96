// libFuzzer harness of the datafile reader: whatever the bytes, an answer or
// InvalidInput; what is read can be written, and read again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "evolve/datafile/fe_commands.h"
#include "evolve/datafile/fe_complex.h"
#include "evolve/datafile/fe_write.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace meniscus;
  using namespace meniscus::datafile;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::string written;
  try {
    const FeFile file = read_fe(text, "fuzz.fe");
    written = fe_text(complex_of(file));
    parse_commands(file.commands, file.name, file.commands_line);
  } catch (const InvalidInput&) {
    if (written.empty()) {
      return 0;
    }
  }
  try {
    complex_of(read_fe(written, "written.fe"));
  } catch (const InvalidInput& error) {
    // Formulas that were just deep or long enough, or one-sided constraints
    // that rounding breaks, may be refused; broken syntax may not.
    const std::string message = error.what();
    if (message.find("expected") != std::string::npos ||
        message.find("not defined") != std::string::npos) {
      std::abort();
    }
  }
  return 0;
}
