// libFuzzer harness of the reader of csv curves: finite points, or problems
// that say why not.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "core/units.h"
#include "pipeline/files/curve_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace meniscus;
  const std::string text(reinterpret_cast<const char*>(data), size);
  static const UnitSystem units = *unit_system("mm-N-MPa");
  const files::CurveFile file = files::read_curve_text(text, "fuzz.csv", units);
  for (const Vec3& p : file.points) {
    if (file.problems.empty() && !p.allFinite()) {
      std::abort();
    }
  }
  if (file.problems.empty() && file.points.size() < 3) {
    std::abort();
  }
  return 0;
}
